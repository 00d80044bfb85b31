:- module(test_agent, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(apply)).
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(readutil)).
:- use_module(library(settings)).
:- use_module(library(typhon)).

/** <module> Tests of the lives of agents, from birth to end

Agents on hosts of this process. An agent with on_message/2 remains for
inspection when its goals are done.
*/

%   lives(+Clauses, -Facts): Facts are the state of an agent of Clauses when it
%   has no goals left.

lives(Clauses, Facts) :-
    lives(Clauses, [], Facts).

lives(Clauses, Options, Facts) :-
    with_hosts([alpha,beta], lives_(Clauses, Options, Facts)).

lives_(Clauses, Options, Facts) :-
    create([on_message(_, _)|Clauses], Agent, Options),
    wait_state(Agent, resident),
    facts(Agent, Facts).

%   ends(+Clauses, -Outcome, -Messages)

ends(Clauses, Outcome, Messages) :-
    ends(Clauses, [], Outcome, Messages).

ends(Clauses, Options, Outcome, Messages) :-
    with_hosts([alpha,beta],
               capturing(( create(Clauses, Agent, Options),
                           joined(Agent, Outcome) ), Messages)).

gone(Agent) :-
    \+ agent_property(Agent, state(_)).

:- begin_tests(birth).

test(agent_ends_with_outcome_done, O-M == done-[]) :-
    ends([main], O, M).
test(failure_is_reported,
     true(O-M = failed-[warning-typhon(agent_failed(_, _))])) :-
    ends([(main :- fail)], O, M).
test(agent_without_main_waits, F == []) :-
    lives([], F).
test(agent_without_main_is_resident_from_birth, States == [resident]) :-
    with_hosts([alpha],
               ( findall(S, ( between(1, 300, _),
                              create([on_message(_, _)], A),
                              agent_property(A, state(S)) ),
                         All),
                 sort(All, States) )).
test(handler_in_the_state_only, S == resident) :-
    with_hosts([alpha],
               ( agent_create(clauses([(:- agent(t, [state([on_message/2])])),
                                       main,
                                       (on_message(_, stop) :- dispose)]), A),
                 wait_state(A, S0),
                 ( S0 == resident -> S = S0 ; wait_state(A, resident),
                                              S = resident ),
                 agent_send(A, stop),
                 joined(A, disposed) )).
test(name_is_that_of_the_program, N == test) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, _),
                 atomic_list_concat([N|_], '.', A) )).
test(given_name, N == scout) :-
    with_hosts([alpha],
               ( create([main], A, [name(scout)]), joined(A, _),
                 atomic_list_concat([N|_], '.', A) )).
test(invalid_name, [ forall(member(Name, ['', 'a@b', 'a\e[31mb',
                                          'a\nb', 'a\u202eb'])),
                     error(domain_error(agent_name, Name)) ]) :-
    with_hosts([alpha], create([main], _, [name(Name)])).
test(id_contains_the_home, true(sub_atom(A, _, _, 0, Home))) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, _),
                 address(alpha, Address),
                 atom_concat(@, Address, Home) )).
test(host_by_name_and_by_address, true(H1-H2 == B-B)) :-
    with_hosts([alpha,beta],
               ( address(beta, B),
                 create([on_message(_, _)], A1, [host(beta)]),
                 create([on_message(_, _)], A2, [host(B)]),
                 agent_property(A1, host(H1)),
                 agent_property(A2, host(H2)) )).
test(first_host_by_default, true(H == A)) :-
    with_hosts([alpha,beta],
               ( address(alpha, A),
                 create([on_message(_, _)], Agent),
                 agent_property(Agent, host(H)) )).
test(no_host, error(existence_error(host, here))) :-
    create([main], _).
test(unknown_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha], create([main], _, [host(nowhere)])).
test(unknown_host_of_this_process, error(existence_error(host, _))) :-
    with_hosts([alpha],
               ( address(alpha, A),
                 atom_concat(alpha, Endpoint, A),
                 atom_concat(nowhere, Endpoint, Nowhere),
                 create([main], _, [host(Nowhere)]) )).
test(unknown_option, error(domain_error(agent_option, colour(red)))) :-
    with_hosts([alpha], create([main], _, [colour(red)])).
test(option_of_the_wrong_type, error(type_error(boolean, 1))) :-
    with_hosts([alpha], create([main], _, [static(1)])).
test(options_no_list, error(type_error(list, host(alpha)))) :-
    with_hosts([alpha], create([main], _, host(alpha))).
test(negative_lifetime, error(type_error(nonneg, -1))) :-
    with_hosts([alpha], create([main], _, [lifetime(-1)])).
test(facts, F == [(r(2):-s(1)),s(0),s(1)]) :-
    lives([s(0)], [facts([s(1),(r(2):-s(1))])], F).
test(facts_of_the_program_itself,
     error(permission_error(attach, procedure, p/1))) :-
    with_hosts([alpha], create([main, p(1)], _, [facts([p(2)])])).
test(facts_that_cannot_travel, error(type_error(mobile_term, _))) :-
    with_hosts([alpha],
               ( current_output(S), create([main], _, [facts([s(S)])]) )).
test(invalid_facts, error(type_error(callable, 3))) :-
    with_hosts([alpha], create([main], _, [facts([3])])).
test(refused_by_a_full_host_at_creation,
     error(move_refused(_, capacity))) :-
    with_hosts([alpha-[capacity(0)]], create([main], _)).
test(refused_without_a_token_at_creation, error(move_refused(_, token))) :-
    with_hosts([alpha-[tokens([red])]], create([main], _, [tokens([blue])])).
test(admitted_with_a_token, O == done) :-
    with_hosts([alpha-[tokens([red,green])]],
               ( create([main], A, [tokens([blue,green])]), joined(A, O) )).
test(token_must_match_the_host, error(move_refused(_, token))) :-
    with_hosts([alpha-[tokens([red])]], create([main], _, [tokens([_])])).
test(ids_are_unique, N == 400) :-
    with_hosts([alpha,beta], unique_ids(N)).

unique_ids(N) :-
    findall(T, ( member(H, [alpha,alpha,beta,beta]),
                 thread_create(plunit_birth:create_100(H), T) ), Ts),
    findall(Id, ( member(T, Ts), thread_join(T, exited(Ids)),
                  member(Id, Ids) ), All),
    maplist(joined, All, _),
    sort(All, Set),
    length(Set, N).

create_100(Host) :-
    findall(A, ( between(1, 100, _), create([main], A, [host(Host)]) ), As),
    thread_exit(As).

test(vocabulary, true(F == [s(Id,A,A,0,[B],1)])) :-
    with_hosts([alpha,beta],
               ( link(alpha, beta), address(alpha, A), address(beta, B),
                 agent_create(clauses([(:- agent(t, [state([s/6])])),
                                       on_message(_, _),
                                       (main :- self(I), here(H), home(O),
                                                hops(N), neighbours(L),
                                                host_load(W), \+ parent(_),
                                                now(T), float(T),
                                                assertz(s(I,H,O,N,L,W)))]),
                              Id),
                 wait_state(Id, resident),
                 agent_property(Id, facts(F)) )).
