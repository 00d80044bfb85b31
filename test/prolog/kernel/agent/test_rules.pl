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
test(changes_of_clauses_travel, true(Got == got([1,4],[],[3,2]))) :-
    with_tmp_dir(changed_and_sent(Got)).

:- end_tests(rules_of_agents).

%   A predicate without clauses travels, too.

changed_and_sent(got(Ps, Qs, Rs), Dir) :-
    with_hosts([here],
               ( agent_create(clauses([ (:- agent(a, [state([p/1,q/1,r/1])])),
                                        p(1), q(1), r(2),
                                        (main :- retract(q(1)), asserta(r(3)),
                                             assertz((p(X) :- X = 4)),
                                             receive(_-go),
                                             findall(P, p(P), Ps0),
                                             findall(Q, q(Q), Qs0),
                                             findall(R, r(R), Rs0),
                                             leave(got(Ps0, Qs0, Rs0))) ]), A),
                 wait_state(A, waiting),
                 sent_on(Dir, A, B),
                 agent_send(B, go),
                 agent_join(B, done, 10),
                 remote(here, take(got(Ps, Qs, Rs))) )).

travelled(PIs, Options, More, Y, Dir) :-
    with_hosts([here],
               ( agent(PIs, Options, A),
                 (   More == []
                 ->  true
                 ;   agent_change(A, facts(More))
                 ),
                 sent_on(Dir, A, B),
                 asked(B, Y) )).
