:- module(typhon_log,
          [ log_server_start/2,         % +Options, -Address
            log_server_stop/1,          % +Address
            log_events/2                % +File, -Events
          ]).
:- use_module(library(apply), [include/3, maplist/2]).
:- use_module(library(error),
              [ domain_error/2, existence_error/2, must_be/2,
                permission_error/3 ]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module('../base/own_thread', [in_own_thread/1]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_call/5, endpoint_reply/2]).
:- use_module('../host', [runtime_acquire/2, runtime_release/1]).

/** <module> The log server

A log server is a host that takes no part: it has an address, and hosts
post events there without waiting. It stamps each with the time of its
arrival and writes one fact per line,

    event(Time, Host, Agent, What).

Time is in host seconds of the clock that the server was given. The file is
plain ASCII, whatever characters the events hold, and needs no operators:
consult/1 reads it back on every system. log_events/2 reads it line by
line, so a line cut short by a crash costs that line and no other.

What hosts post is event(Log, Host, Agent, What) of kind `log`. Log is the
address of the server; its name tells servers of one process apart.

*Threading*: events arrive in the threads of the endpoint, which stamp them
and pass them on in one step, so the stamps ascend in the file. One thread
per server writes, and flushes whenever nothing more waits. The queue
between them is bounded: senders of more than the disk can take wait in the
end, nothing is dropped.
*/

:- multifile
    prolog:message//1,
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4.

:- dynamic
    server/3,                   % Name, Queue, Clock
    writer/2,                   % Name, Thread
    homeless/1.                 % Name of a server that events came for

%!  log_server_start(+Options, -Address) is det.
%
%   Starts a log server in this process. Options:
%
%     - file(File)
%       Where events are written. Has no default.
%     - mode(Mode)
%       `write` (default): the file is begun anew; `append`: it goes on.
%     - name(Name)
%       Default `log`.
%     - bind(Interface), port(Port)
%       Of the process' endpoint, if it has to be started. Default
%       `localhost` and any.
%     - clock(Epoch, Rate)
%       Default clock(0, 1), the time of day.
%
%   Address is Name@Interface:Port, for log(Address) of host_start/2.
%
%   @error domain_error(log_server_option, Option),
%   existence_error(option, file),
%   permission_error(start, log_server, Name) when it is running,
%   existence_error(directory, Dir), permission_error(open, source_sink,
%   File)

log_server_start(Options, Address) :-
    must_be(list, Options),
    maplist(check_option, Options),
    option(name(Name), Options, log),
    (   option(file(File), Options)
    ->  true
    ;   existence_error(option, file)
    ),
    with_mutex(typhon_log, start(Name, File, Options, Address)).

check_option(Option) :-
    must_be(nonvar, Option),
    (   option_type(Option, Value, Type)
    ->  must_be(Type, Value)
    ;   domain_error(log_server_option, Option)
    ).

option_type(file(File), File, ground).
option_type(mode(Mode), Mode, oneof([write, append])).
option_type(name(Name), Name, atom).
option_type(bind(Interface), Interface, atom).
option_type(port(Port), Port, between(0, 65535)).
option_type(clock(Epoch, Rate), [Epoch, Rate], list(number)).

clock_option(Options, Clock) :-
    (   memberchk(clock(Epoch, Rate), Options)
    ->  Clock = clock(Epoch, Rate)
    ;   Clock = clock(0, 1)
    ).

start(Name, _, _, _) :-
    server(Name, _, _),
    !,
    permission_error(start, log_server, Name).
start(Name, File, Options, Address) :-
    option(mode(Mode), Options, write),
    clock_option(Options, Clock),
    include(of_endpoint, Options, EndpointOptions),
    runtime_acquire(log(Name), EndpointOptions),
    catch(start_writer(File, Mode, Queue, Thread), Error,
          ( runtime_release(log(Name)), throw(Error) )),
    assertz(writer(Name, Thread)),
    retractall(homeless(Name)),
    assertz(server(Name, Queue, Clock)),
    endpoint_address(Endpoint),
    atomic_list_concat([Name, @, Endpoint], Address).

of_endpoint(bind(_)).
of_endpoint(port(_)).

start_writer(Spec, Mode, Queue, Thread) :-
    (   absolute_file_name(Spec, File)
    ->  may_write(File)
    ;   existence_error(source_sink, Spec)
    ),
    open_log(File, Mode, Stream),
    message_queue_create(Queue, [max_size(100 000)]),
    catch(thread_create(write_events(Queue, File, open(Stream, 0)), Thread),
          Error,
          ( close(Stream), message_queue_destroy(Queue), throw(Error) )).

may_write(File) :-
    access_file(File, write),
    \+ exists_directory(File),
    !.
may_write(File) :-
    file_directory_name(File, Dir),
    \+ exists_directory(Dir),
    !,
    existence_error(directory, Dir).
may_write(File) :-
    not_writable(File).

not_writable(File) :-
    Text = 'the log cannot be written there',
    throw(error(permission_error(open, source_sink, File),
                context(log_server_start/2, Text))).

open_log(File, Mode, Stream) :-
    catch(open(File, Mode, Stream,
               [ encoding(ascii), newline(posix), buffer(full) ]),
          error(existence_error(_, _), _),
          not_writable(File)),
    (   Mode == append,
        cut_short(File)
    ->  nl(Stream)
    ;   true
    ).