test(vocabulary_after_a_move, true(F == [s(B,A,1)])) :-
    with_hosts([alpha,beta],
               ( address(alpha, A), address(beta, B),
                 agent_create(clauses([(:- agent(t, [state([s/3])])),
                                       on_message(_, _),
                                       (main :- move(beta), here(H), home(O),
                                                hops(N),
                                                assertz(s(H,O,N)))]), Id),
                 wait_state(Id, resident),
                 agent_property(Id, facts(F)) )).
test(only_agents_have_a_self,
     error(existence_error(running_agent, here))) :-
    with_hosts([alpha], typhon_words:self(_)).

:- end_tests(birth).

:- begin_tests(moves).

test(move_and_continue, F == [s(1),s(2),s(3)]) :-
    lives([(main :- assertz(s(1)), move(beta), assertz(s(2)),
                    move(alpha), assertz(s(3)))], F).
test(move_to_the_current_host, F == [s(0)]) :-
    lives([(main :- move(alpha), hops(N), assertz(s(N)))], F).
test(move_by_address, true(H == B)) :-
    with_hosts([alpha,beta],
               ( address(beta, B),
                 create([on_message(_, _), (main :- s(X), move(X))], A,
                        [facts([s(B)])]),
                 wait_state(A, resident),
                 agent_property(A, host(H)) )).
test(no_such_host,
     true(F = [s(move_refused(nowhere, unknown_host))])) :-
    lives([(main :- catch(move(nowhere), error(E, _), assertz(s(E))))], F).
test(refused_by_a_full_host, true(F = [s(move_refused(_, capacity))])) :-
    with_hosts([alpha,beta-[capacity(0)]],
               lives_([(main :- catch(move(beta), error(E, _),
                                      assertz(s(E))))], [], F)).
test(refused_without_a_token, true(F = [s(move_refused(_, token)),s(here)])) :-
    with_hosts([alpha,beta-[tokens([red])]],
               lives_([(main :- catch(move(beta), error(E, _),
                                      assertz(s(E))), assertz(s(here)))],
                      [tokens([blue])], F)).
test(admitted_with_a_token, F == [s(there)]) :-
    with_hosts([alpha,beta-[tokens([red])]],
               lives_([(main :- move(beta), assertz(s(there)))],
                      [tokens([red])], F)).
test(no_process_at_the_address, true(F = [s(host_unreachable(X)),s(X)])) :-
    lives([ (main :- move_to('gamma@127.0.0.1:1')),
            (move_to(X) :- catch(move(X), error(E, _), assertz(s(E))),
                           assertz(s(X))) ], F).
test(move_to_an_unbound_host, true(F = [s(instantiation_error)])) :-
    lives([(main :- catch(move(_), error(E, _), assertz(s(E))))], F).
test(goal_that_cannot_travel, true(F = [s(mobile_term),s(alpha)])) :-
    lives([ (main :- current_output(S),
                     catch(( move(beta), write(S, x) ),
                           error(type_error(E, _), _), assertz(s(E))),
                     name(N), assertz(s(N))),
            (name(N) :- here(A), atomic_list_concat([N,_], @, A)) ], F).
test(state_that_cannot_travel,
     [ forall(member(First-To, [true-beta, move(beta)-alpha])),
       true(F = [r(mobile_term)|_]) ]) :-
    lives([ s(0),
            (main :- First, current_output(S), assertz(s(S)),
                     catch(move(To), error(type_error(E, _), _),
                           assertz(r(E)))) ], F).
%   Stored goals would keep the variable and lose its attribute.

test(attributed_variable_in_a_waiting_goal_is_refused,
     [ forall(member(Stop, [sleep(1), receive(_), receive(_, 1), clone(_)])),
       true(F == [s(mobile_term)]) ]) :-
    lives([ (main :- freeze(X, true),
                     catch(( Stop, E = none ), error(type_error(E, _), _),
                           true),
                     assertz(s(E)), X = 1) ], F).
test(unused_attributed_variable_is_ignored, true(F == [s(2)])) :-
    lives([ (main :- two(X), sleep(0.01), assertz(s(X))),
            (two(X) :- freeze(X, true), freeze(_, true), X = 2) ], F).
test(all_kinds_of_terms_travel, true(F == Terms)) :-
    Big is 7**77, Neg is -(3**80), Inf is inf, Nan is nan, Tiny is 2.0** -1074,
    MZero is -0.0,
    findall(s(T), member(T, [ Big, Neg, Inf, Nan, Tiny, MZero, 0.1, 1r3,
                              "a string\n", 'an atom\\', [], '[]', {}, (:-),
                              f(x:y, "", `codes`), 'γεια', - 1, -(1), 1-2,
                              [a|b], 'hello world'(1) ]), Terms),
    lives([(main :- move(beta), move(alpha))], [facts(Terms)], F).
test(variables_stay_shared, true(F =@= [(r(Y):-s(Y)),s(f(X,X,_))])) :-
    lives([(main :- X = f(A,A,_), move(beta), assertz(s(X)))],
          [facts([(r(Y) :- s(Y))])], F).
test(lifetime, true(O-H == disposed-2)) :-
    with_hosts([alpha,beta],
               ( remote(alpha, leave(hops(0))),
                 create([(main :- tour),
                         (tour :- move(beta), mark, move(alpha), mark, tour),
                         (mark :- hops(N), leave(hops(N)))], A, [lifetime(2)]),
                 joined(A, O),
                 findall(N, ( member(Host, [alpha,beta]),
                              remote(Host, findall(N0, sense(hops(N0)), Ns)),
                              member(N, Ns) ), All),
                 max_list(All, H) )).
test(lifetime_without_end, F == [s(4)]) :-
    lives([(main :- move(beta), move(alpha), move(beta), move(alpha),
                    hops(N), assertz(s(N)))], [lifetime(inf)], F).
test(static_agent, true(F = [s(permission_error(move, static_agent, _))])) :-
    lives([(main :- catch(move(beta), error(E, _), assertz(s(E))))],
          [static(true)], F).
test(hop_time_is_measured, true((C1-C2 == 1-1, M >= 0.05))) :-
    with_hosts([alpha-[hop_time(uniform(0.05, 0.06))],beta],
               ( create([(main :- move(beta))], A), joined(A, done),
                 host_property(alpha, hop_time(out, stats(C1,_,_,_))),
                 host_property(beta, hop_time(in, stats(C2,M,_,_))) )).
test(hosts_are_empty_afterwards, L1-L2 == 0-0) :-
    with_hosts([alpha,beta],
               ( numlist(1, 50, Ns),
                 findall(A, ( member(_, Ns),
                              create([(main :- move(beta), move(alpha),
                                               move(beta))], A) ), As),
                 maplist(joined, As, Os),
                 assertion(forall(member(O, Os), O == done)),
                 wait_until(( host_property(alpha, load(0)),
                              host_property(beta, load(0)) ), 5),
                 host_property(alpha, load(L1)),
                 host_property(beta, load(L2)) )).
test(thousand_round_trips_without_pause, O == done) :-
    with_hosts([alpha,beta],
               ( create([ (main :- s(0), !),
                          (main :- move(beta), move(alpha), retract(s(N)),
                                   N1 is N-1, assertz(s(N1)), main),
                          s(1000) ], A),
                 joined(A, O) )).

:- end_tests(moves).

