:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(plunit)).
:- use_module(library(lists), [member/2, nth0/3]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(typhon)).

/** <module> Tests of stopping networks while agents are busy

Agents that cannot continue because hosts have stopped are not reported;
faults of agents are.
*/

:- begin_tests(stopping).

%   stopped(+Options, +Clauses, +Count, -Told): Told are the messages printed
%   when a network with Count agents of Clauses is stopped.

stopped(Options, Clauses, Count, Told) :-
    with_settings([ typhon_processes:answer_seconds=30,    % a slow machine
                    typhon_children:stop_seconds=30 ],
                  capturing(with_network(ring(6), Options, Network,
                                busy(Network, Clauses, Count)), Told)).

busy(Network, Clauses, Count) :-
    network_property(Network, hosts(Hosts)),
    forall(( between(1, Count, I), J is I mod 6, nth0(J, Hosts, Host) ),
           agent_create(clauses([ (:- agent(busy, [state([hosts/1, other/1])]))
                                | Clauses ]), _,
                        [host(Host), facts([hosts(Hosts)])])),
    network_property(Network, agents([Agent|_])),
    wait_until(( agent_property(Agent, hops(Hops)), Hops > 2 ), 10).

anywhere((anywhere(Host) :- hosts(Hosts), random_member(Host, Hosts))).

walks([ (main :- anywhere(Host), move(Host), main), Anywhere ]) :-
    anywhere(Anywhere).

dozes([ (main :- anywhere(Host), sleep(0.005), move(Host), main), Anywhere ]) :-
    anywhere(Anywhere).

talks([ (main :- anywhere(Host), clone(Host, Other), met(Other)),
        (met(parent(Clone)) :- send(Clone, hello), tour),
        (met(clone(Parent)) :- send(Parent, hello), tour),
        (tour :- anywhere(Host), move(Host), receive(Other-hello),
                 send(Other, hello), tour),
        Anywhere ]) :-
    anywhere(Anywhere).

test(agents_stopped_in_flight_print_nothing,
     [ forall(( member(Kind, [walks, dozes, talks]),
                member(Options, [[processes(3)], []]) )),
       Told == [] ]) :-
    call(Kind, Clauses),
    with_settings([typhon_node_process:rest_seconds=10],
                  no_leaks(stopped(Options, Clauses, 50, Told))).

%   A goal longer than agents have to come to rest, and one so long that it is
%   interrupted.

test(agents_stopped_in_a_long_goal_print_nothing,
     [ forall(member(Seconds-Options, [1.3-[processes(3)], 1.3-[],
                                       3-[processes(3)]])),
       Told == [] ]) :-
    anywhere(Anywhere),
    format(atom(Sleep), 'sleep ~w', [Seconds]),
    Clauses = [ (main :- hops(N), N < 3, !, anywhere(Host), move(Host), main),
                (main :- shell(Sleep), anywhere(Host), move(Host), main),
                Anywhere ],
    no_leaks(stopped(Options, Clauses, 6, Told)).

test(fault_of_an_agent_is_reported,
     [ forall(member(Options, [[processes(3)], []])),
       true(Told = [error-_]) ]) :-
    anywhere(Anywhere),
    Clauses = [ (main :- hops(N), N < 3, !, anywhere(Host), move(Host), main),
                (main :- shell('sleep 0.3'), atom_length(_, _)),
                Anywhere ],
    no_leaks(stopped(Options, Clauses, 1, Told)).

%   No agent is ordered twice to leave.

test(resting_agents_are_not_waited_for, Looks == 64) :-
    flag(test_stopping_looks, _, 0),
    setup_call_cleanup(
        wrap_predicate(typhon_orders:order_take(_, Order), counted, Taken,
                       ( ( Order = evacuate(_)
                         ->  flag(test_stopping_looks, N, N+1)
                         ;   true
                         ),
                         Taken )),
        all_rest(64),
        unwrap_predicate(typhon_orders:order_take/2, counted)),
    flag(test_stopping_looks, Looks, 0).

all_rest(Count) :-
    network_start(ring(Count), Network, []),
    network_property(Network, hosts(Hosts)),
    findall(Agent, ( member(Host, Hosts),
                     create([(main :- receive(_-never))], Agent, [host(Host)]) ),
            Agents),
    forall(member(Agent, Agents), wait_state(Agent, waiting)),
    network_stop(Network).

%   These agents miss a turn meanwhile.

test(agents_on_other_hosts_continue) :-
    with_hosts([alpha, beta],
               ( create([ (main :- s(N), retract(s(N)), N1 is N+1,
                                   assertz(s(N1)), move(beta), move(alpha),
                                   sleep(0.001), main) ], Agent,
                        [facts([s(0)])]),
                 walks(Clauses),
                 stopped([], Clauses, 50, []),
                 wait_until(fact_of(Agent, s(Then)), 10),
                 wait_until(( fact_of(Agent, s(Now)), Now > Then+10 ), 10) )).

:- end_tests(stopping).
