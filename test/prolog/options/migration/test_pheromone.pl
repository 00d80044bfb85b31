:- module(test_pheromone, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, maplist/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(typhon)).

/** <module> Pheromones and phercon(Problem)

Diffusion against the closed form on small graphs, in one process and in
two, and agents that follow it.
*/

%   line(+Names, :Goal): hosts linked in a row.

:- meta_predicate
    line(+, 0),
    line(+, +, 0).

line(Names, Goal) :-
    line(Names, [], Goal).

line(Names, Options, Goal) :-
    findall(Name-Options, member(Name, Names), Specs),
    with_hosts(Specs, ( link_all(Names), once(Goal) )).

link_all([A,B|Names]) :-
    !,
    link(A, B),
    link_all([B|Names]).
link_all(_).

emit(Host, Problem) :-
    emit(Host, Problem, []).

emit(Host, Problem, Options) :-
    remote(Host, emit(Problem, Options)).

%   The pheromones at Host: Strength-Name of the source.

at(Host, Problem, Found) :-
    remote(Host, findall(S-Source, pheromone(Problem, Source, S), Found0)),
    findall(S-Name,
            ( member(S-Source, Found0), name_of(Source, Name) ),
            Found).

name_of(Address, Name) :-
    sub_atom(Address, Before, _, _, @),
    !,
    sub_atom(Address, 0, Before, _, Name).

reaches(Host, Problem) :-
    wait_until(\+ at(Host, Problem, []), 10).

gone(Host, Problem) :-
    wait_until(at(Host, Problem, []), 10).

close_to(X, Y) :-
    abs(X - Y) < 1.0e-9.

:- begin_tests(pheromone_spreads).

test(pheromone_spreads_along_a_line, Strengths == [100, 75, 50, 25]) :-
    line([a, b, c, d, e, f],
         ( emit(a, fire, [span(4)]),
           emit(a, end, [span(5)]),
           reaches(f, end),
           reaches(e, fire),
           findall(S, ( member(H, [b, c, d, e]),
                        at(H, fire, [S0-a]),
                        S is round(S0) ),
                   Strengths),
           at(f, fire, []),
           at(a, fire, []) )).
test(pheromone_takes_the_shorter_path, Found-Next == [100-a]-a) :-
    line([a, b, c, d],
         ( link(d, a),
           emit(a, fire),
           wait_until(( at(c, fire, [S-a]), round(S) =:= 67 ), 10),
           wait_until(( at(d, fire, [T-a]), round(T) =:= 100 ), 10),
           at(d, fire, Found),
           remote(d, sense(pheromone(fire, _, _, N, _))),
           name_of(N, Next) )).
test(several_kinds_and_sources, F1-F2 == [100-a,100-c]-[100-c]) :-
    line([a, b, c],
         ( emit(a, fire), emit(c, fire), emit(c, flood(3)),
           wait_until(at(b, fire, [_,_]), 10),
           reaches(b, flood(_)),
           at(b, fire, F1_), msort(F1_, F1),
           at(b, flood(_), F2) )).
test(pheromone_evaporates_at_far_hosts_first, true(Earlier =:= 20)) :-
    get_time(Now),
    line([a, b, c], [clock(Now, 100)],
         ( emit(a, fire, [span(2), period(20)]),
           reaches(c, fire),
           remote(b, sense(pheromone(fire, _, _, _, UB))),
           remote(c, sense(pheromone(fire, _, _, _, UC))),
           Earlier is round(UB - UC),
           gone(c, fire),
           gone(b, fire) )).
test(evaporates_one_period_earlier_at_each_hop, Apart == [10, 10]) :-
    get_time(Now),
    line([a, b, c, d, e], [clock(Now, 1)],
         ( emit(a, fire, [span(3), period(10)]),
           reaches(d, fire),
           findall(Until,
                   ( member(Host, [b, c, d]),
                     remote(Host, sense(pheromone(fire, _, _, _, Until))) ),
                   [B, C, D]),
           Apart0 = [B-C, C-D],
           findall(Seconds, ( member(X, Apart0), Seconds is round(X) ),
                   Apart) )).
