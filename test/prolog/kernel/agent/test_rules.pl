:- module(test_rules, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Rules in the state of agents

*Threading*: one test at a time.
*/

%   A variable that is unified before it is used.

rule((same(X, Y) :- X = at(_), ( X = at(2) -> Y = two ; Y = X ))).

agent(PIs, Options, Agent) :-
    agent_create(clauses([ (:- agent(a, [state(PIs)])),
                           (main :- receive(_-X), same(X, Y), leave(got(Y)))
                         ]),
                 Agent, Options).

%   The agent is saved twice, as in two hops to other processes: the received
%   form is sent on.

sent_on(Dir, Agent, Clone) :-
    atom_concat(Dir, '/agent', File),
    agent_save(Agent, File),
    agent_load(File, Other),
    agent_save(Other, File),
    agent_load(File, Clone).

asked(Agent, Y) :-
    agent_send(Agent, at(1)),
    agent_join(Agent, done, 10),
    remote(here, take(got(Y))).

:- begin_tests(rules_of_agents).

test(initial_rules_travel, true(Y == at(1))) :-
    rule(Rule),
    with_tmp_dir(travelled([same/2], [facts([Rule])], [], Y)).
test(added_rules_travel, true(Y == at(1))) :-
    rule(Rule),
    with_tmp_dir(travelled([same/2], [], [Rule], Y)).

:- end_tests(rules_of_agents).

travelled(PIs, Options, More, Y, Dir) :-
    with_hosts([here],
               ( agent(PIs, Options, A),
                 (   More == []
                 ->  true
                 ;   agent_change(A, facts(More))
                 ),
                 sent_on(Dir, A, B),
                 asked(B, Y) )).
