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

%   means(:Goal, +Part): Goal raises an error, and Part is in its message.

:- meta_predicate means(0, +).

means(Goal, Part) :-
    catch(( Goal, Error = none ), Error, true),
    Error = error(existence_error(state, _, _), _),
    message_text(Error, Text),
    assertion(sub_string(Text, _, _, _, Part)).

census(clauses([ (:- agent(census, [state([todo/1, seen/2])])),
                 (main :- receive(_)) ])).

%   created(+Options, -Facts): the facts of an agent of that program.

created(Options, Facts) :-
    census(Program),
    with_hosts([alpha],
               ( agent_create(Program, A, Options), facts(A, Facts) )).

undeclared([tood(beta)], "tood/1 as state (did you mean todo/1?)").
undeclared([todo(a), seen(b)], "seen/1 as state (did you mean seen/2?)").
undeclared([(tood(X) :- todo(X))], "did you mean todo/1?").

:- begin_tests(declared_facts).

test(undeclared_fact_is_refused,
     [forall(undeclared(Facts, Part)), Agents == []]) :-
    census(Program),
    with_hosts([alpha],
               ( means(agent_create(Program, _, [facts(Facts)]), Part),
                 findall(A, agent_property(A, state(_)), Agents) )).
test(change_with_an_undeclared_fact, forall(undeclared(Facts, Part))) :-
    census(Program),
    with_hosts([alpha],
               ( agent_create(Program, A),
                 means(agent_change(A, facts(Facts)), Part) )).
test(declared_facts_are_accepted, Facts == [seen(b, 1), todo(a)]) :-
    created([facts([todo(a), seen(b, 1)])], Facts).
test(facts_of_a_payload_are_accepted, Facts == [tool(hammer)]) :-
    created([ payloads([payload(box, [tool/1], [])]), facts([tool(hammer)]) ],
            Facts).
test(undeclared_fact_is_refused_by_another_process) :-
    census(Program),
    with_peers([east],
               ( peer_host(east, Host),
                 means(agent_create(Program, _,
                                    [host(Host), facts([tood(beta)])]),
                       "did you mean todo/1?") )).

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