test(repeated_emission_refreshes, true(U2 > U1)) :-
    line([a, b],
         ( emit(a, fire),
           reaches(b, fire),
           remote(b, sense(pheromone(fire, _, _, _, U1))),
           emit(a, fire),
           wait_until(( remote(b, sense(pheromone(fire, _, _, _, U2))),
                        U2 > U1 ), 10),
           remote(b, aggregate_all(count, sense(pheromone(_, _, _, _, _)),
                                   1)) )).
test(pheromone_is_withdrawn_everywhere) :-
    line([a, b, c, d],
         ( emit(a, fire), emit(b, fire),
           wait_until(at(c, fire, [_,_]), 10),
           reaches(d, fire),
           remote(a, withdraw(fire)),
           wait_until(at(c, fire, [_-b]), 10),
           wait_until(at(d, fire, [_-b]), 10) )).
test(removed_link_is_not_crossed) :-
    line([a, b, c],
         ( unlink(b, c),
           emit(a, fire),
           reaches(b, fire),
           emit(b, end), unlink(a, b), link(b, c), emit(b, end2),
           reaches(c, end2),
           at(c, fire, []) )).
test(refused_pheromone,
     [ forall(( stream_property(S, alias(user_input)),
                member(Problem-Options-Formal,
                       [ fire(_)-[]-instantiation_error,
                         fire-[spam(2)]-
                         domain_error(pheromone_option, spam(2)),
                         fire(S)-[]-type_error(mobile_term, _) ]) )),
       error(Formal) ]) :-
    line([a], emit(a, Problem, Options)).

:- end_tests(pheromone_spreads).

:- begin_tests(pheromone_follow).

follower([ (:- agent(follower, [state([problem/1, path/1])])),
           (main :- here(Here), assertz(path(Here)),
                    \+ sense(source(here)),
                    !,
                    problem(P),
                    next_host(phercon(P), Next),
                    move(Next),
                    main),
           main,
           on_message(_, _)
         ]).

follow(From, Problem, Path) :-
    follower(Clauses),
    agent_create(clauses(Clauses), Agent,
                 [host(From), facts([problem(Problem)])]),
    wait_state(Agent, resident),
    agent_property(Agent, facts(Facts)),
    findall(Name, ( member(path(H), Facts), name_of(H, Name) ), Path),
    agent_dispose(Agent),
    agent_join(Agent, disposed, 10).

%   next_from(+Host, +Problem, -Next): the next host of an agent on Host.

next_from(Host, Problem, Next) :-
    agent_create(clauses([ (:- agent(asker, [state([problem/1])])),
                           (main :- problem(P), next_host(phercon(P), Next0),
                                    result(Next0)) ]),
                 Agent, [host(Host), facts([problem(Problem)])]),
    agent_result(Agent, Address, 10),
    name_of(Address, Next).

all_from(Host, Problem, Nexts) :-
    findall(Next, ( between(1, 30, _), next_from(Host, Problem, Next) ), All),
    sort(All, Nexts).

test(trail_is_followed_to_the_source, Path == [d, c, b, a]) :-
    line([a, b, c, d, e],
         ( remote(a, leave(source(here))),
           emit(a, fire(1)),
           reaches(d, fire(1)),
           link(c, e),
           follow(d, fire(_), Path) )).
test(unrelated_pheromone_is_no_trail, First == e) :-
    line([e, d, c],
         ( remote(e, leave(source(here))),
           emit(c, flood),
           reaches(d, flood),
           unlink(c, d),
           follow(d, fire, [d, First|_]) )).
