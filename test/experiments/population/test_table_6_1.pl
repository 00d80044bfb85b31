:- use_module('../../lib/common').
:- use_module('../../lib/project_studies').
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/population/states').

/** <module> Table 6.1: the states of the agents, in logs and in a small run
*/

study(Study) :-
    project_study('population/table_6_1', Study).

%   Two kinds; a clone, and what else is logged as a state, do not count.

log([ event(0, a, 'agent2.x.2@a', begun),
      event(0, a, 'agent2.x.2@a', state(dormant)),
      event(0, b, 'agent1.x.1@b', begun),
      event(0, b, 'agent1.x.1@b', state(dormant)),
      event(1, b, 'agent1.x.1@b', state(excited)),
      event(3, a, 'agent1.x.1@b', state(active)),
      event(4, a, 'agent1.x.1@b', state(replicate)),
      event(4, a, 'agent1.x.7@a', state(death)),
      event(5, b, 'agent2.x.2@a', state(excited)),
      event(9, b, 'agent2.x.2@a', state(active)) ]).

rows(Rows) :-
    log(Events),
    first_agents(Events, Agents),
    findall(Agent-Moods,
            ( member(Agent, Agents), moods_of(Agent, Events, Moods) ), All),
    state_rows(All, Rows).

:- begin_tests(states).

test(first_agents_are_in_the_order_of_tasks,
     Agents == ['agent1.x.1@b', 'agent2.x.2@a']) :-
    log(Events),
    first_agents(Events, Agents).
test(table_6_1, Rows == [ [dormant, dormant], [excited, dormant],
                     [active, dormant], [active, excited],
                     [active, active] ]) :-
    rows(Rows).
test(kinds_of_rows, Kinds == [printed, printed, between, printed, printed]) :-
    rows(Rows),
    findall(Kind, ( member(Row, Rows), once(table_row(Kind, Row)) ), Kinds).
test(excited_out_of_order_is_no_row,
     [ forall(member(Row, [ [dormant, excited], [excited, excited],
                            [excited, active], [dormant, active] ])),
       fail ]) :-
    table_row(_, Row).

:- end_tests(states).

:- begin_tests(table_claims).

test(well_formed, Problems == []) :-
    study(Study),
    invalid_claims(Study, Problems).
test(holds_in_a_small_network, Failed == []) :-
    study(Study),
    with_tmp_dir(Dir, first_run(Study, [hosts-12, degree-4], 4, Dir, Case-Ms)),
    verdicts(Study, [Case-Ms], Verdicts),
    findall(Text, member(Text-false, Verdicts), Failed),
    length(Verdicts, 8).
test(each_claim_can_fail,
     [ forall(member(Worse, [ _{rows:6}, _{wrong:1}, _{lapses:1},
                              _{excited_1:9}, _{excited_2:9},
                              _{excited_5:39} ])),
       Count == 7 ]) :-
    study(Study),
    Good = ms{rows:7, wrong:0, lapses:0, excited_1:0, active_1:10,
              excited_2:11, active_2:20, excited_3:21, active_3:30,
              excited_4:31, active_4:40, excited_5:41, active_5:50},
    holding(Study, [case{hosts:50}-Good], All),
    length(All, 8),
    holding(Study, [case{hosts:50}-Good.put(Worse)], Held),
    length(Held, Count).

:- end_tests(table_claims).
