:- module(test_supervisor, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, append/3, member/2, nth1/3]).
:- use_module(library(pairs), [map_list_to_pairs/3]).
:- use_module(library(typhon)).

/** <module> Supervisors

*Threading*: one test at a time.
*/

worker(clauses([ (:- agent(worker, [])),
                 (main :- receive(_-Goal), call(Goal)) ])).

supervised(Children, More, S) :-
    worker(W),
    findall(child(Name, W, Options), member(Name-Options, Children), Facts),
    append([More, Facts], All),
    agent_create(agents(supervisor), S, [facts(All)]),
    wait_until(children(S, Children, _), 10).

%   children(+Supervisor, +Children, -Ids): Supervisor runs all of Children.

children(S, Children, Ids) :-
    agent_property(S, facts(Facts)),
    findall(Id, ( member(Name-_, Children),
                  member(running(Name, Id), Facts) ), Ids),
    length(Children, Count),
    length(Ids, Count).

%   with_children(+Children, +More, -S, -Ids, :Goal): on the host alpha;
%   messages are not printed.

:- meta_predicate with_children(+, +, -, -, 0), quietly(+, 0).

with_children(Children, More, S, Ids, Goal) :-
    quietly([alpha], ( supervised(Children, More, S),
                       children(S, Children, Ids),
                       Goal )).

quietly(Hosts, Goal) :-
    with_hosts(Hosts, capturing(Goal, _)).

:- dynamic ended/1.                     % Id, in the order of the ends

note(event(_, _, Id, What)) :-
    ( What = ended(_) -> assertz(ended(Id)) ; true ).

:- begin_tests(supervisor).

%   Kept are those that are the same agents after b has ended.

test(strategy, [ forall(member(Strategy-Same, [ one_for_one-[a,c],
                                                rest_for_one-[a],
                                                one_for_all-[] ])),
                 Kept == Same ]) :-
    Children = [a-[], b-[], c-[]],
    with_children(Children, [strategy(Strategy)], S, Old,
        ( Old = [_, B, _],
          agent_dispose(B),
          wait_until(( children(S, Children, New), New = [_, B1, _],
                       B1 \== B ), 10) )),
    findall(Name, ( nth1(N, Old, Id), nth1(N, New, Id),
                    nth1(N, Children, Name-_) ), Kept).
%   Messages show a few names.

test(long_lists_of_restarts_are_cut,
     [ forall(member(Count-Told, [ 1-[a], 5-[a,b,c,d,e],
                                   6-[a,b,c,others(3)] ])),
       Restarts == Told ]) :-
    length(Children, Count),
    append(Children, _, [a-[],b-[],c-[],d-[],e-[],f-[]]),
    with_children(Children, [strategy(one_for_all)], S, [Id|_],
        ( agent_dispose(Id),
          wait_until(was_printed(informational,
                                 typhon(log(_, _, restarts(Restarts)))), 10),
          wait_until(children(S, Children, _), 10) )).
test(restart_types, [forall(member(Type-Goal-Again,
                                   [ permanent-true-yes, transient-true-no,
                                     transient-dispose-yes,
                                     temporary-dispose-no ]))]) :-
    Children = [a-[restart(Type)]],
    with_children(Children, [], S, [A],
        ( agent_send(A, Goal),
          joined(A, _),
          (   Again == yes
          ->  wait_until(( children(S, Children, [B]), B \== A ), 10)
          ;   wait_until(was_printed(informational,
                                     typhon(log(_, _, down(a, _)))), 10),
              \+ children(S, Children, _)
          ) )).
test(too_many_restarts, O == disposed) :-
    Children = [a-[], b-[]],
    with_children(Children, [intensity(2, 60)], S, [A0,B],
        ( again(S, Children, A0, A1),
          again(S, Children, A1, A2),
          agent_dispose(A2),
          joined(S, O),
          joined(B, disposed) )).

again(S, Children, A0, A) :-
    agent_dispose(A0),
    wait_until(( children(S, Children, [A|_]), A \== A0 ), 10).

test(children_end_with_the_supervisor,
     [ forall(member(End-Outcome, [ agent_send(S, stop)-done,
                                    agent_dispose(S)-disposed ])),
       O-O1-O2 == Outcome-disposed-disposed ]) :-
    with_children([a-[], b-[]], [], S, [A,B],
        ( call(End),
          maplist(joined, [S,A,B], [O,O1,O2]) )).

%   Where is the host on which a child starts.

test(places, [forall(member(Where-Begins,
                            [ here-alpha, on(gamma)-gamma,
                              least_loaded-gamma, tagged(big)-beta,
                              [tagged(none),on(nowhere),on(beta)]-beta,
                             [on(beta),on(gamma)]-beta,
                             [on(gamma),on(beta)]-gamma ]))]) :-
    quietly([alpha,beta,gamma],
        ( link(alpha, beta), link(alpha, gamma),
          remote(beta, leave(tag(big))),
          worker(W),
          agent_create(W, _, [host(beta)]),
          supervised([a-[where(Where)]], [], S),
          children(S, [a-[]], [A]),
          agent_property(A, host(Host)),
          address(Begins, Host) )).
