:- module(typhon_mqtt, []).

/** <module> MQTT brokers as services of a place

    :- use_module(library(typhon/mqtt)).

    ?- host_start(alpha), mqtt_start(alpha, 'mqtt://localhost', []).

Agents on alpha can then publish/2,3, subscribe/1,2 and unsubscribe/1; what
they have subscribed to comes as mqtt-message(Topic, Payload, Options).  See
doc/bridges.md.
*/

:- use_module(tools/user_errors, [user_errors/1]).
:- reexport(bridges/common/starting, [mqtt_start/3, mqtt_stop/1]).
:- use_module('bridges/mqtt/service', []).

:- user_errors(typhon_mqtt).
