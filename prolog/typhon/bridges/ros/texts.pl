:- module(typhon_ros_texts, []).

/** <module> What is told to people of ROS

*Threading*: any thread.
*/

:- multifile
    prolog:error_message//1,
    prolog:message//1.

prolog:message(typhon(ros_lost(Host, Why))) -->
    [ '~w has lost ROS (~p), and looks for it again'-[Host, Why] ].
prolog:message(typhon(ros_found(Host))) -->
    [ '~w has ROS again'-[Host] ].
prolog:message(typhon(ros_ignored(Host, What))) -->
    [ '~w has heard of ROS what it does not understand: ~p (more of it is \c
       only counted)'-[Host, What] ].
prolog:message(typhon(ros_complaint(Host, Text))) -->
    [ 'ROS complains to ~w: ~w'-[Host, Text] ].

prolog:error_message(existence_error(ros, Host)) -->
    [ '~w has no ROS (ros_start/3 gives it some)'-[Host] ].
prolog:error_message(existence_error(ros_python, File)) -->
    [ 'There is no Python with rclpy at ~w (make tools-ros puts it \c
       there)'-[File] ].
prolog:error_message(existence_error(ros_type, Type)) -->
    [ 'There is no type ~w among those that are installed'-[Type] ].
prolog:error_message(existence_error(ros_topic, Topic)) -->
    [ 'There is no topic ~w'-[Topic] ].
prolog:error_message(existence_error(ros_service, Service)) -->
    [ 'There is no service ~w'-[Service] ].
prolog:error_message(existence_error(ros_field, Field)) -->
    [ 'The message has no field ~w'-[Field] ].
prolog:error_message(existence_error(ros_subscription, Topic)) -->
    [ 'This agent does not hear ~w'-[Topic] ].
prolog:error_message(type_error(ros_field(Field, Type), Value)) -->
    [ 'The field ~w is ~w, not ~p'-[Field, Type, Value] ].
prolog:error_message(permission_error(use, ros_topic(Type), Topic)) -->
    [ '~w is in use here, with messages ~w'-[Topic, Type] ].
prolog:error_message(permission_error(offer, ros_service, Service)) -->
    [ 'An agent here offers ~w'-[Service] ].
prolog:error_message(timeout_error(ros_call, Service)) -->
    [ '~w did not answer in time'-[Service] ].
prolog:error_message(ros_error(refused, Name)) -->
    [ '~w has refused'-[Name] ].
prolog:error_message(ros_error(not_connected, Host)) -->
    [ '~w is not connected to ROS now'-[Host] ].
prolog:error_message(ros_error(lost, Host)) -->
    [ '~w has lost ROS meanwhile'-[Host] ].
prolog:error_message(resource_error(ros_queue)) -->
    [ 'ROS does not take so much' ].
