:- module(test_learning_settings, []).
:- use_module('../../lib/common').
:- use_module('../../lib/algorithms_bench').
:- use_module('../../lib/fake_agent').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/prng)).

/** <module> Printers, and algorithms that find good settings

See test_algorithms.pl for agents on a network.
*/

printers(Facts) :-
    problem(payloads(learning/settings), Facts),
    at_host('alpha@x:1').

quality(Host, Settings, Quality) :-
    fake_agent:quality(Host, Settings, Quality).

close_to(X, Y) :-
    abs(X - Y) < 1.0e-6.

first_page(Seed, Vector) :-
    chance_seed(Seed, Chance),
    fake_agent:start(Chance, State),
    fake_agent:sensed(State, Vector).

%   pages(+Actions, -State): the state after Actions, without noise.

pages(Actions, State) :-
    chance_seed(1, Chance),
    fake_agent:start(Chance, State0),
    foldl(done, Actions, State0, State).

done(Action, State0, State) :-
    fake_agent:act(Action, State0, State).

                /*******************************
                *           PRINTERS           *
                *******************************/

:- begin_tests(settings, [setup(printers([]))]).

%   With equal printers the best density for mode photo is 6, and the best heat
%   for glossy paper is 6.

test(quality_by_hand, [ setup(printers([setting(difference, 0.0)])),
                        cleanup(printers([])) ]) :-
    fake_agent:makes(alpha, makes(_, _, Wear)),
    quality(alpha, [3,photo,glossy,6,6,3], Q1),
    Expected1 is 0.96 - Wear,           % speed 3
    close_to(Q1, Expected1),
    quality(alpha, [2,text,plain,4,3,3], Q2),
    Expected2 is 1 - Wear - 0.07 - 0.12 - 0.09 - 0.04,
    close_to(Q2, Expected2),
    quality(alpha, [3,photo,glossy,4,3,5], Q3),
    Expected3 is 1 - Wear - 0.02*4 - 0.015*16 - 0.08,
    close_to(Q3, Expected3).
test(better_paper_alone_does_not_help,
     [setup(printers([setting(difference, 0.0)])), cleanup(printers([]))]) :-
    quality(alpha, [2,text,plain,4,3,3], Plain),
    quality(alpha, [2,text,glossy,4,3,3], Glossy),
    quality(alpha, [2,text,glossy,4,6,3], Hot),
    Glossy < Plain,
    Hot > Plain.
test(printers_differ) :-
    quality(alpha, [3,photo,glossy,6,6,3], Q1),
    quality(beta, [3,photo,glossy,6,6,3], Q2),
    abs(Q1 - Q2) > 0.001.
test(printer_is_constant) :-
    first_page(1, sv(alpha, _, _)),
    fake_agent:makes(alpha, Makes),
    at_host('alpha@elsewhere:2'),
    first_page(2, sv(alpha, _, _)),
    fake_agent:makes(alpha, Makes).
test(other_printers, [ setup(printers([setting(printers, 2)])),
                       cleanup(printers([])) ]) :-
    fake_agent:makes(alpha, Makes),
    printers([]),
    \+ fake_agent:makes(alpha, Makes).
test(noise_comes_from_the_random_generator) :-
    first_page(7, Vector1),
    first_page(7, Vector2),
    first_page(8, Vector3),
    Vector1 == Vector2,
    Vector1 \== Vector3.
test(noise_has_the_configured_width) :-
    findall(Q, ( between(1, 400, Seed), first_page(Seed, sv(_, _, Q)) ), Qs),
    quality(alpha, [2,text,plain,4,3,3], True),
    sum_list(Qs, Sum),
    Mean is Sum/400,
    abs(Mean - True) < 0.008,
    aggregate_all(sum((Q - Mean)**2), member(Q, Qs), Squares),
    Deviation is sqrt(Squares/400),
    Deviation > 0.034,
    Deviation < 0.046.
test(all_levels_can_be_set, Count-Bad == 35-[]) :-
    fake_agent:actions(Actions),
    length(Actions, Count),
    findall(set(P, L),
            ( member(set(P, L), Actions),
              pages([set(P, L)], page(Settings, _, _)),
              \+ nth1(P, Settings, L) ),
            Bad).
test(consecutive_pages_are_counted, Ns == [1, 2, 3, 1, 2]) :-
    Best = [3,photo,glossy,6,6,3],
    findall(N, ( member(Actions, [ [], [again], [again,set(2,text)],
                                   [again,set(2,photo)],
                                   [use(Best),use(Best)] ]),
                 pages(Actions, page(_, Qs, _)),
                 length(Qs, N) ),
            Ns).
test(good_needs_several_pages, [ setup(printers([ setting(noise, 0.0),
                                                  setting(good, 0.8) ])),
                                 cleanup(printers([])),
                                 Held == [false, false, true, false] ]) :-
    Use = use([3,photo,glossy,6,6,3]),
    Bad = use([1,draft,thin,6,6,3]),
    findall(H,
            ( member(Actions, [ [Use,again,again],
                                [Use,again,set(5,5),set(5,6),again,again],
                                [Bad,Use,again,again,again],
                                [Bad,again,again,again] ]),
              pages(Actions, State),
              ( fake_agent:reached(State) -> H = true ; H = false ) ),
            Held).
