:- module(typhon_appointments,
          [ appointments_wait/2,        % +Network, +Seconds
            appointments_at/3,          % +Network, +Time, :Goal
            appointments/2,             % +Network, -Due
            appointments_again/2        % +Network, +Due
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/host',
              [alarm_set/3, scheduler_call/1, time_now/1, time_wait/3]).
:- use_module(networks, [network_clock/2]).

/** <module> What is to happen when, in a network

*Threading*: any thread. Goals run in a worker.
*/

:- multifile
    typhon_networks:ended/1,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- meta_predicate appointments_at(+, +, 0).

:- dynamic
    due/3.                      % Network, Number, Goal

typhon_networks:ended(Network) :-
    retractall(due(Network, _, _)).

%!  appointments_wait(+Network, +Seconds) is det.
%
%   See network_advance/2.

appointments_wait(Network, Seconds) :-
    must_be(number, Seconds),
    network_clock(Network, clock(_, Rate)),
    time_now(Now),
    Stamp is Now+Seconds/Rate,
    setup_call_cleanup(
        message_queue_create(Queue),
        \+ time_wait(Queue, _, Stamp),
        message_queue_destroy(Queue)).

%!  appointments_at(+Network, +Time, :Goal) is det.
%
%   See network_at/3.

appointments_at(Network, Time, Goal) :-
    must_be(number, Time),
    strip_module(Goal, _, Plain),
    must_be(callable, Plain),
    network_clock(Network, clock(Epoch, Rate)),
    flag(typhon_network_at, N, N+1),
    assertz(due(Network, N, Goal)),
    Stamp is Epoch+Time/Rate,
    alarm_set(Stamp, Network, at(N)).

%!  appointments(+Network, -Due:list) is det.
%!  appointments_again(+Network, +Due:list) is det.
%
%   What is still to be called: pairs N-Goal; their alarms, at(N), are set
%   by the caller.

appointments(Network, Due) :-
    findall(N-Goal, due(Network, N, Goal), Due).

appointments_again(Network, Due) :-
    forall(member(N-Goal, Due),
           ( assertz(due(Network, N, Goal)),
             flag(typhon_network_at, N0, max(N0, N+1)) )).

typhon_scheduler:fire(Network, at(N)) :-
    !,
    (   retract(due(Network, N, Goal))
    ->  scheduler_call(Goal)
    ;   true
    ).

typhon_scheduler:over(Network, at(N)) :-
    \+ due(Network, N, _).
