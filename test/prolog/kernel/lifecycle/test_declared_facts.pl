:- module(test_declared_facts, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Facts that the program of an agent does not declare

They are errors wherever they are given.

*Threading*: one test at a time.
*/

%   refused(:Goal, -Text): Goal raises an error, and Text is its message.

:- meta_predicate refused(0, -).

refused(Goal, Text) :-
    catch(( Goal, Error = none ), error(Formal, Context),
          Error = error(Formal, Context)),
    assertion(Error = error(existence_error(state, _, _), _)),
    message_text(Error, Text).

means(Goal, Part) :-
    refused(Goal, Text),
    assertion(sub_string(Text, _, _, _, Part)).

census(clauses([ (:- agent(census, [state([todo/1, seen/2])])),
                 (main :- receive(_)) ])).

:- begin_tests(declared_facts).

test(undeclared_fact_is_refused) :-
    census(Program),
    with_hosts([alpha],
               means(agent_create(Program, _, [facts([tood(beta)])]),
                     "tood/1 as state (did you mean todo/1?)")).
test(other_arity_is_refused) :-
    census(Program),
    with_hosts([alpha],
               means(agent_create(Program, _, [facts([todo(a), seen(b)])]),
                     "seen/1 as state (did you mean seen/2?)")).
test(undeclared_rule_is_refused) :-
    census(Program),
    with_hosts([alpha],
               means(agent_create(Program, _,
                                  [facts([(tood(X) :- todo(X))])]),
                     "did you mean todo/1?")).
test(refused_agent_is_not_created, Agents == []) :-
    census(Program),
    with_hosts([alpha],
               ( refused(agent_create(Program, _, [facts([tood(b)])]), _),
                 findall(A, agent_property(A, state(_)), Agents) )).
test(declared_facts_are_accepted, Facts == [seen(b, 1), todo(a)]) :-
    census(Program),
    with_hosts([alpha],
               ( agent_create(Program, A, [facts([todo(a), seen(b, 1)])]),
                 facts(A, Facts) )).
test(facts_of_a_payload_are_accepted, Facts == [tool(hammer)]) :-
    census(Program),
    with_hosts([alpha],
               ( agent_create(Program, A,
                              [ payloads([payload(box, [tool/1], [])]),
                                facts([tool(hammer)]) ]),
                 facts(A, Facts) )).
test(undeclared_fact_is_refused_by_another_process) :-
    census(Program),
    with_peers([east],
               ( peer_host(east, Host),
                 means(agent_create(Program, _,
                                    [host(Host), facts([tood(beta)])]),
                       "did you mean todo/1?") )).

test(change_with_an_undeclared_fact) :-
    census(Program),
    with_hosts([alpha],
               ( agent_create(Program, A),
                 means(agent_change(A, facts([tood(beta)])),
                       "tood/1 as state (did you mean todo/1?)") )).
test(change_with_a_declared_fact, Facts == [todo(a)]) :-
    census(Program),
    with_hosts([alpha],
               ( agent_create(Program, A),
                 agent_change(A, facts([todo(a)])),
                 facts(A, Facts) )).
test(implicit_state_may_be_added_to,
     Facts == [extra(1), extra(2)]) :-
    with_hosts([alpha],
               capturing(( create([(main :- assertz(extra(1)), receive(_))],
                                  A),
                           wait_state(A, waiting),
                           agent_change(A, facts([extra(2)])),
                           facts(A, Facts) ), _)).

:- end_tests(declared_facts).
