:- module(typhon_ros, []).

/** <module> ROS: robots as services of a place

    :- use_module(library(typhon/ros)).

Hosts with ROS 2, as a node of it or through a rosbridge server; agents
that stand there publish, subscribe, call, offer services and send goals.  It
is not part of library(typhon).  Nothing is defined here: see the modules in
bridges/ros/.

  | start, stop, properties       | typhon/bridges/common/starting |
  | topics                        | typhon/bridges/ros/service     |
  | services, parameters, actions | typhon/bridges/ros/requests    |
  | messages as terms             | typhon/bridges/ros/messages    |
*/

:- use_module(tools/user_errors, [user_errors/1]).
:- reexport(bridges/common/starting, [ros_property/2, ros_start/3, ros_stop/1]).
:- reexport(bridges/ros/service).
:- use_module(bridges/ros/events, []).

:- user_errors(typhon_ros).
