:- module(typhon_restarts,
          [ restarts_begin/3,           % +Network, +Queue, :Do
            restarts_end/1,             % +Network
            restarts_notify/3,          % +Network, +Queue, +Event
            restarts_absent/2,          % +Network, +P
            restarts_back/1             % +Network
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2, min_member/2, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/fifo', [fifo_empty/2]).
:- use_module('../kernel/base/monotonic',
              [deadline/2, monotonic_time/1, poll_within/2]).
:- use_module('../kernel/base/error_text', [print_error/2]).
:- use_module('../kernel/base/server',
              [server_cast/2, server_start/4, server_stop/1]).

/** <module> Restarts of the processes of a network

A process that dies is restarted at once, but only a limited number of times
within some time: more restarts would not help a process that dies after each
start. A process is absent from its death until its hosts are restored.
Meanwhile requests to the whole network wait.

*Threading*: one server for each such network. The start and the end of a child
are messages to it, so it never waits for a child. Callers that wait for an
absent process do so in their own threads.
*/

:- multifile
    prolog:message//1.

:- meta_predicate
    restarts_begin(+, +, 1).

:- public
    handle/3,                   % of the server
    interrupt/0.                % goal of a signal

:- setting(restarts, nonneg, 10,
           "Restarts of a process within restart_seconds").
:- setting(restart_seconds, number, 60,
           "Seconds within which the setting restarts counts").

:- dynamic
    restarter/2,                % Network, Server
    restoring/2,                % Network, Thread: calls Do(restore(_))
    absent/2,                   % Network, P
    death/3.                    % Network, P, Time

%!  restarts_begin(+Network, +Queue, :Do) is det.
%
%   Start the server of Network. From now on restarts_notify/3 sends it the
%   events up(P), down(P, Status) and failed(P, Error); it gets the events in
%   Queue first. The server calls Do with start(P) to start P again, with
%   restore(P) to restore the hosts of P when it is up, with kill(P) to kill a
%   process that does not come up, and with give_up(P) when it will not restart
%   P.
%
%   @error resource_error(What) if no thread can be created

restarts_begin(Network, Queue, Do) :-
    atom_concat(restarts_, Network, Role),
    server_start(Role, typhon_restarts:handle, state(Network, Do, []),
                 Server),
    with_mutex(typhon_restarts,
               ( assertz(restarter(Network, Server)),
                 fifo_empty(Queue, Events),
                 forall(member(Event, Events), server_cast(Server, Event)) )).

%!  restarts_end(+Network) is det.
%
%   Stop the server of Network: from now on no process is restarted.

restarts_end(Network) :-
    with_mutex(typhon_restarts, retract(restarter(Network, Server))),
    !,
    forall(restoring(Network, Thread),
           catch(thread_signal(Thread, typhon_restarts:interrupt),
                 error(existence_error(_, _), _), true)),
    server_stop(Server),
    retractall(restoring(Network, _)),
    retractall(absent(Network, _)),
    retractall(death(Network, _, _)).
restarts_end(_).

%!  restarts_notify(+Network, +Queue, +Event) is det.
%
%   Send Event to the server of Network, or, before it begins, to Queue.

restarts_notify(Network, Queue, Event) :-
    with_mutex(typhon_restarts,
               (   restarter(Network, Server)
               ->  ignore(server_cast(Server, Event))
               ;   thread_send_message(Queue, Event)
               )).

%   Interrupt a restore, which may wait for a process that hangs, and no other
%   work of the thread.

interrupt :-
    (   nb_current(typhon_restoring, true)
    ->  nb_setval(typhon_restoring, false),
        throw(stop_restoring)
    ;   true
    ).

%   The state is state(Network, Do, Starting). Starting are terms Deadline-P. If
%   the thread of the server was replaced, absent/2 still has the processes that
%   it was starting, and death/3 the earlier deaths.

handle(begin, state(Network, Do, _), Next) :-
    !,
    start_deadline(Deadline),
    findall(Deadline-P, absent(Network, P), Starting),
    next(state(Network, Do, Starting), Next).
handle(Event, State0, Next) :-
    State0 = state(Network, _, _),
    (   restarter(Network, _)
    ->  handled(Event, State0, State)
    ;   State = State0
    ),
    next(State, Next).

next(State, Next) :-
    State = state(_, _, Starting),
    (   min_member(Deadline-_, Starting)
    ->  Next = until(Deadline, State)
    ;   Next = State
    ).

start_deadline(Deadline) :-
    setting(typhon_processes:start_seconds, Seconds),
    deadline(Seconds, Deadline).

handled(down(P, _), state(Network, Do, Starting0), State) :-
    not_starting(P, Starting0, Starting),
    (   may_restart(Network, P)
    ->  debug(typhon(network), 'process ~w of ~w is started again',
              [P, Network]),
        catch(ignore(call(Do, start(P))), error(Formal, Context),
              print_error(error, error(Formal, Context))),
        start_deadline(Deadline),
        State = state(Network, Do, [Deadline-P|Starting])
    ;   State = state(Network, Do, Starting),
        give_up(P, Network, Do)
    ).
handled(up(P), state(Network, Do, Starting0), state(Network, Do, Starting)) :-
    not_starting(P, Starting0, Starting),
    (   Starting \== Starting0
    ->  restored(P, Network, Do)
    ;   true                            % P was up before this server began
    ).
handled(failed(_, Error), State, State) :-
    print_error(error, Error).
handled(timeout, state(Network, Do, Starting0), state(Network, Do, Starting)) :-
    min_member(_-P, Starting0),
    not_starting(P, Starting0, Starting),
    ignore(call(Do, kill(P))).

give_up(P, Network, Do) :-
    setting(restarts, Most),
    setting(restart_seconds, Seconds),
    print_message(error, typhon(node_given_up(Network, P, Most, Seconds))),
    ignore(call(Do, give_up(P))),
    retractall(absent(Network, P)).

not_starting(P, Starting0, Starting) :-
    (   selectchk(_-P, Starting0, Starting1)
    ->  Starting = Starting1
    ;   Starting = Starting0
    ).

%   may_restart(+Network, +P): record a death of P; fails if P has died too
%   often.

may_restart(Network, P) :-
    monotonic_time(Now),
    setting(restart_seconds, Seconds),
    setting(restarts, Most),
    Since is Now-Seconds,
    findall(Time, ( death(Network, P, Time), Time =< Since ), Olds),
    forall(member(Old, Olds), retractall(death(Network, P, Old))),
    aggregate_all(count, death(Network, P, _), Count),
    Count < Most,
    assertz(death(Network, P, Now)).

%   A process that is up but cannot be restored is useless, so it is killed,
%   which counts as another death.

restored(P, Network, Do) :-
    (   catch(restore(Network, Do, P), Ball, not_restored(Ball))
    ->  print_message(informational, typhon(node_back(Network, P))),
        retractall(absent(Network, P))
    ;   ignore(call(Do, kill(P)))
    ).

restore(Network, Do, P) :-
    thread_self(Me),
    setup_call_cleanup(assertz(restoring(Network, Me)),
                       restore_p(Network, Do, P),
                       retractall(restoring(Network, Me))).

%   No race with the end of the network: a thread that ends it after this check
%   finds this thread in restoring/2, and interrupts it.

restore_p(Network, Do, P) :-
    nb_setval(typhon_restoring, true),
    (   restarter(Network, _)
    ->  call(Do, restore(P))
    ;   true
    ),
    nb_setval(typhon_restoring, false).

not_restored(stop_restoring) :-
    !.
not_restored(error(existence_error(carrier, _), _)) :-
    !,
    fail.                               % the process has died again
not_restored(Ball) :-
    nb_setval(typhon_restoring, false),
    print_error(error, Ball),
    fail.

%!  restarts_absent(+Network, +P) is det.
%
%   P has died: record it as absent, if the processes of Network are restarted.

restarts_absent(Network, P) :-
    (   restarter(Network, _),
        \+ absent(Network, P)
    ->  assertz(absent(Network, P))
    ;   true
    ).

%!  restarts_back(+Network) is det.
%
%   Wait until no process of Network is absent, but at most the setting
%   `typhon_processes:order_seconds`.

restarts_back(Network) :-
    setting(typhon_processes:order_seconds, Seconds),
    ignore(poll_within(Seconds, \+ absent(Network, _))).

prolog:message(typhon(node_given_up(Network, P, Most, Seconds))) -->
    [ 'Process ~w of ~w is not started again: it has died ~D times within \c
       ~w seconds'-[P, Network, Most, Seconds] ].
prolog:message(typhon(node_back(Network, P))) -->
    [ 'Process ~w of ~w is running again'-[P, Network] ].
