%   Table 6.1: the sequence of states of the agents of five tasks.

:- include(ground).
:- use_module('../sync/metrics', [from_start/2]).
:- use_module(states, [first_agents/2, moods_of/3, state_rows/2, table_row/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).

study('6.1', "Table 6.1: the states of the agents").
text("The first agents of five kinds. At first all are DORMANT. The agent of \c
the first task is EXCITED at once; each of the others when it perceives that \c
the previous task has been completed. When its potential is zero an agent is \c
ACTIVE, and remains so. The measures are the times of these changes.").

fixed(crash, 0, assumed("the table assumes a network without failures")).

view(Log, view{agents:Agents, moods:Moods, rows:Rows}) :-
    from_start(Log.events, Events),
    first_agents(Events, Agents),
    findall(Agent-Of, ( member(Agent, Agents), moods_of(Agent, Events, Of) ),
            Moods),
    state_rows(Moods, Rows).

printed(rows, [], 7).

label(Measure, Text) :-
    mood_of(Measure, Kind, Mood),
    upcase_atom(Mood, Upper),
    format(string(Text), "AT~d is ~w (s)", [Kind, Upper]).
label(rows, "Rows of the table that were seen").
label(others, "Rows between these: the next agent has not been stimulated yet").
label(wrong, "Other rows").

%   The times at which the first agent of each kind became excited, and active.

mood_of(Measure, Kind, Mood) :-
    between(1, 5, Kind),
    member(Mood, [excited, active]),
    atomic_list_concat([Mood, Kind], '_', Measure).

measure(Measure, View, Time) :-
    mood_of(Measure, Kind, Mood),
    nth1(Kind, View.moods, _-Moods),
    memberchk(Time-Mood, Moods).
measure(lapses, View, Count) :-
    aggregate_all(count,
                  ( member(_-Moods, View.moods),
                    \+ Moods = [_-dormant, _-excited, _-active] ), Count).
measure(rows, View, Count) :-
    aggregate_all(count, ( member(Row, View.rows), table_row(printed, Row) ),
                  Count).
measure(others, View, Count) :-
    aggregate_all(count, ( member(Row, View.rows), table_row(between, Row) ),
                  Count).
measure(wrong, View, Count) :-
    aggregate_all(count, ( member(Row, View.rows), \+ table_row(_, Row) ),
                  Count).

claim("all seven rows of the table are seen, in its order", [line(4072)],
      rows =:= 7).
claim("there is no other row, but those in which the next agent has not yet \c
perceived what is done", [line(4072)],
      wrong =:= 0).
claim("every agent is DORMANT, then EXCITED, then ACTIVE to the end",
      [line(4189)],
      lapses =:= 0).
claim("the first agent is EXCITED at once (within 5 s)", [line(4175)],
      excited_1 =< 5).
claim(Text, [line(4183)], Test) :-
    between(2, 5, Kind),
    Before is Kind - 1,
    format(string(Text), "AT~d is EXCITED only when AT~d is ACTIVE",
           [Kind, Before]),
    atom_concat(excited_, Kind, Excited),
    atom_concat(active_, Before, Active),
    Test = (Excited > Active).

plot('6.1', "When the agents are EXCITED, and ACTIVE",
     script('states.gp', [states-mood_rows], [size(1000, 560)])).

%   A row for each state of each run: size, kind, from, mood (1 excited, 2
%   active).

mood_rows(Runs, Rows) :-
    findall([Hosts, Kind, Time, Number],
            ( member(run(Case, _, Measures), Runs),
              Hosts = Case.hosts,
              mood_of(Measure, Kind, Mood),
              get_dict(Measure, Measures, Time),
              nth1(Number, [excited, active], Mood) ),
            Rows).
