:- use_module(library(lists)).
:- use_module(library(option)).
:- use_module(library(plunit)).
:- use_module('../../experiments/simulation/batch').
:- use_module('../../experiments/simulation/model').
:- use_module('../../experiments/simulation/reading').
:- use_module('../../experiments/simulation/study').
:- use_module('../../experiments/sync/metrics').
:- use_module('../../prolog/typhon/base/chance').
:- use_module(library(aggregate)).
:- use_module(library(apply)).

/** <module> The simulation of Algorithm 2

Cases small enough to be worked out by hand, and what must hold in every
run, tried with random parameters.
*/

close_to(X, Y) :-
    abs(X - Y) < 1.0e-9.

same_times([], []).
same_times([execution(T, H, S1, E1)|As], [execution(T, H, S2, E2)|Bs]) :-
    close_to(S1, S2),
    close_to(E1, E2),
    same_times(As, Bs).

                /*******************************
                *            BY HAND           *
                *******************************/

%   One agent goes to and fro between two hosts, a hop takes half a second.
%   A task takes 0.7 s, so it is executing when the agent first returns.

to_and_fro(Delta, Tasks,
           [ topology(ring(2)), agents(1), tasks(Tasks), delta(Delta),
             seed(1), hop_time(0.5-0.5), task_time(0.7)
           ]).

%   With delta 100 a potential is gone at once. The agent arrives at A at 0,
%   at B at 0.5; at 1.0 it finds that A is done, and searches for T2 from the
%   next host on: B, at 1.5, which is free since 1.2; A at 2.0. At 2.5 B is
%   done.

:- begin_tests(by_hand).

test(times) :-
    to_and_fro(100, 2, Options),
    simulate(Options, run(Executions, [], true, Hops, Penalties)),
    Executions = [execution(1, A, _, _), execution(1, B, _, _)|_],
    assertion(msort([A, B], [1, 2])),
    assertion(same_times(Executions,
                         [ execution(1, A, 0, 0.7),
                           execution(1, B, 0.5, 1.2),
                           execution(2, B, 1.5, 2.2),
                           execution(2, A, 2.0, 2.7) ])),
    assertion(Hops =:= 6),
    assertion(Penalties =:= 2).

%   A task takes 1.2 s: at 1.0 and 1.5 the agent passes, at 2.0 A is done.

test(busy_hosts_are_passed) :-
    to_and_fro(100, 2, Options0),
    select(task_time(_), Options0, Options1),
    Options = [task_time(1.2)|Options1],
    simulate(Options, run(Executions, _, true, _, Penalties)),
    Executions = [execution(1, A, _, _), execution(1, B, _, _)|_],
    assertion(same_times(Executions,
                         [ execution(1, A, 0, 1.2),
                           execution(1, B, 0.5, 1.7),
                           execution(2, B, 2.5, 3.7),
                           execution(2, A, 3.0, 4.2) ])),
    assertion(Penalties =:= 2).
test(as_printed_a_busy_host_is_serviced_again) :-
    to_and_fro(100, 1, Options0),
    select(task_time(_), Options0, Options1),
    Options = [task_time(1.2), service(printed)|Options1],
    simulate(Options, run(Executions, _, true, _, _)),
    findall(S, member(execution(1, _, S, _), Executions), Starts),
    assertion(maplist(close_to, Starts, [0, 0.5, 1.0, 1.5])).

%   An agent that cannot leave: one reward, which leaves 15 and 15 in the
%   history, then nothing but penalties.

test(penalties_until_zero, Penalties == 35) :-
    to_and_fro(0.5, 1, Options0),
    select(topology(_), Options0, Options),
    simulate([topology(mesh(1))|Options], run([_], [], true, 0, Penalties)).
test(first_penalties_of_the_chosen_reading) :-
    reading_full(D0),
    reading_step(chosen, penalty, 0.5, D0, D1),
    reading_step(chosen, penalty, 0.5, D1, drive(P2, H2)),
    assertion(D1 == drive(84.5, [15, 15.5])),
    Theta is 15.25 * 0.845 + 0.5,
    P is 84.5 - Theta,
    assertion(close_to(P2, P)),
    assertion(last(H2, Theta)).
test(first_penalties_of_other_readings) :-
    forall(member(Reading-P, [ over_window-98.5, inside-84.5, scaled-77.5,
                               signed-84.5 ]),
           ( reading_full(D0),
             reading_step(Reading, penalty, 0.5, D0, drive(P1, _)),
             assertion(close_to(P1, P)) )).
test(steps_to_zero, Steps == [76, 54, 37, 26, 23]) :-
    findall(N, ( member(D, [0.2, 0.3, 0.5, 0.8, 1.0]),
                 reading_steps(chosen, D, N) ), Steps).
test(inside_never_comes_to_zero, fail) :-
    reading_steps(inside, 0.5, _).
