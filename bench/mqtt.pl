:- use_module(common).
:- use_module('../test/lib/brokers').
:- use_module(library(typhon)).

/*  Messages per second from a host through a broker to an agent on it, with
QoS 0: each is published, returned by the broker, and received.  A publisher
that waits for each acknowledgement, with QoS 1, is slower.  And calls of a
Python function per second, one after the other.  Without mosquitto and
paho-mqtt MQTT is not measured. */

:- initialization(main, main).

main([_]) :-
    host_start(alpha),
    python_calls,
    (   exists_file('/usr/sbin/mosquitto')
    ->  setup_call_cleanup(broker_start([], Broker),
                           through(Broker),
                           broker_stop(Broker))
    ;   true
    ),
    host_stop(alpha).

python_calls :-
    module_property(bench_common, file(Bench)),
    file_directory_name(Bench, Dir),
    atom_concat(Dir, '/../bridges/python/hello.py', File),
    python_start(alpha, File, []),
    calls(100, _),
    calls(2000, Rate),
    figure('calls of Python per second, one after the other', Rate, '1/s'),
    python_stop(alpha).

calls(Count, Rate) :-
    seconds(remote(alpha, forall(between(1, Count, _), hello(x, _))),
            Seconds),
    Rate is Count/Seconds.

through(Broker) :-
    broker_url(Broker, URL),
    mqtt_start(alpha, URL, [queue(1000000)]),
    received(1000, [], _),              % warm up
    received(20000, [], QoS0),
    figure('MQTT messages per second, in and out, QoS 0', QoS0, '1/s'),
    received(2000, [qos(1),wait(true)], QoS1),
    figure('MQTT messages per second, in and out, QoS 1, each awaited',
           QoS1, '1/s'),
    mqtt_stop(alpha).

received(Count, Options, Rate) :-
    agent_create(clauses([ (:- agent(counter, [state([left/1])])),
                           (main :- subscribe(bench), leave(ready),
                                    left(N), count(N)),
                           (count(0) :- !),
                           (count(N) :- receive(mqtt-_), N1 is N-1,
                                        count(N1)) ]),
                 Agent, [facts([left(Count)])]),
    ready,
    seconds(( remote(alpha, forall(between(1, Count, I),
                                   publish(bench, I, Options))),
              agent_join(Agent, done, 120)
            ),
            Seconds),
    Rate is Count/Seconds.

ready :-
    (   remote(alpha, take(ready))
    ->  true
    ;   sleep(0.01),
        ready
    ).