:- begin_tests(clones).

test(fork, true(Ps-Cs == [s(parent(C))]-[s(clone(P))])) :-
    with_hosts([alpha],
               ( create([on_message(_, _), (main :- clone(W), assertz(s(W)))],
                        P),
                 wait_state(P, resident),
                 agent_property(P, facts(Ps)),
                 Ps = [s(parent(C))],
                 wait_state(C, resident),
                 agent_property(C, facts(Cs)) )).
test(clone_has_the_name_of_its_parent, true(sub_atom(C, 0, _, _, 'v1.2.'))) :-
    with_hosts([alpha],
               ( create([on_message(_, _), (main :- clone(W), assertz(s(W)))],
                        P, [name('v1.2')]),
                 wait_state(P, resident),
                 agent_property(P, facts([s(parent(C))])) )).
test(fork_elsewhere, true(H1-H2-Cs == A-B-[s(clone(P)),s(P)])) :-
    with_hosts([alpha,beta],
               ( address(alpha, A), address(beta, B),
                 create([on_message(_, _),
                         (main :- clone(beta, W), assertz(s(W)),
                                  ( parent(P0) -> assertz(s(P0)) ; true ))],
                        P),
                 wait_state(P, resident),
                 agent_property(P, facts([s(parent(C))])),
                 wait_state(C, resident),
                 agent_property(P, host(H1)),
                 agent_property(C, host(H2)),
                 agent_property(C, facts(Cs)) )).
test(clone_has_its_own_state, Fs == [[s(1),s(clone)],[s(1),s(parent)]]) :-
    with_hosts([alpha],
               ( create([on_message(_, _), s(1),
                         (main :- clone(W), functor(W, N, 1), assertz(s(N)))],
                        P),
                 wait_until(two_residents(P, C), 10),
                 agent_property(P, facts(F1)),
                 agent_property(C, facts(F2)),
                 sort([F1,F2], Fs) )).

two_residents(P, C) :-
    agent_property(P, state(resident)),
    agent_property(C, state(resident)),
    C \== P,
    !.

test(clones_do_not_share_bindings, true(F1 == [s(x)])) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- clone(W), bind(W, X), assertz(s(X))),
                         bind(parent(_), x), bind(clone(_), y)], P),
                 wait_until(two_residents(P, _), 10),
                 agent_property(P, facts(F1)) )).
test(mail_is_not_cloned, F == [s(none)]) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- receive(_-go), clone(W),
                                  ( W = clone(_)
                                  -> ( receive(_, 0) -> assertz(s(mail))
                                     ; assertz(s(none)) )
                                  ; true ))], P),
                 wait_state(P, waiting),
                 agent_send(P, other),
                 agent_send(P, go),
                 wait_until(two_residents(P, C), 10),
                 agent_property(C, facts(F)) )).
test(clone_of_a_clone, N == 8) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- clone(_), clone(_), clone(_))], _),
                 wait_until(residents(8), 10),
                 host_property(alpha, load(N)) )).

residents(N) :-
    findall(A, agent_property(A, state(resident)), As),
    length(As, N).

test(no_capacity_for_a_clone, true(F = [s(move_refused(_, capacity))])) :-
    with_hosts([alpha-[capacity(1)]],
               lives_([(main :- catch(clone(_), error(E, _), assertz(s(E))))],
                      [], F)).
test(no_capacity_for_a_clone_on_another_host,
     true(F = [s(move_refused(_, capacity))])) :-
    with_hosts([alpha,beta-[capacity(0)]],
               lives_([(main :- catch(clone(beta, _), error(E, _),
                                      assertz(s(E))))], [], F)).
test(clone_to_a_missing_host, true(F = [s(host_unreachable(_))])) :-
    lives([(main :- catch(clone('gamma@127.0.0.1:1', _), error(E, _),
                          assertz(s(E))))], F).
test(clone_has_the_tokens_of_its_parent,
     [ forall(member(Clone, [clone(_), clone(beta, _)])),
       true(Hs == [B,B]) ]) :-
    with_hosts([alpha,beta-[tokens([red])]],
               ( address(beta, B),
                 create([on_message(_, _), (main :- Clone, move(beta))], P,
                        [tokens([red])]),
                 wait_until(two_residents(P, C), 10),
                 findall(H, ( member(A, [P,C]), agent_property(A, host(H)) ),
                         Hs) )).
test(clone_is_born_on_the_host_of_its_parent, true(H == B)) :-
    with_hosts([alpha,beta],
               ( address(beta, B),
                 create([on_message(_, _), (main :- move(beta), clone(_))], P),
                 wait_until(two_residents(P, C), 10),
                 agent_property(C, home(H)) )).
test(payloads_are_cloned, F == [s(7),s(7)]) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- clone(_), p(X), assertz(s(X)))], P,
                        [payloads([payload(seven, [p/1], [p(7)])])]),
                 wait_until(two_residents(P, C), 10),
                 findall(s(X), ( member(A, [P,C]), fact_of(A, s(X)) ), F) )).
test(clone_order_from_outside, true(F1-F2 == [s(1)]-[s(1)])) :-
    with_hosts([alpha],
               ( create([on_message(_, _), s(1)], A),
                 agent_clone(A, C),
                 wait_state(C, resident),
                 agent_property(A, facts(F1)),
                 agent_property(C, facts(F2)) )).
test(clone_order_to_a_waiting_agent, Os == [done,done]) :-
    with_hosts([alpha],
               ( create([(main :- receive(_-go))], A),
                 wait_state(A, waiting),
                 agent_clone(A, C),
                 wait_state(C, waiting),
                 maplist([X]>>agent_send(X, go), [A,C]),
                 maplist(joined, [A,C], Os) )).
test(clone_order_is_refused, error(move_refused(_, capacity))) :-
    with_hosts([alpha-[capacity(1)]],
               ( create([on_message(_, _)], A),
                 agent_clone(A, _) )).

:- end_tests(clones).

:- begin_tests(waiting).

test(sleep, true(S >= 0.1)) :-
    with_hosts([alpha],
               elapsed(( create([(main :- sleep(0.1))], A),
                         joined(A, done) ), S)).
test(sleep_is_in_host_seconds, true((S >= 0.1, S < 5))) :-
    with_hosts([alpha-[clock(0, 100)]],
               elapsed(( create([(main :- sleep(10))], A),
                         joined(A, done) ), S)).
test(sleepers_wake_in_order, F == [1,2,3,4,5]) :-
    with_hosts([alpha-[concurrency(1), clock(virtual)]],
               ( remote(alpha, now(T0)),
                 T is T0+1,
                 findall(A, ( member(N, [3,1,5,2,4]),
                              Until is T+N*0.01,
                              create([(main :- s(U), now(Now), D is U-Now,
                                               sleep(D), r(N), leave(up(N)))],
                                     A, [facts([s(Until),r(N)])]) ), As),
                 maplist(joined, As, _),
                 remote(alpha, findall(N, sense(up(N)), F)) )).
test(sleep_without_end, Count-O == 2-timeout) :-
    with_hosts([alpha],
               ( create([(main :- sleep(inf))], A),
                 create([(main :- X is inf, sleep(X))], B),
                 wait_state(A, sleeping),
                 wait_state(B, sleeping),
                 with_output_to(string(Table), agents),
                 findall(x, sub_string(Table, _, _, _, "sleeping  "), Xs),
                 length(Xs, Count),
                 agent_join(A, O, 0) )).