test(problem_must_be_subsumed_as_a_whole,
     [ forall(member(Problem, [fire(2), fire(1, _)])), Nexts == [a, c] ]) :-
    line([a, b, c],
         ( emit(a, fire(1)),
           reaches(b, fire(_)),
           all_from(b, Problem, Nexts) )).
test(strongest_trail_comes_first, Next == a) :-
    line([a, b, c, d],
         ( emit(d, fire), emit(a, fire),
           wait_until(at(b, fire, [_,_]), 10),
           next_from(b, fire, Next) )).
test(ties_are_drawn, Nexts == [a, c]) :-
    line([a, b, c],
         ( emit(a, fire), emit(c, fire),
           wait_until(at(b, fire, [_,_]), 10),
           all_from(b, fire, Nexts) )).
test(ties_are_drawn_alike_in_any_order, true(First == Second)) :-
    line([a, b, c],
         ( tie_draws([a, c], First),
           tie_draws([c, a], Second) )).
test(trail_over_a_lost_link_is_abandoned, Next == c) :-
    line([a, b, c],
         ( emit(a, fire),
           reaches(b, fire),
           unlink(a, b),
           next_from(b, fire, Next) )).

:- end_tests(pheromone_follow).

%   The hosts chosen with seeds, of two equally strong pheromones, which came to
%   b in the order of their Sources.

tie_draws(Sources, Hosts) :-
    forall(append(Before, [Source|_], Sources),
           ( emit(Source, fire),
             length([_|Before], Count),
             wait_until(( at(b, fire, Found), length(Found, Count) ), 10) )),
    maplist(address, [a,b,c], [A,B,C]),
    findall(Host,
            ( between(1, 20, Seed),
              typhon_strategy:strategy_memory(Seed, Memory),
              typhon_strategy:next_host(phercon(fire), [A,C], B, Memory, Host,
                                        _) ),
            Hosts),
    forall(member(Source, Sources), remote(Source, withdraw(fire))),
    gone(b, fire).

:- begin_tests(pheromone_network).

%   Strength is that of the closed form at the distance in the graph.

test(pheromones_in_two_processes, Wrong == []) :-
    setup_call_cleanup(
        network_start(grid(3, 4), Network, [processes(2)]),
        once(diffused(Network, 4, Wrong)),
        network_stop(Network)).

diffused(Network, Span, Wrong) :-
    network_property(Network, hosts(Hosts)),
    network_property(Network, edges(Edges)),
    Hosts = [Source|Others],
    remote(Source, emit(fire, [span(Span)])),
    distances([Source], Edges, 0, [Source-0], Distances),
    findall(Host-D,
            ( member(Host, Others),
              member(Host-D, Distances),
              D =< Span,
              \+ arrives(Host, D, Span) ),
            Wrong).

arrives(Host, D, Span) :-
    Expected is 100*(Span-D+1)/Span,
    wait_until(( remote(Host, pheromone(fire, _, Strength)),
                 close_to(Strength, Expected) ), 10).

distances([], _, _, Distances, Distances).
distances([From|Froms], Edges, D, Known, Distances) :-
    D1 is D + 1,
    findall(To,
            ( member(Host, [From|Froms]),
              ( member(Host-To, Edges) ; member(To-Host, Edges) ),
              \+ memberchk(To-_, Known) ),
            Tos0),
    sort(Tos0, Tos),
    findall(To-D1, member(To, Tos), New),
    append(Known, New, Known1),
    distances(Tos, Edges, D1, Known1, Distances).

:- end_tests(pheromone_network).

%   Hosts b and c are linked; c has pheromones of d, and is flooded from b.

:- begin_tests(pheromones_are_bounded).

test(flood_of_an_agent_leaves_space_for_others, Left == [25,10]) :-
    flooded(forall(between(1, 5000, N), emit(flood(N))), Left).
