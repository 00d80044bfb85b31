:- module(test_pole, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/project_studies', [holding/3, invalid_claims/2]).
:- use_module('../../lib/robot_logs').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists)).
:- use_module('../../../experiments/robots/pole_metrics').

/** <module> Metrics of carried poles, on logs made by hand
*/

pole(Y, Tilt, Phase, pole(1.5, Y, 0.1, 0, 0, Tilt, 0, 0, Phase)).

%   States of 0.5 s, from 9.5 on, of a pole that is carried: with seven of
%   them 1.2 m.

terms(Tilts, Terms) :-
    findall(state(Time, [], Pole, []),
            ( nth0(I, Tilts, Tilt),
              Time is 9.5 + 0.5*I,
              Y is 1 + 0.24*max(0, I - 1),
              pole(Y, Tilt, lying, Pole) ),
            Terms).

%   Four robots that take 5, 6, 7 and 8 s for each task; robot R begins task
%   T at Start.

executions(Way, Executions) :-
    findall(execution(T, R, Start, End),
            ( between(1, 4, T),
              between(1, 4, R),
              start(Way, T, R, Start),
              End is Start + R + 4 ),
            Executions0),
    sort(3, @=<, Executions0, Executions).

start(in_step, T, R, Start) :-
    Start is 27*(T - 1) + 0.2*(R - 1).
start(alone, T, R, Start) :-
    Start is (R + 4)*(T - 1).

%   The entries of the network's log. When the first agent begins the clock of
%   the hosts shows 20, that of the arena 10.

events(Way, [event(20, 1, agent, begun), event(20, 1, none, arena_time(10))
            |Events]) :-
    executions(Way, Executions),
    findall(event(Time, R, agent, What),
            ( member(execution(T, R, Start, End), Executions),
              (   Time is Start + 20,
                  What = executing(pole, T)
              ;   Time is End + 20,
                  What = completed(pole, T)
              ) ),
            Events).

point(Way, Tilts, Point) :-
    robot_study(pole, Study),
    events(Way, Events),
    terms(Tilts, Terms),
    measured(Study, [way-Way], [1, 2, 3, 4], Events, Terms, Point).

%   Claims 1 to 9 are of robots in step, the last ones of robots alone, too.

points([InStep, Alone]) :-
    point(in_step, [9, 0, 0, 1, 3, 1, 0], InStep),
    point(alone, [0, 0, 6, 5, 4, 4, 0], Alone).

worse(in_step-_{executions:15}, 1).
worse(in_step-_{pairs:15}, 1).
worse(in_step-_{out_of_order:1}, 1).
worse(in_step-_{started_within:3.5}, 2).
worse(in_step-_{slowest:7.4}, 3).
worse(in_step-_{second:21}, 4).
worse(in_step-_{third:47}, 5).
worse(in_step-_{overlaps:1}, 6).
worse(in_step-_{tau:3}, 7).
worse(in_step-_{carried:1.1}, 8).
worse(in_step-_{lying:0}, 8).
worse(in_step-_{tilt:4.1}, 9).
worse(in_step-_{apart:9.5}, 10).
worse(alone-_{overlaps:0}, 11).
worse(alone-_{tilt:3.9}, 12).

spoilt(Way-More, Points0, [Case-Ms|Points]) :-
    select(Case-Ms0, Points0, Points),
    Case.way == Way,
    !,
    Ms = Ms0.put(More).

:- begin_tests(pole_metrics).

test(states_from_the_start, Times == [0.0, 0.5, 1.0]) :-
    terms([9, 0, 1, 2], Terms),
    pole_states([event(1, x), state(20, [], none, [])|Terms], [10-0], States),
    findall(T, member(state(T, _), States), Times).
test(clocks, Times == [8.0, 10.0, 11.0, 12.0, 14.0, 17.0]) :-
    findall(Host,
            ( member(Arena, [-2.0, 0.0, 0.5, 1.0, 2.0, 5.0]),
              host_time([0.0-10.0, 1.0-12.0, 2.0-14.0], Arena, Host) ),
            Times).
test(stopped_clock, Time =:= 13) :-
    host_time([1-11, 2-12, 2-13, 3-14], 2.0, Time0),
    Time is Time0 + 1.
test(over_limit, Seconds =:= 1.0) :-
    over_limit([0-0, 0.5-6, 1.0-5, 1.5-1, 2.0-6], 4, Seconds).
