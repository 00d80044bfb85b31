:- module(test_named, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(filesex)).
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Agents by names that are given at creation

*/

bob(Agent) :-
    bob(Agent, []).

bob(Agent, Options) :-
    agent_create(clauses([ (:- agent(bob, [state([got/1])])),
                           (on_message(_, X) :- assertz(got(X))) ]),
                 Agent, Options),
    wait_state(Agent, resident).

%   The message crash leaves a faulty agent.

replaced :-
    Program = clauses([ (:- agent(bob, [state([got/1])])),
                        (on_message(_, crash) :- throw(crash)),
                        (on_message(_, X) :- assertz(got(X))) ]),
    agent_create(Program, First, [name(bob), host(alpha)]),
    agent_send(bob, crash),
    wait_state(First, faulty(_)),
    agent_create(Program, Second, [name(bob), host(beta)]),
    agent_send(bob, hello),
    wait_until(fact_of(Second, got(hello)), 5),
    assertion(agent_property(bob, facts([got(hello)]))),
    assertion(agent_property(First, state(faulty(_)))),
    agent_move(bob, alpha, [wait(5)]),
    address(alpha, Alpha),
    assertion(agent_property(Second, host(Alpha))),
    agent_dispose(bob),
    assertion(agent_join(Second, disposed, 5)).

supervised :-
    Worker = clauses([ (:- agent(worker, [state([got/1])])),
                       (on_message(_, crash) :- throw(crash)),
                       (on_message(_, X) :- assertz(got(X))) ]),
    agent_create(agents(supervisor), Supervisor,
                 [ host(alpha),
                   facts([child(worker, Worker, []), intensity(9, 1)]) ]),
    wait_until(( called(worker, One), state_of(One, resident) ), 10),
    forall(between(1, 3, _),
           ( findall(Id, called(worker, Id), Before),
             agent_send(worker, crash),
             wait_until(( called(worker, New), \+ memberchk(New, Before),
                          state_of(New, resident) ), 10) )),
    agent_send(worker, hello),
    wait_until(agent_property(worker, facts([got(hello)])), 5),
    with_output_to(string(Listing), agent_listing(worker)),
    assertion(sub_string(Listing, _, _, _, "got(hello)")),
    agent_send(Supervisor, stop),
    assertion(agent_join(Supervisor, done, 10)).

called(Name, Id) :-
    agent_property(Id, home(_)),
    atom_concat(Name, '.', Begin),
    sub_atom(Id, 0, _, _, Begin).

:- begin_tests(names).

test(unique_name_is_accepted) :-
    with_hosts([alpha, beta],
               ( bob(Id),
                 agent_send(bob, hello),
                 wait_until(fact_of(Id, got(hello)), 5),
                 agent_move(bob, beta),
                 address(beta, Beta),
                 wait_until(agent_property(bob, host(Beta)), 5),
                 agent_send(at(bob, beta), again),
                 wait_until(fact_of(Id, got(again)), 5),
                 agent_dispose(bob),
                 agent_join(bob, Outcome, 5),
                 assertion(Outcome == disposed) )).
test(names_for_restore_points_and_payloads) :-
    with_tmp_dir(saved).

saved(Dir) :-
    directory_file_path(Dir, bob, File),
    with_hosts([alpha],
               ( bob(Id),
                 agent_save(bob, File),
                 payload_attach(bob, clauses([ (:- payload(p, [provides([q/1])])),
                                               q(1) ])),
                 agent_property(Id, payloads([p])),
                 payload_detach(bob, p),
                 agent_dispose(bob),
                 agent_join(Id, disposed, 5),
                 agent_load(File, Again),
                 agent_property(bob, home(_)),
                 agent_dispose(Again) )).

test(last_ended_agent_of_the_name) :-
    with_hosts([alpha],
               ( bob(A), agent_dispose(A), agent_join(A, _, 5),
                 create([main], B, [name(bob)]), agent_join(B, _, 5),
                 agent_join(bob, Outcome, 5),
                 assertion(Outcome == done) )).
