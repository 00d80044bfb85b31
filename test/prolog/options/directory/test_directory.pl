:- module(test_directory, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/directory), [host_offers/2]).

/** <module> Services are offered and found

*Threading*: one test at a time.
*/

%   offering(+Offers, +Host, -Agent): an agent that has made the offers,
%   Service-Properties, and calls the goals that it receives.

offering(Offers, Host, Agent) :-
    Clauses = [ (main :- offers(Offers), assertz(r(1))),
                (offers([])),
                (offers([S-P|Os]) :- offer(S, P), offers(Os)),
                (on_message(user, G) :- call(G), assertz(r(G))) ],
    create(Clauses, Agent, [host(Host)]),
    did(Agent, 1).

did(Agent, What) :-
    wait_until(( fact_of(Agent, r(Done)), Done == What ), 10).

does(Agent, Goal) :-
    agent_send(Agent, Goal),
    did(Agent, Goal).

%   found(+Host, ?Pattern, +Options, -Agents): the agents that an agent on Host
%   finds.

found(Host, Pattern, Options, Found) :-
    create([(main :- find(Pattern, Found0, Options), result(Found0))], A,
           [host(Host)]),
    agent_result(A, Found, 20).

agents_found(Host, Pattern, Options, Agents) :-
    found(Host, Pattern, Options, Found),
    pairs_keys(Found, Agents).

three(Goal) :-
    with_hosts([alpha,beta,gamma],
               ( link(alpha, beta), link(beta, gamma), call(Goal) )).

here(Goal) :-
    setup_call_cleanup(host_start(alpha), once(Goal), host_stop(alpha)).

:- meta_predicate here(0).

:- begin_tests(directory).

test(offer_is_found_with_its_properties,
     Found == [A-offer(shop(7), [open], Address)]) :-
    with_hosts([alpha],
               ( offering([shop(7)-[open], bank-[]], alpha, A),
                 address(alpha, Address),
                 found(alpha, shop(_), [], Found) )).
test(nearest_first_within_the_radius,
     [forall(member(Radius-Names, [ 0-[], 1-[b], 2-[b,c], inf-[b,c] ])),
      true(Found == Names)]) :-
    three(( offering([shop-[]], beta, B),
            offering([shop-[]], gamma, C),
            agents_found(alpha, shop, [radius(Radius)], Agents),
            findall(Name, ( member(A, Agents), member(A-Name, [B-b, C-c]) ),
                    Found) )).

test(farther_hosts_are_not_queried_when_enough_are_found, Agents == [A]) :-
    three(( offering([shop-[]], alpha, A),
            offering([shop-[]], beta, _),
            agents_found(alpha, shop, [radius(inf),most(1)], Agents) )).
test(offers_are_selected_by_properties, Agents == [B]) :-
    with_hosts([alpha],
               ( offering([shop-[colour(red),open]], alpha, _),
                 offering([shop-[colour(blue),open]], alpha, B),
                 agents_found(alpha, shop, [properties([colour(blue)])],
                              Agents) )).
test(repeated_offer_replaces_the_first, Found = [A-offer(shop, [closed], _)]) :-
    with_hosts([alpha],
               ( offering([shop-[open], shop-[closed]], alpha, A),
                 found(alpha, shop, [], Found) )).

%   lapse(-Agent, -Goal): after Goal its offer is not found.

lapse(A, does(A, unoffer(shop))).
lapse(A, ( agent_dispose(A), joined(A, disposed) )).
lapse(A, ( maplist(address, [alpha,beta], [Alpha,Beta]),
           agent_move(A, Beta, [wait(5)]),
           agent_move(A, Alpha, [wait(5)]) )).

test(offer_lapses, [forall(lapse(A, Goal)), Agents == []]) :-
    with_hosts([alpha,beta],
               ( offering([shop-[]], alpha, A),
                 call(Goal),
                 agents_found(alpha, shop, [], Agents) )).
