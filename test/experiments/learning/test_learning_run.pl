:- use_module('../../lib/common', [project_file/2, run_swipl/5, with_tmp_dir/1]).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(readutil)).
:- use_module('../../../experiments/learning/cases').
:- use_module('../../../experiments/learning/claims').
:- use_module('../../../experiments/learning/links').
:- use_module('../../../experiments/learning/maze').
:- use_module('../../../experiments/learning/metrics').

/** <module> The experiment of agents that learn: what is told of its runs

On event logs made by hand, and, small, by its own command line.
*/

                /*******************************
                *           MEASURES           *
                *******************************/

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

result(Result) :-
    events(Events),
    learning_result(Events, Result).

%   learning(Lengths, Shared, Actions): of an agent that took so many
%   executions and sharing events, and converged.

learning(Executions-Shared-Actions,
         learner(Lengths, Times, converged(1000, 10, Actions))) :-
    numlist(1, Executions, Lengths),
    findall(T, between(1, Shared, T), Times).

run_of(Settings, Agents, Told, run(none, Result)) :-
    maplist(learning, Told, Learners),
    Result = [ agents(Agents), settings(Settings), duration(1000),
               learners(Learners) ].

about(X, Y) :-
    abs(X - Y) < 1.0e-9.

:- begin_tests(learning_measures).

test(learners,
     Learners == [ learner([0, 4, 6], [2, 12],
                           converged(30, 12, [forward])),
                   learner([0, 2], [6], none) ]) :-
    result(Result),
    memberchk(learners(Learners), Result).
test(times, Duration-Unanswered == 30-1) :-
    result(Result),
    memberchk(duration(Duration), Result),
    memberchk(unanswered(Unanswered), Result).
test(nothing_happened, Result == [ learners([]), duration(0),
                                   unanswered(0) ]) :-
    learning_result([event(1, h, t, created)], Result).
test(executions, true(Mean =:= 2.5)) :-
    result(Result),
    executions([Result], Mean).
test(ratio_of_averages, true(Ratio =:= 4/12)) :-
    result(Result),
    run_of([], 1, [7-1-[]], run(_, Other)),
    sharing([Result, Other], Ratio).
test(spread) :-
    result(Result),
    spread([Result], Actions, Share),
    about(Actions, 0.5),        % lengths 0, 0; then 4, 2
    about(Share, 1/3).
test(overlap, true(abs(Overlap) < 1.0e-9)) :-
    overlap([[0-0,1-0,2-0], [2-0,3-0], [2-0,3-0,2-0,1-0]], Overlap0),
    Overlap is Overlap0 - (1/4 + 2/4 + 2/3)/3.
test(overlap_of_one, true(Overlap =:= 1)) :-
    overlap([[0-0,1-0]], Overlap).
test(no_overlap, true(Overlap =:= 0)) :-
    overlap([[0-0], [1-1], [2-2]], Overlap).
test(slope) :-
    slope([0-5, 1-4, 2-0, 3-(-1)], Slope, Level),
    about(Slope, -2.2),
    about(Level, 5.3).
test(no_slope, fail) :-
    slope([1-5, 1-4], _, _).
test(bins, Points == [1.0-2, 3.0-0, 5.0-3]) :-
    bins([0, 1.9, 4, 5, 6], 6, 3, Points).

:- end_tests(learning_measures).

                /*******************************
                *             MAZE             *
                *******************************/

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
test(settings_are_gone, Size == 50) :-
    maze_size([size-3], 3),
    maze_size([], Size).

:- end_tests(learning_maze).

                /*******************************
                *             CASES            *
                *******************************/

:- begin_tests(learning_cases).

test(agents, Agents == [1, 2, 5, 25]) :-
    maplist(case_agents, [ case(sharing, 10, 1), case(sharing, 10, 2),
                           case(sharing, 50, 1), case(dynamic, 50, 5) ],
            Agents).
