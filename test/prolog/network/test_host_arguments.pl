:- module(test_host_arguments, []).
:- use_module(library(plunit)).
:- use_module('../../../app/packaging/parts', [installed/1]).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [message_text/2]).
:- use_module('../../lib/networks').
:- use_module('../../lib/fixtures').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> Hosts of own networks as arguments

A host of a child process is named like one of this process.
*/

%   takes(+Host, -Goal): Goal has the argument Host, at the position that
%   host_position/2 names.  The other host is inn, the agent bob.

takes(H, Goal) :-
    nb_getval(test_saved, File),
    member(Goal,
           [ agent_create(clauses([(:- agent(a)), main]), _, [host(H)]),
             agent_move(bob, H), agent_move(bob, H, [wait(10)]),
             agent_load(File, _, [host(H)]), remote(H, neighbours(_)),
             host_property(H, load(_)),
             host_property(H, neighbours(_)), host_change(H, capacity(7)),
             link(inn, H), link(inn, H, [cost(2)]), link(H, inn),
             unlink(H, inn), unlink(inn, H), watched(H), watched([inn,H]),
             shown(H),
             host_stop(H) ]).
takes(H, Goal) :-
    member(Part-Goal,
           [ fipa-bridged(fipa_start(H, 'http://localhost:0', []),
                          fipa_stop(H)),
             bridges-python_start(H, '/no/such.py', []),
             bridges-python_stop(H),
             bridges-mqtt_start(H, 'mqtt://localhost:1', [wait(false)]),
             bridges-mqtt_stop(H),
             bridges-gpio_start(H, [a=output(99)], [factory(mock)]),
             bridges-gpio_stop(H),
             bridges-ros_start(H, 'ws://localhost:1', []),
             bridges-ros_stop(H), bridges-ros_property(H, _) ]),
    installed(Part).

:- public watched/1, shown/1, bridged/2.

watched(Hosts) :-
    watch(Hosts, [_]>>true, Watch),
    unwatch(Watch).

shown(Host) :-
    page_start([host(Host), port(0)]),
    page_stop.

bridged(Start, Stop) :-
    call(Start),
    call(Stop).

%   These end with an error that is not about the host.

ends(Goal, Formal) :-
    functor(Goal, Name, _),
    ends_with(Name, Formal).

ends_with(python_start, existence_error(source_sink, _)).
ends_with(python_stop, existence_error(python, _)).
ends_with(mqtt_start, existence_error(python_module, paho)).
ends_with(mqtt_stop, existence_error(mqtt, _)).
ends_with(gpio_start, existence_error(python_module, gpiozero)).
ends_with(gpio_start, existence_error(gpio_pin, 99)).
ends_with(gpio_stop, existence_error(gpio, _)).
ends_with(ros_start, socket_error(_, _)).
ends_with(ros_stop, existence_error(ros, _)).
ends_with(host_stop, existence_error(host, _)).

with_network(Goal) :-
    with_network(edges([inn-mill, mill-farm]), [processes(3)], _,
        ( create([on_message(_, _)], _, [name(bob), host(inn)]),
          create([on_message(_, _)], Eve, [host(inn)]),
          tmp_file(saved, File),
          agent_save(Eve, File),
          nb_setval(test_saved, File),
          call(Goal) )).

outcome(Goal, Outcome) :-
    (   catch(Goal, error(Formal, Context), true)
    ->  ( var(Formal) -> Outcome = true
        ; Outcome = error(Formal, Context) )
    ;   Outcome = false
    ).

works(Goal) :-
    copy_term(Goal, Copy),
    outcome(Copy, Outcome),
    (   Outcome = error(Formal, _)
    ->  assertion(ends(Goal, Formal)),
        message_text(Outcome, Text),
        assertion(\+ sub_string(Text, _, _, _, "Unknown error")),
        ( Goal = host_stop(_)
        -> assertion(sub_string(Text, _, _, _, "remote('farm@")) ; true )
    ;   Goal = ros_property(_, _)
    ->  assertion(Outcome == false)
    ;   assertion(Goal-Outcome = Goal-true)
    ).

is_unknown(Goal) :-
    outcome(Goal, Outcome),
    assertion(Outcome = error(existence_error(host, fram), _)),
    message_text(Outcome, Text),
    assertion(sub_string(Text, _, _, _, "(did you mean farm")).

:- begin_tests(host_arguments).

test(hosts_of_child_processes_are_named_as_those_here) :-
    with_network(forall(takes(farm, Goal), works(Goal))).
test(similar_name_is_suggested) :-
    with_network(forall(takes(fram, Goal), is_unknown(Goal))).

:- end_tests(host_arguments).