test(mean_of_the_last_pages_counts,
     [setup(printers([setting(good, 0.89)])), cleanup(printers([]))]) :-
    fake_agent:reached(page(s, [1.0, 0.8, 1.0, 0.8, 0.1], c)),
    \+ fake_agent:reached(page(s, [1.0, 0.8, 1.0, 0.7, 1.0], c)).
test(every_page_is_a_unit) :-
    execution([use([3,photo,glossy,6,6,3]),again], Units, unreached),
    length(Units, Pages),               % the first, two, three at random
    Pages >= 6,
    forall(member(unit(P, S, Q)-W, Units),
           ( P == alpha, length(S, 6), Q >= 0, W >= 0 )).
test(units_are_weighted_by_their_gain) :-
    fake_agent:weight(sv(a, s, 0.5), sv(a, t, 0.7), Up),
    fake_agent:weight(sv(a, s, 0.7), sv(a, t, 0.5), Down),
    close_to(Up, 0.2),
    close_to(Down, -0.2),
    fake_agent:shareable([ step(sv(a,s,0.5), x, sv(a,t,0.7), Up),
                           step(sv(a,t,0.7), y, sv(a,s,0.5), Down) ],
                         Units),
    Units == [unit(a,s,0.5)-0, unit(a,t,0.7)-Up, unit(a,s,0.5)-0].
test(without_executions_nothing_is_shared, Units == []) :-
    fake_agent:shareable([], Units).

:- end_tests(settings).

                /*******************************
                *          ALGORITHMS          *
                *******************************/

samples(List, Units) :-
    findall(unit(Printer, Settings, Value)-0,
            member(Printer-Settings-Value, List),
            Units0),
    sort(Units0, Units).

plan(Module, List, Plan) :-
    samples(List, Units),
    Module:plan(start, Units, Plan).

:- begin_tests(climb, [setup(algorithm(climb, payloads(learning/climb),
                                       []))]).

test(best_settings_are_confirmed, Last == [use([2,b]), again, again, again]) :-
    plan(climb, [ p-[1,a]-0.5, p-[2,a]-0.6, p-[2,b]-0.7 ], Plan),
    append(_, Last, Plan),
    length(Last, 4),
    !.
test(number_of_pages_is_configurable,
     [ setup(algorithm(climb, payloads(learning/climb), [setting(pages, 2)])),
       cleanup(algorithm(climb, payloads(learning/climb), [])),
       Plan == [use([1,a]), again] ]) :-
    plan(climb, [p-[1,a]-0.5], Plan).
test(untried_settings_are_tried) :-
    plan(climb, [ p-[1,a]-0.5, p-[2,a]-0.6, p-[1,b]-0.7 ], [First|_]),
    First == use([2,b]).                % both changes were for the better
test(one_lucky_page_is_not_enough) :-
    findall(p-[2,a]-V, member(V, [0.80, 0.81, 0.79, 0.80]), Often),
    plan(climb, [p-[1,a]-0.5, p-[1,b]-0.3, p-[2,b]-0.83|Often], Plan),
    once(append(_, [use(Best),again,again,again], Plan)),
    Best == [2,a].
test(printers_with_more_measurements_are_levelled) :-
    findall(Printer-[1,X]-V,
            ( member(Printer-Level, [high-0.2, low-0.0]), member(X-V0,
              [a-0.5, b-0.55]), V is V0 + Level ),
            Both),
    findall(low-[2,c]-V, member(V, [0.6, 0.61, 0.6]), More),
    append(Both, More, All),
    plan(climb, All, Plan),
    once(append(_, [use(Best),again,again,again], Plan)),
    Best == [2,c].

:- end_tests(climb).

:- begin_tests(genetic, [setup(algorithm(genetic, payloads(learning/genetic),
                                         []))]).

known([ p-[1,a,x]-0.9, p-[2,b,x]-0.8, p-[3,a,y]-0.1, p-[1,c,y]-0.2 ]).

test(four_children_and_the_fittest) :-
    known(Known),
    plan(genetic, Known, Plan),
    Plan = [use(_), use(_), use(_), use(_), use([1,a,x]), again, again,
            again].
test(genes_keep_their_positions) :-
    known(Known),
    forall(( between(1, 20, _), plan(genetic, Known, Plan),
             member(use([A,B,C]), Plan) ),
           ( memberchk(A, [1,2,3]), memberchk(B, [a,b,c]),
             memberchk(C, [x,y]) )).
test(generations_differ) :-
    known(Known),
    plan(genetic, Known, Plan1),
    plan(genetic, Known, Plan2),
    Plan1 \== Plan2.
test(same_history_same_children, Plan1 == Plan2) :-
    known(Known),
    algorithm(genetic, payloads(learning/genetic), []),
    plan(genetic, Known, Plan1),
    algorithm(genetic, payloads(learning/genetic), []),
    plan(genetic, Known, Plan2).
