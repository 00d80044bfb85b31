:- module(population_track,
          [ track_start/2,              % +Tasks, -State
            track/3,                    % +Event, +State0, -State
            track_done/2,               % +State, -Count
            track_done/3,               % +State, +Task, -Count
            track_alive/2,              % +State, -Count
            track_settled/2,            % +State, +Hosts
            agent_kind/2                % +Agent, -Kind
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, selectchk/4]).
:- use_module(library(ordsets), [ord_add_element/3, ord_del_element/3]).

/** <module> How far a population has come, event by event

*Threading*: pure.
*/

%!  track_start(+Tasks, -State) is det.
%!  track(+Event, +State0, -State) is det.
%
%   State is where a network stands after the event(Time, Host, Agent, What)
%   facts of its log so far: what is completed where, and how many agents
%   there are of kinds that have a number.

track_start(Tasks, state(Done, 0)) :-
    maplist(none_done, Tasks, Done).

none_done(Task, Task-[]).

track(event(_, Host, _, completed(_, Task)), State0, State) :-
    !,
    change(ord_add_element, Task, Host, State0, State).
track(event(_, Host, _, failed(_, Task)), State0, State) :-
    !,
    change(ord_del_element, Task, Host, State0, State).
track(event(_, _, Agent, created), state(Done, Alive0), state(Done, Alive)) :-
    agent_kind(Agent, _),
    !,
    Alive is Alive0 + 1.
track(event(_, _, Agent, ended(_)), state(Done, Alive0),
      state(Done, Alive)) :-
    agent_kind(Agent, _),
    !,
    Alive is Alive0 - 1.
track(_, State, State).

change(Change, Task, Host, state(Done0, Alive), state(Done, Alive)) :-
    selectchk(Task-Hosts0, Done0, Task-Hosts, Done),
    !,
    call(Change, Hosts0, Host, Hosts).
change(_, _, _, State, State).

%!  track_done(+State, -Count) is det.
%!  track_done(+State, +Task, -Count) is semidet.
%!  track_alive(+State, -Count) is det.
%
%   How many pairs of host and task, or hosts for Task, are completed; how
%   many agents there are.

track_done(state(Done, _), Count) :-
    aggregate_all(count, ( member(_-Hosts, Done), member(_, Hosts) ), Count).

track_done(state(Done, _), Task, Count) :-
    member(Task-Hosts, Done),
    !,
    length(Hosts, Count).

track_alive(state(_, Alive), Alive).

%!  track_settled(+State, +Hosts:integer) is semidet.
%
%   All tasks are completed at so many Hosts, and of each kind there is but
%   one agent left.

track_settled(state(Done, Alive), Hosts) :-
    length(Done, Alive),
    forall(member(_-At, Done), length(At, Hosts)).

%!  agent_kind(+Agent, -Kind:integer) is semidet.
%
%   Kind is the number in the name of Agent, `agent<Kind>`.

agent_kind(Agent, Kind) :-
    sub_atom(Agent, 0, _, _, agent),
    sub_atom(Agent, Dot, _, _, '.'),
    !,
    Length is Dot - 5,
    sub_atom(Agent, 5, Length, _, Digits),
    atom_number(Digits, Kind).
