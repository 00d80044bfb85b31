:- module(test_sync_studies, []).
:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module('../../lib/project_studies').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/engine/cases').
:- use_module('../../../experiments/engine/picture').
:- use_module('../../../experiments/engine/studies').

/** <module> The studies of chapter 5: claims, and small runs
*/

sync_study(Name, Study) :-
    atom_concat('sync/', Name, File),
    project_study(File, Study).

a_study(Name, Count) :-
    member(Name-Count,
           [ figure_5_2-5, figure_5_5-4, figure_5_6-20, figure_5_7-28,
             figure_5_8-1, figure_5_9-8, figure_5_11-4, figure_5_12-2,
             study_choices-16, study_links-9, study_onset-48,
             study_readings-35, study_demo-1, beyond_several-4,
             beyond_selected-11, beyond_guarantee-16, study_surface-320,
             study_long_tasks-4 ]).

:- begin_tests(studies).

test(cases, [forall(a_study(Name, Count)), true(Found == Count)]) :-
    sync_study(Name, Study),
    case_count(Study, Found).
test(claims_are_well_formed, [forall(a_study(Name, _)), true(Odd == [])]) :-
    sync_study(Name, Study),
    invalid_claims(Study, Odd).
test(best_delta_of_the_topology, Deltas == [0.2, 0.8, 0.2, 0.5]) :-
    sync_study(figure_5_5, Study),
    study_cases(Study, [], Cases),
    findall(Delta, ( member(Case, Cases), Delta = Case.delta ), Deltas).

test(table_5_1, Idle == [star_bus-66, ring-32, tree-142, grid-25]) :-
    sync_study(figure_5_5, Study),
    findall(Topology-Seconds,
            study_call(Study, printed(idle, [topology=Topology], Seconds)),
            Idle).
test(table_5_2, Slowest == [1.4, 2.3, 3.0, 4.1, 5.2, 8.0]) :-
    sync_study(figure_5_8, Study),
    study_cases(Study, [], [Case]),
    findall(To, member(_-To, Case.task_time), Slowest).

:- end_tests(studies).

                /*******************************
                *            CLAIMS            *
                *******************************/

%   made(+Held, +Name, +Case, -Pairs): measures of which every claim holds, or
%   none does, besides those of any/2.

made(true, figure_5_2, Case, [ visits-Visits, first_penalty-20, last_theta-D,
                               not_raised-0, early-Early, late-Late ]) :-
    D = Case.delta,
    Visits is 100 - 50*D,
    Early is 10 + 4*D,
    Late is 5 + D/100.
made(false, figure_5_2, Case, [ visits-Visits, first_penalty-0.1,
                                last_theta-Last, not_raised-1, early-10,
                                late-D ]) :-
    D = Case.delta,
    Visits is 50*D,
    Last is 5 - D.
made(true, beyond_several, Case, [ missing-0, out_of_order-0, executions-9,
                                   wanted-9, both-0, early-Early, overlaps-0,
                                   total-90 ]) :-
    memberchk(Case.dependent-Early, [true-0, false-3]).
made(false, beyond_several, Case, [ missing-1, out_of_order-0, executions-9,
                                    wanted-9, both-1, early-Early, overlaps-1,
                                    total-Total ]) :-
    memberchk(Case.dependent-Early, [true-3, false-0]),
    Total is 5*Case.hosts.
made(Held, beyond_selected, Case, [ missing-0, out_of_order-Wrong, executions-9,
                                    wanted-9, overlaps-Wrong, total-Total ]) :-
    member(Held-Wrong-Total0, [ true-0-(50/Case.share),
                               false-1-(Case.hosts*Case.share) ]),
    Total is Total0.
made(Held, figure_5_5, Case, [idle-Idle|Pairs]) :-
    member(Held-Idles, [ true-[star_bus-66, ring-32, tree-142, grid-25],
                         false-[star_bus-20, ring-45, tree-10, grid-50] ]),
    memberchk(Case.topology-Idle, Idles),
    member(Held-Pairs,
           [ true-[serviced-8, unrequired-6, second-37, pause-1],
             false-[serviced-10, unrequired-20, second-60, pause-0] ]).
made(true, Name, Case, [idle-Idle, overlaps-Overlaps, tau-Tau]) :-
    memberchk(Name, [figure_5_6, study_onset]),
    best(Case.topology, Best),
    Idle is 50/Case.delta,
    (   Case.delta > Best,
        Case.topology \== ring
    ->  Overlaps is integer(Case.delta*10), Tau = 3
    ;   Overlaps = 0, Tau = 2
    ).
