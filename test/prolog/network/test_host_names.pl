:- module(test_host_names, []).
:- use_module(library(plunit)).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(yall)).
:- use_module(library(typhon)).

/** <module> Bare names of hosts in other processes

*/

%   with_networks(+Count, :Goal): that many networks of two hosts, each host in
%   a process of its own; call(Goal, Networks).

:- meta_predicate with_networks(+, 1).

with_networks(Count, Goal) :-
    length(Networks, Count),
    no_leaks(setup_call_cleanup(
                 maplist(started, Networks),
                 call(Goal, Networks),
                 maplist(network_stop, Networks))).

started(Network) :-
    network_start(ring(2), Network, [processes(2)]).

ambiguous(Goal, Name, Addresses) :-
    catch(( Goal, Formal = none ), error(Formal, _), true),
    assertion(Formal == ambiguous_host(Name, Addresses)).

:- meta_predicate ambiguous(0, +, +).

noted(Queue, Event) :-
    thread_send_message(Queue, Event).

:- begin_tests(host_names).

test(bare_name_is_accepted_as_a_host) :-
    with_networks(1, wherever).

wherever([Network]) :-
    network_property(Network, hosts([First, Second])),
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
    with_networks(1, linked).

linked([Network]) :-
    network_property(Network, hosts([First, Second])),
    unlink(n1, n2),
    assertion(host_property(First, neighbours([]))),
    link(n1, n2, [cost(3)]),
    assertion(host_property(First, neighbours([Second]))),
    host_start(alpha),
    link(n2, alpha),
    host_property(alpha, neighbours(There)),
    host_stop(alpha),
    assertion(There == [Second]).

test(stopping_a_host_of_another_process_is_an_error) :-
    with_networks(1, stopped_from_here).

stopped_from_here([Network]) :-
    network_property(Network, hosts([_, Second])),
    forall(member(Host, [n2, Second]),
           ( catch(host_stop(Host), Error, true),
             assertion(Error = error(existence_error(host, Host), _)),
             message_text(Error, Text),
             format(string(Wanted), "Host ~w is not in this process", [Second]),
             assertion(sub_string(Text, _, _, _, Wanted)) )).

message_text(Error, Text) :-
    phrase('$messages':translate_message(Error), Lines),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)).

test(error_of_host_stop_names_a_goal_that_stops_the_host) :-
    with_networks(1, stopped_as_the_error_says).

stopped_as_the_error_says([Network]) :-
    network_property(Network, hosts([_, Second])),
    catch(host_stop(n2), Error, true),
    message_text(Error, Text),
    assertion(sub_string(Text, _, _, _, "such as typhon:host_stop(n2)")),
    format(string(Way), "remote(~q, Goal)", [Second]),
    assertion(sub_string(Text, _, _, _, Way)),
    remote(Second, typhon:host_stop(n2)),
    catch(remote(Second, true), error(Formal, _), true),
    assertion(Formal == existence_error(host, Second)).

test(bare_name_is_accepted_by_watch) :-
    with_networks(1, watched).

watched(_) :-
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
    with_networks(1, moves).

moves(_) :-
    host_start(alpha),
    create([(main :- move(n2), here(Here), result(Here))], Agent,
           [host(alpha)]),
    agent_result(Agent, Here, 10),
    host_stop(alpha),
    assertion(host_property(n2, address(Here))).

test(own_host_precedes_others) :-
    with_hosts([n1], with_networks(1, own_first)).

own_first([Network]) :-
    network_property(Network, hosts([Other|_])),
    once(( host_property(Name, address(Own)), Name == n1 )),
    host_property(n1, address(Address)),
    assertion(Address == Own),
    assertion(Address \== Other).

test(ambiguous_name_lists_the_candidates) :-
    with_networks(2, two_networks).

two_networks(Networks) :-
    findall(First,
            ( member(Network, Networks),
              network_property(Network, hosts([First|_])) ),
            Firsts),
    msort(Firsts, Sorted),
    ambiguous(host_property(n1, load(_)), n1, Sorted),
    ambiguous(remote(n1, true), n1, Sorted),
    ambiguous(create([main], _, [host(n1)]), n1, Sorted),
    message_to_codes(n1, Sorted, Text),
    atomic_list_concat(Sorted, ', ', Listed),
    assertion(sub_string(Text, _, _, _, Listed)).

message_to_codes(Name, Addresses, Text) :-
    '$messages':translate_message(error(ambiguous_host(Name, Addresses), _),
                                  Lines, []),
    with_output_to(string(Text),
                   print_message_lines(current_output, '', Lines)).

test(name_is_forgotten_with_its_network,
     error(existence_error(host, n2))) :-
    with_networks(1, [_]>>host_property(n2, load(0))),
    host_property(n2, load(_)).

:- end_tests(host_names).
