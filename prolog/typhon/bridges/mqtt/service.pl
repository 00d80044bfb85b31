:- module(typhon_mqtt_service, []).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3, select_option/4]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [ service_begin/5, subscribe/5 as subscribe_to, subscriber/2,
                subscription/3, unsubscribe/4 as unsubscribe_from ]).
:- use_module('../helper',
              [ helper_call/5, helper_close/1, helper_file/2, helper_note/2,
                helper_open/3, helper_python/2, helper_send/2 ]).
:- use_module(incoming,
              [ connection/1, connection_gone/1, mqtt_filter/2,
                mqtt_payload/3, mqtt_topic/2, mqtt_url/2 ]).

/** <module> MQTT on a host: connection, publishing and subscribing

*Threading*: any thread; predicates of agents run in the thread of the agent.
*/

:- multifile
    typhon_starting:starts/4,
    typhon_helper_owner:again/2,
    typhon_options:declared/4,
    typhon_starting:ends/2,
    prolog:error_message//1.

:- dynamic
    started/3.                  % Host, Options, Request: connects to the broker

typhon_starting:starts(mqtt, Host, URL, Options) :-
    check_options(mqtt_option, Options),
    mqtt_url(URL, Parts),
    request(Options, Parts, Request),
    service_begin(mqtt, Host,
                  [ publish/2, publish/3, subscribe/1, subscribe/2,
                    unsubscribe/1 ],
                  typhon_mqtt_service,
                  connect(Host, Options, Request)).

connect(Host, Options, Request) :-
    assertz(started(Host, Options, Request)),
    helper_python(Options, Python),
    helper_file('mqtt/bridge.py', File),
    helper_open(mqtt(Host), command(Python, ['-u', File]), [restart(always)]),
    option(timeout(Seconds), Options, 10),
    option(wait(Wait), Options, true),
    mqtt_ask(Host, Request.put(wait, Wait), Seconds).

