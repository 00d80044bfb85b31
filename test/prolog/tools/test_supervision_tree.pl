:- module(test_supervision_tree, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/peers').
:- use_module('../../../prolog/typhon/tools/supervision_tree').
:- use_module('../../../prolog/typhon/tools/tables', [print_tree/1]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Trees of supervisors and monitored agents

*Threading*: one test at a time.
*/

%   shape(+Places, -Shapes): Name-Relation-Below, by name.

shape(Places, Shapes) :-
    supervision_tree(Places, Trees, []),
    maplist(shape_of, Trees, Shapes).

shape_of(node(Id, Relation, _, Below0), Name-Relation-Below) :-
    atomic_list_concat([Name|_], '.', Id),
    maplist(shape_of, Below0, Below).

has_shape(Places, Shape) :-
    wait_until(shape(Places, Shape), 10).

worker(clauses([(:- agent(worker, [])), (main :- receive(_-Goal), call(Goal))])).

supervisor(Children, Options, S) :-
    worker(W),
    findall(child(Name, W, []), member(Name, Children), Facts),
    agent_create(agents(supervisor), S, [facts(Facts)|Options]).

watcher(Name, Id) :-
    create([ (main :- receive(_-of(A)), monitor(A), receive(_-end)) ], Id,
           [name(Name)]).

:- begin_tests(supervision_tree).

test(no_supervision, Shape == []) :-
    with_hosts([alpha], ( worker(W), agent_create(W, _, []), shape([], Shape) )).
test(children, true) :-
    with_hosts([alpha],
               ( supervisor([b,a], [], _),
                 has_shape([], [supervisor-top-[a-child-[], b-child-[]]]) )).
test(monitored_agents_that_are_no_children, true) :-
    with_hosts([alpha],
               ( watcher(w, W), watcher(a, A),
                 agent_send(W, of(A)),
                 has_shape([], [w-top-[a-monitored-[]]]) )).
test(mutual_monitors_are_shown_once, true) :-
    with_hosts([alpha],
               ( watcher(a, A), watcher(b, B),
                 agent_send(A, of(B)), agent_send(B, of(A)),
                 has_shape([], [a-top-[b-monitored-[]]]) )).
test(agent_of_shared_fate_is_a_child, true) :-
    with_hosts([alpha],
               ( worker(W),
                 agent_create(W, C, [name(c)]),
                 create([ (main :- monitor(C, [shared(true)]),
                                   receive(_-end)) ], _, [name(p)]),
                 has_shape([], [p-top-[c-child-[]]]) )).
test(supervisors_of_supervisors, true) :-
    with_hosts([alpha],
               ( worker(W),
                 agent_create(agents(supervisor), _,
                              [ name(top),
                                facts([child(sub, agents(supervisor),
                                             [facts([child(a, W, [])])])]) ]),
                 has_shape([], [top-top-[sub-child-[a-child-[]]]]) )).
test(agents_of_other_processes, [nondet]) :-
    no_leaks(with_peers([p1, p2],
        ( peer_host(p1, H1),
          peer_host(p2, H2),
          peer_do(p1, link(p1, H2)),
          worker(W),
          setup_call_cleanup(
              host_start(alpha),
              ( agent_create(agents(supervisor), _,
                             [ host(H1), facts([child(a, W, [host(H1)]),
                                                child(b, W, [host(H2)])]) ]),
                has_shape([H1], [supervisor-top-[a-child-[], b-child-[]]]) ),
              host_stop(alpha)) ))).
test(table) :-
    with_hosts([alpha],
               ( supervisor([a], [], _),
                 has_shape([], [supervisor-top-[a-child-[]]]),
                 with_output_to(string(Text), print_tree([])) )),
    split_string(Text, "\n", "", [Head,Top,Child|_]),
    assertion(wildcard_match("agent*is*host*program*state", Head)),
    assertion(wildcard_match("supervisor.* alpha  supervisor  *", Top)),
    assertion(wildcard_match("  a.* child  alpha  worker *", Child)).
test(no_table, Text == "No agent that monitors others\n") :-
    with_hosts([alpha], with_output_to(string(Text), print_tree([]))).

:- end_tests(supervision_tree).
