:- module(test_host_names, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [message_text/2]).
:- use_module('../../lib/fixtures').
:- use_module('../../lib/networks').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Bare names of hosts in other processes

Most tests share a network of two hosts, each in a process of its own.
*/

:- dynamic world/3.                     % Network, First, Second

world_start :-
    network_start(ring(2), Network, [processes(2)]),
    network_property(Network, hosts([First, Second])),
    assertz(world(Network, First, Second)).

world_end :-
    retract(world(Network, _, _)),
    network_stop(Network).

ambiguous(Goal, Name, Addresses) :-
    catch(( Goal, Formal = none ), error(Formal, _), true),
    assertion(Formal == ambiguous_host(Name, Addresses)).

:- meta_predicate ambiguous(0, +, +).

noted(Queue, Event) :-
    thread_send_message(Queue, Event).

:- begin_tests(host_names, [setup(world_start), cleanup(world_end)]).

test(bare_name_is_accepted_as_a_host) :-
    world(_, First, Second),
    host_property(n2, address(Address)),
    assertion(Address == Second),
    remote(n2, leave(parcel(7))),
    remote(Second, sense(parcel(X))),
    assertion(X == 7),
    create([on_message(_, _)], Agent, [host(n2)]),
    assertion(agent_property(Agent, home(n2))),
    agent_move(Agent, n1),
    wait_until(agent_property(Agent, host(n1)), 10),
    assertion(agent_property(Agent, host(First))),
    agent_dispose(Agent),
    agent_join(Agent, disposed, 10).
test(bare_name_is_accepted_by_link_and_unlink) :-
    world(_, First, Second),
    unlink(n1, n2),
    assertion(host_property(First, neighbours([]))),
    link(n1, n2, [cost(3)]),
    assertion(host_property(First, neighbours([Second]))),
    with_hosts([alpha],
               ( link(n2, alpha),
                 host_property(alpha, neighbours(There)) )),
    assertion(There == [Second]).
test(stopping_a_host_of_another_process_is_an_error,
     [forall(( world(_, _, Second), member(Host, [n2, Second]) ))]) :-
    catch(host_stop(Host), Error, true),
    assertion(Error = error(existence_error(host, Host), _)),
    message_text(Error, Text),
    format(string(Wanted), "Host ~w is not in this process", [Second]),
    assertion(sub_string(Text, _, _, _, Wanted)).
test(bare_name_is_accepted_by_watch) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        ( watch([n2], test_host_names:noted(Queue), Watch),
          create([main], Agent, [host(n2)]),
          thread_get_message(Queue, event(_, Host, Agent, created),
                             [timeout(10)]),
          unwatch(Watch)
        ),
        message_queue_destroy(Queue)),
    assertion(host_property(n2, address(Host))).
test(agent_of_this_process_moves_to_a_bare_name) :-
    with_hosts([alpha],
               ( create([(main :- move(n2), here(Here), result(Here))], Agent,
                        [host(alpha)]),
                 agent_result(Agent, Here, 10) )),
    assertion(host_property(n2, address(Here))).
test(own_host_precedes_others) :-
    world(_, Other, _),
    with_hosts([n1],
               ( once(( host_property(Name, address(Own)), Name == n1 )),
                 host_property(n1, address(Address)) )),
    assertion(Address == Own),
    assertion(Address \== Other).
test(ambiguous_name_lists_the_candidates) :-
    world(_, First, _),
    with_network(ring(2), [processes(2)], _, [Other|_],
        ( msort([First, Other], Sorted),
          ambiguous(host_property(n1, load(_)), n1, Sorted),
          ambiguous(remote(n1, true), n1, Sorted),
          ambiguous(create([main], _, [host(n1)]), n1, Sorted),
          message_text(error(ambiguous_host(n1, Sorted), _), Text),
          atomic_list_concat(Sorted, ', ', Listed),
          assertion(sub_string(Text, _, _, _, Listed)) )).
test(error_of_host_stop_names_a_goal_that_stops_the_host) :-
    world(_, _, Second),
    catch(host_stop(n2), Error, true),
    message_text(Error, Text),
    assertion(sub_string(Text, _, _, _, "such as typhon:host_stop(n2)")),
    format(string(Way), "remote(~q, Goal)", [Second]),
    assertion(sub_string(Text, _, _, _, Way)),
    remote(Second, typhon:host_stop(n2)),
    catch(remote(Second, true), error(Formal, _), true),
    assertion(Formal == existence_error(host, Second)).

:- end_tests(host_names).

:- begin_tests(host_names_of_the_past).

test(name_is_forgotten_with_its_network,
     error(existence_error(host, n2))) :-
    with_network(ring(2), [processes(2)], _, host_property(n2, load(0))),
    host_property(n2, load(_)).

:- end_tests(host_names_of_the_past).