test(clock, Rates == [40, 20, 8]) :-
    findall(Rate,
            ( member(D, [1, 2, 5]),
              case_clock(case(sharing, 50, D), pace(200, 40), Rate0),
              Rate is round(Rate0) ),
            Rates).
test(thirty_cases_of_figure_4_9, Count == 30) :-
    figure_cases('4.9', [10,20,30,40,50], Cases),
    sort(Cases, Set),
    length(Set, Count).
test(alone, [Agents, Model, Settings] == [5, none, [sharing-false, c-1]]) :-
    case_options(case(alone, 50, 1),
                 [clock(20), dynamic(random_links), settings([c-1])],
                 Options),
    memberchk(agents(Agents), Options),
    memberchk(dynamic(Model), Options),
    memberchk(settings(Settings), Options).
test(obstacle, Obstacles == [(40,0)-(40,40)]) :-
    case_options(case(obstacle, 50, 2),
                 [clock(20), dynamic(none), settings([])], Options),
    memberchk(settings(Settings), Options),
    memberchk(obstacles-Obstacles, Settings).
test(dynamic, Model-Rate == random_links-20) :-
    case_options(case(dynamic, 50, 2),
                 [clock(20), dynamic(random_links), settings([])], Options),
    memberchk(dynamic(Model), Options),
    memberchk(clock(Rate), Options).
test(degrees_of_a_dynamic_mesh, true(Most < 49)) :-
    degrees(thesis_4_4_7, 50, 1, 300, Least-Most),
    assertion(( Least >= 0, Least < Most )).
test(degrees_of_a_mesh, Degrees == none) :-
    degrees(none, 50, 1, 300, Degrees).

:- end_tests(learning_cases).

                /*******************************
                *            CLAIMS            *
                *******************************/

%   held(+Figure, +CaseRuns, +Start, -Held): of the claims whose text begins
%   with Start.

held(Figure, CaseRuns, Start, Held) :-
    learning_claims(Figure, CaseRuns, Claims),
    findall(H, ( member(claim(Text, H, Found), Claims),
                 sub_atom(Text, 0, _, _, Start),
                 atomic(Found) ),
            Held).

%   Ways through a maze of size 2, the same and different ones.

two_paths(same, [W, W]) :-
    W = [forward,forward,turn_left,forward,forward].
two_paths(different, [ [forward,forward,turn_left,forward,forward],
                       [turn_left,forward,forward,turn_right,forward,forward]
                     ]).

paths_data(Kind, Paths, case(Kind, 20, 1)-[Run]) :-
    two_paths(Paths, [W1, W2]),
    run_of([size-2], 2, [195-0-W1, 195-0-W2], Run).

%   Densities 0.1 to 0.5 of one network: executions and sharing events of
%   the one agent there is.

curve(Kind, N, Told, CaseRuns) :-
    findall(case(Kind, N, D)-[Run],
            ( nth1(D, Told, Executions-Shared),
              run_of([], 1, [Executions-Shared-[]], Run) ),
            CaseRuns).

sharing_over_time(Times, [case(sharing, 50, 5)-[run(none, Result)]]) :-
    Result = [ agents(1), settings([]), duration(300),
               learners([learner([1], Times, none)]) ].

:- begin_tests(learning_claims).

test(same_paths, Held == [[true], [true], [true], [false]]) :-
    paths_data(alone, different, Alone),
    paths_data(sharing, same, Sharing),
    findall(H,
            ( member(Text, [ without, 'with sharing all', '195', '92' ]),
              held('4.7', [Alone, Sharing], Text, H) ),
            Held).
test(different_paths, Held == [[false], [false], [false], [false]]) :-
    paths_data(alone, same, Alone),
    paths_data(sharing, different, Sharing),
    findall(H,
            ( member(Text, [ without, 'with sharing all', 'or highly',
                             'paths overlap' ]),
              held('4.7', [Alone, Sharing], Text, H) ),
            Held).
