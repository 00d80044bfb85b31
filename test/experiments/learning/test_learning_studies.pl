:- module(test_learning_studies, []).
:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module('../../lib/project_studies').
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(yall)).
:- use_module(library(apply)).
:- use_module('../../../experiments/engine/cases').
:- use_module('../../../experiments/engine/picture').
:- use_module('../../../experiments/engine/run').
:- use_module('../../../experiments/engine/studies').

/** <module> The studies of agents that learn: claims, and small runs
*/

a_study(Name, Count) :-
    member(Name-Count,
           [ 'learning/figure_4_7'-3, 'learning/figure_4_9'-30,
             'learning/figure_4_13'-5, 'learning/study_light'-12,
             'learning/study_bounds'-5,
             'algorithms/beyond_settings'-4, 'algorithms/beyond_islands'-3,
             'algorithms/beyond_mixed'-6, 'algorithms/beyond_exchange'-2,
             'algorithms/beyond_contest'-1, 'algorithms/beyond_cloning'-3, 'algorithms/beyond_crews'-12 ]).

:- begin_tests(learning_studies).

test(cases, [forall(a_study(Name, Count)), true(Found == Count)]) :-
    project_study(Name, Study),
    case_count(Study, Found).
test(claims_are_well_formed, [forall(a_study(Name, _)), true(Odd == [])]) :-
    project_study(Name, Study),
    invalid_claims(Study, Odd).

:- end_tests(learning_studies).

                /*******************************
                *            CLAIMS            *
                *******************************/

%   made(+Held, +Name, +Case, -Pairs): measures of which all claims hold, or
%   none does.

made(true, 'learning/figure_4_7', Case, Pairs) :-
    (   Case.sharing == false
    ->  Pairs = [ distinct-5, agents-5, overlap-0.1, executions-195,
                  total-900, duration-900, spread-0.2, aside-9, nearer-90,
                  detour-0 ]
    ;   ( Case.network == obstacle -> Executions = 93 ; Executions = 92 ),
        Pairs = [ distinct-1, agents-5, overlap-1, executions-Executions,
                  total-350, duration-300, spread-0.1, aside-1, nearer-1,
                  detour-0 ]
    ).
made(false, 'learning/figure_4_7', Case, Pairs) :-
    (   Case.sharing == false
    ->  Pairs = [ distinct-4, agents-5, overlap-0.5, executions-100,
                  total-500, duration-300, spread-0.1, aside-1, nearer-90,
                  detour-0 ]
    ;   Pairs = [ distinct-2, agents-5, overlap-0.4, executions-60,
                  total-300, duration-900, spread-0.2, aside-2, nearer-10,
                  detour-1 ]
    ).
made(Held, 'algorithms/beyond_crews', Case,
     [reached-Reached, executions-Executions]) :-
    crew_made(Held, Case.maze, Case.crew, Reached, Executions),
    !.
made(Held, 'learning/figure_4_9', Case, Pairs) :-
    nth_density(Case.density, I),
    more(Held, Case.network, More),
    curve(Held, I, Executions0, Sharing0),
    Executions is Executions0 + More,
    (   Case.network == 10,
        I =:= 1
    ->  ( Held == true -> Sharing = 0 ; Sharing = 1 )
    ;   Sharing is Sharing0 + More/1000
    ),
    member(Held-Rest, [ true-[duration-300, trend-(-1), early_trend-(-1)],
                        false-[duration-200, trend-1, early_trend-1] ]),
    (   Case.network == obstacle
    ->  Open = []
    ;   Open = [no_obstacle-Executions]
    ),
    append([[executions-Executions, sharing-Sharing], Open, Rest], Pairs).
made(Held, 'learning/figure_4_13', Case, [ executions-Executions,
                                           sharing-Sharing|Rest ]) :-
    nth_density(Case.density, I),
    curve(Held, I, Executions, Sharing),
    member(Held-Rest, [ true-[least_degree-0, most_degree-27],
                        false-[least_degree-1, most_degree-40] ]).

made(Held, 'learning/study_bounds', Case,
     [ executions-Executions, beta_digits-Beta, gamma_digits-Gamma,
       theta_digits-3 ]) :-
    bounds_made(Held, Beta, Gamma, Executed),
    nth1(I, [0.02, 0.04, 0.1, 0.2, 0.5], Case.density),
    nth1(I, Executed, Executions).

%   bounds_made(-World, -Beta, -Gamma, -Executed): agents share the work without
%   loss in `divided`, and gain nothing in `alike`.

bounds_made(true,    1004, 3, [195, 110, 90, 80, 70]).
bounds_made(divided, 1003, 4, [1000, 500, 200, 100, 40]).
bounds_made(alike,   1003, 4, [100, 100, 100, 100, 100]).

nth_density(Density, I) :-
    I is round(10*Density).

more(true, obstacle, 2) :- !.
more(false, obstacle, -2) :- !.
more(false, 20, 40) :- !.
more(_, _, 0).

curve(true, I, Executions, Sharing) :-
    nth1(I, [195, 110, 95, 94, 93], Executions),
    nth1(I, [0.3, 1.0, 1.1, 1.2, 1.22], Sharing).