test(sleep_for_no_time, O == done) :-
    ends([(main :- sleep(0), sleep(-1))], O, []).
test(invalid_sleep_time, true(O = raised(error(type_error(_, soon), _)))) :-
    ends([(main :- sleep(soon))], O, _).
test(unbound_sleep_time,
     true(O = raised(error(instantiation_error, _)))) :-
    ends([(main :- sleep(_))], O, _).
test(state_is_sleeping, S == sleeping) :-
    with_hosts([alpha],
               ( create([(main :- sleep(1000))], A),
                 wait_state(A, sleeping),
                 agent_property(A, state(S)) )).
test(oldest_message_is_received, F == [s(1),s(2),s(3)]) :-
    with_hosts([alpha],
               ( mailed([(main :- receive(_-go), get, get, get),
                         (get :- receive(_-X), assertz(s(X)))],
                        [1,2,3,go], F) )).
test(receive_selects, F == [s(b(2)),s(a(1)),s(c(3))]) :-
    with_hosts([alpha],
               ( mailed([(main :- receive(_-go), get(b(_)), get(_), get(_)),
                         (get(X) :- receive(_-X), assertz(s(X)))],
                        [a(1),b(2),c(3),go], F) )).
test(other_messages_are_kept_for_on_message,
     F == [s(got(go)),s(heard(1)),s(heard(2))]) :-
    with_hosts([alpha],
               ( agent_create(clauses([(:- agent(t, [state([s/1])])),
                                       (main :- receive(_-go),
                                                assertz(s(got(go)))),
                                       (on_message(_, X) :-
                                            assertz(s(heard(X))))]), A),
                 wait_state(A, waiting),
                 maplist(agent_send(A), [1,2,go]),
                 wait_until(fact_of(A, s(heard(2))), 10),
                 agent_property(A, facts(F)) )).
test(bindings_of_a_message, F == [s(7-user)]) :-
    with_hosts([alpha],
               mailed([(main :- receive(From-add(X, 3)), Y is X+3,
                                assertz(s(Y-From)))], [add(4,3)], F)).
test(unmatched_message_does_not_wake, S == waiting) :-
    with_hosts([alpha],
               ( create([(main :- receive(_-a))], A),
                 wait_state(A, waiting),
                 agent_send(A, b),
                 agent_property(A, state(S)) )).
test(timeout_fails, F == [s(late)]) :-
    lives([(main :- ( receive(_, 0.05) -> assertz(s(got))
                    ; assertz(s(late)) ))], F).
test(timeout_takes_its_time, true(S >= 0.1)) :-
    with_hosts([alpha],
               elapsed(( create([(main :- \+ fail, ( receive(_, 0.1) -> true
                                                   ; true ))], A),
                         joined(A, done) ), S)).
test(zero_timeout_polls, F == [s(1),s(none)]) :-
    with_hosts([alpha],
               mailed([(main :- receive(_-go), get, get),
                       (get :- receive(_-X, 0) -> assertz(s(X))
                             ; assertz(s(none)))], [1,go], F)).
test(message_before_the_timeout, true((F == [s(x)], S < 10))) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- receive(_-X, 1000), assertz(s(X)))], A),
                 wait_state(A, waiting),
                 agent_send(A, x),
                 elapsed(wait_state(A, resident), S),
                 agent_property(A, facts(F)) )).
test(receive_without_a_timeout, Fs == [[s(x)],[s(x)],[s(x)]]) :-
    with_hosts([alpha],
               findall(F, ( member(T, [inf,infinite,1.0Inf]),
                            mailed([(main :- r(T), receive(_-X, T),
                                             assertz(s(X)), retract(r(T))),
                                    r(T)], [x], F) ), Fs)).
test(invalid_timeout, true(O = raised(error(type_error(_, soon), _)))) :-
    ends([(main :- receive(_, soon))], O, _).
test(expired_timeout_does_not_affect_later_receives, F == [s(late),s(x)]) :-
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- ( receive(_-no, 0.05) -> true
                                  ; assertz(s(late)) ),
                                  receive(_-X), assertz(s(X)))], A),
                 wait_until(( fact_of(A, s(late)), state_of(A, waiting) ), 10),
                 agent_send(A, x),
                 wait_state(A, resident),
                 agent_property(A, facts(F)) )).
test(failing_handler,
     true(M-F = [warning-typhon(message_failed(_, user, bad))]-[s(good)])) :-
    with_hosts([alpha],
               capturing(mailed([(on_message(_, good) :- assertz(s(good)))],
                                [bad,good], F), M)).
test(failing_handler_after_a_move,
     true(M-F = [warning-typhon(message_undone(_, user, bad, _))]
                -[s(good)])) :-
    with_hosts([alpha,beta],
               capturing(mailed([(on_message(_, bad) :- move(beta), fail),
                                 (on_message(_, good) :- assertz(s(good)))],
                                [bad,good], F), M)).
test(raising_handler, true(O = raised(oops))) :-
    with_hosts([alpha],
               capturing(( create([(on_message(_, _) :- throw(oops))], A),
                           wait_state(A, resident),
                           agent_send(A, hello),
                           joined(A, O) ), _)).
test(send_to_an_unbound_recipient, F == [s(instantiation_error)]) :-
    lives([(main :- catch(send(_, x), error(E, _), assertz(s(E))))], F).
test(send_to_an_unbound_host, F == [s(instantiation_error)]) :-
    lives([(main :- catch(send(at(_, alpha), x), error(E, _),
                          assertz(s(E))))], F).
test(handler_is_called_once_per_message, F == [s(1),s(2)]) :-
    with_hosts([alpha],
               mailed([(on_message(_, X) :- member(_, [a,b]),
                                            assertz(s(X)))], [1,2], F)).
test(handler_that_waits, F == [s(1),s(2)]) :-
    with_hosts([alpha],
               mailed([(on_message(_, a) :- receive(_-c), assertz(s(1))),
                       (on_message(_, b) :- assertz(s(2)))], [a,b,c], F)).

%   mailed(+Clauses, +Messages, -Facts): of an agent that has been sent
%   messages and has no goals left.

mailed(Clauses, Messages, Facts) :-
    (   member((on_message(_, _):-_), Clauses)
    ->  All = Clauses
    ;   All = [on_message(_, _)|Clauses]
    ),
    create(All, Agent),
    wait_until(( state_of(Agent, S), memberchk(S, [waiting,resident]) ), 10),
    maplist(agent_send(Agent), Messages),
    wait_until(at_rest(Agent), 10),
    agent_property(Agent, facts(Facts)),
    agent_dispose(Agent),
    joined(Agent, _).

at_rest(Agent) :-
    state_of(Agent, resident),
    typhon_mailbox:mail_list(Agent, []).

:- end_tests(waiting).

:- begin_tests(end).

test(dispose, O == disposed) :-
    ends([(main :- dispose, throw(never))], O, []).
test(dispose_in_a_handler, O == disposed) :-
    with_hosts([alpha],
               ( create([(on_message(_, _) :- dispose)], A),
                 agent_send(A, x),
                 joined(A, O) )).
