:- module(test_sync_guarantee, []).
:- use_module('../../lib/common', []).
:- use_module('../../../experiments/sync/guarantee').
:- use_module('../../../experiments/sync/metrics', [overlaps/2]).
:- use_module('../../../prolog/typhon/kernel/base/prng',
              [chance_below/4, chance_member/4, chance_seed/2]).
:- use_module('../../../prolog/typhon/options/migration/strategy',
              [next_host/6, strategy_memory/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(assoc)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(yall)).
:- include('../../../agents/sync/potential').

/** <module> Potentials with which no executions overlap

The search for counterexamples moves agents over random connected networks, with
the strategy and the potentials of the platform. Times of migrations and
executions are drawn: mostly the extreme ones.
*/

                /*******************************
                *           NETWORKS           *
                *******************************/

ring(N, Links) :-
    findall(A-B, ( between(1, N, A), B is A mod N + 1 ), Links).

mesh(N, Links) :-
    findall(A-B, ( between(1, N, A), between(1, N, B), A < B ), Links).

star(N, Links) :-
    findall(1-B, between(2, N, B), Links).

%   drawn(-Links, +Chance0, -Chance): a tree of 3 to 6 hosts, and more links.

drawn(Links, Chance0, Chance) :-
    chance_between(3, 6, N, Chance0, Chance1),
    findall(B, between(2, N, B), Others),
    foldl(to_earlier, Others, []-Chance1, Tree-Chance2),
    chance_between(0, N, More, Chance2, Chance3),
    length(Extra, More),
    foldl(any_link(N), Extra, Tree-Chance3, Links-Chance).

to_earlier(B, Links-Chance0, [A-B|Links]-Chance) :-
    Last is B - 1,
    chance_between(1, Last, A, Chance0, Chance).

chance_between(Low, High, X, Chance0, Chance) :-
    Count is High - Low + 1,
    chance_below(Count, Index, Chance0, Chance),
    X is Low + Index.

any_link(N, _, Links0-Chance0, Links-Chance) :-
    chance_between(1, N, A, Chance0, Chance1),
    chance_between(1, N, B, Chance1, Chance),
    ( A =:= B -> Links = Links0 ; Links = [A-B|Links0] ).

next_to(Links, Host, Others) :-
    findall(B, ( member(Host-B, Links) ; member(B-Host, Links) ), Others).

                /*******************************
                *             MOVES            *
                *******************************/

%   walk(+Count, +Links, +Here, +Memory0, -Path): the hosts at which a
%   conscientious agent arrives.

walk(0, _, _, _, []) :-
    !.
walk(Count0, Links, Here, Memory0, [Next|Path]) :-
    next_to(Links, Here, Others),
    next_host(conscientious, Others, Here, Memory0, Next, Memory),
    Count is Count0 - 1,
    walk(Count, Links, Next, Memory, Path).

%   longest_absence(+Path, +Links, -Moves): the most moves in a row that miss a
%   host.

longest_absence(Path, Links, Moves) :-
    setof(Host, O^( member(Host-O, Links) ; member(O-Host, Links) ), Hosts),
    aggregate_all(max(Absence),
                  ( member(Host, Hosts), absence(Path, Host, Absence) ),
                  Moves).

absence(Path, Host, Most) :-
    foldl(absent(Host), Path, 0-0, _-Most).

absent(Host, Host, _-Most, 0-Most) :-
    !.
absent(_, _, Now0-Most0, Now-Most) :-
    Now is Now0 + 1,
    Most is max(Most0, Now).

                /*******************************
                *            AGENTS            *
                *******************************/

%   Times are in migrations of the shortest duration. The longest execution takes
%   `longest`, three tasks are executed.

tasks(3).
longest(4).

%   executed(+Links, +Agents, +Maximum, +Settings, +Chance, -Executions):
%   Settings are Theta-Delta.

executed(Links, Count, Maximum, Settings, Chance0, Executions) :-
    setof(Host, O^( member(Host-O, Links) ; member(O-Host, Links) ), Hosts),
    findall(Host-free(0, 0), member(Host, Hosts), Pairs),
    list_to_assoc(Pairs, State),
    findall(I, between(1, Count, I), Is),
    foldl(placed(Hosts, Maximum, Settings), Is, []-Chance0, Agents-Chance),
    Settings = Theta-Delta,
    run(Agents, world(Links, Maximum, Theta, Delta), State, Chance, Executions).

placed(Hosts, Maximum, Theta-_, I, Agents-Chance0,
       [0-agent(I, Host, 1, drive(Maximum, [Theta]), Memory)|Agents]-Chance) :-
    chance_member(Host, Hosts, Chance0, Chance1),
    chance_between(0, 1000000, Seed, Chance1, Chance),
    strategy_memory(Seed, Memory).

%   The agent with the least time visits its host, and migrates.

run([], _, _, _, []).
run([Time-Agent0|Agents0], World, State0, Chance0, Executions) :-
    visit(Agent0, Time, World, State0, State, Chance0, Chance1, Agent1,
          Executions, Rest),
    next_task(Agent1, World, Agent2),
    (   tasks(Last), arg(3, Agent2, Task), Task > Last
    ->  Agents = Agents0,
        Chance = Chance1
    ;   migrated(Agent2, World, Agent),
        extreme(1, 3, Duration, Chance1, Chance),
        Arrival is Time + Duration,
        sort([Arrival-Agent|Agents0], Agents)
    ),
    run(Agents, World, State, Chance, Rest).

%   visit(...): free(Done, From) is a host that has begun Done tasks, and is free
%   from From on.

visit(Agent, Time, _, State, State, Chance, Chance, Agent, Es, Es) :-
    arg(2, Agent, Host),
    get_assoc(Host, State, free(_, From)),
    From > Time,
    !.
visit(agent(I, Host, Task, Drive0, Memory), Time, World, State0, State, Chance0,
      Chance, agent(I, Host, Task, Drive, Memory),
      [execution(Next, Host, Time, End)|Es], Es) :-
    get_assoc(Host, State0, free(Done, _)),
    Done < Task,
    !,
    Next is Done + 1,
    longest(Longest),
    extreme(0, Longest, Duration, Chance0, Chance),
    End is Time + Duration,
    put_assoc(Host, State0, free(Next, End), State),
    World = world(_, Maximum, _, _),
    rewarded(Drive0, Maximum, 5, _, Drive).
visit(agent(I, Host, Task, Drive0, Memory), _, World, State, State, Chance,
      Chance, agent(I, Host, Task, Drive, Memory), Es, Es) :-
    World = world(_, Maximum, _, Delta),
    penalised(Drive0, Maximum, 5, Delta, _, Drive).

next_task(agent(I, Host, Task0, drive(P, _), Memory),
          world(_, Maximum, Theta, _),
          agent(I, Host, Task, drive(Maximum, [Theta]), Memory)) :-
    P =:= 0,
    !,
    Task is Task0 + 1.
next_task(Agent, _, Agent).

migrated(agent(I, Host, Task, Drive, Memory0), world(Links, _, _, _),
         agent(I, Next, Task, Drive, Memory)) :-
    next_to(Links, Host, Others),
    next_host(conscientious, Others, Host, Memory0, Next, Memory).

extreme(Low, High, X, Chance0, Chance) :-
    Middle is (Low + High)/2,
    chance_member(X, [Low, Middle, High, High], Chance0, Chance).

%   overlapping(+Maximum, +Settings, +Runs, -Count): how many of Runs drawn
%   networks have overlaps, with the potential that call(Maximum, Links, P)
%   gives.

overlapping(Maximum, Settings, Runs, Count) :-
    aggregate_all(count,
                  ( between(1, Runs, Seed),
                    chance_seed(Seed, Chance0),
                    drawn(Links, Chance0, Chance1),
                    chance_between(1, 4, Agents, Chance1, Chance),
                    call(Maximum, Links, Settings, P),
                    executed(Links, Agents, P, Settings, Chance, Executions),
                    overlaps(Executions, [_|_]) ),
                  Count).

sufficient(Links, Theta-Delta, Maximum) :-
    longest(Hops),
    potential_required(Links, Hops, Theta, Delta, Maximum).

small(Links, Settings, Maximum) :-
    sufficient(Links, Settings, Sufficient),
    Maximum is Sufficient/20.

                /*******************************
                *            TESTS             *
                *******************************/

:- begin_tests(sync_guarantee).

test(moves_of_two_hosts, Moves == 2) :-
    moves_to_all([a-b], Moves).
test(moves_on_a_ring, Moves == 9) :-      % 2 - 1, 2 - 1, 2*3 - 1, and 2
    ring(4, Links),
    moves_to_all(Links, Moves).
test(moves_between_all_pairs, Moves == 14) :-   % 4 hosts, 4 - 1 each, and 2
    mesh(5, Links),
    moves_to_all(Links, Moves).
test(moves_on_a_star, Moves == 26) :-     % the centre 5 - 1, 4 leaves 6 - 1
    star(6, Links),
    moves_to_all(Links, Moves).
test(no_host_is_missed_for_longer, Worse == []) :-
    findall(Seed-Links,
            ( between(1, 60, Seed),
              chance_seed(Seed, Chance),
              drawn(Links, Chance, _),
              moves_to_all(Links, Moves),
              Links = [Here-_|_],
              strategy_memory(Seed, Memory),
              walk(400, Links, Here, Memory, Path),
              longest_absence(Path, Links, Absence),
              Absence >= Moves ),
            Worse).

test(penalties_by_hand, Counts == [1, 4]) :-    % 1, 0.45, 0.1525, 0.011
    findall(Count, ( member(Maximum, [2, 20]),
                     penalties_at_least(Maximum, 10, 1, Count) ),
            Counts).
test(no_potential_is_exhausted_earlier, Worse == []) :-
    findall(Seed-Delta,
            ( between(1, 100, Seed),
              member(Delta, [0.2, 1, 5]),
              penalties_at_least(100, 15, Delta, Least),
              chance_seed(Seed, Chance),
              exhausted(drive(100, [15]), Delta, Chance, 0, Count),
              Count < Least ),
            Worse).
test(each_penalty_counts, Counts == [24, 18]) :-
    findall(Count, ( member(Delta, [0.2, 0.5]),
                     penalties_at_least(100, 15, Delta, Count) ),
            Counts).
test(no_such_potential, error(domain_error(positive_number, 0))) :-
    penalties_at_least(0, 15, 0.2, _).

test(required_is_the_least) :-
    mesh(5, Links),
    potential_required(Links, 9, 15, 0.2, Maximum),
    Less is Maximum - 1,
    penalties_at_least(Maximum, 15, 0.2, Enough),
    penalties_at_least(Less, 15, 0.2, Few),
    assertion(Enough >= 14 + 9 + 1),
    assertion(Few < 14 + 9 + 1).
test(network_too_large, error(type_error(_, _))) :-
    ring(60, Links),
    potential_required(Links, 9, 15, 0.2, _).
test(no_overlaps_with_the_potential_required,
     [ forall(member(Settings, [15-0.2, 15-2, 1-0.01])),
       true(Count == 0) ]) :-
    overlapping(sufficient, Settings, 40, Count).
test(overlaps_with_a_twentieth, true(Count > 5)) :-
    overlapping(small, 15-0.2, 40, Count).

:- end_tests(sync_guarantee).

%   exhausted(+Drive, +Delta, +Chance, +Count0, -Count): penalties, between
%   which up to three rewards are drawn, until the potential is 0; at most 300.

exhausted(drive(P, _), _, _, Count, Count) :-
    ( P =:= 0 ; Count >= 300 ),
    !.
exhausted(Drive0, Delta, Chance0, Count0, Count) :-
    chance_member(Rewards, [0, 0, 1, 3], Chance0, Chance),
    length(List, Rewards),
    foldl([_, D0, D]>>rewarded(D0, 100, 15, _, D), List, Drive0, Drive1),
    penalised(Drive1, 100, 15, Delta, _, Drive),
    Count1 is Count0 + 1,
    exhausted(Drive, Delta, Chance, Count1, Count).
