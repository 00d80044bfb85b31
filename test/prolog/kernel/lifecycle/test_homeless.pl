:- module(test_homeless, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(typhon)).

/** <module> Where agents are and how they ended, when their home is gone

An option knows it; here the suite does so.

*Threading*: one test at a time.
*/

:- dynamic
    at/2,                               % Id, Address
    end/2,                              % Id, Outcome
    results/2,                          % Id, Results
    ends_when_asked/1,                  % Id
    ended/4.                            % Id, Outcome, Hops, Results

:- multifile
    typhon_whereabouts:ended_with/4,
    typhon_whereabouts:known_at/2,
    typhon_join:known_end/2,
    typhon_join:known_results/2.

typhon_whereabouts:ended_with(Id, Outcome, Hops, Results) :-
    typhon_agents:agent_on(Id, _),
    assertz(test_homeless:ended(Id, Outcome, Hops, Results)).
typhon_whereabouts:known_at(Id, Address) :-
    test_homeless:at(Id, Address).
typhon_whereabouts:known_at(Id, _) :-
    retract(test_homeless:ends_when_asked(Id)),
    assertz(test_homeless:end(Id, done)),
    fail.
typhon_join:known_end(Id, Outcome) :-
    test_homeless:end(Id, Outcome).
typhon_join:known_results(Id, Results) :-
    test_homeless:results(Id, Results).

known(Fact) :-
    assertz(Fact).

forget :-
    retractall(at(_, _)),
    retractall(end(_, _)),
    retractall(results(_, _)),
    retractall(ended(_, _, _, _)).

%   homeless(-Id): an agent whose home is gone.

homeless(Id) :-
    free_port(Port),
    format(atom(Id), 'none.b7b4qcym.1@nowhere@127.0.0.1:~d', [Port]).

:- meta_predicate on_alpha(0).

on_alpha(Goal) :-
    call_cleanup(with_hosts([alpha], Goal), forget).

:- begin_tests(homeless).

test(agent_is_where_it_is, Where == Beta) :-
    on_alpha(with_peers([beta],
                        ( peer_host(beta, Beta),
                          create([ (main :- move(Beta), receive(_)) ], A,
                                 [host(alpha)]),
                          wait_until(agent_property(A, host(Beta)), 20),
                          agent_where(A, Where),
                          agent_send(A, end),
                          joined(A, done) ))).
test(name_of_an_agent_serves, Where == Alpha) :-
    on_alpha(( address(alpha, Alpha),
               create([on_message(_, _)], _, [host(alpha), name(bob)]),
               agent_where(bob, Where) )).
test(ended_agent_is_nowhere, error(existence_error(agent, A))) :-
    on_alpha(( create([main], A, [host(alpha)]),
               joined(A, done),
               agent_where(A, _) )).
test(agent_without_a_home_is_nowhere, error(existence_error(agent, A))) :-
    on_alpha(( homeless(A), agent_where(A, _) )).
test(agent_without_a_home_is_where_an_option_knows, Where == 'b@1.2.3.4:5') :-
    on_alpha(( homeless(A), known(at(A, 'b@1.2.3.4:5')),
               agent_where(A, Where) )).
test(agent_of_a_dead_process_is_where_it_was, Where == Beta) :-
    on_alpha(with_peers([beta],
                        ( peer_host(beta, Beta),
                          create([ (main :- move(Beta), receive(_)) ], A,
                                 [host(alpha)]),
                          wait_until(agent_property(A, host(Beta)), 20),
                          peer_kill(beta),
                          agent_where(A, Where) ))).
test(end_without_a_home_is_known, Outcome == done) :-
    on_alpha(( homeless(A), known(end(A, done)), agent_join(A, Outcome, 5) )).
test(end_between_two_questions_is_known, Outcome == done) :-
    on_alpha(( homeless(A), known(ends_when_asked(A)),
               agent_join(A, Outcome, 5) )).
test(end_without_a_home_is_an_error, error(host_unreachable(_))) :-
    on_alpha(( homeless(A), agent_join(A, _, 5) )).
test(end_that_the_home_does_not_know_is_known, Outcome == failed) :-
    on_alpha(( address(alpha, Alpha),
               atom_concat('none.b7b4qcym.1@', Alpha, A),
               known(end(A, failed)),
               agent_join(A, Outcome, 5) )).
test(agent_that_is_alive_is_waited_for, Outcome == timeout) :-
    on_alpha(( homeless(A), known(at(A, 'b@1.2.3.4:5')),
               agent_join(A, Outcome, 0.3) )).
test(end_is_known_as_soon_as_the_option_knows_it, Outcome == disposed) :-
    on_alpha(( homeless(A), known(at(A, 'b@1.2.3.4:5')),
               thread_create(known(end(A, disposed)), Thread),
               agent_join(A, Outcome, 30),
               thread_join(Thread, true) )).
test(result_without_a_home_is_known, Result == two) :-
    on_alpha(( homeless(A), known(end(A, done)),
               known(results(A, [result(one), cloned(x), result(two)])),
               agent_result(A, Result, 5) )).
test(result_that_no_option_knows_is_an_error,
     error(host_unreachable(_))) :-
    on_alpha(( homeless(A), known(end(A, done)), agent_result(A, _, 5) )).
test(end_is_noted_where_it_was_before_the_agent_is_gone,
     Ends == [end(done, 0, [result(r)])]) :-
    on_alpha(( create([ (main :- result(r)) ], A, [host(alpha)]),
               joined(A, done),
               findall(end(O, N, Rs), ended(A, O, N, Rs), Ends) )).

:- end_tests(homeless).