typhon_options:declared(mqtt_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(user(X), text, X).
option_type(password(X), text, X).
option_type(client(X), text, X).
option_type(clean(X), boolean, X).
option_type(will(X, _), text, X).
option_type(will(X, _, Y), list, [X|Y]).
option_type(keepalive(X), between(1, 65535), X).
option_type(ca(X), ground, X).
option_type(cert(X), ground, X).
option_type(key(X), ground, X).
option_type(insecure(X), boolean, X).
option_type(payload(X), oneof([auto,json,text,bytes]), X).
option_type(queue(X), positive_integer, X).
option_type(pending(X), between(1, 1000000), X).
option_type(largest(X), between(1, 33554432), X).
option_type(timeout(X), between(0.001, 3600), X).
option_type(wait(X), boolean, X).
option_type(python(X), atom, X).

%   Request is the request by which the helper connects, also after a restart.

request(Options, Parts, Request) :-
    option(clean(Clean), Options, true),
    option(client(Client), Options, ''),
    (   Clean == false,
        Client == ''
    ->  throw(error(existence_error(mqtt_option, client),
                    context(_, 'for clean(false)')))
    ;   true
    ),
    option(keepalive(Keepalive), Options, 60),
    option(pending(Pending), Options, 1000),
    option(largest(Largest), Options, 4194304),
    findall(Key-Value, given(Key, Options, Value), Given),
    will(Options, Will),
    dict_pairs(More, _, Given),
    Request = Parts.put(More).put(_{ do:connect, wait:false, clean:Clean,
                                     client:Client, keepalive:Keepalive,
                                     pending:Pending, largest:Largest,
                                     will:Will }).

given(Key, Options, Value) :-
    member(Key, [user,password,insecure,ca,cert,key]),
    Option =.. [Key,Value0],
    option(Option, Options),
    (   memberchk(Key, [ca,cert,key])
    ->  absolute_file_name(Value0, Value, [access(read)])
    ;   Value = Value0
    ).

will(Options, Will) :-
    (   option(will(Topic, Payload), Options)
    ->  More = []
    ;   option(will(Topic, Payload, More), Options)
    ),
    !,
    mqtt_message(Topic, Payload, More, auto, Will).
will(_, false).

%   mqtt_message(+Topic, +Payload, +Options, +Kind, -Message:dict) is det.
%
%   Message is to be published.  Options are those of publish/3, Kind is the
%   default kind of the payload.
%
%   @error the errors of mqtt_topic/2 and mqtt_payload/3

mqtt_message(Topic0, Payload0, Options, Kind0, Message) :-
    check_options(mqtt_publish_option, Options),
    mqtt_topic(Topic0, Topic),
    option(payload(Kind), Options, Kind0),
    mqtt_payload(Payload0, Kind, Payload),
    option(qos(QoS), Options, 0),
    option(retain(Retain), Options, false),
    Message = _{ topic:Topic, payload:Payload, kind:Kind, qos:QoS,
                 retain:Retain }.

typhon_options:declared(mqtt_publish_option, Option, Type, Value) :-
    publish_type(Option, Type, Value).

publish_type(qos(X), between(0, 2), X).
publish_type(retain(X), boolean, X).
publish_type(payload(X), oneof([auto,json,text,bytes]), X).
publish_type(wait(X), boolean, X).

typhon_starting:ends(mqtt, Host) :-
    helper_close(mqtt(Host)),
    retractall(started(Host, _, _)),
    connection_gone(Host).

%   mqtt_default(+Host, +Option, +Default) is det.
%
%   As option/3, for the options with which Host was started.
%
%   @error existence_error(mqtt, Host) if it was stopped meanwhile

mqtt_default(Host, Option, Default) :-
    (   started(Host, Options, _)
    ->  option(Option, Options, Default)
    ;   existence_error(mqtt, Host)
    ).

                /*******************************
                *           REQUESTS           *
                *******************************/

%   mqtt_ask(+Host, +Request, +Seconds) is det.
%
%   @error mqtt_error(Problem, Host), where Problem is unreachable, refused, tls
%   or failed; timeout_error(mqtt(What), Host), and the errors of helper_call/5

mqtt_ask(Host, Request, Seconds) :-
    helper_call(mqtt(Host), Request, Seconds, failure(Host, Request), _).

failure(Host, Request, said(Dict), error(Formal, context(_, Message))) :-
    _{error:Text, message:Message} :< Dict,
    atom_string(Kind, Text),
    formal(Kind, Host, Request, Formal).

formal(no_paho, _, _, existence_error(python_module, paho)).
formal(unreachable, Host, _, mqtt_error(unreachable, Host)).
formal(refused, Host, _, mqtt_error(refused, Host)).
formal(tls, Host, _, mqtt_error(tls, Host)).
formal(exception, Host, _, mqtt_error(failed, Host)).
formal(full, _, _, resource_error(mqtt_pending)).
formal(too_big, _, _, resource_error(mqtt_payload)).
formal(denied, _, Request, permission_error(subscribe, mqtt_filter, Filter)) :-
    get_dict(filter, Request, Filter).
formal(timeout, Host, Request, timeout_error(mqtt(What), Host)) :-
    get_dict(do, Request, What).

%   mqtt_publish(+Host, +Message, +Wait:boolean, +Seconds) is det.
%
%   While there is a connection, a message that may be lost (QoS 0) is sent
%   without waiting for an answer of the helper, as that would halve the rate.
%
%   @error the errors of mqtt_ask/3

mqtt_publish(Host, Message, false, _) :-
    get_dict(qos, Message, 0),
    connection(Host),
    fits(Host, Message),
    !,
    helper_send(mqtt(Host), Message.put(_{do:publish, wait:false})).
mqtt_publish(Host, Message, Wait, Seconds) :-
    mqtt_ask(Host, Message.put(_{do:publish, wait:Wait}), Seconds).

%   Message is not too large, whatever its characters: UTF-8 needs up to four
%   bytes.

fits(Host, Message) :-
    get_dict(payload, Message, Text),
    string_length(Text, Length),
    mqtt_default(Host, largest(Largest), 4194304),
    Length*4 =< Largest.

typhon_helper_owner:again(mqtt(Host), Request) :-
    connection_gone(Host),
    started(Host, _, Request0),
    findall(_{filter:Filter, kind:Kind, qos:2},
            subscription(mqtt, Host, mqtt(Filter, Kind)),
            Filters),
    put_dict(filters, Request0, Filters, Request).

                /*******************************
                *            AGENTS            *
                *******************************/

:- multifile
    typhon_options:declared/4,
    typhon_subscribers:wanted/4.

:- public                               % called by agents
    publish/2,
    publish/3,
    subscribe/1,
    subscribe/2,
    unsubscribe/1.

%!  publish(+Topic, +Payload) is det.
%!  publish(+Topic, +Payload, +Options) is det.
%
%   Publish Payload on Topic.  Options:
%
%     - qos(QoS): quality of service, 0 (default), 1 or 2
%     - retain(Boolean): whether the broker keeps the message for later
%       subscribers, default `false`
%     - payload(Kind): `auto`, by which dicts and lists are written as JSON and
%       other terms as text; `json`; `text`; or `bytes`, text whose characters
%       are bytes
%     - wait(Boolean): whether to wait until the broker has the message, default
%       `false`
%
%   While there is no connection messages are kept, and sent after the next
%   connection.
%
%   @error domain_error(mqtt_topic, Topic), type_error(mqtt_payload, Payload),
%   resource_error(mqtt_pending) if too many are kept,
%   resource_error(mqtt_payload) if Payload is too large

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
%   The agent gets messages on topics that match Filter as
%   mqtt-message(Topic, Payload, Options), where Topic is an atom and Options
%   are qos(N) and retain(Boolean), until it unsubscribes, leaves the host, or
%   ends. Messages that do not fit in its queue are reported by
%   mqtt-dropped(mqtt(Filter, Kind), Count), messages that are too large by
%   mqtt-too_big(Topic, Bytes). Options:
%
%     - qos(N): maximal quality of service of the messages, default 0
%     - payload(Kind): `auto`, JSON objects and lists become dicts and lists,
%       other payloads strings; `json`, all payloads become terms; `text`; or
%       `bytes`, a string of characters up to 255.  A payload that is not UTF-8
%       is always bytes.
%     - as(How), queue(N): as of subscribe/5 of typhon_subscribers
%
%   @error domain_error(mqtt_filter, Filter)
%   @error permission_error(subscribe, mqtt_filter, Filter) the broker refuses
%   the subscription

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
%   End the subscription of the agent to Filter.
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

%   A subscription with another kind of payload replaces the first: an agent has
%   one subscription to a filter.

unsubscribe_others(Filter, Key, Host, Agent) :-
    forall(( kind(Kind), Other = mqtt(Filter, Kind), Other \== Key ),
           ignore(unsubscribe_from(mqtt, Host, Other, Agent))).

kind(auto).
kind(json).
kind(text).
kind(bytes).

typhon_subscribers:wanted(mqtt, Host, mqtt(Filter, Kind), Wanted) :-
    wanted_request(Wanted, Do, More),
    helper_note(mqtt(Host), More.put(_{do:Do, filter:Filter, kind:Kind})).

wanted_request(true, subscribe, _{qos:2}).
wanted_request(false, unsubscribe, _{}).
