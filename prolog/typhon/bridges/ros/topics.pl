:- module(typhon_ros_topics,
          [ ros_publish/3,              % +Topic, +Type, +Message
            ros_subscribe/2,            % +Topic, ?Type
            ros_subscribe/3,            % +Topic, ?Type, +Options
            ros_unsubscribe/1,          % +Topic
            ros_topics/1,               % -Pairs
            ros_services/1              % -Services
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [memberchk/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module('../common', [subscribe/5, subscriber/2, unsubscribe/4]).
:- use_module(requests, [call_json/5]).
:- use_module(advertisements, [claim/3]).
:- use_module(messages, [ros_name/3, ros_type/3, value_json/2]).
:- use_module(connection, [way_say/2]).

/** <module> Topics, as agents use them

*Threading*: the thread that runs the agent.  It waits until our own node
has taken what is said, or it fits in the queue to a server.
*/

%!  ros_publish(+Topic, +Type, +Message) is det.
%
%   Publish Message, a dict or a list as of value_json/2; fields that are
%   missing have the values that ROS gives them.
%
%   @error domain_error(ros_name(topic), Topic)
%   @error domain_error(ros_type(msg), Type), existence_error(ros_type, Type)
%   @error permission_error(use, ros_topic(Type), Topic) if it is in use here
%          with messages of another Type
%   @error type_error(ros_message, Message), type_error(ros_value, Value)
%   @error existence_error(ros_field, Field), type_error(ros_field(F, T), V)
%   @error ros_error(not_connected, Host), resource_error(ros_queue)
%
%   A server does not say what is wrong with a message; some send a status,
%   which the agent gets as a message `ros-error(Text)`.

ros_publish(Topic0, Type0, Message) :-
    subscriber(Host, Agent),
    ros_name(topic, Topic0, Topic),
    ros_type(msg, Type0, Type),
    value_json(Message, JSON),
    claim(Host, advertise(Topic), advertise(Topic, Type)),
    atom_concat('publish:', Agent, Id),
    way_say(Host, publish(Id, Topic, JSON)).

%!  ros_subscribe(+Topic, ?Type) is det.
%!  ros_subscribe(+Topic, ?Type, +Options) is det.
%
%   From now on the agent gets what is published on Topic, as messages
%   `ros-topic(Topic, Message)`, or as Options say: see subscribe/5.  If Type
%   is unbound it is that of a topic which is there.
%
%   @error domain_error(ros_name(topic), Topic)
%   @error domain_error(ros_type(msg), Type), existence_error(ros_type, Type)
%   @error permission_error(use, ros_topic(Type), Topic)
%   @error existence_error(ros_topic, Topic)
%   @error domain_error(subscription_option, Option)
%   @error existence_error(running_agent, here) if it is for no agent

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

topic_type(Topic, Type, Atom) :-
    nonvar(Type),
    !,
    ros_type(msg, Type, Atom),
    ros_name(topic, Topic, _).
topic_type(Topic, Type, Type) :-
    ros_topics(Pairs),
    (   memberchk(Topic-Type0, Pairs)
    ->  Type = Type0
    ;   existence_error(ros_topic, Topic)
    ).

%!  ros_unsubscribe(+Topic) is det.
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
%   Topic-Type of all topics that are known; the names of all services.  A
%   server needs the node `rosapi` beside it for this.
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