test(raised_term_is_kept, true(O-S-M = raised(oops)-faulty(oops)
                               -[error-typhon(faulty(A, oops, _))])) :-
    with_hosts([alpha],
               capturing(( create([s(1), (main :- throw(oops))], A),
                           joined(A, O),
                           agent_property(A, state(S)),
                           agent_property(A, facts([s(1)])) ), M)).
test(raised_error, true(O = raised(error(type_error(evaluable, _), _)))) :-
    ends([(main :- _ is foo+1)], O, _).
test(raised_term_that_cannot_travel, true(O = raised(_))) :-
    ends([(main :- current_output(S), throw(S))], O, _).
test(faulty_agent_takes_no_capacity, L == 0) :-
    with_hosts([alpha],
               capturing(( create([(main :- throw(oops))], A),
                           joined(A, _),
                           host_property(alpha, load(L)) ), _)).
test(faulty_agent_can_be_disposed_of, O == raised(oops)) :-
    with_hosts([alpha],
               capturing(( create([(main :- throw(oops))], A),
                           joined(A, _),
                           agent_dispose(A),
                           gone(A),
                           joined(A, O),
                           host_property(alpha, load(0)) ), _)).
test(faulty_agents_are_bounded, N == 3) :-
    with_settings([typhon_creation:faulty=3],
        with_hosts([alpha],
                   capturing(( findall(A, ( between(1, 10, _),
                                            create([(main :- throw(x))], A) ),
                                       As),
                               maplist(joined, As, _),
                               wait_until(faulty(3), 5),
                               faulty(N) ), _))).

faulty(N) :-
    findall(A, agent_property(A, state(faulty(_))), As),
    length(As, N).

test(outcome_of_a_discarded_agent, O == done) :-
    with_hosts([alpha],
               ( create([main], A),
                 wait_until(gone(A), 10),
                 joined(A, O) )).
test(join_twice, Os == [done,done]) :-
    with_hosts([alpha],
               ( create([(main :- receive(_))], A),
                 findall(T, ( between(1, 2, _),
                              thread_create(( agent_join(A, O, 10),
                                              thread_exit(O) ), T) ), Ts),
                 agent_send(A, go),
                 findall(O, ( member(T, Ts), thread_join(T, exited(O)) ),
                         Os) )).
test(join_times_out, true(S >= 0.1)) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 elapsed(agent_join(A, O, 0.1), S),
                 assertion(O == timeout) )).
test(join_without_waiting, O == timeout) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A), agent_join(A, O, 0) )).
test(join_without_a_timeout, O == disposed) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 thread_create(( agent_join(A, O0, inf),
                                 thread_exit(O0) ), T),
                 agent_dispose(A),
                 thread_join(T, exited(O)) )).
test(join_after_it_moved, O == done) :-
    ends([(main :- move(beta), sleep(0.05))], O, []).
test(join_unknown_agent,
     error(existence_error(agent, 'x.1@alpha@127.0.0.1:1'))) :-
    with_hosts([alpha-[]],
               ( address(alpha, Address),
                 atom_concat('x.1@', Address, Id),
                 catch(agent_join(Id, _, 10), error(existence_error(agent, Id), _),
                       throw(error(existence_error(agent,
                                       'x.1@alpha@127.0.0.1:1'), _))) )).
test(join_of_an_invalid_id, error(existence_error(agent, foo))) :-
    with_hosts([alpha], agent_join(foo, _, 10)).
test(join_of_an_unbound_id, error(instantiation_error)) :-
    agent_join(_, _, 10).
test(join_with_an_invalid_timeout, error(type_error(number, soon))) :-
    with_hosts([alpha], ( create([main], A), agent_join(A, _, soon) )).
test(timeout_is_checked_before_the_agent,
     [ forall(member(Goal, [ agent_join(foo, _, soon),
                             agent_join(family(foo), _, soon),
                             agent_result(foo, _, soon) ])),
       error(type_error(number, soon)) ]) :-
    call(Goal).
test(join_for_an_infinite_float, O == disposed) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 agent_dispose(A),
                 Timeout is inf,
                 agent_join(A, O, Timeout) )).
test(join_when_the_host_stops, O == disposed) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 thread_create(( agent_join(A, O0, 10),
                                 thread_exit(O0) ), T),
                 host_stop(alpha),
                 thread_join(T, exited(O)) )).
test(join_after_the_host_stopped, O == disposed) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A), host_stop(alpha) )),
    agent_join(A, O, 10).

:- end_tests(end).

                /*******************************
                *      ORDERS FROM OUTSIDE     *
                *******************************/

%   An agent in each state, and the goal that brings it there.

in_state(running, [(main :- receive(_-go), busy(200 000), receive(_-stop)),
                   (busy(N) :- N =< 0, !),
                   (busy(N) :- N1 is N-1, busy(N1))], go).
in_state(looping, [(main :- ( receive(_-stop, 0) -> true ; main ))], none).
in_state(sleeping, [(main :- sleep(1000))], none).
in_state(waiting, [(main :- receive(_-stop))], none).
in_state(waiting, [(main :- receive(_-stop, 1000))], none).
in_state(resident, [(on_message(_, stop) :- dispose)], none).

ready_for_orders(State, Agent) :-
    in_state(State, Clauses, First),
    create(Clauses, Agent),
    (   memberchk(State, [sleeping,waiting,resident])
    ->  wait_state(Agent, State)
    ;   State == running
    ->  wait_state(Agent, waiting),
        agent_send(Agent, First)
    ;   true
    ).

:- begin_tests(orders).

test(dispose, [forall(in_state(State, _, _)), O == disposed]) :-
    with_hosts([alpha],
               ( ready_for_orders(State, A),
                 agent_dispose(A),
                 joined(A, O),
                 gone(A),
                 wait_until(host_property(alpha, load(0)), 5) )).
test(late_answer_leaves_no_message, Left == 0) :-
    with_hosts([alpha],
               ( create([(main :- leave(begun), shell('sleep 0.5')),
                         on_message(_, _)], A),
                 wait_until(remote(alpha, sense(begun)), 5),
                 catch(typhon_questions:agent_ask(A, order(clone), 0.1, _),
                       error(timeout_error(order, A), _),
                       true),
                 wait_until(host_property(alpha, load(2)), 5),
                 wait_until(forall(agent_property(_, state(S)),
                                   S == resident), 5),
                 thread_self(Me),
                 message_queue_property(Me, size(Left)) )).
test(dispose_in_flight, O == disposed) :-
    with_hosts([alpha-[hop_time(uniform(1000, 1001))],beta],
               ( create([(main :- move(beta))], A),
                 wait_state(A, in_transit),
                 agent_dispose(A),
                 joined(A, O) )).
test(move, [forall(in_state(State, _, _)), true(H == B)]) :-
    with_hosts([alpha,beta],
               ( address(beta, B),
                 ready_for_orders(State, A),
                 agent_move(A, beta),
                 wait_until(agent_property(A, host(B)), 10),
                 agent_property(A, host(H)),
                 wait_until(host_property(alpha, load(0)), 5) )).