made(false, figure_5_6, Case, [idle-Idle, overlaps-Overlaps, tau-2]) :-
    Idle is 50*Case.delta,
    (   Case.topology == star_bus,
        Case.delta =:= 0.3
    ->  Overlaps = 0
    ;   Overlaps is integer((2 - Case.delta)*10)
    ).
made(false, study_onset, Case, [overlaps-Overlaps]) :-
    (   memberchk(Case.topology, [star_bus, tree]),
        Case.delta =:= 0.5
    ->  Overlaps = 0
    ;   Overlaps = 1
    ).
made(true, figure_5_7, Case, [idle-Idle, overlaps-Overlaps]) :-
    least(Case.topology, Case.agents, Idle),
    (   member(some(T, A, N), [some(grid, 5, 8), some(ring, 20, 2)]),
        Case.topology == T,
        Case.agents =:= A
    ->  Overlaps = N
    ;   Overlaps = 0
    ).
made(false, figure_5_7, Case, [idle-Idle, overlaps-9]) :-
    Idle is 1000/Case.agents.
made(Held, figure_5_9, Case, [idle-Idle, total-Total]) :-
    member(Held-Sign-Twice, [true-1-190, false-(-1)-90]),
    Idle is 100 + Sign*Case.agents,
    ( Case.links == dynamic_1 -> Total = 100 ; Total = Twice ).
made(true, figure_5_11, _, [executions-380]).
made(true, figure_5_12, _, [lost-180, redone-180, lost_hosts-60,
                            healing_tau-2]).
made(false, figure_5_12, _, [lost-180, lost_hosts-60, healing_tau-3]).
made(Held, study_choices, _, [idle-Idle, serviced-Serviced]) :-
    member(Held-Idle-Serviced, [true-32-7, false-10-10]).
made(Held, study_readings, Case, Pairs) :-
    (   Case.reading == agents
    ->  member(Held-Visits, [true-76, false-10]),
        Pairs = [visits-Visits]
    ;   Held == false
    ->  Pairs = [visits-76]
    ;   Pairs = []
    ).
made(true, study_surface, Case, [ second-N, total-N, overlaps-Overlaps,
                                  spread-10 ]) :-
    N = Case.visits,
    (   ( Case.topology == ring ; N*0.4 > 10 )
    ->  Overlaps = 0
    ;   Overlaps is 100 - N
    ).
made(false, study_surface, Case, [ second-Less, total-Less, overlaps-N,
                                   spread-0 ]) :-
    N = Case.visits,
    Less is -N.
made(Held, beyond_guarantee, Case, [overlaps-Overlaps, total-Total]) :-
    (   Held == true
    ->  Overlaps is ceiling(1 - Case.share),
        Total is 100*Case.share
    ;   Overlaps is truncate(Case.share),
        Total = 100
    ).
made(true, study_long_tasks, _, [busy-60, tau_least-0]).
made(false, study_long_tasks, _, [busy-59, tau_least-1]).
made(_, Name, _, []) :-
    memberchk(Name, [figure_5_8, study_links, study_demo]).
made(false, figure_5_11, _, []).

any(true, [ idle-10, overlaps-0, tau-2, least_gap-5, out_of_order-0,
            missing-0, executions-360, burst-19, later_burst-5, lost-20,
            redone-20, healing_tau-3, meanwhile-5, later_tau-2 ]).
any(false, [ idle-10, overlaps-1, tau-3, least_gap-0, out_of_order-1,
             missing-1, executions-359, burst-5, later_burst-6, lost-20,
             redone-19, healing_tau-2, meanwhile-0, later_tau-3 ]).

best(star_bus, 0.2).
best(ring,     0.8).
best(tree,     0.2).
best(grid,     0.5).

least(tree, Agents, Idle) :-
    !,
    memberchk(Agents-Idle, [5-98, 10-48, 15-60, 20-116]).
least(ring, Agents, Agents) :-
    !.
least(_, Agents, Idle) :-
    Idle is abs(Agents - 10).

point(Held, Name, Case, Case-Measures) :-
    any(Held, Common),
    once(made(Held, Name, Case, Pairs)),
    dict_pairs(Any, measures, Common),
    dict_pairs(Own, measures, Pairs),
    (   Name == study_readings
    ->  Measures = Own
    ;   Measures = Any.put(Own)
    ).

:- begin_tests(claims).

