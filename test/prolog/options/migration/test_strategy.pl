:- module(test_strategy, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(lists), [last/2, member/2, numlist/3, sum_list/2]).
:- use_module(library(random), [random_permutation/2]).
:- use_module(library(terms), [term_size/2]).
:- use_module(library(yall)).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/migration/strategy)).
:- use_module(library(typhon/kernel/base/prng)).

%   walk(+Strategy, +Steps, +Links, +Here, +Memory0, -Path): the visited hosts,
%   in order, in the graph Links.

walk(_, 0, _, _, _, []) :-
    !.
walk(Strategy, Steps, Links, Here, Memory0, [Next|Path]) :-
    member(Here-Neighbours, Links),
    !,
    next_host(Strategy, Neighbours, Here, Memory0, Next, Memory),
    Steps1 is Steps - 1,
    walk(Strategy, Steps1, Links, Next, Memory, Path).

share(Strategy, Neighbours, Here, Memory, Host, Share) :-
    aggregate_all(count,
                  ( between(1, 4000, Seed),
                    draw_from(Strategy, Neighbours, Here, Memory, Seed, Host)
                  ),
                  Count),
    Share is Count / 4000.

draw_from(Strategy, Neighbours, Here, Visited, Seed, Host) :-
    strategy_memory(Seed, Memory0),
    foldl(memory_mark, Visited, Memory0, Memory),
    next_host(Strategy, Neighbours, Here, Memory, Host, _).

:- begin_tests(random_numbers).

uniform(Seeds, Mean) :-
    findall(X,
            ( member(Seed, Seeds),
              chance_seed(Seed, C),
              chance_float(X, C, _) ),
            Xs),
    sum_list(Xs, Sum),
    length(Xs, N),
    Mean is Sum / N.

test(floats_lie_inside_the_unit_interval) :-
    chance_seed(42, C0),
    numlist(1, 10000, L),
    foldl([_, A, B]>>( chance_float(X, A, B), X > 0.0, X < 1.0 ), L, C0, _).
test(mean_of_a_sequence) :-
    chance_seed(42, C0),
    numlist(1, 10000, L),
    foldl([_, S0-A, S-B]>>( chance_float(X, A, B), S is S0 + X ),
          L, 0-C0, Sum-_),
    abs(Sum / 10000 - 0.5) < 0.0116.
test(neighbouring_seeds_are_unrelated) :-
    numlist(0, 9999, Seeds),
    uniform(Seeds, Mean),
    abs(Mean - 0.5) < 0.0116,
    findall(B,
            ( member(Seed, Seeds),
              chance_seed(Seed, C),
              chance_below(10, B, C, _) ),
            Bs),
    forall(between(0, 9, Box),
           ( aggregate_all(count, member(Box, Bs), Count),
             abs(Count - 1000) < 120 )).
test(large_and_negative_seeds, true(A \== B)) :-
    chance_seed(-1, A),
    chance_seed(123456789012345678901234567890, B).
test(state_is_the_same_on_every_platform,
     C == chance(310702730, 1339802110)) :-
    chance_seed(1, C0),
    chance_float(_, C0, C).
test(seed_of_a_term_is_the_same_on_every_platform, Seed == 11129677) :-
    chance_hash(c(1, 2.5, [a]), Seed).
test(probabilities_zero_and_one_draw_alike, C1 == C2) :-
    chance_seed(3, C0),
    chance_true(0, false, C0, C1),
    chance_true(1, true, C0, C2).
test(sample_is_without_repetition, Sorted == [a, b, c, d]) :-
    forall(between(1, 20, Seed),
           ( chance_seed(Seed, C),
             chance_sample(3, [a, b, c, d], Sample, C, _),
             sort(Sample, Set),
             length(Set, 3) )),
    chance_seed(1, C0),
    chance_sample(4, [a, b, c, d], All, C0, _),
    sort(All, Sorted).
test(sample_larger_than_the_list, Counts == [1, 2, 2]) :-
    chance_seed(4, C0),
    chance_sample(5, [a, b, c], Sample, C0, _),
    findall(N, ( member(X, [a, b, c]),
                 aggregate_all(count, member(X, Sample), N) ), Ns),
    msort(Ns, Counts).
test(sample_of_nothing, fail) :-
    chance_seed(4, C0),
    chance_sample(1, [], _, C0, _).
test(nothing_to_choose_from, fail) :-
    chance_seed(3, C0),
    chance_member(_, [], C0, _).

:- end_tests(random_numbers).

:- begin_tests(migration_strategies).

test(isolated, [forall(member(S, [random, conscientious,
                                  epsilon_conscientious(0.2)])), fail]) :-
    strategy_memory(1, M),
    next_host(S, [], a, M, _, _).
test(no_strategy,
     [ forall(member(Strategy-Formal,
                     [ teleport-domain_error(migration_strategy, teleport),
                       _-instantiation_error,
                       epsilon_conscientious(2)-domain_error(probability, 2) ])),
       error(Formal) ]) :-
    strategy_memory(1, M),
    next_host(Strategy, [b], a, M, _, _).
test(memory_is_ground_and_small, true) :-
    strategy_memory(1, M0),
    next_host(conscientious, [b, c], a, M0, _, M),
    ground(M),
    term_size(M, Cells),
    Cells =< 20.                        % so many on 32 bit
test(unvisited_hosts_come_first, Host == d) :-
    draw_from(conscientious, [b, c, d], a, [b, c], 1, Host).
