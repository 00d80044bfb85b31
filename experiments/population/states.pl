:- module(population_states,
          [ first_agents/2,             % +Events, -Agents
            moods_of/3,                 % +Agent, +Events, -Moods
            state_rows/2,               % +Moods, -Rows
            table_row/2                 % ?Kind, +Row
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(metrics, [agent_kind/2]).

/** <module> States of the agents of chapter 6, from an event log

*Threading*: pure.
*/

%!  first_agents(+Events, -Agents:list) is det.
%
%   The first agent of each kind, in the order of kinds: clones do not log
%   `begun`.

first_agents(Events, Agents) :-
    findall(Kind-Agent,
            ( member(event(_, _, Agent, begun), Events),
              agent_kind(Agent, Kind) ),
            Pairs0),
    sort(1, @<, Pairs0, Pairs),
    pairs_values(Pairs, Agents).

%!  moods_of(+Agent, +Events, -Moods:list(pair)) is det.
%
%   Moods are Time-Mood for each change of Agent to one of the three states.

moods_of(Agent, Events, Moods) :-
    findall(Time-Mood,
            ( member(event(Time, _, Agent, state(Mood)), Events),
              memberchk(Mood, [dormant, excited, active]) ),
            Moods).

%!  state_rows(+Moods, -Rows:list(list)) is det.
%
%   Rows are the simultaneous states of the agents, in order of time; Moods are
%   Agent-Moods, as from moods_of/3.

state_rows(Moods, Rows) :-
    findall(Time-(Agent-Mood),
            ( member(Agent-Changes, Moods), member(Time-Mood, Changes) ),
            Timed0),
    sort(1, @=<, Timed0, Timed),
    findall(Agent-dormant, member(Agent-_, Moods), Row0),
    rows(Timed, Row0, Rows0),
    pairs_values(Row0, First),
    distinct_rows([First|Rows0], Rows).

rows([], _, []).
rows([_-(Agent-Mood)|Changes], Row0, [States|Rows]) :-
    append(Before, [Agent-_|After], Row0),
    !,
    append(Before, [Agent-Mood|After], Row),
    pairs_values(Row, States),
    rows(Changes, Row, Rows).

distinct_rows([Row, Row|Rows0], Rows) :-
    !,
    distinct_rows([Row|Rows0], Rows).
distinct_rows([Row|Rows0], [Row|Rows]) :-
    distinct_rows(Rows0, Rows).
distinct_rows([], []).

%!  table_row(?Kind, +Row:list) is nondet.
%
%   Row is `printed` in Table 6.1: some are active, the next one is excited
%   unless all or none are active, all others are dormant.  Or it is `between`
%   two printed rows: the next agent has not been stimulated yet.

table_row(printed, Row) :-
    append(Active, [excited|Dormant], Row),
    all(Active, active),
    all(Dormant, dormant),
    !.
table_row(printed, Row) :-
    ( all(Row, dormant) ; all(Row, active) ),
    !.
table_row(between, Row) :-
    append(Active, Dormant, Row),
    Active = [_|_],
    Dormant = [_|_],
    all(Active, active),
    all(Dormant, dormant),
    !.

all(List, State) :-
    maplist(==(State), List).
