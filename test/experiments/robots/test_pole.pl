:- module(test_pole, []).
:- use_module('../../lib/common', []).
:- use_module(library(plunit)).
:- use_module(library(apply), [include/3]).
:- use_module(library(lists)).
:- use_module(library(yall)).
:- use_module('../../../experiments/robots/pole_claims').
:- use_module('../../../experiments/robots/pole_metrics').
:- use_module('../../../experiments/sync/metrics', [task_rows/2]).

/** <module> What is said of a pole that was carried, on logs made by hand
*/

pole(Y, Tilt, Phase, pole(1.5, Y, 0.1, 0, 0, Tilt, 0, 0, Phase)).

%   Five states of 0.5 s, from 10 on, of a pole that is carried 1.2 m.

terms(Tilts, Terms) :-
    findall(state(Time, [], Pole, []),
            ( nth0(I, Tilts, Tilt),
              Time is 9.5 + 0.5*I,
              Y is 1 + 0.24*max(0, I - 1),
              pole(Y, Tilt, lying, Pole) ),
            Terms).

%   Four robots that take 5, 6, 7 and 8 s for each task; robot R begins task
%   T at Start.

executions(Case, Executions) :-
    findall(execution(T, R, Start, End),
            ( between(1, 4, T),
              between(1, 4, R),
              start(Case, T, R, Start),
              End is Start + R + 4 ),
            Executions0),
    sort(3, @=<, Executions0, Executions).

start(synchronised, T, R, Start) :-
    Start is 20*(T - 1) + 0.2*R.
start(alone, T, R, Start) :-
    Start is (R + 4)*(T - 1).

result(Case, Tilts, Result) :-
    executions(Case, Executions),
    terms(Tilts, Terms),
    pole_states(Terms, [10-10], 10, States),
    task_rows(Executions, Rows),
    numlist(1, 4, Hosts),
    Result = [ outcomes([done, done]), hosts(Hosts), tasks(Hosts),
               executions(Executions), rows(Rows), steps([0-1, 5-2]),
               states(States), tilt_limit(4)
             ].

held(Synchronised, Alone, Helds) :-
    result(synchronised, Synchronised, Result1),
    result(alone, Alone, Result2),
    pole_claims(Result1, Result2, Claims),
    findall(Held, member(claim(_, Held, _), Claims), Helds).

:- begin_tests(pole_metrics).

test(states_from_the_start, Times == [0.0, 0.5, 1.0]) :-
    terms([9, 0, 1, 2], Terms),
    pole_states([event(1, x), state(20, [], none, [])|Terms], [10-15], 15,
                States),
    findall(T, member(state(T, _), States), Times).
test(clocks, Times == [8.0, 10.0, 11.0, 12.0, 14.0, 17.0]) :-
    findall(Host,
            ( member(Arena, [-2.0, 0.0, 0.5, 1.0, 2.0, 5.0]),
              host_time([0.0-10.0, 1.0-12.0, 2.0-14.0], Arena, Host) ),
            Times).
test(clock_that_stands, Time =:= 13) :-
    host_time([1-11, 2-12, 2-13, 3-14], 2.0, Time0),
    Time is Time0 + 1.
test(tilt, Tilt-Seconds =:= 6-1.0) :-
    terms([9, 0, 6, 5, 1, 0], Terms),
    pole_states(Terms, [10-10], 10, States),
    max_tilt(States, Tilt0),
    over_limit(States, 4, Seconds0),
    Tilt-Seconds = Tilt0-Seconds0.
test(nothing_seen, [Tilt, Seconds, Metres] == [0, 0, 0]) :-
    max_tilt([], Tilt),
    over_limit([], 4, Seconds),
    carried([], Metres).
test(carried, true(abs(Metres - 0.96) < 1.0e-6)) :-
    terms([0, 0, 0, 0, 0, 0], Terms),
    pole_states(Terms, [10-10], 10, States),
    carried(States, Metres).
test(durations, Seconds == [5, 6, 7, 8]) :-
    executions(alone, Executions),
    durations(Executions, 1, Seconds0),
    msort(Seconds0, Seconds).
test(starts, true(abs(Seconds - 0.6) < 1.0e-6)) :-
    executions(synchronised, Executions),
    starts_apart(Executions, 2, Seconds).
test(none_mingled, Mingled == []) :-
    executions(synchronised, Executions),
    mingled(Executions, Mingled).
test(mingled, Mingled == [execution(2, 1, 5, 10), execution(2, 2, 6, 12)]) :-
    executions(alone, Executions0),
    include([execution(T, R, _, _)]>>(T =< 2, R =\= 4), Executions0,
            Executions),
    mingled(Executions, Mingled).

:- end_tests(pole_metrics).

:- begin_tests(pole_claims).

test(all_hold, Helds == [true, true, true, true, true, true, true, true,
                         true, true]) :-
    held([9, 0, 0, 1, 3, 1, 0], [0, 0, 6, 5, 4, 4, 0], Helds).
test(tilted, Helds == [true, true, true, true, true, true, false, true,
                       true, true]) :-
    held([9, 0, 0, 1, 5, 1, 0], [0, 0, 6, 5, 4, 4, 0], Helds).
test(not_carried, Held == false) :-
    held([9, 0, 0, 1], [0, 0, 6, 5, 4, 4, 0], Helds),
    nth1(8, Helds, Held).
test(alone_is_no_worse, Held == false) :-
    held([9, 0, 0, 1, 3, 1, 0], [0, 0, 3, 3, 3, 3, 0], Helds),
    nth1(10, Helds, Held).
test(not_synchronised, Helds == [true, true, true, true, false, true, true,
                                 true, false, true]) :-
    result(alone, [9, 0, 0, 1, 3, 1, 0], Result1),
    result(synchronised, [0, 0, 6, 5, 4, 4, 0], Result2),
    pole_claims(Result1, Result2, Claims),
    findall(Held, member(claim(_, Held, _), Claims), Helds).

:- end_tests(pole_claims).