test(never_over_limit, Seconds =:= 0) :-
    over_limit([0-0, 0.5-4, 1.0-4], 4, Seconds).
test(starts, true(abs(Seconds - 0.6) < 1.0e-6)) :-
    executions(in_step, Executions),
    starts_apart(Executions, 2, Seconds).

test(stacked, Rows == [[0, 1, 0], [0, 1, 1], [0, 2, 2], [3, 2, 0]]) :-
    start_rows([ execution(1, a, 0.1, 2), execution(1, b, 0.2, 2),
                 execution(2, b, 0.7, 2), execution(2, a, 3.5, 4) ], Rows).

:- end_tests(pole_metrics).

%   ready(+Task, +Robot, -Time): the one before has ended.

ready(1, _, 0) :-
    !.
ready(T, R, End) :-
    Before is T - 1,
    start(in_step, Before, R, Start),
    End is Start + R + 4.

%   about(+Row, +Wanted): rows of numbers, or atoms.

about([], []).
about([X|Xs], [Y|Ys]) :-
    ( X == Y -> true ; abs(X - Y) < 1.0e-6 ),
    about(Xs, Ys).

:- begin_tests(pole_claims).

test(well_formed, Problems == []) :-
    robot_study(pole, Study),
    invalid_claims(Study, Problems).
test(measures) :-
    points([_-Ms|_]),
    forall(member(Name-Value,
                  [ executions-16, pairs-16, out_of_order-0, overlaps-0,
                    premature-0, tau-1, quickest-5, slowest-8, second-27,
                    third-54, tilt-3, tilt_limit-4, over-0, lying-1,
                    started_within-0.6, carried-1.2 ]),
           assertion(abs(Ms.Name - Value) < 1.0e-6)).
test(bars) :-
    points([_, _-Ms]),
    forall(member(Bar, [[1, 1, 0.0, 5.0, 1], [4, 2, 8.0, 16.0, 1]]),
           assertion(( member(Row, Ms.bars), maplist(=:=, Row, Bar) ))),
    assertion(length(Ms.bars, 16)).    % alone, no robot waits

%   In step only the robots that have not begun yet require a task; alone none
%   ever does.

test(required_tasks) :-
    points([_-InStep, _-Alone]),
    assertion(maplist(about, InStep.taus,
                      [ [0, 1], [0.6, 0], [5, 1], [27.6, 0], [32, 1],
                        [54.6, 0], [59, 1], [81.6, 0] ])),
    assertion(Alone.taus == [[0, 0], [32, 0]]).
test(robots_require_a_task_until_they_begin_it) :-
    findall([R, T, From, To, 0],
            ( between(1, 4, R), between(1, 4, T), start(in_step, T, R, To),
              ready(T, R, From), From < To ), Wanted),
    points([_-Ms|_]),
    findall([R, T, From, To, 0], member([R, T, From, To, 0], Ms.bars), Found0),
    sort(Found0, Found),
    assertion(maplist(about, Found, Wanted)).
test(tables) :-
    points([_-InStep, _-Alone]),
    assertion(maplist(about, InStep.tilts,
                      [ [0, 0], [0.5, 0], [1, 1], [1.5, 3], [2, 1],
                        [2.5, 0] ])),
    assertion(maplist(about, InStep.tasks,
                      [ [1, 0, 8.6, 18.4], [2, 27, 35.6, 18.4],
                        [3, 54, 62.6, 18.4], [4, 81, 89.6, none] ])),
    assertion(append([[0, 1, 0], [0, 1, 1], [0, 1, 2], [0, 1, 3], [5, 2, 0]],
                     _, Alone.starts)),
    assertion(append(_, [[0, 1, 3], [27, 2, 0], [27, 2, 1]|_],
                     InStep.starts)).
test(all_hold, true(Numbers == All)) :-
    robot_study(pole, Study),
    points(Points),
    holding(Study, Points, Numbers),
    numlist(1, 12, All).
test(each_claim_can_fail, [forall(worse(Worse, N)), true(Failing == [N])]) :-
    robot_study(pole, Study),
    points(Points0),
    spoilt(Worse, Points0, Points),
    holding(Study, Points, Numbers),
    numlist(1, 12, All),
    subtract(All, Numbers, Failing).

:- end_tests(pole_claims).