test(ambiguous_name_lists_both) :-
    with_hosts([alpha],
               ( bob(A), bob(B), bob(_, [name(bobby)]),
                 msort([A, B], Both),
                 forall(( order(bob, Goal) ; Goal = agent_join(bob, _, 1) ),
                        catch(( call(Goal), assertion(fail) ),
                              error(Formal, _),
                              assertion(Formal == ambiguous_agent(bob, Both)))),
                 agent_dispose(A),
                 agent_send(bob, only_b),
                 wait_until(fact_of(B, got(only_b)), 5) )).
test(living_agent_has_the_name_of_faulty_ones) :-
    with_hosts([alpha, beta], capturing(replaced, _)).
test(restarted_worker_has_its_name) :-
    with_hosts([alpha, beta], capturing(supervised, _)).
%   order(?Name, -Goal)

order(Name, Goal) :-
    member(Goal, [ agent_send(Name, x), agent_move(Name, alpha),
                   agent_dispose(Name), agent_property(Name, hops(_)) ]).

test(unknown_name, [ forall(( order(tim, Goal) ; Goal = agent_join(tim, _, 1) )),
                     error(existence_error(agent, tim)) ]) :-
    with_hosts([alpha], ( bob(_), call(Goal) )).
test(order_to_an_ended_agent_reports_its_end,
     [ forall(order(bob, Goal)), true(Agent == Id) ]) :-
    with_hosts([alpha],
               ( bob(Id), agent_dispose(Id), agent_join(Id, _, 5),
                 catch(Goal, error(existence_error(agent, Agent), _), true) )).
test(name_with_dots) :-
    with_hosts([alpha], ( bob(Id, [name('dr.bob')]),
                          agent_property('dr.bob', home(_)),
                          agent_dispose(Id) )).
test(id_is_not_resolved) :-
    with_hosts([alpha],
               ( bob(Id),
                 statistics(inferences, I0),
                 typhon_questions:agent_named(Id, Same),
                 statistics(inferences, I1),
                 assertion(Same == Id),
                 assertion(I1-I0 < 10) )).

%   An agent of a network of other processes, wherever it is: this process
%   alone does not create it.

test(agents_in_other_processes) :-
    no_leaks(setup_call_cleanup(
                 network_start(ring(2), Network, [processes(2)]),
                 ( elsewhere(Network), born_elsewhere(Network) ),
                 network_stop(Network))).

elsewhere(Network) :-
    network_property(Network, hosts([First, Second])),
    bob(Carl, [host(First), name(carl)]),
    agent_move(carl, Second),
    wait_until(agent_property(carl, host(Second)), 5),
    agent_send(carl, hello),
    wait_until(agent_property(carl, facts([got(hello)])), 5),
    agent_dispose(carl),
    agent_join(carl, Outcome, 5),
    assertion(Outcome == disposed),
    catch(agent_send(carl, hello), error(Formal, _), true),
    assertion(Formal == existence_error(agent, Carl)).

%   This process has created none of these agents.

born_elsewhere(Network) :-
    network_property(Network, hosts([First, _])),
    remote(First, typhon:agent_create(
                      clauses([ (:- agent(ede, [])), (main :- receive(_)) ]),
                      Id, [])),
    agent_send(ede, go),
    agent_join(Id, done, 10),
    agent_join(ede, Outcome, 10),
    assertion(Outcome == done).

test(name_of_a_visitor_that_ended_here) :-
    with_hosts([alpha], with_peers([beta], came_and_ended)).

came_and_ended :-
    peer_host(beta, Beta),
    address(alpha, Alpha),
    remote(Beta, typhon:agent_create(
                     clauses([ (:- agent(ede, [])),
                               (main :- receive(_-go(H)), move(H)) ]),
                     Id, [])),
    agent_send(Id, go(Alpha)),
    agent_join(Id, done, 10),
    agent_join(ede, Outcome, 10),
    assertion(Outcome == done).

:- end_tests(names).