curve(false, I, Executions, Sharing) :-
    nth1(I, [100, 98, 50, 51, 40], Executions),
    nth1(I, [1.0, 0.9, 0.5, 0.4, 1.3], Sharing).

%   The claims hold if in the open maze `greedy` alone is quick.

crew_made(true, open, greedy, 100, 200).
crew_made(true, _, greedy, 0, 2000).
crew_made(true, _, both, 100, 700).
crew_made(true, _, scout, 50, 2000).
crew_made(true, _, scout_apart, 75, 1000).
crew_made(false, _, greedy, 75, 900).
crew_made(false, _, scout, 75, 600).
crew_made(false, _, _, 50, 800).

made_up(Held, Name, Verdicts) :-
    project_study(Name, Study),
    study_cases(Study, [], Cases),
    findall(Case-Measures,
            ( member(Case, Cases),
              made(Held, Name, Case, Pairs),
              dict_create(Measures, measures, Pairs) ),
            Points),
    verdicts(Study, Points, Verdicts).

:- begin_tests(learning_claims).

test(hold, [forall(figure(Name)), true(Others == [])]) :-
    made_up(true, Name, Verdicts),
    findall(Text, member(Text-false, Verdicts), Others).
test(do_not_hold, [forall(figure(Name)), true(Others == [])]) :-
    made_up(false, Name, Verdicts),
    findall(Text, member(Text-true, Verdicts), Others).

test(bounds_hold, Others == []) :-
    made_up(true, 'learning/study_bounds', Verdicts),
    findall(Text, member(Text-false, Verdicts), Others).
test(each_bound_fails_if_work_is_divided_or_nothing_is_gained,
     Always == []) :-
    maplist([World, Verdicts]>>made_up(World, 'learning/study_bounds',
                                       Verdicts),
            [divided, alike], [Divided, Alike]),
    findall(Text, ( member(Text-true, Divided), memberchk(Text-true, Alike) ),
            Always).

figure(Name) :-
    member(Name, [ 'learning/figure_4_7', 'learning/figure_4_9',
                   'learning/figure_4_13', 'algorithms/beyond_crews' ]).

:- end_tests(learning_claims).

                /*******************************
                *             RUNS             *
                *******************************/

%   Runs of a maze of 3 by 3 cells, on few hosts.

small([ size-2, settings-[[rho_max-3]], obstacle_hosts-10 ]).

run_small(Name, Given, Dir, Runs) :-
    project_study(Name, Study),
    small(Small),
    append(Given, Small, All),
    study_cases(Study, All, Cases),
    findall(run(Case, 1, Measures),
            ( nth1(I, Cases, Case),
              atomic_list_concat([Dir, /, I], Directory),
              make_directory_path(Directory),
              run_make(Study, Case, 1, Directory),
              run_measures(Directory, Measures) ),
            Runs).

drawn(Name, Plot, Runs, Dir, Tables) :-
    project_study(Name, Study),
    once(study_call(Study, plot(Plot, Title, Picture))),
    picture(Study, plot(Plot, Title, Picture), Runs, Dir),
    forall(member(Table, Tables),
           ( directory_file_path(Dir, Table, File),
             assertion(exists_file(File)) )).

ways(Dir) :-
    Name = 'learning/figure_4_7',
    run_small(Name, [network-obstacle], Dir, Runs),
    Runs = [run(_, _, Measures)],
    assertion(Measures.agents =:= 1),
    forall(member(Way, Measures.final),
           ( last(Way, 0-2), \+ memberchk(1-0, Way) )).

densities(Dir) :-
    Name = 'learning/figure_4_9',
    run_small(Name, [network-10, density-[0.2, 0.5]], Dir, Runs),
    findall(A, ( member(run(_, _, Ms), Runs),
                 A is round(Ms.total/Ms.executions) ), [2, 5]),
    drawn(Name, '4.9', Runs, Dir, ['4.9-medians.dat', '4.9-printed.dat']).

printers(Dir) :-
    project_study('algorithms/beyond_settings', Study),
    first_run(Study,
              [ algorithm-climb, sharing-true, agents-2, hosts-3,
                settings-[[good-0.75]] ], 1, Dir, _-Measures),
    assertion(Measures.reached =:= 100),
    assertion(Measures.pages > 0).

%   No agent is waited for after the limit.

given_up(Dir) :-
    project_study('algorithms/beyond_exchange', Study),
    first_run(Study, [limit-60, exchange-at(20, greedy, scout)], 1, Dir,
              _-Measures),
    assertion(Measures.reached < 100),
    assertion(Measures.time < 100).

crew(Dir) :-
    project_study('algorithms/beyond_crews', Study),
    first_run(Study,
              [maze-near_start, crew-both, size-8, arm-2, limit-1000], 1, Dir,
              _-Measures),
    assertion(Measures.reached =:= 100).

:- begin_tests(learning_runs).

test(ways) :-
    with_tmp_dir(ways).
test(densities) :-
    with_tmp_dir(densities).
test(printers) :-
    with_tmp_dir(printers).
test(given_up) :-
    with_tmp_dir(given_up).
test(crew) :-
    with_tmp_dir(crew).

:- end_tests(learning_runs).
