:- module(typhon_ros_requests,
          [ ros_call/4,                 % +Service, +Type, +Request, -Response
            ros_call/5,                 % +Service, +Type, +Request, -Response,
                                        % +Options
            ros_offer/3,                % +Service, +Type, +Options
            ros_withdraw/1,             % +Service
            ros_answer/2,               % +Id, +Response
            ros_refuse/1,               % +Id
            ros_parameters/2,           % +Node, -Names
            ros_parameter/3,            % +Node, +Name, -Value
            ros_set_parameter/3,        % +Node, +Name, +Value
            ros_goal/4,                 % +Action, +Type, +Goal, -Id
            ros_cancel/1,               % +Id
            call_json/5,                % +Host, +Service, +Type, +JSON, -JSON
            goal_end/4,                 % +Host, ?Id, -Agent, -Action
            request_begin/3,            % +Host, +Id, +Service
            request_end/3               % +Host, ?Id, ?Service
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error),
              [ existence_error/2, must_be/2, permission_error/3,
                type_error/2 ]).
:- use_module(library(option), [option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [subscribe/5, subscriber/2, subscription/3, unsubscribe/4]).
:- use_module(advertisements, [claim/3]).
:- use_module(connection, [way_await/5, way_option/3, way_send/2]).
:- use_module(messages,
              [json_value/3, ros_id/1, ros_name/3, ros_type/3, value_json/2]).

/** <module> Services, parameters and actions

The parameters of a node of ROS 2 are services of the node, so they are the same
for a host that is a node and for one that uses a server.

*Threading*: the thread that runs the agent, which waits for answers; any thread
may use the tables of open requests and goals.
*/

:- multifile
    typhon_options:declared/4.

typhon_options:declared(ros_call_option, deadline(X), between(0.01, 3600), X).

%!  ros_call(+Service, +Type, +Request, -Response) is semidet.
%!  ros_call(+Service, +Type, +Request, -Response, +Options) is semidet.
%
%   Call Service.  Request and Response have the form of a message of
%   ros_publish/3.  Option: deadline(Seconds), default that of ros_start/3.
%
%   @error domain_error(ros_name(service), Service)
%   @error domain_error(ros_type(srv), Type), existence_error(ros_type, Type)
%   @error type_error(ros_message, Request), type_error(ros_value, Value)
%   @error existence_error(ros_field, Field), type_error(ros_field(F, T), V)
%   @error existence_error(ros_service, Service)
%   @error timeout_error(ros_call, Service)
%   @error ros_error(refused, Service) the service reports a failure
%   @error ros_error(not_connected, Host), ros_error(lost, Host)

ros_call(Service, Type, Request, Response) :-
    ros_call(Service, Type, Request, Response, []).

ros_call(Service0, Type0, Request, Response, Options) :-
    subscriber(Host, _),
    check_options(ros_call_option, Options),
    ros_name(service, Service0, Service),
    ros_type(srv, Type0, Type),
    value_json(Request, JSON),
    way_option(Host, deadline(Default), 5),
    option(deadline(Seconds), Options, Default),
    call_json(Host, Service, Type, JSON, Seconds, Answer),
    way_option(Host, messages(Form), dict),
    json_value(Form, Answer, Response).

%!  call_json(+Host, +Service, +Type, +Request, -Response) is det.
%
%   Call Service; Request and Response are JSON.
%
%   @error the errors of ros_call/5

call_json(Host, Service, Type, Request, Response) :-
    way_option(Host, deadline(Seconds), 5),
    call_json(Host, Service, Type, Request, Seconds, Response).

call_json(Host, Service, Type, Request, Seconds0, Response) :-
    ros_id(Id),
    Seconds is float(Seconds0),
    way_await(Host, Id, call(Id, Service, Type, Request, Seconds), Seconds,
              Answer),
    answered(Answer, Host, Service, Response).

answered(ok(JSON), _, _, JSON).
answered(failed(Text), _, Service, _) :-
    (   sub_string(Text, _, _, _, "does not exist")
    ->  Formal = existence_error(ros_service, Service)
    ;   Formal = ros_error(refused, Service)
    ),
    throw(error(Formal, context(_, Text))).
answered(lost(Why), Host, _, _) :-
    throw(error(ros_error(lost, Host), context(_, Why))).
answered(timeout, _, Service, _) :-
    throw(error(timeout_error(ros_call, Service), _)).

                /*******************************
                *           OFFERING           *
                *******************************/

%!  ros_offer(+Service, +Type, +Options) is det.
%
%   The agent offers Service.  For each call it gets a message
%   `ros-request(Id, Service, Request)`, which it answers by ros_answer/2 or
%   ros_refuse/1.  Options may hold queue(N), see subscribe/5.
%
%   @error permission_error(offer, ros_service, Service) if an agent on this
%          host offers Service already
%   @error domain_error(ros_name(service), Service)
%   @error domain_error(ros_type(srv), Type), existence_error(ros_type, Type)

ros_offer(Service0, Type0, Options) :-
    subscriber(Host, Agent),
    ros_name(service, Service0, Service),
    ros_type(srv, Type0, Type),
    with_mutex(typhon_ros_offer,
               (   subscription(ros, Host, service(Service))
               ->  permission_error(offer, ros_service, Service)
               ;   subscribe(ros, Host, service(Service), Agent,
                             [as(message)|Options])
               )),
    catch(claim(Host, service(Service), offer(Service, Type)), Ball,
          ( ignore(unsubscribe(ros, Host, service(Service), Agent)),
            throw(Ball) )).

%!  ros_withdraw(+Service) is det.
%
%   The agent stops offering Service.  Calls that it has not answered fail.
%
%   @error existence_error(ros_offer, Service)

ros_withdraw(Service0) :-
    subscriber(Host, Agent),
    ros_name(service, Service0, Service),
    (   unsubscribe(ros, Host, service(Service), Agent)
    ->  true
    ;   existence_error(ros_offer, Service)
    ).

%!  ros_answer(+Id, +Response) is det.
%!  ros_refuse(+Id) is det.
%
%   Answer the call Id by Response; let it fail.
%
%   @error existence_error(ros_request, Id) if the call has been answered, or
%   its caller is gone
%   @error type_error(ros_message, Response), and others of ros_publish/3

ros_answer(Id, Response) :-
    subscriber(Host, _),
    value_json(Response, JSON),
    respond(Host, Id, JSON, true).

ros_refuse(Id) :-
    subscriber(Host, _),
    respond(Host, Id, _{}, false).

respond(Host, Id, JSON, Result) :-
    must_be(nonvar, Id),
    (   request(Id, Host, Service)
    ->  way_send(Host, respond(Id, Service, JSON, Result)),
        ignore(request_end(Host, Id, Service))
    ;   existence_error(ros_request, Id)
    ).

                /*******************************
                *          PARAMETERS          *
                *******************************/

%!  ros_parameters(+Node, -Names:list(atom)) is det.
%!  ros_parameter(+Node, +Name, -Value) is det.
%!  ros_set_parameter(+Node, +Name, +Value) is det.
%
%   Names are the parameters of Node; Value is the value of the parameter Name;
%   set it to Value.  A value is `true` or `false`, a number, a string, or a
%   list of these.  A parameter that is a float does not accept an integer.
%
%   @error existence_error(ros_service, Service) if there is no such Node
%   @error existence_error(ros_parameter, Name)
%   @error ros_error(refused, Name)
%   @error type_error(ros_parameter, Value), and the errors of ros_call/4

ros_parameters(Node, Names) :-
    ask(Node, list_parameters, 'ListParameters', _{prefixes:[], depth:0},
        JSON),
    maplist(atom_string, Names, JSON.result.names).

ros_parameter(Node, Name, Value) :-
    must_be(atom, Name),
    ask(Node, get_parameters, 'GetParameters', _{names:[Name]}, JSON),
    (   JSON.values = [Parameter|_],
        value_key(Parameter.type, Key)
    ->  Value = Parameter.get(Key)
    ;   existence_error(ros_parameter, Name)
    ).

ros_set_parameter(Node, Name, Value) :-
    must_be(atom, Name),
    must_be(ground, Value),
    (   value_type(Value, Type)
    ->  value_key(Type, Key),
        dict_pairs(Parameter, _, [type-Type,Key-Value])
    ;   type_error(ros_parameter, Value)
    ),
    ask(Node, set_parameters, 'SetParameters',
        _{parameters:[_{name:Name, value:Parameter}]}, JSON),
    JSON.results = [Result|_],
    (   Result.successful == true
    ->  true
    ;   throw(error(ros_error(refused, Name), context(_, Result.reason)))
    ).

ask(Node0, Name, Type, Request, JSON) :-
    subscriber(Host, _),
    ros_name(node, Node0, Node),
    atomic_list_concat([Node, Name], /, Service),
    atom_concat('rcl_interfaces/srv/', Type, FullType),
    call_json(Host, Service, FullType, Request, JSON).

%   The numbers are those of rcl_interfaces/msg/ParameterType; 0 is no value.

value_key(1, bool_value).
value_key(2, integer_value).
value_key(3, double_value).
value_key(4, string_value).
value_key(5, byte_array_value).
value_key(6, bool_array_value).
value_key(7, integer_array_value).
value_key(8, double_array_value).
value_key(9, string_array_value).

value_type(List, Type) :-
    is_list(List),
    !,
    List = [First|_],
    value_type(First, Type1),
    maplist(of_type(Type1), List),
    Type is Type1+5.
value_type(true, 1) :- !.
value_type(false, 1) :- !.
value_type(Value, 2) :- integer(Value).
value_type(Value, 3) :- float(Value).
value_type(Value, 4) :- ( string(Value) ; atom(Value) ).

of_type(Type, Value) :-
    value_type(Value, Type),
    !.

%!  ros_goal(+Action, +Type, +Goal, -Id:atom) is det.
%
%   Send Goal to an action server, and do not wait for the result.  The agent
%   gets messages `ros-feedback(Id, Feedback)`, and finally `ros-result(Id,
%   Status, Result)`.  Status is `succeeded`, `canceled`, `aborted`, or
%   `failed`.  If it is `failed`, Result is text: the server does not exist, has
%   refused the goal, or is gone.  The goal of an agent that leaves or ends is
%   cancelled.
%
%   @error domain_error(ros_name(action), Action)
%   @error domain_error(ros_type(action), Type)
%   @error existence_error(ros_type, Type)
%   @error type_error(ros_message, Goal), and others of ros_publish/3

ros_goal(Action0, Type0, Goal, Id) :-
    subscriber(Host, Agent),
    ros_name(action, Action0, Action),
    ros_type(action, Type0, Type),
    value_json(Goal, JSON),
    ros_id(Id),
    subscribe(ros, Host, goal(Id), Agent, []),
    assertz(goal(Id, Host, Agent, Action)),
    catch(way_send(Host, goal(Id, Action, Type, JSON)), Ball,
          ( ignore(goal_end(Host, Id, _, _)),
            ignore(unsubscribe(ros, Host, goal(Id), Agent)),
            throw(Ball) )).

%!  ros_cancel(+Id) is det.
%
%   Request the server to cancel the goal Id.  The result of the goal reports
%   whether it was cancelled.
%
%   @error existence_error(ros_goal, Id) if the goal has ended, or is of another
%   host

ros_cancel(Id) :-
    subscriber(Host, _),
    must_be(atom, Id),
    (   goal(Id, Host, _, Action)
    ->  way_send(Host, cancel(Id, Action))
    ;   existence_error(ros_goal, Id)
    ).

                /*******************************
                *            TABLES            *
                *******************************/

:- setting(most, positive_integer, 1000,
           "Requests of ROS that may wait for the answers of agents").

:- dynamic
    goal/4,                     % Id, Host, Agent, Action: open
    request/3.                  % Id, Host, Service: open

%!  goal_end(+Host, ?Id, -Agent, -Action) is semidet.

goal_end(Host, Id, Agent, Action) :-
    retract(goal(Id, Host, Agent, Action)),
    !.

%!  request_begin(+Host, +Id, +Service) is semidet.
%!  request_end(+Host, ?Id, ?Service) is semidet.
%
%   Record the open request Id for Service; remove it.  request_begin/3 fails if
%   too many requests are open.

request_begin(Host, Id, Service) :-
    aggregate_all(count, request(_, Host, _), Count),
    setting(most, Most),
    Count < Most,
    assertz(request(Id, Host, Service)).

request_end(Host, Id, Service) :-
    retract(request(Id, Host, Service)),
    !.
