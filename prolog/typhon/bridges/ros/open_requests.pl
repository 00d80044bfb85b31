:- module(typhon_ros_open_requests,
          [ goal_begin/4,               % +Host, +Id, +Agent, +Action
            goal_end/4,                 % +Host, ?Id, -Agent, -Action
            goal_action/3,              % +Host, +Id, -Action
            request_begin/3,            % +Host, +Id, +Service
            request_open/3,             % +Host, +Id, -Service
            request_end/3               % +Host, ?Id, ?Service
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(settings), [setting/2, setting/4]).

/** <module> What is under way: goals of our agents, requests to them

*Threading*: any thread.
*/

:- setting(most, positive_integer, 1000,
           "Requests of ROS that may wait for the answers of agents").

:- dynamic
    goal/4,                     % Id, Host, Agent, Action
    request/3.                  % Id, Host, Service

%!  goal_begin(+Host, +Id, +Agent, +Action) is det.
%!  goal_end(+Host, ?Id, -Agent, -Action) is semidet.
%!  goal_action(+Host, +Id, -Action) is semidet.

goal_begin(Host, Id, Agent, Action) :-
    assertz(goal(Id, Host, Agent, Action)).

goal_end(Host, Id, Agent, Action) :-
    retract(goal(Id, Host, Agent, Action)),
    !.

goal_action(Host, Id, Action) :-
    goal(Id, Host, _, Action),
    !.

%!  request_begin(+Host, +Id, +Service) is semidet.
%!  request_open(+Host, +Id, -Service) is semidet.
%!  request_end(+Host, ?Id, ?Service) is semidet.
%
%   The first fails if too many wait already.

request_begin(Host, Id, Service) :-
    aggregate_all(count, request(_, Host, _), Count),
    setting(most, Most),
    Count < Most,
    assertz(request(Id, Host, Service)).

request_open(Host, Id, Service) :-
    request(Id, Host, Service),
    !.

request_end(Host, Id, Service) :-
    retract(request(Id, Host, Service)),
    !.