test(clone, [forall(in_state(State, _, _)), true(O1-O2 == disposed-disposed)]) :-
    with_hosts([alpha],
               ( ready_for_orders(State, A),
                 agent_clone(A, C),
                 agent_dispose(A),
                 agent_dispose(C),
                 joined(A, O1),
                 joined(C, O2) )).
test(attach_and_detach, [forall(in_state(State, _, _)), P1-P2 == [seven]-[]]) :-
    with_hosts([alpha],
               ( ready_for_orders(State, A),
                 payload_attach(A, payload(seven, [p/1], [p(7)])),
                 agent_property(A, payloads(P1)),
                 payload_detach(A, seven),
                 agent_property(A, payloads(P2)) )).
test(agent_continues_after_a_move_order,
     [forall(member(State, [looping,waiting])),
      O == done]) :-
    with_hosts([alpha,beta],
               ( ready_for_orders(State, A),
                 agent_move(A, beta),
                 agent_send(A, stop),
                 joined(A, O) )).
test(sleep_continues_after_a_move_order, O-T == done-200.0) :-
    with_hosts([alpha-[clock(virtual)], beta-[clock(virtual)]],
               ( create([(main :- sleep(200))], A),
                 agent_join(A, timeout, 100),
                 agent_move(A, beta),
                 agent_join(A, O, 1000),
                 remote(beta, now(T)) )).
test(move_of_a_static_agent,
     true(M = [warning-typhon(order_failed(_, permission_error(move, _, _)))])) :-
    with_hosts([alpha,beta],
               capturing(( create([on_message(_, _)], A, [static(true)]),
                           agent_move(A, beta),
                           payload_attach(A, payload(x, [], [])) ), M)).
test(move_that_is_refused,
     true(M = [warning-typhon(order_failed(_, move_refused(_, capacity)))])) :-
    with_hosts([alpha,beta-[capacity(0)]],
               capturing(( create([on_message(_, _)], A),
                           agent_move(A, beta),
                           payload_attach(A, payload(x, [], [])),
                           wait_state(A, resident) ), M)).
test(move_to_a_missing_host, error(existence_error(host, nowhere))) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A), agent_move(A, nowhere) )).
test(order_to_unknown_agent,
     [forall(member(Order, [agent_dispose(foo), agent_clone(foo, _),
                            agent_move(foo, alpha),
                            agent_save(foo, '/nowhere/x'),
                            payload_detach(foo, x)])),
      error(existence_error(agent, foo))]) :-
    with_hosts([alpha], Order).
test(order_to_an_ended_agent, error(existence_error(agent, _))) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, done), agent_dispose(A) )).
test(order_to_an_unbound_id, error(instantiation_error)) :-
    with_hosts([alpha], agent_dispose(_)).
test(orders_are_executed_in_sequence, Ps == [p5,p4,p3,p2,p1]) :-
    with_hosts([alpha],
               ( create([(main :- ( receive(_-stop, 0) -> true ; main ))], A),
                 forall(member(P, [p1,p2,p3,p4,p5]),
                        payload_attach(A, payload(P, [], []))),
                 agent_property(A, payloads(Ps)) )).
test(hopping_agent_takes_orders, O == disposed) :-
    with_hosts([alpha,beta],
               ( create([(main :- move(beta), move(alpha), main)], A),
                 forall(between(1, 20, N),
                        ( atom_concat(p, N, P),
                          payload_attach(A, payload(P, [], [])),
                          payload_detach(A, P) )),
                 agent_dispose(A),
                 joined(A, O) )).
test(order_is_taken_before_a_message, true(H == B)) :-
    setup_call_cleanup(
        message_queue_create(Queue, [alias(test_agent)]),
        with_hosts([alpha,beta],
                   ( address(beta, B),
                     create([ (on_message(_, wait) :-
                                   thread_send_message(test_agent, begun),
                                   thread_get_message(test_agent, go)),
                              (on_message(_, ask) :- here(X), assertz(s(X))) ],
                            A, [host(alpha)]),
                     maplist(agent_send(A), [wait,ask]),
                     thread_get_message(Queue, begun),
                     agent_move(A, beta),
                     thread_send_message(Queue, go),
                     wait_until(fact_of(A, s(H)), 10) )),
        message_queue_destroy(Queue)).

:- end_tests(orders).

:- begin_tests(agent_property).

test(all, true(Ps =@= [ facts([s(1)]), goals([receive(_-go),foo]), home(A),
                       hops(1), host(B), mailbox([]), payloads([x]),
                       program(test), state(waiting) ])) :-
    with_hosts([alpha,beta],
               ( address(alpha, A), address(beta, B),
                 create([s(1), foo, (main :- move(beta), receive(_-go), foo)],
                        Agent, [payloads([payload(x, [], [])])]),
                 wait_state(Agent, waiting),
                 findall(P, agent_property(Agent, P), Ps0),
                 sort(Ps0, Ps) )).
test(host_and_home_by_name, As-Bs == [A]-Both) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _)], A),
                 create([on_message(_, _)], B),
                 agent_move(B, beta),
                 wait_until(agent_property(B, host(beta)), 10),
                 findall(X, agent_property(X, host(alpha)), As),
                 findall(X, agent_property(X, home(alpha)), Bs0),
                 sort(Bs0, Bs),
                 sort([A,B], Both) )).
test(unknown, [fail]) :-
    with_hosts([alpha],
               ( address(alpha, Address),
                 atom_concat('x.1@', Address, A),
                 agent_property(A, _) )).
test(unknown_agent_of_a_missing_process,
     error(host_unreachable('127.0.0.1:1'))) :-
    with_hosts([alpha], agent_property('x.1@alpha@127.0.0.1:1', _)).
test(invalid_id, error(existence_error(agent, foo))) :-
    with_hosts([alpha], agent_property(foo, _)).
test(id_is_no_atom, error(type_error(atom, 12))) :-
    with_hosts([alpha], agent_property(12, _)).
test(ended, [fail]) :-
    with_hosts([alpha],
               ( create([main], A), joined(A, _), agent_property(A, _) )).
test(all_agents, true(As == [A1,A2])) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _)], B1),
                 create([on_message(_, _)], B2, [host(beta)]),
                 sort([B1,B2], [A1,A2]),
                 findall(A, agent_property(A, program(test)), As0),
                 sort(As0, As) )).
test(in_flight, S-G == in_transit-[foo]) :-
    with_hosts([alpha-[hop_time(uniform(1000,1001))],beta],
               ( create([foo, (main :- move(beta), foo)], A),
                 wait_state(A, in_transit),
                 agent_property(A, state(S)),
                 agent_property(A, goals(G)) )).
test(running, S == running) :-
    with_hosts([alpha],
               ( create([(main :- take(stop), !), (main :- main)], A),
                 agent_property(A, state(S)),
                 remote(alpha, leave(stop)),
                 joined(A, done) )).
test(hopping_agent_always_has_a_host, N == 2000) :-
    with_hosts([alpha,beta],
               ( create([(main :- move(beta), move(alpha), main)], A),
                 aggregate_all(count,
                               ( between(1, 2000, _),
                                 once(agent_property(A, host(_))) ), N),
                 agent_dispose(A),
                 joined(A, disposed) )).

:- end_tests(agent_property).

                /*******************************
                *           PAYLOADS           *
                *******************************/

