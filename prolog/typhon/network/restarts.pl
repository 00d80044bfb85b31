:- module(typhon_restarts,
          [ restarts_begin/3,           % +Network, +Queue, :Do
            restarts_end/2,             % +Network, +Queue
            restarts_absent/2,          % +Network, +P
            restarts_back/1             % +Network
          ]).
:- use_module(library(apply), [include/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2, min_member/2, selectchk/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/error_text', [print_error/2]).
:- use_module(nodes, [deadline/2, message_before/3]).

/** <module> Processes of a network that die are started again

At once, but not more than so many times within so many seconds: what dies
whenever it is started would not be better for it. From when one dies until its
hosts are there again it is absent: requests to the whole network
wait meanwhile.

*Threading*: one thread for each such network. Nothing in it waits for a child
to come up: that is a message, as is its end. Callers that wait for an
absent one do so in threads of their own.
*/

:- multifile
    prolog:message//1.

:- meta_predicate
    restarts_begin(+, +, 1).

:- public
    interrupt/0.                % goal of a signal

:- setting(restarts, nonneg, 10,
           "A process of a network is started again so often").
:- setting(restart_seconds, number, 60,
           "The time that this number is for").

:- dynamic
    restarter/2,                % Network, Thread
    absent/2,                   % Network, P
    waiting/2.                  % Network, Queue: until none is absent

%!  restarts_begin(+Network, +Queue, :Do) is det.
%!  restarts_end(+Network, +Queue) is det.
%
%   From now on Queue is read: up(P), down(P, Status) and failed(P, Error) are
%   what happens to processes. Do(start(P)) is to start P again, Do(restore(P))
%   what is done when it is up, Do(kill(P)) what ends one that cannot begin,
%   Do(give_up(P)) what follows when it is not started again.
%   From restarts_end/2 on nothing of this is done any more.

restarts_begin(Network, Queue, Do) :-
    atom_concat(typhon_restarts_, Network, Alias),
    thread_create(restarts(Network, Queue, Do), Thread, [alias(Alias)]),
    assertz(restarter(Network, Thread)).

restarts_end(Network, Queue) :-
    retract(restarter(Network, Thread)),
    !,
    thread_send_message(Queue, stop),
    catch(thread_signal(Thread, typhon_restarts:interrupt),
          error(existence_error(_, _), _), true),
    thread_join(Thread, _),
    retractall(absent(Network, _)),
    tell_waiting(Network).
restarts_end(_, _).

%   Only what is being restored is interrupted: that may wait for one that
%   hangs.

interrupt :-
    (   nb_current(typhon_restoring, true)
    ->  nb_setval(typhon_restoring, false),
        throw(stop_restoring)
    ;   true
    ).

restarts(Network, Queue, Do) :-
    loop(state(Network, Queue, Do), [], []).

%   Deaths are terms P-Time, Starting terms Deadline-P.

loop(State, Deaths, Starting) :-
    next(State, Starting, Event),
    (   Event == stop
    ->  true
    ;   handled(Event, State, Deaths, Deaths1, Starting, Starting1),
        loop(State, Deaths1, Starting1)
    ).

next(state(_, Queue, _), [], Event) :-
    !,
    thread_get_message(Queue, Event).
next(state(_, Queue, _), Starting, Event) :-
    min_member(Deadline-P, Starting),
    (   message_before(Queue, Event, Deadline)
    ->  true
    ;   Event = late(P)
    ).

handled(down(P, _), State, Deaths0, Deaths, Starting0, Starting) :-
    !,
    not_starting(P, Starting0, Starting1),
    State = state(Network, _, Do),
    (   once_more(P, Deaths0, Deaths)
    ->  debug(typhon(network), 'process ~w of ~w is started again',
              [P, Network]),
        catch(ignore(call(Do, start(P))), error(Formal, Context),
              print_error(error, error(Formal, Context))),
        setting(typhon_processes:start_seconds, Seconds),
        deadline(Seconds, Deadline),
        Starting = [Deadline-P|Starting1]
    ;   Deaths = Deaths0,
        Starting = Starting1,
        setting(restarts, Most),
        setting(restart_seconds, Seconds),
        print_message(error,
                      typhon(node_given_up(Network, P, Most, Seconds))),
        ignore(call(Do, give_up(P))),
        present(Network, P)
    ).
handled(up(P), State, Deaths, Deaths, Starting0, Starting) :-
    !,
    (   not_starting(P, Starting0, Starting),
        Starting \== Starting0
    ->  restored(P, State)
    ;   Starting = Starting0            % it came before this thread did
    ).
handled(failed(_, Error), _, Deaths, Deaths, Starting, Starting) :-
    !,
    print_error(error, Error).
handled(late(P), state(_, _, Do), Deaths, Deaths, Starting0, Starting) :-
    not_starting(P, Starting0, Starting),
    ignore(call(Do, kill(P))).

not_starting(P, Starting0, Starting) :-
    (   selectchk(_-P, Starting0, Starting1)
    ->  Starting = Starting1
    ;   Starting = Starting0
    ).

%   once_more(+P, +Deaths0, -Deaths) fails if it has died too often.

once_more(P, Deaths0, [P-Now|Deaths]) :-
    get_time(Now),
    setting(restart_seconds, Seconds),
    Since is Now-Seconds,
    include(later(Since), Deaths0, Deaths),
    findall(x, member(P-_, Deaths), Times),
    length(Times, Count),
    setting(restarts, Most),
    Count < Most.

later(Since, _-Time) :-
    Time > Since.

%   One that is up but cannot be what it was is no use: it is as if it had
%   died.

restored(P, state(Network, _, Do)) :-
    (   catch(restore(Do, P), Ball, not_restored(Ball))
    ->  print_message(informational, typhon(node_back(Network, P))),
        present(Network, P)
    ;   ignore(call(Do, kill(P)))
    ).

restore(Do, P) :-
    nb_setval(typhon_restoring, true),
    call(Do, restore(P)),
    nb_setval(typhon_restoring, false).

not_restored(stop_restoring) :-
    !.
not_restored(error(existence_error(carrier, _), _)) :-
    !,
    fail.                               % it has died again
not_restored(Ball) :-
    nb_setval(typhon_restoring, false),
    print_error(error, Ball),
    fail.

                /*******************************
                *            ABSENCE           *
                *******************************/

%!  restarts_absent(+Network, +P) is det.
%!  restarts_back(+Network) is det.
%
%   P has died, and is absent, if those of Network are started again; wait until
%   none is absent, so long as an order may take.

restarts_absent(Network, P) :-
    (   restarter(Network, _),
        \+ absent(Network, P)
    ->  assertz(absent(Network, P))
    ;   true
    ).

present(Network, P) :-
    retractall(absent(Network, P)),
    (   absent(Network, _)
    ->  true
    ;   tell_waiting(Network)
    ).

tell_waiting(Network) :-
    forall(waiting(Network, Queue),
           catch(thread_send_message(Queue, back),
                 error(existence_error(_, _), _), true)).

restarts_back(Network) :-
    absent(Network, _),
    !,
    setting(typhon_processes:order_seconds, Seconds),
    deadline(Seconds, Deadline),
    setup_call_cleanup(
        ( message_queue_create(Queue),
          assertz(waiting(Network, Queue)) ),
        (   absent(Network, _)
        ->  ignore(message_before(Queue, back, Deadline))
        ;   true
        ),
        ( retractall(waiting(Network, Queue)),
          message_queue_destroy(Queue) )).
restarts_back(_).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(node_given_up(Network, P, Most, Seconds))) -->
    [ 'Process ~w of ~w is not started again: it has died ~D times within \c
       ~w seconds'-[P, Network, Most, Seconds] ].
prolog:message(typhon(node_back(Network, P))) -->
    [ 'Process ~w of ~w is there again'-[P, Network] ].
