:- module(test_learning_metrics, []).
:- use_module('../../lib/common', []).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/learning/complexity').
:- use_module('../../../experiments/learning/degrees').
:- use_module('../../../experiments/learning/maze').
:- use_module('../../../experiments/learning/metrics').
:- use_module('../../../experiments/learning/ways').

/** <module> Metrics of learning agents

On logs and paths made by hand.
*/

%   Two agents begin at 10 and 11.  a executes three times and converges at
%   40; b executes twice and does not.  b gets something once, a twice.

events([ event(2, h1, t, created),
         event(10, h1, a, executed(1, 0, 1, unreached)),
         event(11, h2, b, executed(1, 0, 2, unreached)),
         event(12, h3, a, shared(b, 2)),
         event(15, h3, a, executed(2, 4, 3, unreached)),
         event(16, h3, b, shared(a, 1)),
         event(17, h3, b, unanswered(t)),
         event(20, h3, b, executed(2, 2, 3, unreached)),
         event(22, h3, a, shared(b, 1)),
         event(25, h4, a, executed(3, 6, 4, reached)),
         event(26, h4, a, reached(7)),
         event(40, h5, a, converged(3, 12, [forward])),
         event(40, h5, a, ended(exit)) ]).

some_learners(Learners) :-
    events(Events),
    learners(Events, Learners).

about(X, Y) :-
    abs(X - Y) < 1.0e-9.

                /*******************************
                *       BOUNDS (4.3.6)         *
                *******************************/

:- begin_tests(complexity).

test(section_4_3_6_beta, Beta == 39) :-          % 3 + 9 + 27
    exhaustive_search(3, 4, Beta).
test(one_action, Beta == 3) :-
    exhaustive_search(1, 4, Beta).
test(maze_of_the_thesis, Digits == 6990) :-      % 10,000 lg 5, less lg 4
    exhaustive_search(5, 10000, Beta),
    digits(Beta, Digits).
test(sharing_of_even_numbers, Times == [2, 6, 10]) :-   % 1, 3, 5 rounds
    findall(Time, ( member(N, [2, 4, 6]), sharing_time(N, 2, Time) ), Times).
test(sharing_of_odd_numbers, Times == [0, 3, 7]) :-     % 1 + 2, 3 + 4 rounds
    findall(Time, ( member(N, [1, 3, 5]), sharing_time(N, 1, Time) ), Times).
test(section_4_3_6_gamma, Gamma =:= 39 rdiv 4 + 6) :-
    shared_search(39, 4, 2, Gamma).
test(no_number_of_agents, error(type_error(_, 0))) :-
    sharing_time(0, 1, _).
test(no_time, error(type_error(rational, 0.5))) :-
    sharing_time(2, 0.5, _).
test(digits, Counts == [1, 3]) :-
    findall(Count, ( member(N, [1 rdiv 3, 1999 rdiv 2]),
                     Q is N, digits(Q, Count) ), Counts).

:- end_tests(complexity).

:- begin_tests(learning_measures).

test(learners,
     Learners == [ learner([0, 4, 6], [2, 12],
                           converged(30, 12, [forward])),
                   learner([0, 2], [6], none) ]) :-
    some_learners(Learners).
test(nothing_happened, Learners == []) :-
    learners([event(1, h, t, created)], Learners).
test(counts, Executed-Times-End == 5-[2, 12, 6]-30) :-
    some_learners(Learners),
    executed(Learners, Executed),
    shared_times(Learners, Times),
    duration(Learners, End).
test(spread) :-
    some_learners(Learners),
    spread(Learners, Share),
    about(Share, 1/3).          % lengths 0, 0; then 4, 2
test(overlap, true(about(Overlap, (1/4 + 2/4 + 2/3)/3))) :-
    overlap([[0-0,1-0,2-0], [2-0,3-0], [2-0,3-0,2-0,1-0]], Overlap).
test(overlap_of_one, true(Overlap =:= 1)) :-
    overlap([[0-0,1-0]], Overlap).
test(no_overlap, true(Overlap =:= 0)) :-
    overlap([[0-0], [1-1], [2-2]], Overlap).
test(trend) :-
    trend([0-5, 1-4, 2-0, 3-(-1)], Slope, Level),
    about(Slope, -2.2),
    about(Level, 5.3).
test(no_trend, fail) :-
    trend([1-5, 1-4], _, _).
test(bins, Points == [1.0-2, 3.0-0, 5.0-3]) :-
    bins([0, 1.9, 4, 5, 6], 6, 3, Points).

:- end_tests(learning_measures).

:- begin_tests(learning_maze).

test(path, Cells == [3-0, 3-1, 2-1, 3-1]) :-
    maze_path([size-3], [forward, turn_left, forward, backward, turn_back],
              Cells).
test(path_at_a_wall, Cells == [3-0, 3-1]) :-
    maze_path([size-3, obstacles-[(2,0)-(2,2)]],
              [forward, turn_left, forward], Cells).
test(walls, Cells == [2-0, 2-1]) :-
    maze_walls([obstacles-[(2,0)-(2,1)]], Cells).
test(ends, [Size, Start, Goal] == [50, 50-0, 0-50]) :-
    maze_size([], Size),
    start_cell([], Start),
    goal_cell([], Goal).
test(settings_are_removed, Size == 50) :-
    maze_size([size-3], 3),
    maze_size([], Size).

:- end_tests(learning_maze).

:- begin_tests(learning_ways).

%   Of 2 by 2 moves there are six ways.

test(all_shortest_ways, Count == 6) :-
    random_ways([size-2], 200, Ways),
    forall(member(Way, Ways), length(Way, 5)),
    sort(Ways, Set),
    length(Set, Count).
test(shortest_ways_are_drawn_uniformly) :-
    random_ways([size-2], 1200, Ways),
    msort(Ways, Sorted),
    clumped_ways(Sorted, Counts),
    forall(member(Count, Counts), assertion(Count > 150)).
test(no_way_through_a_wall, Set == [[2-0, 2-1, 2-2, 1-2, 0-2]]) :-
    random_ways([size-2, obstacles-[(1,0)-(1,1)]], 20, Ways),
    sort(Ways, Set).
test(ways_are_repeatable, Ways == Again) :-
    random_ways([size-5], 3, Ways),
    random_ways([size-5], 3, Again).
test(distance_from_the_diagonal) :-
    distance(diagonal(2), [2-0, 2-1, 2-2, 1-2, 0-2], Mean),
    about(Mean, (2/sqrt(2) + 2*1/sqrt(2))/5).
test(distance_from_a_wall) :-
    distance(wall(1, 1), [4-0, 2-0, 2-1, 2-2, 0-2], Mean),
    about(Mean, 2/3).
test(nearer_to_the_goal, true(Share =:= 1/2)) :-
    nearer(diagonal(2), [[2-0, 1-1, 0-2], [2-0, 2-2]], 0.5, Share).

clumped_ways(Ways, Counts) :-
    findall(Way-1, member(Way, Ways), Pairs),
    clumped(Pairs, Counts0),
    findall(Count, member(_-Count, Counts0), Counts).

:- end_tests(learning_ways).

:- begin_tests(learning_degrees).

test(degrees_of_a_dynamic_mesh) :-
    degrees(thesis_4_4_7, 50, 1, 300, Least-Most),
    assertion(( Least >= 0, Least < Most, Most < 49 )).
test(one_link_at_a_time, true(Least > 40)) :-
    degrees(random_links, 50, 1, 300, Least-_).
test(too_short, Degrees == none) :-
    degrees(thesis_4_4_7, 5, 1, 8, Degrees).

:- end_tests(learning_degrees).
