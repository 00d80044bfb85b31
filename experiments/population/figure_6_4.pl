%   Figure 6.4: hosts lose task 2 while task 4 is executed.

:- include(ground).
:- include(tasks).
:- use_module('../sync/metrics', [overlaps/2]).
:- use_module(metrics, [peak/3, peak/4, population_at/3]).
:- use_module(pictures,
              [bar_rows/2, crash_rows/2, kind_rows/2, other_rows/2,
               panel_variables/2, span_rows/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, min_member/2, subtract/3]).

study('6.4', "Twenty hosts lose task 2 while task 4 is executed").
text("As in Figure 6.3, but 20 hosts lose task 2 while task 4 is executed. An \c
agent of the second kind visits them, executes it again, and clones itself.").

fixed(crash, 20, printed("section 6.5")).

printed(rise_time, [hosts=50], 250).
printed(rise_time, [hosts=100], 300).

label(crash_time, "Time of the crash (s)").
label(rise, "Greatest increase of Agent-2 after the crash").
label(rise_time, "Time of the greatest number of Agent-2 after the crash (s)").
label(healed, "Time at which the last host had T2 again (s)").

measure(lost, View, Count) :-
    length(View.failures, Count).
measure(crash_time, View, Time) :-
    min_member(Time-_, View.failures).
measure(healed, View, Time) :-
    aggregate_all(max(End), member(execution(2, _, _, End), View.again),
                  Time).
measure(rise, View, Rise) :-
    agent_2(View, Before, _-Peak),
    Rise is Peak - Before.
measure(rise_time, View, Time) :-
    agent_2(View, _, Time-_).
measure(first_peak, View, Count) :-
    peak(2, View.steps, _-Count).
measure(second_peak, View, Count) :-
    agent_2(View, _, _-Count).
measure(not_healed, View, Count) :-
    findall(Host, member(_-Host, View.failures), Lost),
    findall(Host, member(execution(2, Host, _, _), View.again), Healed),
    subtract(Lost, Healed, Missing),
    length(Missing, Count).
measure(again, View, Count) :-
    length(View.again, Count).
measure(later_overlapped, View, Count) :-
    findall(execution(Task, Host, Start, End),
            ( member(execution(Task, Host, Start, End), View.executions),
              Task >= 4 ),
            Later),
    overlaps(Later, Overlapping),
    length(Overlapping, Count).

%   agent_2(+View, -Before, -Peak): the number of agents of the second kind at
%   the crash, and their greatest number from then on.

agent_2(View, Before, Peak) :-
    min_member(Crash-_, View.failures),
    population_at(Crash, View.steps, [_, Before|_]),
    peak(2, Crash, View.steps, Peak).

claim("all hosts that lost T2 execute it again, nothing else is executed \c
again", [line(4347)],
      ( not_healed =:= 0, again =:= lost )).
claim("the number of Agent-2 rises a little, to less than its first peak",
      [line(4350)],
      ( rise > 0, second_peak < first_peak )).
claim("this rise is at around 250 s with 50 hosts",
      [line(4350), why("four tasks of 30 s and four idle times precede it")],
      at([hosts=50], near(rise_time, 250, 25))).
claim("this rise is at around 300 s with 100 hosts", [line(4351)],
      at([hosts=100], near(rise_time, 300, 25))).
claim("T4 and T5 keep their order", [line(4351)], later_overlapped =:= 0).

plot('6.4', "Twenty hosts lose task 2 while task 4 is executed",
     script('population.gp',
            [ starts-bar_rows, kinds-kind_rows, others-other_rows,
              spans-span_rows, crash-crash_rows ],
            [size(1600, 1050), variables(panel_variables)])).