test(atomic_failure, Healed-Twice == [2-2]-2) :-
    to_and_fro(0.5, 3, Options),
    simulate([failure(atomic(1, 2, 3))|Options],
             run(Executions, Failures, true, _, _)),
    length(Failures, Lost),
    findall(H-T, member(execution(T, H, _, _), Executions), All),
    sort(All, Distinct),
    length(All, Count),
    length(Distinct, DistinctCount),
    Twice is Count - DistinctCount,
    findall(Lost-Redone,
            aggregate_all(count, ( member(failure(T, H, K), Failures),
                                   member(execution(K, H, S, _),
                                          Executions),
                                   S >= T ), Redone),
            Healed).
test(quantiles, Qs == [1, 2, 4]) :-
    findall(Q, ( member(P, [0, 0.5, 1]), quantile(P, [4, 1, 3, 2], Q) ), Qs).

:- end_tests(by_hand).

                /*******************************
                *          INVARIANTS          *
                *******************************/

random_options(Seed, [ topology(Topology), agents(Agents), tasks(Tasks),
                       delta(Delta), hop_time(Min-Max), task_time(0-Time),
                       dynamic(Dynamic), seed(Seed)
                     ]) :-
    chance_seed(Seed, C0),
    chance_member(Topology, [ star_bus(2, 4), ring(7), tree(9), grid(3, 4),
                              random(8, 0.4), mesh(5) ], C0, C1),
    chance_below(5, A, C1, C2),
    Agents is A + 1,
    chance_below(3, T, C2, C3),
    Tasks is T + 1,
    chance_member(Delta, [0.2, 0.4, 0.6], C3, C4),
    chance_uniform(0.01, 0.5, Min, C4, C5),
    chance_uniform(0, 0.5, More, C5, C6),
    Max is Min + More,
    chance_uniform(0, 2, Time, C6, C7),
    chance_member(Dynamic, [none, none, dynamic_1, dynamic_2], C7, _).

%   A host executes the tasks in order, and one after the other.

in_order(Executions) :-
    findall(H-(S-(E-T)), member(execution(T, H, S, E), Executions), Pairs0),
    sort(Pairs0, Pairs),
    forall(nextto(H-(_-(E1-T1)), H-(S2-(_-T2)), Pairs),
           ( T2 =:= T1 + 1, S2 >= E1 )),
    forall(( member(H-(_-(_-T)), Pairs), T > 1 ),
           ( T1 is T - 1, memberchk(H-(_-(_-T1)), Pairs) )).

ascending(Executions) :-
    findall(S, member(execution(_, _, S, _), Executions), Starts),
    msort(Starts, Starts).

:- begin_tests(invariants).

test(order_and_exclusion) :-
    forall(between(1, 30, Seed),
           ( random_options(Seed, Options),
             simulate(Options, run(Executions, [], true, Hops, Penalties)),
             assertion(in_order(Executions)),
             assertion(ascending(Executions)),
             option(agents(Agents), Options),
             assertion(( \+ option(dynamic(none), Options)
                       ; Penalties =< Hops + Agents )) )).
test(everything_is_executed) :-
    forall(between(1, 15, Seed),
           ( random_options(Seed, Options0),
             select(dynamic(_), Options0, Options1),
             select(delta(_), Options1, Options2),
             Options = [delta(0.1), dynamic(none)|Options2],
             simulate(Options, Run),
             run_measures(Options, Run, Measures),
             assertion(arg(5, Measures, 0)),
             assertion(arg(6, Measures, 0)) )).
test(same_seed_same_run) :-
    forall(member(Seed, [3, 4, 5]),
           ( random_options(Seed, Options),
             simulate(Options, Run1),
             simulate(Options, Run2),
             assertion(Run1 == Run2) )).
test(other_seed_other_run) :-
    random_options(3, Options),
    select(seed(3), Options, Others),
    simulate(Options, Run1),
    simulate([seed(4)|Others], Run2),
    assertion(Run1 \== Run2).
test(threads_do_not_matter, Ms1 == Ms2) :-
    random_options(6, Options),
    batch([runs(5)|Options], 1, Ms1),
    batch([runs(5)|Options], 2, Ms2),
    assertion(length(Ms1, 5)).
test(an_endless_run_is_broken_off) :-
    random_options(3, Options0),
    simulate([reading(inside), limit(20)|Options0],
             run(_, _, Ended, _, _)),
    assertion(Ended == false).
test(hops_take_time, error(domain_error(hop_time, 0-0))) :-
    random_options(3, Options0),
    select(hop_time(_), Options0, Options),
    simulate([hop_time(0-0)|Options], _).
test(rows_of_studies_have_one_form) :-
    forall(study(Name, _),
           ( findall(Keys, ( study_point(Name, Given),
                             findall(K, ( member(O, Given),
                                          functor(O, K, 1) ), Keys) ),
                     Lists),
             sort(Lists, Distinct),
             assertion(Distinct = [_]) )).

:- end_tests(invariants).