payload(tools, payload(tools, [p/1,q/1], [p(1),p(2),(q(X):-p(X),X>1)])).

payload_file(Goal) :-
    with_tmp_dir(test_agent:payload_in(Goal)).

payload_in(Goal, Dir) :-
    directory_file_path(Dir, 'tools.pl', File),
    write_file(File, ':- payload(tools, [provides([p/1])]).~n\c
                      p(1).~np(2).~nq(X) :- p(X), X > 1.~n', []),
    call(Goal, File).

:- begin_tests(payloads).

test(payloads_at_creation, F == [s(2),s([tools])]) :-
    payload_file(plunit_payloads:at_birth(F)).

at_birth(F, File) :-
    with_hosts([alpha],
               ( create([on_message(_, _), (main :- q(X), assertz(s(X)))], A,
                        [payloads([File])]),
                 wait_state(A, resident),
                 agent_property(A, payloads(Ps)),
                 findall(s(X), fact_of(A, s(X)), F0),
                 append(F0, [s(Ps)], F) )).

test(attached_by_the_agent, F == [s(2)]) :-
    payload_file(plunit_payloads:attached(F)).

attached(F, File) :-
    with_hosts([alpha,beta],
               ( create([on_message(_, _),
                         (main :- r(File), attach(File), move(beta), q(X),
                                  assertz(s(X)), detach(tools),
                                  catch(q(_), error(existence_error(_, _), _),
                                        true))], A,
                        [facts([r(File)])]),
                 wait_state(A, resident),
                 agent_property(A, payloads([])),
                 findall(s(X), fact_of(A, s(X)), F) )).

test(provided_but_undefined_is_empty, F == [s(none)]) :-
    lives([(main :- ( p(_) -> true ; assertz(s(none)) ))],
          [payloads([payload(x, [p/1], [])])], F).
test(payload_may_move_the_agent, F == [s(beta)]) :-
    lives([ (main :- trip, name(N), assertz(s(N))),
            (name(N) :- here(A), atomic_list_concat([N,_], @, A)) ],
          [payloads([payload(trip, [trip/0], [(trip:-move(beta))])])], F0),
    include([s(_)]>>true, F0, F).
test(attached_payload_may_move_the_agent, F == [s(beta)]) :-
    lives([ (main :- r(P), attach(P), trip, name(N), assertz(s(N)),
                     detach(trip), retract(r(_))),
            (name(N) :- here(A), atomic_list_concat([N,_], @, A)) ],
          [facts([r(payload(trip, [trip/0], [(trip:-move(beta))]))])], F).
test(attach_cannot_redefine_the_program,
     true(F = [s(permission_error(attach, procedure,
                                  main/0))])) :-
    lives([(main :- P = payload(x, [main/0], [main]),
                    catch(attach(P), error(E, _), assertz(s(E))))], F).
test(attach_twice, true(F = [s(permission_error(attach, procedure, p/1))])) :-
    lives([(main :- P = payload(x, [p/1], [p(1)]), attach(P),
                    catch(attach(P), error(E, _), assertz(s(E))),
                    detach(x))], F).
test(attach_another_payload_of_the_same_name,
     [ forall(member(Options, [[payloads([P, Q])], [payloads([P])]])),
       error(permission_error(attach, payload, x)) ]) :-
    P = payload(x, [p/1], [p(1)]),
    Q = payload(x, [q/1], [q(1)]),
    with_hosts([alpha],
               ( create([on_message(_, _)], A, Options),
                 payload_attach(A, Q) )).
test(provided_twice_at_creation,
     [ forall(member(Name/PI, [y/(p/1), y/(s/1)])),
       error(permission_error(attach, procedure, PI)) ]) :-
    PI = P/1,
    Head =.. [P, 2],
    with_hosts([alpha],
               create([on_message(_, _)], _,
                      [payloads([ payload(x, [p/1], [p(1)]),
                                  payload(Name, [PI], [Head]) ])])).
test(agent_is_checked_before_the_payload_is_read,
     [ forall(member(Agent-Error, [ _-instantiation_error,
                                    1-type_error(atom, 1),
                                    foo-existence_error(agent, foo) ])),
       error(Error) ]) :-
    payload_attach(Agent, no_such_file).
test(payload_of_the_wrong_type,
     [ forall(member(Payload-Error,
                     [ payload(x, _, [])-instantiation_error,
                       payload(x, p, [])-type_error(list, p),
                       payload(x, [p], [])-type_error(predicate_indicator, p),
                       payload(x, [], p)-type_error(list, p),
                       clauses([ (:- payload(x, [provides(p)])) ])
                       -domain_error(payload_declaration, provides(p)) ])),
       error(Error) ]) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 payload_attach(A, Payload) )).
test(detach_a_missing_payload,
     true(F = [s(existence_error(payload, x))])) :-
    lives([(main :- catch(detach(x), error(E, _), assertz(s(E))))], F).
test(detach_order_for_a_missing_payload,
     error(existence_error(payload, x))) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A), payload_detach(A, x) )).
test(attach_order_for_an_attached_payload,
     error(permission_error(attach, procedure, s/1))) :-
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 payload_attach(A, payload(x, [s/1], [])) )).
test(deliver, F == [s(2),s(remote(2))]) :-
    payload(tools, P),
    with_hosts([alpha,beta],
               ( create([on_message(_, _),
                         (main :- move(beta), deliver(tools))], A,
                        [payloads([P])]),
                 wait_state(A, resident),
                 create([on_message(_, _), (main :- q(X), assertz(s(X)))], B,
                        [host(beta)]),
                 wait_state(B, resident),
                 agent_property(B, facts(F0)),
                 remote(beta, q(X)),
                 append(F0, [s(remote(X))], F) )).
test(undeliver, error(existence_error(procedure, _))) :-
    payload(tools, P),
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- deliver(tools), undeliver(tools))], A,
                        [payloads([P])]),
                 wait_state(A, resident),
                 remote(alpha, q(_)) )).
test(deliver_again, X == 9) :-
    with_hosts([alpha],
               ( forall(member(N, [1,9]),
                        ( create([(main :- deliver(x))], A,
                                 [payloads([payload(x, [p/1], [p(N)])])]),
                          joined(A, done) )),
                 remote(alpha, findall(Y, p(Y), [X])) )).
test(deliver_an_unattached_payload,
     true(F = [s(existence_error(payload, x))])) :-
    lives([(main :- catch(deliver(x), error(E, _), assertz(s(E))))], F).
test(undeliver_a_missing_payload,
     true(F = [s(existence_error(payload, x))])) :-
    lives([(main :- catch(undeliver(x), error(E, _), assertz(s(E))))], F).
test(payload_must_be_bound,
     [ forall(member(Goal, [detach(X), deliver(X), undeliver(X)])),
       F == [s(instantiation_error)] ]) :-
    lives([(main :- catch(Goal, error(E, _), assertz(s(E))))], F).
test(deliver_over_another_payload,
     true(F = [s(permission_error(deliver, procedure, p/1))])) :-
    with_hosts([alpha],
               ( create([(main :- deliver(x))], A,
                        [payloads([payload(x, [p/1], [p(1)])])]),
                 joined(A, done),
                 create([on_message(_, _),
                         (main :- catch(deliver(y), error(E, _),
                                        assertz(s(E))))], B,
                        [payloads([payload(y, [p/1], [p(2)])])]),
                 wait_state(B, resident),
                 findall(s(X), fact_of(B, s(X)), F) )).