test(restart_is_retried_when_capacity_is_free) :-
    quietly([alpha],
        ( worker(W),
          agent_create(agents(supervisor), S,
                       [facts([child(a, W, [where(on(beta))])])]),
          wait_until(was_printed(informational,
                                 typhon(log(_, _, not_started(a, _)))), 10),
          \+ children(S, [a-[]], _),
          setup_call_cleanup(
              host_start(beta),
              wait_until(children(S, [a-[]], _), 10),
              host_stop(beta)) )).

%   Ids are numbered as agents are created.

test(children_start_in_order_and_end_in_reverse,
     [ Started-Ended == [a,b,c]-[c,b,a] ]) :-
    with_children([a-[], b-[], c-[]], [], S, Ids,
        ( retractall(test_supervisor:ended(_)),
          setup_call_cleanup(
              watch(alpha, test_supervisor:note, Watch),
              ( agent_send(S, stop), joined(S, done) ),
              with_settings([typhon_watches:last_seconds=20],
                            unwatch(Watch))) )),
    map_list_to_pairs(number_of, Ids, Numbered0),
    keysort(Numbered0, Numbered),
    findall(Name, ( member(_-Id1, Numbered), named(Id1, Name) ), Started),
    findall(Name, ( test_supervisor:ended(Id2), memberchk(Id2, Ids),
                    named(Id2, Name) ), Ended).

named(Id, Name) :-
    atomic_list_concat([Name|_], '.', Id).

number_of(Id, Number) :-
    atomic_list_concat([Local|_], @, Id),
    atomic_list_concat([_, _, Text], '.', Local),
    atom_number(Text, Number).

%   In virtual time, which passes while the test waits, each child ends after
%   some seconds; the 20th stays.

ends_after(Seconds, More, S) :-
    Program = clauses([ (:- agent(short, [])),
                        (main :- leave(started),
                                 findall(x, sense(started), Started),
                                 length(Started, Count),
                                 (   Count < 20
                                 ->  sleep(Seconds)
                                 ;   receive(_-never)
                                 )) ]),
    agent_create(agents(supervisor), S,
                 [facts([child(a, Program, [])|More])]).

started(Count) :-
    remote(alpha, aggregate_all(count, sense(started), Count)).

test(supervisor_gives_up_after_so_many_restarts,
     [ forall(member(More-Count,
                     [ []-3, [intensity(0, 9)]-0, [intensity(2, 9)]-2,
                       [intensity(5, 9)]-5 ])),
       Outcome-Restarts == disposed-Count ]) :-
    quietly([alpha-[clock(virtual)]],
        ( ends_after(1, More, S),
          joined(S, Outcome),
          started(All),
          Restarts is All-1 )).
test(restarts_of_long_ago_do_not_count) :-
    quietly([alpha-[clock(virtual)]],
        ( ends_after(2, [], S),
          \+ agent_result(S, _, 100),
          started(20),
          agent_property(S, state(_)) )).
test(child_starts_again_on_its_host, Host-Again == Beta-Beta) :-
    Children = [a-[host(beta)]],
    quietly([alpha, beta],
        ( supervised(Children, [], S),
          children(S, Children, [A0]),
          address(beta, Beta),
          agent_property(A0, host(Host)),
          again(S, Children, A0, A),
          agent_property(A, host(Again)) )).
test(restart_on_demand) :-
    Children = [a-[], b-[]],
    with_children(Children, [], S, [A0, B],
        ( agent_send(S, restart(a)),
          joined(A0, disposed),
          wait_until(( children(S, Children, [A, B]), A \== A0 ), 10) )).
test(failed_child_is_kept_and_another_takes_its_name, Got == here) :-
    Children = [a-[]],
    with_children(Children, [], S, [A0],
        ( agent_send(A0, fail),
          wait_until(( children(S, Children, [A]), A \== A0 ), 10),
          agent_property(A0, state(faulty(_))),
          agent_send(a, leave(here)),
          wait_until(remote(alpha, sense(Got)), 10) )).
test(child_may_be_a_supervisor_itself) :-
    worker(W),
    quietly([alpha],
        ( agent_create(agents(supervisor), Top,
                       [facts([child(sub, self,
                                     [facts([child(leaf, W, [])])])])]),
          wait_until(tree_of(Top, _, _), 10) )).

%   A tree: the child `sub` of the top is a supervisor of `leaf`.

:- meta_predicate with_tree(-, -, -, 0).

with_tree(Top, Sub, Leaf, Goal) :-
    worker(W),
    quietly([alpha],
        ( agent_create(agents(supervisor), Top,
                       [facts([child(sub, agents(supervisor),
                                     [facts([ child(leaf, W, []),
                                              intensity(1, 60) ])])])]),
          wait_until(tree_of(Top, Sub, Leaf), 10),
          Goal )).

