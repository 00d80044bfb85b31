:- module(typhon_bridge_texts, []).

/** <module> Texts of the errors of bridges

The modules of a bridge are loaded in the process of its host.  Its errors also
reach processes that have not loaded them.

*Threading*: pure.
*/

:- multifile prolog:error_message//1.

prolog:error_message(existence_error(Bridge, Host)) -->
    { bridge(Bridge, Name) },
    [ '~w has no ~w (start it by ~w_start/3)'-[Host, Name, Bridge] ].

bridge(fipa, 'FIPA').
bridge(gpio, 'GPIO').
bridge(mqtt, 'MQTT').
bridge(ros, 'ROS').

prolog:error_message(existence_error(python, Python)) -->
    [ 'There is no Python ~w (a host: start it by python_start/3; a \c
       program: install python3, or set typhon_helper_process:python)'-
      [Python] ].
prolog:error_message(existence_error(helper, Name)) -->
    [ 'There is no helper ~p'-[Name] ].
prolog:error_message(helper_died(Status, Name)) -->
    [ 'The helper ~p ended: ~p'-[Name, Status] ].
prolog:error_message(helper_error(Kind, Name)) -->
    [ 'The helper ~p reports ~w'-[Name, Kind] ].

prolog:error_message(python_error(Class, Message)) -->
    [ 'Python: ~w: ~w'-[Class, Message] ].
prolog:error_message(timeout_error(python(What), Host)) -->
    [ 'Python on ~w has not completed ~w in time'-[Host, What] ].

prolog:error_message(mqtt_error(Problem, Host)) -->
    { problem(Problem, Text) },
    [ 'MQTT on ~w: ~w'-[Host, Text] ].
prolog:error_message(existence_error(python_module, paho)) -->
    [ 'This Python has no paho-mqtt (install it: apt install \c
       python3-paho-mqtt, or pip install paho-mqtt)' ].
prolog:error_message(timeout_error(mqtt(What), Host)) -->
    [ 'MQTT on ~w: the broker has not answered ~w in time'-[Host, What] ].

problem(unreachable, 'the broker cannot be reached').
problem(refused, 'the broker refuses the connection').
problem(tls, 'TLS cannot be used').
problem(failed, 'the client library raises an exception').

prolog:error_message(gpio_error(Problem, Host)) -->
    { gpio_problem(Problem, Text) },
    [ 'GPIO on ~w: ~w'-[Host, Text] ].
prolog:error_message(existence_error(gpio_pin, Number)) -->
    [ 'The board has no pin ~w'-[Number] ].
prolog:error_message(existence_error(pin, Name)) -->
    [ 'This host has no pin ~w (pins/1 lists them)'-[Name] ].
prolog:error_message(existence_error(pin_watch, Name)) -->
    [ 'This agent does not watch the pin ~w'-[Name] ].
prolog:error_message(existence_error(python_module, gpiozero)) -->
    [ 'This Python has no gpiozero (install it: apt install \c
       python3-gpiozero, or pip install gpiozero)' ].
prolog:error_message(timeout_error(gpio(Name), Host)) -->
    [ 'GPIO on ~w: the pin ~w has not answered in time'-[Host, Name] ].

gpio_problem(no_pins, 'this machine has no pins that gpiozero finds').
gpio_problem(silent, 'the thermometer does not answer').
gpio_problem(failed, 'gpiozero raises an exception').

prolog:error_message(existence_error(ros_type, Type)) -->
    [ 'There is no type ~w among those that are installed'-[Type] ].
prolog:error_message(existence_error(ros_topic, Topic)) -->
    [ 'There is no topic ~w'-[Topic] ].
prolog:error_message(existence_error(ros_service, Service)) -->
    [ 'There is no service ~w'-[Service] ].
prolog:error_message(existence_error(ros_field, Field)) -->
    [ 'The message has no field ~w'-[Field] ].
prolog:error_message(existence_error(ros_subscription, Topic)) -->
    [ 'This agent has no subscription to ~w'-[Topic] ].
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
    [ 'The send queue to ROS is full' ].
prolog:error_message(existence_error(ros_python, File)) -->
    [ 'There is no Python with rclpy at ~w (run make tools-ros to \c
       install it)'-[File] ].