%   The last line has no end: the server that wrote it was killed.

cut_short(File) :-
    size_file(File, Size),
    Size > 0,
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        ( Last is Size - 1,
          seek(In, Last, bof, _),
          get_byte(In, Byte)
        ),
        close(In)),
    Byte =\= 0'\n.

%!  log_server_stop(+Address) is det.
%
%   Writes what has arrived, and what was posted in this process before,
%   and ends the server.
%
%   @error existence_error(log_server, Address)

log_server_stop(Address) :-
    must_be(atom, Address),
    server_name(Address, Name),
    in_own_thread(stop(Name, Address)).

stop(Name, Address) :-
    arrived(Name),
    (   with_mutex(typhon_log, retract(server(Name, Queue, _)))
    ->  thread_send_message(Queue, stop),
        retract(writer(Name, Thread)),
        thread_join(Thread, _),
        message_queue_destroy(Queue),
        runtime_release(log(Name))
    ;   existence_error(log_server, Address)
    ).

%   What this process posts to itself comes in order, so a request that is
%   answered tells that the posts before it have arrived.

arrived(Name) :-
    (   server(Name, _, _),
        endpoint_address(Endpoint)
    ->  catch(endpoint_call(Endpoint, log, arrived, answer(yes), 5),
              error(Formal, Context),
              print_message(warning, error(Formal, Context)))
    ;   true
    ).

typhon_endpoint:requested(log, arrived, _, ReplyTo) :-
    endpoint_reply(ReplyTo, yes).

server_name(Address, Name) :-
    (   sub_atom(Address, Before, _, _, @)
    ->  sub_atom(Address, 0, Before, _, Name)
    ;   Name = Address
    ).

                /*******************************
                *           WRITING            *
                *******************************/

typhon_endpoint:received(log, event(Log, Host, Agent, What), _) :-
    server_name(Log, Name),
    with_mutex(typhon_log, stamp(Name, Host, Agent, What)).

stamp(Name, Host, Agent, What) :-
    server(Name, Queue, clock(Epoch, Rate)),
    !,
    get_time(Now),
    Time is round((Now - Epoch) * Rate * 1000000) / 1000000.0,
    thread_send_message(Queue, event(Time, Host, Agent, What)).
stamp(Name, _, _, _) :-
    homeless(Name),
    !.
stamp(Name, Host, _, _) :-
    assertz(homeless(Name)),
    print_message(warning, typhon(no_log_server(Name, Host))).

%   write_events(+Queue, +File, +State): State is open(Stream, Unsure),
%   where the last Unsure events may be in memory only; or lost(Count,
%   Again), where the file could not be written, is tried again at the time
%   Again, and Count events are lost.  People are told when it begins and
%   when it ends, not of each event.

write_events(Queue, File, State0) :-
    next_event(Queue, File, Event, State0, State1),
    (   Event == stop
    ->  finish(State1, File)
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
    catch(( write_fact(Stream, Event), State0 = open(Stream, Unsure) ),
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
    catch(open_log(File, append, Stream), error(_, _), fail),
    catch(( write_fact(Stream, Event),
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

write_fact(Stream, Event) :-
    write_canonical(Stream, Event),
    write(Stream, '.\n').

                /*******************************
                *           READING            *
                *******************************/

%!  log_events(+File, -Events:list) is det.
%
%   Events are the event(Time, Host, Agent, What) facts in File, in the
%   order in which they arrived. A line that is no fact is reported by a
%   warning, and the others are read.
%
%   @error existence_error(source_sink, File)

log_events(Spec, Events) :-
    absolute_file_name(Spec, File, [access(read)]),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_events(In, File, Events),
        close(In)).

read_events(In, File, Events) :-
    line_count(In, Number),
    read_line_to_string(In, Line),
    (   Line == end_of_file
    ->  Events = []
    ;   line_event(Line, Event)
    ->  Events = [Event|Rest],
        read_events(In, File, Rest)
    ;   print_message(warning, typhon(log_line_skipped(File:Number, Line))),
        read_events(In, File, Events)
    ).

line_event(Line, Event) :-
    catch(term_string(Event, Line, [module(typhon_log)]),
          error(syntax_error(_), _), fail),
    nonvar(Event),
    Event = event(_, _, _, _).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(no_log_server(Name, Host))) -->
    [ 'There is no log server ~w here: events of ~w are lost'-[Name, Host] ].
prolog:message(typhon(log_not_written(File, Error))) -->
    [ 'The log ~w cannot be written: '-[File] ],
    reason(Error),
    [ nl, 'Its events are lost until it can.'-[] ].
prolog:message(typhon(log_written_again(File, Count))) -->
    [ 'The log ~w is written again; ~D events were lost'-[File, Count] ].
prolog:message(typhon(log_lost(File, Count))) -->
    [ 'The log ~w ends; ~D events were lost'-[File, Count] ].
prolog:message(typhon(log_line_skipped(File:Number, Line))) -->
    { ( sub_string(Line, 0, 60, _, Start) -> true ; Start = Line ) },
    [ '~w:~d: not an event, or cut short: ~s'-[File, Number, Start] ].

reason(error(io_error(_, _), context(_, Text))) -->
    { atomic(Text) },
    !,
    [ '~w'-[Text] ].
reason(Error) -->
    '$messages':translate_message(Error).