test(all_neighbours_together_cannot_pass_the_bound, Counts == [25,50,50]) :-
    with_settings([typhon_pheromone:pheromones=50],
        with_hosts([b, c, d, e],
            ( forall(member(H, [b, d, e]), link(c, H)),
              findall(Count,
                      ( member(H-Expected, [b-25, d-50, e-50]),
                        forall(between(1, 30, N),
                               emit(H, from(H, N), [span(1), period(1000)])),
                        all_on_c(Expected, Count) ),
                      Counts) ))).
test(large_problem_is_refused, Formal == resource_error(pheromone)) :-
    line([b, c],
         ( guest([ (main :- length(L, 3000), maplist(=(x), L),
                            catch(emit(L), error(F, _), true), result(F)) ], A),
           agent_result(A, Formal, 30) )).
test(emissions_are_counted_by_the_quota_of_facts,
     Outcome = raised(error(resource_error(facts), _))) :-
    with_hosts([b-[quota([facts(100)])]],
               capturing(( guest([ (main :- repeat, emit(x), fail) ], A),
                           agent_join(A, Outcome, 30) ), _)).
test(process_of_another_host_cannot_pass_the_bound, Left-Rest == [25,10]-[]) :-
    with_settings([typhon_pheromone:pheromones=50],
        with_peers([p-[host([])]],
            line([d, c], ( kept(c), pheromones(10), sent_by_peer(Left, Rest) )))).

:- end_tests(pheromones_are_bounded).

all_on_c(Expected, Count) :-
    wait_until(( remote(c, aggregate_all(count, pheromone(_, _, _), Count)),
                 Count >= Expected ), 20).

guest(Clauses, A) :-
    create(Clauses, A, [host(b)]).

flooded(Goal, Left) :-
    with_settings([typhon_pheromone:pheromones=50],
        line([b, c, d], ( kept(c), pheromones(10),
                          guest([(main :- Goal, result(done))], A),
                          agent_result(A, done, 60),
                          left_at(c, Left) ))).

%   Ten pheromones of d are on c.

kept(_) :-
    forall(between(1, 10, N), emit(d, kept(N), [span(1), period(1000)])).

pheromones(Count) :-
    wait_until(( remote(c, findall(N, pheromone(kept(N), _, _), Ns)),
                 length(Ns, Count) ), 20).

left_at(Host, [Flood,Kept]) :-
    wait_until(remote(Host, aggregate_all(count, pheromone(flood(_), _, _), 25)),
               30),
    remote(Host, aggregate_all(count, pheromone(flood(_), _, _), Flood)),
    remote(Host, aggregate_all(count, pheromone(kept(_), _, _), Kept)).

%   The peer sends what emit/2 never does: a hundred thousand pheromones, and
%   malformed ones.

sent_by_peer(Left, Rest) :-
    address(c, C),
    atomic_list_concat([_,Endpoint], @, C),
    peer_host(p, P),
    get_time(Now),
    S = signal(flood(N), P, 1.0e9, 1, 1.0e9, Now, 1),
    peer_do(p, forall(between(1, 5000, N),
                      typhon_endpoint:endpoint_post(
                          Endpoint, pheromone,
                          pheromone(c, smelt(P, S))))),
    length(Long, 5000),
    maplist(=(x), Long),
    Bad = [ smelt(d, S), smelt(P, none), smelt(P, signal(_, _, a, b, c, d, e)),
            smelt(P, signal(Long, P, 1, 1, 1.0e9, Now, 1)), x, withdrawn(1, _) ],
    capturing(( peer_do(p, forall(member(B, Bad),
                                  typhon_endpoint:endpoint_post(
                                      Endpoint, pheromone, pheromone(c, B)))),
                peer_do(p, remote(C, true)),
                left_at(c, Left) ),
              Messages),
    exclude(of_undeclared, Messages, Rest).

of_undeclared(warning-typhon(endpoint, undeclared(_, post, pheromone))).
of_undeclared(warning-typhon(more(undeclared_terms, _))).
