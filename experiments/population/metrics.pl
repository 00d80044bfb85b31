:- module(population_metrics,
          [ track_start/2,              % +Tasks, -State
            track/3,                    % +Event, +State0, -State
            track_done/3,               % +State, +Task, -Count
            track_alive/2,              % +State, -Count
            track_settled/2,            % +State, +Hosts
            until_settled/4,            % +Events, +Tasks, +Hosts, -Kept
            agent_kind/2,               % +Agent, -Kind
            populations/3,              % +Events, +Kinds, -Steps
            peak/3,                     % +Kind, +Steps, -Peak
            peak/4,                     % +Kind, +From, +Steps, -Peak
            population_at/3,            % +Time, +Steps, -Counts
            again/3,                    % +Executions, -First, -Again
            spans/2,                    % +Rows, -Seconds
            gaps/2                      % +Rows, -Seconds
          ]).
:- use_module(library(apply), [foldl/5, maplist/3]).
:- use_module(library(lists),
              [last/2, member/2, memberchk/2, nextto/3, nth1/3, selectchk/4,
               sum_list/2]).
:- use_module(library(ordsets), [ord_add_element/3, ord_del_element/3]).

/** <module> Measures of populations, from an event log

Steps are terms step(Time, Counts, Total) in order of time: Counts are the
numbers of agents of each kind from Time on, Total is their sum.

*Threading*: pure.
*/

%!  track_start(+Tasks, -State) is det.
%!  track(+Event, +State0, -State) is det.
%
%   State is the state of a network after the event(Time, Host, Agent, What)
%   facts of its log so far: the completed tasks of each host, and the number
%   of agents of each numbered kind.

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

%!  track_done(+State, +Task, -Count) is semidet.
%!  track_alive(+State, -Count) is det.
%
%   Count is the number of hosts on which Task is completed; the number of
%   agents.

track_done(state(Done, _), Task, Count) :-
    member(Task-Hosts, Done),
    !,
    length(Hosts, Count).

track_alive(state(_, Alive), Alive).

%!  track_settled(+State, +Hosts:integer) is semidet.
%
%   All tasks are completed at Hosts hosts, and only one agent of each kind is
%   left.

track_settled(state(Done, Alive), Hosts) :-
    length(Done, Alive),
    forall(member(_-At, Done), length(At, Hosts)).

%!  until_settled(+Events, +Tasks, +Hosts:integer, -Kept) is det.
%
%   Kept are the Events up to the first one after which all Tasks are completed
%   at Hosts hosts and one agent of each kind is left; all events if there is
%   none.

until_settled(Events, Tasks, Hosts, Kept) :-
    track_start(Tasks, State),
    until_settled_(Events, State, Hosts, Kept).

until_settled_([], _, _, []).
until_settled_([Event|Events], State0, Hosts, [Event|Kept]) :-
    track(Event, State0, State),
    (   track_settled(State, Hosts)
    ->  Kept = []
    ;   until_settled_(Events, State, Hosts, Kept)
    ).

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

%!  populations(+Events, +Kinds:list(integer), -Steps) is det.
%
%   Events are in order of time.  Events before time 0 are in the first step,
%   at time 0.

populations(Events, Kinds, [step(0, Counts0, Total)|Steps]) :-
    maplist(zero, Kinds, Zeros),
    changes(Events, Changes),
    before(Changes, Later, Kinds, Zeros, Counts0),
    sum_list(Counts0, Total),
    foldl(step(Kinds), Later, Steps, Counts0, _).

zero(_, 0).

changes(Events, Changes) :-
    findall(change(Time, Kind, D),
            ( member(event(Time, _, Agent, What), Events),
              counts(What, D),
              agent_kind(Agent, Kind)
            ),
            Changes).

counts(created, 1).
counts(ended(_), -1).

before([change(Time, Kind, D)|Changes], Later, Kinds, Counts0, Counts) :-
    Time =< 0,
    !,
    count(Kinds, Kind, D, Counts0, Counts1),
    before(Changes, Later, Kinds, Counts1, Counts).
before(Later, Later, _, Counts, Counts).

step(Kinds, change(Time, Kind, D), step(Time, Counts, Total),
     Counts0, Counts) :-
    count(Kinds, Kind, D, Counts0, Counts),
    sum_list(Counts, Total).

count([Kind|_], Kind, D, [N0|Counts], [N|Counts]) :-
    !,
    N is N0 + D.
count([_|Kinds], Kind, D, [N|Counts0], [N|Counts]) :-
    count(Kinds, Kind, D, Counts0, Counts).
count([], _, _, [], []).

%!  peak(+Kind, +Steps, -Peak) is semidet.
%!  peak(+Kind, +From, +Steps, -Peak) is semidet.
%
%   Peak is Time-Count: the greatest number of agents of Kind from time From
%   on, and when it was reached.  Kind is the place of a kind in the counts, or
%   `total`.

peak(Kind, Steps, Peak) :-
    peak(Kind, 0, Steps, Peak).

peak(Kind, From, Steps, Time-Count) :-
    from(Steps, From, Later),
    findall(Count0-Time0,
            ( member(Step, Later),
              Step = step(Time0, _, _),
              of_kind(Kind, Step, Count0)
            ),
            Counts),
    sort(1, @>=, Counts, [Count-_|_]),
    once(member(Count-Time, Counts)).

%   from(+Steps, +From, -Later): Later begins at From, with the last counts
%   before it.

from([step(_, _, _), step(Time, Counts, Total)|Steps], From, Later) :-
    Time =< From,
    !,
    from([step(Time, Counts, Total)|Steps], From, Later).
from([step(Time0, Counts, Total)|Steps], From,
     [step(Time, Counts, Total)|Steps]) :-
    Time is max(Time0, From).

of_kind(total, step(_, _, Total), Total) :-
    !.
of_kind(Kind, step(_, Counts, _), Count) :-
    nth1(Kind, Counts, Count).

%!  population_at(+Time, +Steps, -Counts) is det.

population_at(Time, Steps, Counts) :-
    findall(Counts0, ( member(step(T, Counts0, _), Steps), T =< Time ),
            All),
    last(All, Counts).

%!  again(+Executions, -First, -Again) is det.
%
%   First are the Executions that were the first of their task at their
%   host, Again the others.  Executions are in order of time.

again(Executions, First, Again) :-
    split(Executions, [], First, Again).

split([], _, [], []).
split([E|Es], Seen, First, Again) :-
    E = execution(Task, Host, _, _),
    (   memberchk(Host-Task, Seen)
    ->  Again = [E|Again1],
        split(Es, Seen, First, Again1)
    ;   First = [E|First1],
        split(Es, [Host-Task|Seen], First1, Again)
    ).

%!  spans(+Rows, -Seconds:list) is det.
%!  gaps(+Rows, -Seconds:list) is det.
%
%   For the rows of task_rows/2, see sync_metrics: the time from the first
%   start to the last end of each task; and from the last end to the first start
%   of the next task, negative if they overlap.

spans(Rows, Spans) :-
    findall(Span,
            ( member(task(_, First, _, End, _, _), Rows),
              Span is End - First ),
            Spans).

gaps(Rows, Gaps) :-
    findall(Gap,
            ( nextto(task(_, _, _, End, _, _), task(_, Next, _, _, _, _),
                     Rows),
              Gap is Next - End ),
            Gaps).