test(offer_lapses_when_the_agent_is_faulty, Agents == []) :-
    with_hosts([alpha],
               ( create([(main :- offer(shop, []), throw(oops))], A),
                 capturing(joined(A, raised(oops)), _),
                 agents_found(alpha, shop, [], Agents) )).
test(errors_of_offers,
     [ forall(member(Goal-Formal,
                     [ forall(between(0, 100, N), offer(s(N), []))-
                       resource_error(offers),
                       offer(s(_), [])-instantiation_error,
                       find(s, _, [hot(1)])-
                       domain_error(find_option, hot(1)) ])),
       true(E == Formal) ]) :-
    result_on([alpha],
              [(main :- catch(Goal, error(E0, _), true), result(E0))], E).
test(directory_on_a_guarded_host, Agents == [A]) :-
    with_hosts([alpha-[policy(guarded), cell(none)]],
               ( offering([shop-[]], alpha, A),
                 agents_found(alpha, shop, [], Agents) )).
test(directory_from_the_top_level, Found = [A-offer(shop, [], _)]) :-
    with_hosts([alpha],
               ( offering([shop-[]], alpha, A),
                 remote(alpha, find(shop, Found, [])) )).
test(directory_of_one_host, Offers == [A-offer(shop, [open])]) :-
    with_hosts([alpha],
               ( offering([shop-[open]], alpha, A),
                 host_offers(alpha, Offers) )).
test(lapsed_offers_are_removed, true(Count < 300)) :-
    with_hosts([alpha],
               ( forall(between(1, 600, _),
                        ( create([(main :- offer(shop, []))], A, []),
                          joined(A, done) )),
                 state_size(typhon_offers, Count) )).

:- end_tests(directory).

:- begin_tests(directory_of_processes).

test(over_links_of_processes, Agents == [A,B]) :-
    no_leaks(with_peers([p1, p2],
        here(( peer_host(p1, H1), peer_host(p2, H2),
               link(alpha, H1),
               peer_do(p1, link(p1, H2)),
               offering([shop-[]], H1, A),
               offering([shop-[]], H2, B),
               agents_found(alpha, shop, [radius(inf)], Agents) )))).
test(dead_process_is_left_out, Agents == [A]) :-
    no_leaks(with_peers([p1],
        here(( peer_host(p1, H1),
               link(alpha, H1),
               offering([shop-[]], alpha, A),
               offering([shop-[]], H1, _),
               peer_kill(p1),
               agents_found(alpha, shop, [radius(inf)], Agents) )))).

:- end_tests(directory_of_processes).

:- begin_tests(directory_in_the_journal, [condition(missing([journal], []))]).

test(offers_are_restored) :-
    no_leaks(with_tmp_dir(Dir,
        ( atom_concat(Dir, '/p1', J),
          with_peers([p1-[host([journal(J)])]], here(found_again)) ))).

found_again :-
    peer_host(p1, H1),
    offering([shop-[open]], H1, A),
    link(alpha, H1),
    peer_kill(p1),
    peer_restart(p1),
    wait_until(agent_property(A, state(resident)), 20),
    found(alpha, shop, [radius(1)], [A-offer(shop, [open], H1)]).

:- end_tests(directory_in_the_journal).

:- begin_tests(offers_are_bounded).

test(offers_of_an_agent_are_bounded_in_number_and_size,
     [Formal,Count,Bytes] == [resource_error(offers),99,true]) :-
    with_hosts([a-[policy(guarded), cell(none)]],
               ( create([ (main :- length(L, 30000), maplist(=(0'x), L),
                                   string_codes(S, L),
                                   catch(offer(large, [S]), error(F, _), true),
                                   string_length(S, _), sub_string(S, 0, 900, _, T),
                                   forall(between(1, 99, N), offer(o(N), [T])),
                                   assertz(s(F))),
                          on_message(_, _) ], A, [host(a)]),
                 wait_until(fact_of(A, s(Formal)), 20),
                 host_offers(a, Offers),
                 length(Offers, Count),
                 term_size(Offers, Cells),
                 ( Cells < 99*200 -> Bytes = true ; Bytes = Cells ) )).

:- end_tests(offers_are_bounded).