test(totals, Held == [[false], [false], [true]]) :-
    run_of([], 2, [100-0-[], 96-0-[]], Alone),
    run_of([], 2, [50-0-[], 46-0-[]], Sharing),
    Data = [case(alone, 20, 1)-[Alone], case(sharing, 20, 1)-[Sharing]],
    findall(H,
            ( member(Text, ['around 900', 'around 350', 'less than half']),
              held('4.8', Data, Text, H) ),
            Held).
test(executions_fall, Held == [[true], [true], [true], [true], [true]]) :-
    curve(sharing, 10, [195-0, 110-9, 90-9, 85-9, 85-9], Data),
    findall(H,
            ( member(Text, [ 'executions do', 'largest', '195', '110',
                             'no significant' ]),
              held('4.9', Data, Text, H) ),
            Held).
test(executions_do_not, Held == [[false], [false], [false]]) :-
    curve(sharing, 10, [100-0, 99-9, 50-9, 51-9, 40-9], Ten),
    curve(sharing, 20, [100-0, 90-9, 80-9, 70-9, 60-9], Twenty),
    append(Ten, Twenty, Data),
    findall(H,
            ( member(Text, [ 'executions do not grow with the density, 10',
                             'largest drop from D 0.1 to 0.2, 10',
                             'no significant' ]),
              held('4.9', Data, Text, H) ),
            Held).
test(obstacle, Held == [[true], [false], [true], [true]]) :-
    curve(sharing, 50, [90-9, 80-9, 70-9, 65-9, 60-9], Plain),
    curve(obstacle, 50, [99-9, 88-9, 77-9, 66-9, 61-9], Obstacle),
    append(Plain, Obstacle, Data),
    held('4.9', Data, 'more executions', Executions),
    held('4.10', Data, 'more sharing', Sharing),
    held('4.9', Data, 'all agents', Converged),
    held('4.9', Data, 'runs take', Lengths),
    Held = [Executions, Sharing, Converged, Lengths].
test(sharing_rises, Held == [[true], [true], [true]]) :-
    curve(sharing, 10, [100-0, 100-60, 100-80, 100-90, 100-94], Data),
    findall(H,
            ( member(Text, ['sharing grows', '0 with 1', 'less than 0.05']),
              held('4.10', Data, Text, H) ),
            Held).
test(sharing_does_not, Held == [[false], [false], [false]]) :-
    curve(sharing, 10, [100-1, 100-60, 100-60, 100-90, 100-96], Data),
    findall(H,
            ( member(Text, ['sharing grows', '0 with 1', 'less than 0.05']),
              held('4.10', Data, Text, H) ),
            Held).
test(standard_errors, Found == '13.0±1.0, 20.0±2.0, 9.00±0.00') :-
    findall(case(sharing, 50, D)-[Run1, Run2],
            ( nth1(D, [12-14, 18-22, 9-9], E1-E2),
              run_of([], 1, [E1-0-[]], Run1),
              run_of([], 1, [E2-0-[]], Run2) ),
            Data),
    learning_claims('4.9', Data, Claims),
    memberchk(claim('executions do not grow with the density, 50 hosts',
                    false, Found), Claims).
test(less_and_less, Held == [true]) :-
    sharing_over_time([1, 2, 3, 4, 15, 16, 40, 200], Data),
    held('4.12', Data, sharing, Held).
test(more_and_more, Held == [false]) :-
    sharing_over_time([100, 200, 250, 290, 295, 299], Data),
    held('4.12', Data, sharing, Held).
test(early_gain, Held == [[true], [false]]) :-
    curve(dynamic, 50, [100-10, 100-60, 100-70, 100-80, 100-90], Early),
    curve(dynamic, 50, [100-10, 100-30, 100-50, 100-70, 100-90], Late),
    maplist([D0, D]>>maplist(with_degrees, D0, D), [Early, Late],
            [Early1, Late1]),
    held('4.13', Early1, 'sharing gains', Held1),
    held('4.13', Late1, 'sharing gains', Held2),
    Held = [Held1, Held2].
