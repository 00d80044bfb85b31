:- module(test_irrigation_mqtt, []).
:- use_module('../lib/common').
:- use_module('../lib/networks').

:- needs([mqtt]).

% The gardener of the irrigation with a real broker: the sensor and the valve
% are programs outside the platform.

:- use_module('../lib/brokers').
:- use_module('../lib/fixtures').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(typhon/bridges/json), [json_dict/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

gardening(Broker, Order) :-
    broker_url(Broker, URL),
    capturing(mqtt_start(field1, URL, []), _),
    client_receives(Broker, ['-t', 'field/1/valve', '-C', 1], gardener, [Line]),
    json_dict(Line, Order).

gardener :-
    project_file('examples/applications/irrigation/gardener.pl', Program),
    remote(field1, here(Field)),
    agent_create(Program, _,
                 [ host(office),
                   facts([ field(Field, 1), map(0.3, 0.1, 0.5),
                           strategy(carried) ]) ]).

:- begin_tests(irrigation_mqtt).

%   Of 100 mm there are 50: 40 mm are given, at an efficiency of 3/4.

test(valve) :-
    with_broker([], Broker,
                ( client_publishes(Broker, 'field/1/moisture',
                                [ '-r', '-m', '{"hour":5, "moisture":0.2, \c
                                               "et0":0, "rain":0}' ]),
                  with_network(edges([office-field1]), [ clock(36000), seed(1),
                                                         log('/dev/null') ], _,
                      gardening(Broker, Order)) )),
    assertion(abs(Order.mm - 40/0.75) < 0.001).

:- end_tests(irrigation_mqtt).