test(goal_in_a_place_cannot_move_agents,
     true(F = [s(permission_error(call, control_predicate, move/1))])) :-
    with_hosts([alpha,beta],
               ( create([(main :- deliver(x))], A,
                        [payloads([payload(x, [trip/0],
                                           [(trip:-move(beta))])])]),
                 joined(A, done),
                 lives_([(main :- catch(trip, error(E, _), assertz(s(E))))],
                        [], F) )).
test(no_agent_stops_inside_a_native_goal,
     [ forall(member(Goal, [ move(beta), clone(_), clone(beta, _), sleep(0.1),
                             receive(_), receive(_, 0), dispose ])),
       true(F == [s(permission_error(call, control_predicate, PI))]) ]) :-
    functor(Goal, Name, Arity),
    PI = Name/Arity,
    lives([(main :- G = Goal, catch(findall(x, G, _), error(E, _), true),
                    assertz(s(E)))], F).
test(missing_file, error(existence_error(source_sink, nothing))) :-
    with_hosts([alpha], create([main], _, [payloads([nothing])])).

:- end_tests(payloads).

                /*******************************
                *        RESTORE POINTS        *
                *******************************/

%   saved(+Clauses, +Options, +Seen, -Facts): Facts of the agent that is loaded
%   from the restore point of a waiting agent, after it has got `go`.

saved(Clauses, Options, Facts) :-
    with_tmp_dir(test_agent:saved_in(Clauses, Options, Facts)).

saved_in(Clauses, Options, Facts, Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha,beta],
               ( create([on_message(_, _)|Clauses], A, Options),
                 wait_state(A, waiting),
                 agent_save(A, File),
                 agent_dispose(A) )),
    with_hosts([gamma],
               ( agent_load(File, B),
                 agent_send(B, go),
                 wait_state(B, resident),
                 facts(B, Facts) )).

:- begin_tests(restore_points).

test(restored_agent_continues_at_its_goal, F == [s(1),s(2)]) :-
    saved([(main :- assertz(s(1)), receive(_-go), assertz(s(2)))], [], F).
test(bindings_of_the_goals_are_restored, true(F =@= [s(f(X,X,"a string"))])) :-
    saved([(main :- Y = f(A,A,"a string"), receive(_-go), assertz(s(Y)))],
          [], F).
test(terms_of_all_kinds, true(F == Terms)) :-
    Big is 7**77, Inf is inf, Nan is nan, MZero is -0.0,
    findall(s(T), member(T, [ Big, Inf, Nan, MZero, 0.1, 1r3, "a \"string\"\n",
                              'an atom\\', [], '[]', {}, (:-), {a,b},
                              `codes`, 'γεια', - 1, -(1), 1-2, -(-(1)),
                              [a|b], \+a, (a:-b,c;d->e), 'hello world'(1),
                              '$VAR'(1), "", '' ]), Terms),
    saved([(main :- receive(_-go))], [facts(Terms)], F).
test(operators_do_not_affect_the_file, F == [s(likes(a,b))]) :-
    setup_call_cleanup(
        op(700, xfx, user:likes),
        saved([(main :- receive(_-go))], [facts([s(likes(a,b))])], F),
        op(0, xfx, user:likes)).
test(payloads, F == [s(7)]) :-
    saved([(main :- receive(_-go), p(X), assertz(s(X)), detach(seven))],
          [payloads([payload(seven, [p/1], [p(7)])])], F).
test(mail, F == [s(early)]) :-
    with_tmp_dir(plunit_restore_points:mail_in(F)).

mail_in(F, Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha],
               ( create([on_message(_, _),
                         (main :- receive(_-go),
                                  ( receive(_-X, 0) -> assertz(s(X))
                                  ; assertz(s(none)) ))], A),
                 wait_state(A, waiting),
                 agent_send(A, early),
                 agent_save(A, File),
                 agent_load(File, B),
                 agent_send(B, go),
                 wait_state(B, resident),
                 agent_property(B, facts(F)) )).

%   The agent wakes at once, since its time is over.

test(mail_is_restored_before_the_agent_runs, F == [s(early)]) :-
    with_tmp_dir(plunit_restore_points:mail_before(F)).

mail_before(F, Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha, beta-[clock(-2000, 1)]],
               ( create([on_message(_, _),
                         (main :- sleep(1000),
                                  ( receive(_-X, 0) -> assertz(s(X))
                                  ; assertz(s(none)) ))], A),
                 wait_state(A, sleeping),
                 agent_send(A, early),
                 agent_save(A, File),
                 agent_load(File, B, [host(beta)]),
                 wait_state(B, resident),
                 agent_property(B, facts(F)) )).

test(restored_agent_has_a_new_id, true((A \== B, N == test))) :-
    with_tmp_dir(plunit_restore_points:ids(A, B)),
    atomic_list_concat([N|_], '.', B).

ids(A, B, Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha],
               ( create([on_message(_, _)], A),
                 agent_save(A, File),
                 agent_load(File, B) )).

test(restore_point_is_readable_text,
     true(memberchk("goals([receive(_-go),foo]).", Lines))) :-
    with_tmp_dir(plunit_restore_points:text(Lines0)),
    maplist([L,M]>>( re_plain(L, M) ), Lines0, Lines).

text(Lines, Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha],
               ( create([foo, (main :- receive(_-go), foo)], A),
                 wait_state(A, waiting),
                 agent_save(A, File) )),
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", " ", Lines).

%   without the names of variables, and blanks

re_plain(Line, Plain) :-
    (   catch(term_string(T, Line), error(_, _), fail)
    ->  format(string(Plain0), '~W.', [T, [quoted(true), variable_names([])]]),
        split_string(Plain0, "", "", [Plain1]),
        string_codes(Plain1, Cs0),
        no_numbers(Cs0, Cs),
        string_codes(Plain, Cs)
    ;   Plain = Line
    ).

no_numbers([], []).
no_numbers([0'_|T0], [0'_|T]) :-
    !,
    digits(T0, T1),
    no_numbers(T1, T).
no_numbers([C|T0], [C|T]) :-
    no_numbers(T0, T).

digits([C|T0], T) :- code_type(C, alnum), !, digits(T0, T).
digits(T, T).

test(foreign_file, error(domain_error(restore_point, _))) :-
    with_tmp_dir(plunit_restore_points:foreign).

foreign(Dir) :-
    directory_file_path(Dir, point, File),
    write_file(File, 'foo.~n', []),
    with_hosts([alpha], agent_load(File, _)).

test(no_file, error(existence_error(source_sink, _))) :-
    with_hosts([alpha], agent_load('/nowhere/at/all', _)).
test(state_that_cannot_be_saved, error(type_error(mobile_term, _))) :-
    with_tmp_dir(plunit_restore_points:unsaved).

unsaved(Dir) :-
    directory_file_path(Dir, point, File),
    with_hosts([alpha],
               ( create([(main :- current_output(S), receive(_-go),
                                  write(S, x))], A),
                 wait_state(A, waiting),
                 agent_save(A, File) )).

:- end_tests(restore_points).
