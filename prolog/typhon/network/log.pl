:- module(typhon_log,
          [ log_serve/2,                % +Options, -Address
            log_serve_end/1             % +Address
          ]).
:- use_module(library(apply), [include/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../kernel/base/durable', [durable_closed/0]).
:- use_module('../kernel/base/error_text', [error_lines/3, print_error/2]).
:- use_module('../kernel/base/names', [counted/3, must_be_name/2]).
:- use_module('../kernel/base/options', [check_options/2]).
:- use_module('../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../kernel/base/server',
              [ server_answer/2, server_call/4, server_cast/2, server_start/5,
                server_stop/1 ]).
:- use_module('../kernel/host',
              [runtime_acquire/3, runtime_release/1, time_now/1]).
:- use_module('../kernel/wire',
              [endpoint_address/1, endpoint_call/5, endpoint_reply/2]).
:- use_module(log_file, [log_open/3, log_write/2]).

/** <module> The log server

A log server has an address, like a host. Hosts post events to it and do not
wait. The server stamps each event with its time of arrival, in host seconds of
its clock, and writes it to a file, see module `log_file`.

Hosts post terms event(Log, Host, Agent, What) of kind `log`. Log is the
address of the server; its name distinguishes servers of one process.

*Threading*: events arrive in the threads of the endpoint. A thread stamps an
event and queues it under a mutex, so the stamps ascend in the file. One thread
per server writes. Its queue is bounded: senders that are faster than the disk
wait, and no event is dropped. The thread flushes the file whenever its queue is
empty.
*/

:- multifile
    prolog:message//1,
    typhon_log_file:about_to_read/1,
    typhon_options:declared/4,
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4.

:- dynamic
    server/4,                   % Name, Writer, File, Clock
    missing/1.                  % Name: no such server; reported

%!  log_serve(+Options, -Address) is det.
%
%   See log_server_start/2.

log_serve(Options, Address) :-
    must_be(var, Address),
    check_options(log_server_option, Options),
    option(name(Name), Options, log),
    must_be_name(log_server_name, Name),
    (   option(file(File), Options)
    ->  true
    ;   existence_error(option, file)
    ),
    with_mutex(typhon_log, start(Name, File, Options, Address)).

typhon_options:declared(log_server_option, Option, Type, Value) :-
    option_type(Option, Value, Type).

option_type(file(File), File, ground).
option_type(mode(Mode), Mode, oneof([write, append])).
option_type(name(Name), Name, atom).
option_type(bind(Interface), Interface, atom).
option_type(advertise(Address), Address, atom).
option_type(port(Port), Port, between(0, 65535)).
option_type(clock(Epoch, Rate), [Epoch, Rate], list(number)).

clock_option(Options, Clock) :-
    (   memberchk(clock(Epoch, Rate), Options)
    ->  Clock = clock(Epoch, Rate)
    ;   Clock = clock(0, 1)
    ).

start(Name, _, _, _) :-
    server(Name, _, _, _),
    !,
    permission_error(start, log_server, Name).
start(Name, File, Options, Address) :-
    option(mode(Mode), Options, write),
    clock_option(Options, Clock),
    include(of_endpoint, Options, EndpointOptions),
    runtime_acquire(log(Name), EndpointOptions, Endpoint),
    catch(log_writer_start(File, Mode, Absolute, Writer), Error,
          ( runtime_release(log(Name)), throw(Error) )),
    retractall(missing(Name)),
    assertz(server(Name, Writer, Absolute, Clock)),
    atomic_list_concat([Name, @, Endpoint], Address),
    debug(typhon(network), 'log server ~w writes ~p', [Address, File]).

of_endpoint(bind(_)).
of_endpoint(advertise(_)).
of_endpoint(port(_)).

%!  log_serve_end(+Address) is det.
%
%   See log_server_stop/1.

log_serve_end(Address) :-
    must_be(atom, Address),
    server_name(Address, Name),
    in_own_thread(stop(Name, Address)).

stop(Name, Address) :-
    arrived(Name),
    (   with_mutex(typhon_log, retract(server(Name, Writer, _, _)))
    ->  server_stop(Writer),
        debug(typhon(network), 'log server ~w has ended', [Address]),
        runtime_release(log(Name))
    ;   existence_error(log_server, Address)
    ).

typhon_log_file:about_to_read(File) :-
    server(_, _, File, _),
    !,
    forall(server(_, Writer, File, _),
           in_own_thread(writer_flush(Writer))).

%   Messages that this process posts to itself arrive in order, so the answer to
%   a request shows that the posts before it have arrived. When the journal is
%   closed no request can be sent.

arrived(Name) :-
    (   server(Name, _, _, _),
        endpoint_address(Endpoint),
        \+ durable_closed
    ->  catch(endpoint_call(Endpoint, log, arrived, answer(yes), 5),
              error(Formal, Context),
              print_error(warning, error(Formal, Context)))
    ;   true
    ).

typhon_endpoint:requested(log, arrived, _, ReplyTo) :-
    endpoint_reply(ReplyTo, yes).

server_name(Address, Name) :-
    (   sub_atom(Address, Before, _, _, @)
    ->  sub_atom(Address, 0, Before, _, Name)
    ;   Name = Address
    ).

typhon_endpoint:received(log, event(Log, Host, Agent, What), _) :-
    server_name(Log, Name),
    with_mutex(typhon_log, stamp(Name, Host, Agent, What)).

stamp(Name, Host, Agent, What) :-
    server(Name, Writer, _, clock(Epoch, Rate)),
    !,
    time_now(Now),
    Time is round((Now - Epoch) * Rate * 1000000) / 1000000.0,
    ignore(server_cast(Writer, event(Time, Host, Agent, What))).
stamp(Name, _, _, _) :-
    missing(Name),
    !.
stamp(Name, Host, _, _) :-
    assertz(missing(Name)),
    print_message(warning, typhon(no_log_server(Name, Host))).

prolog:message(typhon(no_log_server(Name, Host))) -->
    [ 'There is no log server ~w here: events of ~w are lost'-[Name, Host] ].

                /*******************************
                *           WRITING            *
                *******************************/

%   log_writer_start(+Spec, +Mode, -File, -Writer) is det.
%
%   Writer, a server, writes terms event(Time, Host, Agent, What) to the file
%   Spec, opened in Mode.
%
%   @error existence_error(directory, Dir), permission_error(open,
%   source_sink, File)

log_writer_start(Spec, Mode, File, Writer) :-
    absolute_file_name(Spec, File, [access(none)]),
    log_open(File, Mode, Stream),
    catch(server_start(log_writer, typhon_log:written(File), open(Stream, 0),
                       [max_size(100 000)], Writer),
          Error,
          ( close(Stream), throw(Error) )).

%   writer_flush(+Writer): wait until all earlier events are in the file, or have
%   been dropped because it cannot be written; at most five seconds.

writer_flush(Writer) :-
    catch(ignore(server_call(Writer, flush, 5, _)),
          error(existence_error(_, _), _),
          true).                        % Writer has written all, and has ended

:- public written/4.

%   written(+File, +Message, +State0, -State): State is open(Stream, Unsure), if
%   the last Unsure events may be only in memory; or lost(Count, Again), if the
%   file could not be written, Count events are lost, and the server retries at
%   the time Again. Only the first failure and the recovery are reported, not
%   each event. The file is flushed when the queue is empty.

written(File, event(Time, Host, Agent, What), State0, until(0, State)) :-
    write_event(State0, File, event(Time, Host, Agent, What), State).
written(File, timeout, State0, State) :-
    flush(State0, File, State).
written(File, call(flush, Caller), State0, State) :-
    flush(State0, File, State),
    server_answer(Caller, flushed).
written(File, stop, State, _) :-
    finish(State, File).

flush(open(Stream, Unsure), File, State) :-
    !,
    catch(( flush_output(Stream), State = open(Stream, 0) ),
          error(Formal, Context),
          after_error(Stream, Unsure, File, error(Formal, Context), State)).
flush(State, _, State).

write_event(open(Stream, Unsure0), File, Event, State) :-
    Unsure is Unsure0+1,
    catch(( log_write(Stream, Event), State0 = open(Stream, Unsure) ),
          error(Formal, Context),
          after_error(Stream, Unsure, File, error(Formal, Context), State0)),
    (   Unsure mod 1000 =:= 0
    ->  flush(State0, File, State)
    ;   State = State0
    ).
write_event(lost(Count0, Again), _, _, lost(Count, Again)) :-
    monotonic_time(Now),
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
    deadline(1, Again).

%   The rest of the buffer must not be written later, in the middle of a line.

after_error(Stream, Count, File, Error, lost(Count, Again)) :-
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

prolog:message(typhon(log_not_written(File, Error))) -->
    [ 'The log ~w cannot be written: '-[File] ],
    reason(Error),
    [ nl, 'Its events are lost until it can.'-[] ].
prolog:message(typhon(log_written_again(File, Count))) -->
    { counted(Count, event, Lost) },
    [ 'The log ~w is written again, without ~w'-[File, Lost] ].
prolog:message(typhon(log_lost(File, Count))) -->
    { counted(Count, event, Lost) },
    [ 'The log ~w ends, without ~w'-[File, Lost] ].

reason(error(io_error(_, _), context(_, Text))) -->
    { atomic(Text) },
    !,
    [ '~w'-[Text] ].
reason(Error) -->
    error_lines(Error).
