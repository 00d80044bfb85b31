:- module(typhon_ros_service,
          [ ros_publish/3,              % +Topic, +Type, +Message
            ros_subscribe/2,            % +Topic, ?Type
            ros_subscribe/3,            % +Topic, ?Type, +Options
            ros_unsubscribe/1,          % +Topic
            ros_topics/1,               % -Pairs
            ros_services/1              % -Services
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [domain_error/2, existence_error/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [ service/2, service_begin/5, subscribe/5, subscriber/2,
                unsubscribe/4 ]).
:- use_module(connection,
              [ answers_fail/2, way_close/1, way_open/3, way_send/2,
                way_state/3 ]).
:- use_module(events, [ros_ignored/2]).
:- use_module(advertisements,
              [claim/3, registration/3, registrations_forget/1]).
:- use_module(requests, [call_json/5]).
:- use_module(messages, [ros_name/3, ros_type/3, value_json/2]).

/** <module> A host with ROS

This module exports the predicates that agents find on the host.  It is started
by ros_start/3.

*Threading*: any thread; predicates of agents run in the thread of the agent,
which waits until the node of Typhon has accepted a message, or it fits in the
queue to a server.
*/

:- reexport(requests,
            except([ call_json/5, goal_end/4, request_begin/3,
                     request_end/3 ])).

:- multifile
    typhon_options:declared/4,
    typhon_starting:ends/2,
    typhon_starting:has/3,
    typhon_starting:starts/4,
    prolog:error_message//1,
    prolog:message//1.

typhon_starting:starts(ros, Host, Where, Options) :-
    check_options(ros_option, Options),
    check_where(Where),
    module_property(typhon_ros_service, exports(PIs)),
    service_begin(ros, Host, PIs, typhon_ros_service,
                  way_open(Host, Where, Options)).

check_where(ros2) :-
    !.
check_where(URL) :-
    (   member(Scheme, ['ws://', 'wss://']),
        atom_concat(Scheme, _, URL)
    ->  true
    ;   domain_error(ros, URL)
    ).

typhon_options:declared(ros_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(messages(X), oneof([dict,terms]), X).
option_type(deadline(X), between(0.01, 3600), X).
option_type(connect_deadline(X), between(0.01, 3600), X).
option_type(silence(X), between(0.1, 3600), X).
option_type(node(X), atom, X).
option_type(domain(X), between(0, 232), X).
option_type(reach(X), oneof([localhost,subnet]), X).
option_type(python(X), atom, X).

typhon_starting:ends(ros, Host) :-
    way_close(Host),
    answers_fail(Host, stopped),
    registrations_forget(Host).

typhon_starting:has(ros, Host, Property) :-
    service(ros, Host),
    property(Property, Host).

property(way(Where), Host) :-
    way_state(Host, Where, _).
property(connected(Connected), Host) :-
    way_state(Host, _, Connected).
property(heard(Topic, Type), Host) :-
    registration(Host, _, subscribe(Topic, Type)).
property(published(Topic, Type), Host) :-
    registration(Host, _, advertise(Topic, Type)).
property(offered(Service, Type), Host) :-
    registration(Host, _, offer(Service, Type)).
property(ignored(Count), Host) :-
    ros_ignored(Host, Count).

                /*******************************
                *            TOPICS            *
                *******************************/

%!  ros_publish(+Topic, +Type, +Message) is det.
%
%   Publish Message, a dict or a list, see value_json/2.  Missing fields get the
%   default values of ROS.
%
%   @error domain_error(ros_name(topic), Topic)
%   @error domain_error(ros_type(msg), Type), existence_error(ros_type, Type)
%   @error permission_error(use, ros_topic(Type), Topic) if Topic is in use on
%          this host with messages of another Type
%   @error type_error(ros_message, Message), type_error(ros_value, Value)
%   @error existence_error(ros_field, Field), type_error(ros_field(F, T), V)
%   @error ros_error(not_connected, Host), resource_error(ros_queue)
%
%   A server does not report errors in a message directly.  Some servers send a
%   status, which the agent gets as a message `ros-error(Text)`.

ros_publish(Topic0, Type0, Message) :-
    subscriber(Host, Agent),
    ros_name(topic, Topic0, Topic),
    ros_type(msg, Type0, Type),
    value_json(Message, JSON),
    claim(Host, advertise(Topic), advertise(Topic, Type)),
    atom_concat('publish:', Agent, Id),
    way_send(Host, publish(Id, Topic, JSON)).

%!  ros_subscribe(+Topic, ?Type) is det.
%!  ros_subscribe(+Topic, ?Type, +Options) is det.
%
%   Subscribe the agent to Topic.  It gets messages as `ros-topic(Topic,
%   Message)`, or in the form given by Options, see subscribe/5.  An unbound
%   Type is unified with that of the existing topic.
%
%   @error domain_error(ros_name(topic), Topic)
%   @error domain_error(ros_type(msg), Type), existence_error(ros_type, Type)
%   @error permission_error(use, ros_topic(Type), Topic)
%   @error existence_error(ros_topic, Topic)
%   @error domain_error(subscription_option, Option)
%   @error existence_error(running_agent, here) if no agent subscribes

ros_subscribe(Topic, Type) :-
    ros_subscribe(Topic, Type, []).

ros_subscribe(Topic0, Type, Options) :-
    subscriber(Host, Agent),
    ros_name(topic, Topic0, Topic),
    topic_type(Topic, Type, Atom),
    subscribe(ros, Host, Topic, Agent, Options),
    catch(claim(Host, topic(Topic), subscribe(Topic, Atom)), Ball,
          ( ignore(unsubscribe(ros, Host, Topic, Agent)),
            throw(Ball) )).

topic_type(_, Type, Atom) :-
    nonvar(Type),
    !,
    ros_type(msg, Type, Atom).
topic_type(Topic, Type, Type) :-
    ros_topics(Pairs),
    (   memberchk(Topic-Type0, Pairs)
    ->  Type = Type0
    ;   existence_error(ros_topic, Topic)
    ).

%!  ros_unsubscribe(+Topic) is det.
%
%   End the subscription of the agent to Topic.
%
%   @error existence_error(ros_subscription, Topic)

ros_unsubscribe(Topic0) :-
    subscriber(Host, Agent),
    ros_name(topic, Topic0, Topic),
    (   unsubscribe(ros, Host, Topic, Agent)
    ->  true
    ;   existence_error(ros_subscription, Topic)
    ).

%!  ros_topics(-Pairs:list) is det.
%!  ros_services(-Services:list) is det.
%
%   Pairs are Topic-Type of all known topics; Services are the names of all
%   services.  A rosbridge server can only answer if the node `rosapi` runs.
%
%   @error existence_error(ros_service, '/rosapi/topics')

ros_topics(Pairs) :-
    subscriber(Host, _),
    call_json(Host, '/rosapi/topics', 'rosapi_msgs/srv/Topics', _{}, JSON),
    maplist(atom_string, Topics, JSON.topics),
    maplist(atom_string, Types, JSON.types),
    pairs_keys_values(Pairs, Topics, Types).

ros_services(Services) :-
    subscriber(Host, _),
    call_json(Host, '/rosapi/services', 'rosapi_msgs/srv/Services', _{},
              JSON),
    maplist(atom_string, Services, JSON.services).

prolog:message(typhon(ros_lost(Host, Why))) -->
    [ '~w has lost ROS (~p), and tries to reconnect'-[Host, Why] ].
prolog:message(typhon(ros_found(Host))) -->
    [ '~w has ROS again'-[Host] ].
prolog:message(typhon(ros_ignored(Host, What))) -->
    [ '~w has received an unknown frame from ROS: ~p (more of them are \c
       only counted)'-[Host, What] ].
prolog:message(typhon(ros_complaint(Host, Text))) -->
    [ 'ROS reports to ~w: ~w'-[Host, Text] ].