test(degrees, Held == [true]) :-
    curve(dynamic, 50, [100-10, 100-60, 100-70, 100-80, 100-90], Data0),
    maplist(with_degrees, Data0, Data),
    held('4.13', Data, degrees, Held).
test(not_converged, Held == [false]) :-
    curve(sharing, 10, [195-0, 110-9, 90-9, 85-9, 85-9], Data),
    held('4.9', [ case(sharing, 50, 5)-[run(none, [ agents(1), settings([]),
                      duration(9), learners([learner([1], [], none)]) ])]
                | Data
                ], 'all agents converge', Held).

with_degrees(Case-[run(D, Result)], Case-[run(D, [degrees(0-26)|Result])]).

:- end_tests(learning_claims).

                /*******************************
                *             RUNS             *
                *******************************/

run(More, Status, Out, Err) :-
    project_file('experiments/learning.pl', Script),
    append([Script, '--'], More, Arguments),
    run_swipl(Arguments, [timeout(120)], Status, Out, Err).

%   A maze of 3 by 3 cells, two agents.

small([ '--sizes', '[20]', '--settings', '[size-2,rho_max-3]',
        '--clock', '40', '--runs', '1', '--jobs', '2' ]).

figure_4_11(Dir) :-
    small(Small),
    append(['--figure', '4.11', '--out', Dir], Small, Arguments),
    run(Arguments, Status, Out, Err),
    (   Status == exit(0)
    ->  true
    ;   throw(error(learning_failed(Status, Err), _))
    ),
    forall(member(Text, [ "obstacle-20-2     1", "sharing-20-2     1",
                          "final paths without an obstacle" ]),
           once(sub_string(Out, _, _, _, Text))),
    forall(member(Name, [ 'figure-4.11.gnuplot', 'figure-4.11.csv',
                          'figure-4.11-claims.csv', 'figure-4.11-1-2.dat',
                          'runs/obstacle-20-2-seed1-*/result.pl' ]),
           ( directory_pattern(Dir, Name, File),
             size_file(File, Size), Size > 0 )),
    directory_pattern(Dir, 'runs/obstacle-20-2-seed1-*/result.pl', File),
    read_file_to_terms(File, [result(Result)], []),
    memberchk(settings(Settings), Result),
    memberchk(learners(Learners), Result),
    length(Learners, 2),
    forall(member(learner(_, _, converged(_, _, Actions)), Learners),
           ( maze_path(Settings, Actions, Cells),
             last(Cells, 0-2),
             \+ memberchk(1-0, Cells) )),
    \+ memberchk(learner(_, _, none), Learners).

directory_pattern(Dir, Pattern, File) :-
    atomic_list_concat([Dir, /, Pattern], Wild),
    expand_file_name(Wild, [File]),
    exists_file(File).

%   In a maze of 2601 cells nobody converges so soon.

given_up(Dir) :-
    run([ '--single', '--nodes', '4', '--agents', '2', '--limit', '30',
          '--clock', '20', '--dynamic', 'none', '--out', Dir ],
        exit(0), _, _),
    directory_pattern(Dir, 'result.pl', File),
    read_file_to_terms(File, [result(Result)], []),
    memberchk(learners(Learners), Result),
    Learners \== [],
    forall(member(learner(_, _, End), Learners), End == none).

refused(Arguments, Name) :-
    run(Arguments, exit(1), _, Err),
    sub_string(Err, _, _, _, Name),
    !.

:- begin_tests(learning_run).

test(figure_4_11) :-
    with_tmp_dir(figure_4_11).
test(given_up) :-
    with_tmp_dir(given_up).
test(wrong_parameters,
     [ forall(member(Arguments-Name,
                     [ ['--figure', '4.6']-"figure",
                       ['--clock', 'pace(0,1)']-"clock",
                       ['--sizes', '[20,10]']-"sizes",
                       ['--hop_time', '2-1']-"hop_time" ])) ]) :-
    refused(Arguments, Name).

:- end_tests(learning_run).
