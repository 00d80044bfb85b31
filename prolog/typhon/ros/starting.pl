:- module(typhon_ros_starting,
          [ ros_start/3,                % +Host, +Where, +Options
            ros_stop/1,                 % +Host
            ros_property/2              % ?Host, ?Property
          ]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module('../base/options', [check_options/2]).
:- use_module('../bridge',
              [service/2, service_begin/4, service_end/2, service_host/2]).
:- use_module(answers, [answers_fail/2]).
:- use_module(events, [ros_ignored/2]).
:- use_module(standing, [standing/3, standing_forget/1]).
:- use_module(ways, [way_close/1, way_open/3, way_state/3]).
:- use_module(words, [ros_words/1]).

/** <module> A host with ROS

*Threading*: any thread.
*/

:- multifile
    typhon_options:declared/4,
    typhon_services:ends/2.

%!  ros_start(+Host, +Where, +Options) is det.
%
%   The place of Host, which is of this process, has ROS: agents there find
%   the predicates of typhon_ros_topics, typhon_ros_calls,
%   typhon_ros_actions and typhon_ros_parameters.  Where is `ros2`: Host
%   is a node of ROS 2; or a URL as 'ws://robot:9090/', that of a
%   rosbridge server, of ROS 1 or 2.  Options:
%
%     - messages(Form): what comes in is a `dict`, default, or `terms`, a
%       list of Name=Value
%     - deadline(Seconds): for what is asked of ROS, default 5
%     - connect_deadline(Seconds): for this call, default 20 for `ros2`,
%       which starts a process, 5 for a server
%
%   for `ros2`
%
%     - node(Name): default typhon_Host
%     - domain(N): default is that of the environment variable ROS_DOMAIN_ID
%     - reach(Reach): who is to be found: `localhost`, default, or `subnet`
%     - python(File): which has rclpy; default that of `make tools-ros`
%
%   and for a server
%
%     - silence(Seconds): when it has not even answered a ping for so long
%       it is gone; default 30
%
%   @error existence_error(host, Host), permission_error(start, ros, Host)
%   @error domain_error(ros_option, Option), domain_error(ros, Where)
%   @error existence_error(ros_python, File) if `make tools-ros` has not made
%          it, existence_error(python_module, rclpy)
%   @error socket_error(Code, Text) and others of http_open/3
%   @error timeout_error(connect, URL)

ros_start(Host0, Where, Options) :-
    service_host(Host0, Host),
    must_be(atom, Where),
    check_where(Where),
    check_options(ros_option, Options),
    ros_words(PIs),
    service_begin(ros, Host, PIs, typhon_ros_words),
    catch(way_open(Host, Where, Options), Ball,
          ( service_end(ros, Host),
            throw(Ball) )).

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

%!  ros_stop(+Host) is det.
%
%   @error existence_error(ros, Host)

ros_stop(Host) :-
    service_end(ros, Host).

typhon_services:ends(ros, Host) :-
    way_close(Host),
    answers_fail(Host, stopped),
    standing_forget(Host).

%!  ros_property(?Host, ?Property) is nondet.
%
%   Property is way(Where), connected(Boolean), heard(Topic, Type),
%   published(Topic, Type), offered(Service, Type), or ignored(Count), of what
%   came and was not for us.

ros_property(Host, Property) :-
    service(ros, Host),
    property(Property, Host).

property(way(Where), Host) :-
    way_state(Host, Where, _).
property(connected(Connected), Host) :-
    way_state(Host, _, Connected).
property(heard(Topic, Type), Host) :-
    standing(Host, _, subscribe(Topic, Type)).
property(published(Topic, Type), Host) :-
    standing(Host, _, advertise(Topic, Type)).
property(offered(Service, Type), Host) :-
    standing(Host, _, offer(Service, Type)).
property(ignored(Count), Host) :-
    ros_ignored(Host, Count).
