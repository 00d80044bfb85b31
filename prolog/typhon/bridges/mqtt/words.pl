:- module(typhon_mqtt_words,
          [ publish/2,                  % +Topic, +Payload
            publish/3,                  % +Topic, +Payload, +Options
            subscribe/1,                % +Filter
            subscribe/2,                % +Filter, +Options
            unsubscribe/1               % +Filter
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(option), [option/3, select_option/4]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [ subscribe/5 as subscribe_to, subscriber/2,
                unsubscribe/4 as unsubscribe_from ]).
:- use_module(service,
              [ mqtt_ask/3, mqtt_default/3, mqtt_message/5, mqtt_note/2,
                mqtt_publish/4 ]).
:- use_module(incoming, [mqtt_filter/2]).

/** <module> What agents can say where there is a broker

*Threading*: whatever thread runs the agent.
*/

:- multifile
    typhon_options:declared/4,
    typhon_subscribers:wanted/4.

%!  publish(+Topic, +Payload) is det.
%!  publish(+Topic, +Payload, +Options) is det.
%
%   Options:
%
%     - qos(0, 1 or 2): default 0
%     - retain(Boolean): whether the broker keeps it for later subscribers
%     - payload(Kind): `auto`, by which dicts and lists are written as JSON and
%       all else as text; `json`; `text`; or `bytes`, text whose characters
%       are bytes
%     - wait(Boolean): whether to wait until the broker has it, default `false`
%
%   What is published while there is no connection is kept for it.
%
%   @error domain_error(mqtt_topic, Topic), type_error(mqtt_payload, Payload),
%   resource_error(mqtt_pending) if too much is kept,
%   resource_error(mqtt_payload) if it is too big

publish(Topic, Payload) :-
    publish(Topic, Payload, []).

publish(Topic, Payload, Options) :-
    subscriber(Host, _),
    mqtt_default(Host, payload(Kind), auto),
    mqtt_default(Host, timeout(Seconds), 10),
    mqtt_message(Topic, Payload, Options, Kind, Message),
    option(wait(Wait), Options, false),
    mqtt_publish(Host, Message, Wait, Seconds).

%!  subscribe(+Filter) is det.
%!  subscribe(+Filter, +Options) is det.
%
%   What is published under topics that match Filter comes to the agent as
%   mqtt-message(Topic, Payload, Options), Topic being an atom and Options
%   qos(N) and retain(Boolean), until it unsubscribes, leaves the host, or
%   ends.  What it cannot take in comes as mqtt-dropped(mqtt(Filter, Kind),
%   Count), and what is too big as mqtt-too_big(Topic, Bytes).  Options:
%
%     - qos(N): as which it comes at the most, default 0
%     - payload(Kind): `auto`, by which JSON objects and lists come as dicts
%       and lists and all else as strings; `json`: all JSON as terms; `text`;
%       or `bytes`: a string of characters up to 255.  What is no UTF-8 is
%       always bytes.
%     - as(How), queue(N): as of subscribe/5 of typhon_subscribers
%
%   @error domain_error(mqtt_filter, Filter)
%   @error permission_error(subscribe, mqtt_filter, Filter): the broker refuses

subscribe(Filter) :-
    subscribe(Filter, []).

subscribe(Filter0, Options0) :-
    must_be(list, Options0),
    subscriber(Host, Agent),
    mqtt_filter(Filter0, Filter),
    mqtt_default(Host, payload(Kind0), auto),
    select_option(payload(Kind), Options0, Options1, Kind0),
    select_option(qos(QoS), Options1, Options2, 0),
    check_options(mqtt_publish_option, [payload(Kind),qos(QoS)]),
    mqtt_default(Host, queue(Max), 1000),
    mqtt_default(Host, timeout(Seconds), 10),
    with_queue(Options2, Max, Options),
    Key = mqtt(Filter, Kind),
    unsubscribe_others(Filter, Key, Host, Agent),
    subscribe_to(mqtt, Host, Key, Agent, Options),
    catch(mqtt_ask(Host, _{do:subscribe, filter:Filter, kind:Kind, qos:QoS},
                   Seconds),
          error(Formal, Context),
          ( ignore(unsubscribe_from(mqtt, Host, Key, Agent)),
            throw(error(Formal, Context)) )).

with_queue(Options, _, Options) :-
    memberchk(queue(_), Options),
    !.
with_queue(Options, Max, [queue(Max)|Options]).

%!  unsubscribe(+Filter) is det.
%
%   @error existence_error(mqtt_subscription, Filter)

unsubscribe(Filter0) :-
    subscriber(Host, Agent),
    mqtt_filter(Filter0, Filter),
    (   kind(Kind),
        unsubscribe_from(mqtt, Host, mqtt(Filter, Kind), Agent)
    ->  true
    ;   existence_error(mqtt_subscription, Filter)
    ).

%   An agent wants a filter in one way.

unsubscribe_others(Filter, Key, Host, Agent) :-
    forall(( kind(Kind), Other = mqtt(Filter, Kind), Other \== Key ),
           ignore(unsubscribe_from(mqtt, Host, Other, Agent))).

kind(auto).
kind(json).
kind(text).
kind(bytes).

typhon_subscribers:wanted(mqtt, Host, mqtt(Filter, Kind), Wanted) :-
    request(Wanted, Do, More),
    mqtt_note(Host, More.put(_{do:Do, filter:Filter, kind:Kind})).

request(true, subscribe, _{qos:2}).
request(false, unsubscribe, _{}).