test(claims_can_hold_and_can_fail,
     [ forall(( a_study(Name, _), member(Held, [true, false]) )),
       true(Others == []) ]) :-
    sync_study(Name, Study),
    study_cases(Study, [], Cases),
    maplist(point(Held, Name), Cases, Points),
    verdicts(Study, Points, Verdicts),
    findall(Text, ( member(Text-Found, Verdicts), Found \== Held ), Others).

:- end_tests(claims).

                /*******************************
                *             RUNS             *
                *******************************/

%   small(+Name, +Given, -Measures, +Dir): one small run of the first case.

small(Name, Given, Measures, Dir) :-
    sync_study(Name, Study),
    first_run(Study, Given, 1, Dir, _-Measures).

%   The pictures of the run, if gnuplot is installed.

drawn(Name, Given, Measures, Dir) :-
    sync_study(Name, Study),
    study_cases(Study, Given, [Case|_]),
    once(study_call(Study, plot(Plot, Title, Picture))),
    picture(Study, plot(Plot, Title, Picture), [run(Case, 1, Measures)], Dir),
    file_name_extension(Plot, svg, File),
    directory_file_path(Dir, File, Path),
    size_file(Path, Size),
    Size > 2000.

has_gnuplot :-
    absolute_file_name(path(gnuplot), _, [ access(execute),
                                           file_errors(fail) ]).

:- begin_tests(runs).

test(in_step, [ forall(member(T, [star_bus, ring, tree, grid])),
                true(Missing-Disorder == 0-0) ]) :-
    with_tmp_dir(small(figure_5_5, [ topology-T, hosts-20, tasks-2,
                                     agents-4 ], M)),
    assertion(M.tau =< 2),
    Missing = M.missing,
    Disorder = M.out_of_order.
test(repeats, A == B) :-
    Given = [hosts-20, tasks-2, agents-4],
    with_tmp_dir(small(figure_5_8, Given, A)),
    with_tmp_dir(small(figure_5_8, Given, B)).
test(random_ring_is_another_run, [true(A \== B)]) :-
    Given = [topology-ring, hosts-20, tasks-1, agents-4],
    with_tmp_dir(small(figure_5_5, Given, A)),
    with_tmp_dir(small(figure_5_5, [choices-by_chance|Given], B)).
test(atomic, Lost-Redone == 5-5) :-
    with_tmp_dir(small(figure_5_11, [ topology-grid, hosts-20, tasks-3,
                                      failure-atomic(1,5,2) ], M)),
    Lost = M.lost,
    Redone = M.redone.
test(cascaded, [true(Lost == Redone)]) :-
    with_tmp_dir(small(figure_5_12, [ links-none, hosts-20, tasks-3,
                                      failure-cascaded(1,20,3) ], M)),
    Lost = M.lost,
    Redone = M.redone,
    assertion(Lost >= 40),
    assertion(M.lost_hosts == 20).
test(dynamic, Missing == 0) :-
    with_tmp_dir(small(figure_5_9, [ links-dynamic_2, agents-5, hosts-20,
                                     tasks-1 ], M)),
    Missing = M.missing.
test(several, Ms == [0, 0, 0, 0]) :-
    with_tmp_dir(small(beyond_several, [dependent-true, hosts-20, tasks-3], M)),
    findall(Value, ( member(Name, [missing, out_of_order, both, early]),
                     get_dict(Name, M, Value) ), Ms).
test(selected, Missing-Disorder == 0-0) :-
    with_tmp_dir(small(beyond_selected, [share-0.5, hosts-20, agents-4], M)),
    Missing = M.missing,
    Disorder = M.out_of_order.
test(gallery, [condition(has_gnuplot)]) :-
    with_tmp_dir(gallery).
test(one_run, [condition(has_gnuplot)]) :-
    with_tmp_dir(one_run).
test(a_sampled_potential, Missing == 0) :-
    with_tmp_dir(small(study_surface,
                       [ topology-grid, hosts-20, tasks-2, maximum-50, theta-20,
                         window-5, delta-0.2 ], M)),
    Missing = M.missing.
test(potentials, Visits == 97) :-
    with_tmp_dir(small(figure_5_2, [delta-0.2], M)),
    Visits = M.visits.

gallery(Dir) :-
    Given = [topology-grid, hosts-20, tasks-2, agents-4],
    small(figure_5_5, Given, M, Dir),
    drawn(figure_5_5, Given, M, Dir).

one_run(Dir) :-
    Given = [hosts-20, tasks-2, agents-4],
    small(figure_5_8, Given, M, Dir),
    drawn(figure_5_8, Given, M, Dir).

:- end_tests(runs).
