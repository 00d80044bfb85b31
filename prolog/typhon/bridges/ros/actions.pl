:- module(typhon_ros_actions,
          [ ros_goal/4,                 % +Action, +Type, +Goal, -Id
            ros_cancel/1                % +Id
          ]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module('../common', [subscribe/5, subscriber/2, unsubscribe/4]).
:- use_module(names, [ros_id/1, ros_name/3, ros_type/3]).
:- use_module(open_requests, [goal_action/3, goal_begin/4, goal_end/4]).
:- use_module(values, [value_json/2]).
:- use_module(ways, [way_say/2]).

/** <module> Actions: goals that take their time

*Threading*: the thread that runs the agent.
*/

%!  ros_goal(+Action, +Type, +Goal, -Id:atom) is det.
%
%   Send a goal to an action server, and go on.  The agent gets messages
%   `ros-feedback(Id, Feedback)`, and at last `ros-result(Id, Status, Result)`.
%   Status is `succeeded`, `canceled`, `aborted`, or `failed`, then Result is
%   text: the server is not there, or has refused the goal, or is gone.  The
%   goal of an agent that leaves or ends is cancelled.
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
    goal_begin(Host, Id, Agent, Action),
    catch(way_say(Host, goal(Id, Action, Type, JSON)), Ball,
          ( ignore(goal_end(Host, Id, _, _)),
            ignore(unsubscribe(ros, Host, goal(Id), Agent)),
            throw(Ball) )).

%!  ros_cancel(+Id) is det.
%
%   Ask the server to give the goal up.  The result tells whether it has.
%
%   @error existence_error(ros_goal, Id) if it is over, or of another host

ros_cancel(Id) :-
    subscriber(Host, _),
    must_be(atom, Id),
    (   goal_action(Host, Id, Action)
    ->  way_say(Host, cancel(Id, Action))
    ;   existence_error(ros_goal, Id)
    ).