test(fitter_settings_have_more_children) :-
    known(Known),
    findall(B, ( between(1, 60, _), plan(genetic, Known, Plan),
                 append(Children, [use([1,a,x])|_], Plan),
                 member(use([_,B,_]), Children) ),
            Genes),
    aggregate_all(count, member(c, Genes), Unfit),
    aggregate_all(count, ( member(G, Genes), memberchk(G, [a,b]) ), Fit),
    Fit > 4*Unfit.
test(crossover_creates_new_settings) :-
    known(Known),
    findall(G, ( between(1, 20, _), plan(genetic, Known, Plan),
                 member(use(G), Plan), \+ memberchk(_-G-_, Known) ),
            New),
    New = [_|_].

:- end_tests(genetic).

:- begin_tests(swarm, [setup(algorithm(swarm, payloads(learning/swarm), []))]).

%   Of the places with numbers, only 1 to 9 are known; x is the best letter.

flown([ p-[1,a,x]-0.9, p-[9,b,y]-0.1, p-[5,c,y]-0.1 ]).

trials(Plan, Trials) :-
    append(Trials, [use([1,a,x]), again, again, again], Plan),
    length(Trials, 4).

test(four_steps_and_the_fittest, [nondet]) :-
    flown(Known),
    plan(swarm, Known, Plan),
    trials(Plan, _).
test(levels_keep_their_places) :-
    flown(Known),
    forall(( between(1, 20, _), plan(swarm, Known, Plan),
             trials(Plan, Trials), member(use([A,B,C]), Trials) ),
           ( memberchk(A, [1,5,9]), memberchk(B, [a,b,c]),
             memberchk(C, [x,y]) )).
test(same_history_same_flight, Plan1 == Plan2) :-
    flown(Known),
    algorithm(swarm, payloads(learning/swarm), []),
    plan(swarm, Known, Plan1),
    algorithm(swarm, payloads(learning/swarm), []),
    plan(swarm, Known, Plan2).
test(particle_flies_on, [true(Plan1 \== Plan2)]) :-
    flown(Known),
    plan(swarm, Known, Plan1),
    plan(swarm, Known, Plan2).

%   A particle that begins at 9 is drawn to the 1 of another agent.

test(drawn_to_the_best_that_others_found, [true(Late < Early)]) :-
    algorithm(swarm, payloads(learning/swarm), []),
    findall(p-[N]-Value, ( between(1, 9, N), Value is 0.1 - N/1000 ), Others),
    plan(swarm, [p-[9]-0.95|Others], _),
    Told = [p-[1]-0.99, p-[1]-0.99, p-[9]-0.2|Others],
    findall(Mean, ( between(1, 15, _), plan(swarm, Told, Plan),
                    mean_trial(Plan, Mean) ),
            Means),
    nth1(1, Means, Early),
    append(_, [A, B, C], Means),
    Late is (A + B + C)/3.

mean_trial(Plan, Mean) :-
    length(Trials, 4),
    append(Trials, _, Plan),
    findall(X, member(use([X]), Trials), Xs),
    sum_list(Xs, Sum),
    Mean is Sum/4.

:- end_tests(swarm).

                /*******************************
                *          COMPARISON          *
                *******************************/

:- begin_tests(settings_found, [setup(printers([]))]).

hosts(['n1@x:1', 'n2@x:1', 'n3@x:1', 'n4@x:1', 'n5@x:1', 'n6@x:1']).

%   Pages of all agents, in runs of several seeds, until all have reached
%   the goal.

pages_of(Algorithm, Count, Seeds, Most, Pages) :-
    algorithm(Algorithm, payloads(learning/Algorithm), []),
    length(Modules, Count),
    maplist(=(Algorithm), Modules),
    hosts(Hosts),
    findall(Printed,
            ( member(Seed, Seeds),
              group(Seed, Modules, Hosts, Most, Reached),
              length(Reached, Count),
              member(_-Printed, Reached) ),
            All),
    length(Seeds, Runs),
    Wanted is Runs * Count,
    length(All, Wanted),                % all agents have reached it
    sum_list(All, Pages).

test(climb_beats_random_search) :-
    pages_of(climb, 1, [1, 2, 3, 4], 100, Climb),
    pages_of(lottery, 1, [1, 2, 3, 4], 500, Lottery),
    Lottery > 2*Climb.
test(sharing_between_printers_that_differ_helps) :-
    pages_of(climb, 1, [1, 2, 3, 4], 100, Alone),
    pages_of(climb, 4, [1], 100, Together),
    Alone > 1.2*Together.
test(genetic_algorithm_beats_random_search) :-
    pages_of(genetic, 3, [1, 2], 200, Genetic),
    pages_of(lottery, 3, [1, 2], 400, Lottery),
    Lottery > 1.2*Genetic.
test(particle_swarm_beats_random_search) :-
    pages_of(swarm, 3, [1, 2], 200, Swarm),
    pages_of(lottery, 3, [1, 2], 400, Lottery),
    Lottery > 1.2*Swarm.

:- end_tests(settings_found).