tree_of(Top, Sub, Leaf) :-
    children(Top, [sub-[]], [Sub]),
    catch(children(Sub, [leaf-[]], [Leaf]), error(_, _), fail).

%   The supervisor gives up at the second end of the leaf.

test(a_leaf_is_restarted_then_its_supervisor) :-
    with_tree(Top, Sub0, Leaf0,
        ( agent_dispose(Leaf0),
          wait_until(( tree_of(Top, Sub0, Leaf1), Leaf1 \== Leaf0 ), 10),
          agent_dispose(Leaf1),
          wait_until(( tree_of(Top, Sub, _), Sub \== Sub0 ), 10) )).
test(restart_of_a_supervisor) :-
    with_tree(Top, Sub0, Leaf0,
        ( agent_dispose(Sub0),
          joined(Leaf0, disposed),
          wait_until(( tree_of(Top, Sub, _), Sub \== Sub0 ), 10) )).
test(the_tree_ends_with_its_top, O-P == done-disposed) :-
    with_tree(Top, _, Leaf,
        ( agent_send(Top, stop),
          joined(Top, O),
          joined(Leaf, P) )).

:- end_tests(supervisor).

:- begin_tests(supervisor_of_processes).

%   on(+Peers, +Name, -Count): agents of that name in all processes.

count(Peers, Name, Count) :-
    atom_concat(Name, '.', Begin),
    aggregate_all(sum(N),
                  ( member(P, Peers),
                    peer_do(P, aggregate_all(count,
                        ( typhon_agents:agent(Id, _, _, _, _),
                          sub_atom(Id, 0, _, _, Begin) ), N)) ),
                  Count).

each_once(Peers) :-
    forall(member(Name, [a,b,c]), count(Peers, Name, 1)).

three(Goal) :-
    no_leaks(with_peers([p1,p2,p3], Goal)).

linked(H1, H2, H3) :-
    peer_host(p1, H1), peer_host(p2, H2), peer_host(p3, H3),
    peer_do(p1, ( link(p1, H2), link(p1, H3) )),
    peer_do(p2, link(p2, H3)).

begun(H1, H2, H3, More) :-
    worker(W),
    Where = where([same,least_loaded,here]),
    agent_create(agents(supervisor), _,
                 [ host(H1),
                   facts([ child(a, W, [host(H1),Where]),
                           child(b, W, [host(H2),Where]),
                           child(c, W, [host(H3),Where]), intensity(100, 1)
                         | More ]) ]).

on_standby(H3) :-
    linked(H1, H2, H3),
    begun(H1, H2, H3, [standby(H2)]),
    wait_until(each_once([p1,p2,p3]), 20),
    wait_until(count([p2], supervisor, 1), 10),
    answers(p1).

%   answers(+Peer): its supervisor has handled all that came before.

answers(Peer) :-
    supervisor_on(Peer, Id),
    Asker = clauses([ (:- agent(asker, [])),
                      (main :- send(Id, children),
                               receive(Id-children(_), 20), result(yes)) ]),
    with_hosts([gamma],
               ( agent_create(Asker, A), agent_result(A, yes, 25) )).

supervisor_on(Peer, Id) :-
    agent_on(Peer, 'supervisor.', Id).

agent_on(Peer, Begin, Id) :-
    peer_do(Peer, ( typhon_agents:agent(Id, _, _, _, _),
                    sub_atom(Id, 0, _, _, Begin) )).

test(a_process_dies) :-
    three(( linked(H1, H2, H3),
            begun(H1, H2, H3, []),
            wait_until(each_once([p1,p2,p3]), 20),
            peer_kill(p3),
            wait_until(each_once([p1,p2]), 30),
            answers(p1),
            each_once([p1,p2]) )).
test(process_of_the_supervisor_dies) :-
    three(( on_standby(_),
            peer_kill(p1),
            wait_until(each_once([p2,p3]), 30),
            answers(p2),
            each_once([p2,p3]) )).
test(child_started_later_ends_when_the_standby_takes_over) :-
    three(( on_standby(_),
            agent_on(p3, 'c.', Old),
            agent_dispose(Old),
            wait_until(( agent_on(p3, 'c.', New), New \== Old ), 20),
            supervisor_on(p2, Standby),
            wait_until(( agent_property(Standby, facts(Facts)),
                         memberchk(running(c, New), Facts) ), 20),
            peer_kill(p1),
            joined(New, disposed),
            wait_until(each_once([p2,p3]), 30),
            answers(p2),
            each_once([p2,p3]) )).
test(home_of_the_supervisor_dies_while_it_is_away) :-
    three(( on_standby(H3),
            supervisor_on(p1, S),
            agent_move(S, H3, [wait(5)]),
            answers(p3),
            peer_kill(p1),
            wait_until(count([p3], supervisor, 0), 30),
            wait_until(each_once([p2,p3]), 30),
            answers(p2),
            each_once([p2,p3]),
            count([p2,p3], supervisor, 1) )).

:- end_tests(supervisor_of_processes).
