:- module(test_within, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/wire),
              [endpoint_address/1, endpoint_call/5]).

/** <module> Agents hop between hosts of one process

*Threading*: tests run one at a time.
*/

%   going(+Hosts, +Clauses, -Agent, :Goal): Goal is called when Agent, which is
%   created on the first of Hosts, has no goals left.

:- meta_predicate going(+, +, -, 0).

going(Hosts, Clauses, Agent, Goal) :-
    with_hosts(Hosts, ( create([on_message(_, _)|Clauses], Agent),
                        wait_state(Agent, resident),
                        call(Goal) )).

:- begin_tests(hops_within_a_process).

test(agent_is_on_one_host_only, true(Loads-In-Out == [0,1]-1-1)) :-
    going([alpha,beta], [(main :- move(beta))], _,
          ( maplist(load, [alpha,beta], Loads),
            host_property(beta, hop_time(in, stats(In, _, _, _))),
            host_property(alpha, hop_time(out, stats(Out, _, _, _))) )).
test(refused_agent_takes_no_capacity, true(Loads == [1,0])) :-
    going([alpha,beta-[tokens([red])]], [(main :- catch(move(beta), _, true))],
          _, maplist(load, [alpha,beta], Loads)).
test(refusal_after_the_hop_delay_is_an_error_of_the_move,
     true(F-Warnings = [s(move_refused(_, capacity))]-[])) :-
    capturing(going([ alpha-[hop_time(uniform(0.01, 0.02))],
                      beta-[capacity(0)] ],
                    [ (main :- catch(move(beta), error(E, _), assertz(s(E)))) ],
                    A, facts(A, F)), Warnings).
test(orders_reach_the_agent_on_any_host, true(Loads == [0,0,0])) :-
    with_hosts([alpha,beta,gamma],
               ( findall(A, ( between(1, 30, _), walker(A) ), Agents),
                 numlist(1, 20, Numbers),
                 forall(( member(N, Numbers), member(A, Agents) ),
                        agent_send(A, N)),
                 maplist(received_numbers(Numbers), Agents),
                 maplist(agent_dispose, Agents),
                 maplist(joined_as(disposed), Agents),
                 maplist(load, [alpha,beta,gamma], Loads) )).

test(services_are_those_of_the_new_place, true(F == [s(a),s(b)])) :-
    lamp(within_a, a),
    lamp(within_b, b),
    going([ alpha-[services([within_a])], beta-[services([within_b])] ],
          [ (main :- assertz((look(X) :- light(X))), see, move(beta), see),
            (see :- forall(look(X), assertz(s(X)))) ],
          A, findall(s(X), fact_of(A, s(X)), F)).
test(place_facts_do_not_travel, true(At == beta)) :-
    with_tmp_dir(device(At)).
test(arrival_is_visible_at_once, true(Answer == answer(true))) :-
    going([alpha,beta], [(main :- move(beta))], A,
          reached_as_it_goes(A, Answer)).
test(static_predicate_stays_behind, true(F == [s(gone)])) :-
    going([alpha,beta],
          [ (main :- assertz(kept(1)), compile_predicates([kept/1]),
                     move(beta), catch(kept(_), _, assertz(s(gone)))) ],
          A, facts(A, F)).
test(predicate_made_static_after_a_hop_stays_behind, true(F == [s(gone)])) :-
    going([alpha,beta],
          [ (main :- assertz(kept(1)), move(beta), compile_predicates([kept/1]),
                     move(alpha), catch(kept(_), _, assertz(s(gone)))) ],
          A, facts(A, F)).
test(changed_host_is_known_by_its_name_and_by_its_address,
     true(F = [s(move_refused(_, token)),s(move_refused(_, token))])) :-
    with_hosts([alpha,beta],
               ( host_property(beta, address(Beta)),
                 create([ (main :- move(Beta), move(alpha), receive(_-change),
                                   try(Beta), try(beta)),
                          (try(H) :- catch(move(H), error(E, _),
                                           assertz(s(E)))),
                          on_message(_, _) ], A),
                 wait_state(A, waiting),
                 host_change(beta, tokens([red])),
                 agent_send(A, change),
                 wait_state(A, resident),
                 facts(A, F) )).
test(order_that_cannot_be_executed, true(At-Ended == alpha-disposed)) :-
    going([alpha-[hop_time(uniform(0.01, 0.02))],beta],
          [ (main :- current_output(S), assertz(s(S))) ], A,
          ( Told = typhon(order_failed(A, _)),
            capturing(( agent_move(A, beta),
                        wait_until(was_printed(warning, Told), 5) ), _),
            wait_state(A, resident),
            stands(A, At),
            agent_dispose(A),
            joined(A, Ended) )).

device(At, Dir) :-
    atom_concat(Dir, '/place.pl', File),
    write_file(File, ':- dynamic device/1.~n\c
  :- current_output(S), assertz(device(S)).~n', []),
    going([alpha-[consult(File)],beta-[consult(File)]],
          [ (main :- assertz((look(ok) :- device(_))), look(_), move(beta)) ],
          A, stands(A, At)).

:- end_tests(hops_within_a_process).

%   The answer of the home of A, at the moment when its record is removed, to a
%   process that asks whether A had arrived with its first hop.

reached_as_it_goes(A, Answer) :-
    thread_self(Me),
    setup_call_cleanup(
        wrap_predicate(typhon_agents:agent_remove(Id, _), asked, Removed,
                       ( Removed, test_within:reached_now(Id, Me) )),
        ( agent_dispose(A),
          thread_get_message(Me, said(Answer), [timeout(30)]) ),
        unwrap_predicate(typhon_agents:agent_remove/2, asked)).

:- public reached_now/2.

reached_now(Id, Caller) :-
    endpoint_address(Home),
    endpoint_call(Home, whereabouts, reached(Id, 1), Answer, 20),
    thread_send_message(Caller, said(Answer)).

stands(Agent, Name) :-
    agent_property(Agent, host(Address)),
    atomic_list_concat([Name|_], @, Address).

lamp(Module, Light) :-
    retractall(Module:light(_)),
    assertz(Module:light(Light)),
    Module:export(Module:light/1).

load(Host, Load) :-
    host_property(Host, load(Load)).

%   The agent goes round until it is ended, and keeps its messages in order.

walker(A) :-
    create([ (main :- move(beta), hear, move(gamma), hear, move(alpha), hear,
                      main),
             (hear :- ( receive(_-M, 0)
                      -> assertz(s(M)), hear
                      ;  true )) ], A).

received_numbers(Numbers, Agent) :-
    wait_until(( agent_property(Agent, facts(Facts)),
                 findall(N, member(s(N), Facts), Heard),
                 Heard == Numbers ), 20).

joined_as(Outcome, Agent) :-
    joined(Agent, Outcome).
