:- module(test_away_study, []).

% Agents that work on robots which are away at times: a small run each way.

:- use_module('../../lib/common', [no_leaks/1, with_tmp_dir/1]).
:- use_module('../../lib/project_studies').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

small(Way, [ way-Way, period-120, robots-6, agents-6, visits-3, between-10,
             limit-1500 ]).

run(Way, Point, Dir) :-
    small(Way, Given),
    project_study('fleet/study_away', Study),
    first_run(Study, Given, 3, Dir, _-Point).

way(Way) :-
    member(Way, [again, others, wait, both]).

:- begin_tests(away_study).

test(agents_come_back_and_work_on_each_robot_once,
     [forall(way(Way)), true(Done-Twice == 6-0)]) :-
    no_leaks(with_tmp_dir(test_away_study:run(Way, Point))),
    get_dict(done, Point, Done),
    get_dict(twice, Point, Twice).
test(agents_that_wait_begin_each_move_once, true(Tries =:= 4)) :-
    with_tmp_dir(test_away_study:run(wait, Point)),
    get_dict(tries, Point, Tries).
test(others_begin_moves_again, true(Tries > 4)) :-
    with_tmp_dir(test_away_study:run(again, Point)),
    get_dict(tries, Point, Tries).

:- end_tests(away_study).
