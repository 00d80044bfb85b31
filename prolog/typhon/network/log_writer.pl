:- module(typhon_log_writer,
          [ log_writer_start/5,         % +Name, +Spec, +Mode, -Queue, -Thread
            log_writer_stop/2,          % +Queue, +Thread
            log_writer_flush/1          % +Queue
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module('../kernel/base/error_text', [error_told/3]).
:- use_module(log_file, [log_open/3, log_write/2]).

/** <module> The thread that writes a log

Its queue is bounded: senders of more than the disk can take wait in the
end, nothing is dropped. It flushes whenever nothing more waits.

*Threading*: one thread per log server.
*/

:- multifile
    prolog:message//1.

%!  log_writer_start(+Name, +Spec, +Mode, -Queue, -Thread) is det.
%!  log_writer_stop(+Queue, +Thread) is det.
%
%   What is put in Queue, terms event(Time, Host, Agent, What), is written to
%   the file Spec, opened in Mode, until all that was there is written.
%
%   @error existence_error(directory, Dir), permission_error(open,
%   source_sink, File)

log_writer_start(Name, Spec, Mode, Queue, Thread) :-
    (   absolute_file_name(Spec, File)
    ->  true
    ;   existence_error(source_sink, Spec)
    ),
    log_open(File, Mode, Stream),
    message_queue_create(Queue, [max_size(100 000)]),
    writer_alias(Name, Alias),
    catch(thread_create(write_events(Queue, File, open(Stream, 0)), Thread,
                        [alias(Alias)]),
          Error,
          ( close(Stream), message_queue_destroy(Queue), throw(Error) )).

%   A server of the same name may be about to end.

writer_alias(Name, Alias) :-
    flag(typhon_log_writer, N, N+1),
    atomic_list_concat([typhon_log_writer_, Name, '_', N], Alias).

log_writer_stop(Queue, Thread) :-
    thread_send_message(Queue, stop),
    thread_join(Thread, _),
    message_queue_destroy(Queue).

%!  log_writer_flush(+Queue) is det.
%
%   What was put in Queue before is in the file, unless it cannot be written;
%   or five seconds have passed.

log_writer_flush(Queue) :-
    setup_call_cleanup(
        message_queue_create(Answers),
        catch(( thread_send_message(Queue, flush(Answers)),
                ignore(thread_get_message(Answers, flushed, [timeout(5)])) ),
              error(existence_error(_, _), _),
              true),                    % it has ended, and written all
        message_queue_destroy(Answers)).

flushed(Answers) :-
    catch(thread_send_message(Answers, flushed),
          error(existence_error(_, _), _),
          true).

%   write_events(+Queue, +File, +State): State is open(Stream, Unsure),
%   where the last Unsure events may be in memory only; or lost(Count,
%   Again), where the file could not be written, is tried again at the time
%   Again, and Count events are lost.  The beginning and the end are
%   reported, not each event.

write_events(Queue, File, State0) :-
    next_event(Queue, File, Event, State0, State1),
    (   Event == stop
    ->  finish(State1, File)
    ;   Event = flush(Answers)
    ->  flush(State1, File, State),
        flushed(Answers),
        write_events(Queue, File, State)
    ;   write_event(State1, File, Event, State),
        write_events(Queue, File, State)
    ).

next_event(Queue, File, Event, State0, State) :-
    (   thread_peek_message(Queue, _)
    ->  State = State0,
        thread_get_message(Queue, Event)
    ;   flush(State0, File, State),
        thread_get_message(Queue, Event)
    ).

flush(open(Stream, Unsure), File, State) :-
    !,
    catch(( flush_output(Stream), State = open(Stream, 0) ),
          error(Formal, Context),
          broken(Stream, Unsure, File, error(Formal, Context), State)).
flush(State, _, State).

write_event(open(Stream, Unsure0), File, Event, State) :-
    Unsure is Unsure0+1,
    catch(( log_write(Stream, Event), State0 = open(Stream, Unsure) ),
          error(Formal, Context),
          broken(Stream, Unsure, File, error(Formal, Context), State0)),
    (   Unsure mod 1000 =:= 0
    ->  flush(State0, File, State)
    ;   State = State0
    ).
write_event(lost(Count0, Again), _, _, lost(Count, Again)) :-
    get_time(Now),
    Now < Again,
    !,
    Count is Count0+1.
write_event(lost(Count, _), File, Event, open(Stream, 0)) :-
    reopened(File, Event, Stream),
    !,
    print_message(warning, typhon(log_written_again(File, Count))).
write_event(lost(Count0, _), _, _, lost(Count, Again)) :-
    Count is Count0+1,
    next_try(Again).

next_try(Again) :-
    get_time(Now),
    Again is Now+1.

%   What is left in the buffer must not be written later, in the middle of
%   a line.

broken(Stream, Count, File, Error, lost(Count, Again)) :-
    close(Stream, [force(true)]),
    print_message(error, typhon(log_not_written(File, Error))),
    next_try(Again).

reopened(File, Event, Stream) :-
    catch(log_open(File, append, Stream), error(_, _), fail),
    catch(( log_write(Stream, Event),
            flush_output(Stream) ),
          error(_, _),
          ( close(Stream, [force(true)]), fail )).

finish(open(Stream, Unsure), File) :-
    flush(open(Stream, Unsure), File, State),
    (   State = open(_, _)
    ->  catch(close(Stream), error(Formal, Context),
              print_message(error,
                            typhon(log_not_written(File,
                                                   error(Formal, Context)))))
    ;   finish(State, File)
    ).
finish(lost(Count, _), File) :-
    print_message(error, typhon(log_lost(File, Count))).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(log_not_written(File, Error))) -->
    [ 'The log ~w cannot be written: '-[File] ],
    reason(Error),
    [ nl, 'Its events are lost until it can.'-[] ].
prolog:message(typhon(log_written_again(File, Count))) -->
    [ 'The log ~w is written again; ~D events were lost'-[File, Count] ].
prolog:message(typhon(log_lost(File, Count))) -->
    [ 'The log ~w ends; ~D events were lost'-[File, Count] ].

reason(error(io_error(_, _), context(_, Text))) -->
    { atomic(Text) },
    !,
    [ '~w'-[Text] ].
reason(Error) -->
    error_told(Error).