test(least_recently_visited_host_comes_next, Host == c) :-
    draw_from(conscientious, [b, c, d], a, [c, b, d], 1, Host).
test(current_host_counts_as_visited, Visited == [b, a, c]) :-
    strategy_memory(1, M0),
    foldl(memory_mark, [a, b, c], M0, M1),
    next_host(conscientious, [b, c], a, M1, Host, M),
    Host == b,
    memory_visited(M, Visited).
test(refusing_host_is_tried_last, Tried == [b, c, d, b]) :-
    strategy_memory(1, M0),
    foldl(memory_mark, [b, c, d], M0, M1),
    Ns = [b, c, d],
    next_host(conscientious, Ns, a, M1, H1, M2),        % all refuse
    next_host(conscientious, Ns, a, M2, H2, M3),
    next_host(conscientious, Ns, a, M3, H3, M4),
    next_host(conscientious, Ns, a, M4, H4, _),
    Tried = [H1, H2, H3, H4].
test(order_of_neighbours_does_not_matter, forall(between(1, 20, Seed))) :-
    random_permutation([a, b, c, d, e], Ns),
    draw_from(random, Ns, x, [], Seed, H1),
    draw_from(random, [a, b, c, d, e], x, [], Seed, H2),
    H1 == H2.
test(same_seed_same_choices, Path1 == Path2) :-
    Links = [a-[b,c,d], b-[a,c], c-[a,b,d], d-[a,c]],
    strategy_memory(9, M),
    walk(epsilon_conscientious(0.3), 100, Links, a, M, Path1),
    walk(epsilon_conscientious(0.3), 100, Links, a, M, Path2).
test(ring_is_patrolled_in_one_direction, Path == Expected) :-
    Links = [a-[b,d], b-[a,c], c-[b,d], d-[a,c]],
    strategy_memory(9, M),
    walk(conscientious, 8, Links, a, M, [First|Rest]),
    Path = [First|Rest],
    (   First == b
    ->  Expected = [b, c, d, a, b, c, d, a]
    ;   Expected = [d, c, b, a, d, c, b, a]
    ).
test(random_is_uniform, forall(member(H, [b, c, d, e]))) :-
    share(random, [b, c, d, e], a, [b, b, c], H, Share),
    abs(Share - 0.25) < 0.028.          % four standard deviations
test(conscientious_draws_among_the_unvisited) :-
    share(conscientious, [b, c, d, e], a, [b, c], d, D),
    abs(D - 0.5) < 0.032,
    share(conscientious, [b, c, d, e], a, [b, c], b, B),
    B =:= 0.
test(epsilon_is_the_share_of_random_choices) :-
    share(epsilon_conscientious(0.2), [b, c], a, [b, c], c, Share),
    abs(Share - 0.1) < 0.019.
test(conscientious_covers_sooner_than_random) :-
    findall(N-Ns, torus(N, Ns), Links),
    cover(random, Links, Random),
    cover(conscientious, Links, Conscientious),
    Conscientious * 2 < Random.

torus(I, Ns) :-
    between(0, 35, I),
    findall(J, ( member(D, [1, 35, 6, 30]), J is (I + D) mod 36 ), Ns).

cover(Strategy, Links, Mean) :-
    aggregate_all(sum(Steps),
                  ( between(1, 20, Seed),
                    strategy_memory(Seed, M),
                    walk(Strategy, 1000, Links, 0, M, Path),
                    covering(Path, [0], Steps) ),
                  Sum),
    Mean is Sum / 20.

covering([Host|Path], Seen0, Steps) :-
    sort([Host|Seen0], Seen),
    (   length(Seen, 36)
    ->  Steps = 1
    ;   covering(Path, Seen, Steps0),
        Steps is Steps0 + 1
    ).

:- end_tests(migration_strategies).

:- begin_tests(choices_of_agents).

test(choices_follow_the_seed_in_real_time, true(( A == B, A \== C ))) :-
    maplist(chosen, [3,3,4], [A,B,C]).

:- end_tests(choices_of_agents).

%   Each in a process of its own: the seed and the number of the agent count.

chosen(Seed, Text) :-
    module_property(test_strategy, file(Here)),
    format(atom(Goal), "test_strategy:choose(~d)", [Seed]),
    run_swipl(['-g', Goal, '-t', halt, Here], [], exit(0), Text, _).

choose(Seed) :-
    network_start(mesh(6), Network, [seed(Seed)]),
    network_property(Network, hosts([Host|_])),
    agent_create(clauses([ (:- agent(chooser)),
                           (main :- findall(H, ( between(1, 30, _),
                                                 next_host(random, H) ), Hs),
                                    result(Hs)) ]),
                 Agent, [host(Host)]),
    agent_result(Agent, Chosen, 10),
    forall(( member(Address, Chosen),
             atomic_list_concat([Name,_], @, Address) ),
           writeln(Name)),
    network_stop(Network).

:- begin_tests(strategies_of_others).

:- multifile
    typhon_strategy:strategy/1,
    typhon_strategy:choose/6.

typhon_strategy:strategy(last_of_all).

typhon_strategy:choose(last_of_all, Hosts, _, Memory, Host, Memory) :-
    last(Hosts, Host).

test(user_defined_strategy, H-Visited == d-[d, a]) :-
    strategy_memory(1, M0),
    next_host(last_of_all, [d, b, c], a, M0, H, M),
    memory_visited(M, Visited).

:- end_tests(strategies_of_others).
