:- module(typhon_ros_calls,
          [ ros_call/4,                 % +Service, +Type, +Request, -Response
            ros_call/5,                 % +Service, +Type, +Request, -Response,
                                        % +Options
            ros_offer/3,                % +Service, +Type, +Options
            ros_withdraw/1,             % +Service
            ros_answer/2,               % +Id, +Response
            ros_refuse/1,               % +Id
            call_json/5                 % +Host, +Service, +Type, +JSON, -JSON
          ]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(option), [option/3]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../common',
              [ subscribe/5, subscriber/2, subscription/3, unsubscribe/4 ]).
:- use_module(claims, [claim/3]).
:- use_module(names, [ros_id/1, ros_name/3, ros_type/3]).
:- use_module(open_requests, [request_end/3, request_open/3]).
:- use_module(values, [json_value/3, value_json/2]).
:- use_module(ways, [way_await/5, way_option/3, way_say/2]).

/** <module> Services: calling and offering them

*Threading*: the thread that runs the agent, which waits for answers.
*/

:- multifile
    typhon_options:declared/4.

typhon_options:declared(ros_call_option, deadline(X), between(0.01, 3600), X).

%!  ros_call(+Service, +Type, +Request, -Response) is semidet.
%!  ros_call(+Service, +Type, +Request, -Response, +Options) is semidet.
%
%   Call a service.  Request is as the message of ros_publish/3.  Options:
%
%     - deadline(Seconds)
%       Default is that of ros_start/3.
%
%   @error domain_error(ros_name(service), Service)
%   @error domain_error(ros_type(srv), Type), existence_error(ros_type, Type)
%   @error type_error(ros_message, Request), type_error(ros_value, Value)
%   @error existence_error(ros_field, Field), type_error(ros_field(F, T), V)
%   @error existence_error(ros_service, Service)
%   @error timeout_error(ros_call, Service)
%   @error ros_error(refused, Service): it says it has failed
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
%   The agent has a service from now on.  For each call it gets a message
%   `ros-request(Id, Service, Request)`, which it answers by ros_answer/2 or
%   ros_refuse/1.  Options are queue(N) of subscribe/5.
%
%   @error permission_error(offer, ros_service, Service) if an agent here
%          does
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
%   The agent has the service no longer.  Calls that it has not answered
%   fail.
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
%   Answer a call; or have it fail.
%
%   @error existence_error(ros_request, Id) if it is answered, or its caller
%          gone
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
    (   request_open(Host, Id, Service)
    ->  way_say(Host, respond(Id, Service, JSON, Result)),
        ignore(request_end(Host, Id, Service))
    ;   existence_error(ros_request, Id)
    ).
