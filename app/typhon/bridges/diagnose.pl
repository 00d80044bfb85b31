:- module(typhon_diagnose_bridges,
          [ diagnose_bridge/2           % +Bridge, +Arguments
          ]).

/** <module> Diagnosis of a bridge

Tests the steps from the Python of the helper to its server, and stops with
advice at the step that fails.

*Threading*: the calling thread.
*/

:- use_module('../../../prolog/typhon/kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../../prolog/typhon',
              [ host_start/1, host_stop/1, mqtt_start/3, python_start/3,
                remote/2, ros_start/3 ]).
:- use_module('../../../prolog/typhon/bridges/helper', [helper_file/2, helper_python/2]).
:- use_module('../../../prolog/typhon/bridges/ros/connection', [node_python/2]).
:- use_module('../diagnose', [diagnose_steps/2, python_says/4]).

%!  diagnose_bridge(+Bridge, +Arguments:list) is semidet.
%
%   Prints the result of each step for the bridge `python`, without arguments;
%   `gpio`; `mqtt`, optionally with the URL of a broker; or `ros`, optionally with the
%   URL of a rosbridge server.  Fails at the first step that does not work, and
%   for an unknown bridge.

diagnose_bridge(Bridge, Arguments) :-
    findall(Step-Advice, step(Bridge, Step, Advice), Steps),
    Steps \== [],
    setup_call_cleanup(
        host_start(diagnosed),
        diagnose_steps(Steps, check(Bridge-Arguments)),
        host_stop(diagnosed)).

%   step(Bridge, Name, Advice)

step(python, python,
     'Install python3, or set typhon_helper_process:python.').
step(python, function,
     'The helper bridges/python/bridge.py does not run: see its output.').
step(python, 'round trip', '').
step(mqtt, python,
     'Install python3, or set typhon_helper_process:python.').
step(mqtt, paho,
     'apt install python3-paho-mqtt, or pip install paho-mqtt.').
step(mqtt, broker,
     'Does the broker run at that port, and may you use it? Give its URL, as \c
      mqtt://localhost:1883.').
step(mqtt, 'round trip',
     'The broker must let you publish and subscribe to typhon/diagnosed.').
step(gpio, python,
     'Install python3, or set typhon_helper_process:python.').
step(gpio, gpiozero,
     'apt install python3-gpiozero, or pip install gpiozero.').
step(gpio, pins,
     'Is this a board, has it python3-lgpio, and is the user in the group \c
      gpio? GPIOZERO_PIN_FACTORY=mock simulates one.').
step(ros, python,
     'make tools-ros installs it from PyPI; a rosbridge server, \c
      diagnose ros URL, does not need it.').
step(ros, rclpy,
     'Delete that directory, and make tools-ros again.').
step(ros, ros,
     'For a server: is rosbridge_server running there, at that port? For \c
      ROS 2: see the messages of the node above.').
step(ros, topics,
     'For a server: start the node rosapi beside it.').
step(ros, 'round trip', '').

%   check(Bridge-Arguments, Step, Found): Found is the result, as text.

check(ros-Arguments, Step, Found) :-
    !,
    check_ros(Step, Arguments, Found).
check(_, python, Found) :-
    python_says('import sys; print(sys.executable, sys.version.split()[0])',
                python3, Found).
check(_, paho, Found) :-
    python_says('import paho.mqtt as p; print(p.__version__)', paho, Found).
check(_, gpiozero, Found) :-
    python_says('import importlib.metadata as m; print(m.version("gpiozero"))',
                gpiozero, Found).
check(_, pins, Found) :-
    catch(python_says('import warnings, gpiozero; \c
                       warnings.simplefilter("ignore"); \c
                       print(type(gpiozero.Device._default_pin_factory()) \c
                             .__name__)', pins, Found),
          error(existence_error(python_module, pins), _),
          throw(error(gpio_error(no_pins, localhost), _))).
check(python-_, function, Found) :-
    helper_file('python/hello.py', File),
    python_start(diagnosed, File, []),
    remote(diagnosed, hello(agents, Found)).
check(python-_, 'round trip', Found) :-
    ten_times(remote(diagnosed, hello(agents, _)), Found).
check(mqtt-[], broker, not_asked) :-
    !.
check(mqtt-[URL], broker, Found) :-
    mqtt_start(diagnosed, URL, []),
    atom_concat(URL, ' answers', Found).
check(mqtt-[], 'round trip', not_asked) :-
    !.
check(mqtt-_, 'round trip', Found) :-
    Topic = 'typhon/diagnosed',
    remote(diagnosed, subscribe(Topic, [as(latest)])),
    ten_times(remote(diagnosed, publish(Topic, x, [qos(1),wait(true)])),
              Found).

%   A rosbridge server needs no Python here.

check_ros(python, [], Python) :-
    node_python([], Python).
check_ros(rclpy, [], Found) :-
    node_python([], Python),
    python_says(Python,
                'import importlib.metadata as m; print(m.version("ros-rclpy"))',
                rclpy, Found).
check_ros(ros, [], 'this is a node, /typhon_diagnosed') :-
    ros_start(diagnosed, ros2, [reach(subnet)]).
check_ros(ros, [URL], Found) :-
    ros_start(diagnosed, URL, []),
    atom_concat(URL, ' answers', Found).
check_ros(topics, _, Found) :-
    remote(diagnosed, ros_topics(Topics)),
    length(Topics, Count),
    format(atom(Found), '~d are known', [Count]).
check_ros('round trip', [], Found) :-
    ten_times(remote(diagnosed, ros_parameters('/typhon_diagnosed', _)),
              Found).
check_ros('round trip', [_], Found) :-
    ten_times(remote(diagnosed, ros_topics(_)), Found).
check_ros(_, [_], not_asked).

ten_times(Goal, Found) :-
    monotonic_time(Start),
    forall(between(1, 10, _), Goal),
    monotonic_time(End),
    MilliSeconds is (End-Start)*100,
    format(atom(Found), '~1f ms', [MilliSeconds]).

python_says(Code, Module, Text) :-
    helper_python([], Python),
    python_says(Python, Code, Module, Text).
