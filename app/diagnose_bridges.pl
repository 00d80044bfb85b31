:- module(typhon_diagnose_bridges,
          [ diagnose_bridge/2           % +Bridge, +Arguments
          ]).

/** <module> Why a bridge does not work here

Goes from the Python of the helper to what it speaks with, and stops with
advice at the step that does not work.

*Threading*: the calling thread.
*/

:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module('../prolog/typhon',
              [ host_start/1, host_stop/1, mqtt_start/3, python_start/3,
                remote/2 ]).
:- use_module('../prolog/typhon/helper', [helper_file/2, helper_python/2]).
:- use_module(diagnose, [diagnose_steps/2]).

%!  diagnose_bridge(+Bridge, +Arguments:list) is semidet.
%
%   Prints what works on the way to `python`, which has no arguments, or
%   `mqtt`, of which the URL of a broker is one.  Fails at the first step that
%   does not work, and if there is no such bridge.

diagnose_bridge(Bridge, Arguments) :-
    findall(Step-Advice, step(Bridge, Step, Advice), Steps),
    Steps \== [],
    setup_call_cleanup(
        host_start(diagnosed),
        diagnose_steps(Steps, check(Bridge-Arguments)),
        host_stop(diagnosed)).

%   step(Bridge, Name, Advice)

step(python, python,
     'Install python3, or set typhon_helper_python:python.').
step(python, function,
     'The helper bridges/python/bridge.py does not run: see what it says.').
step(python, 'round trip', '').
step(mqtt, python,
     'Install python3, or set typhon_helper_python:python.').
step(mqtt, paho,
     'apt install python3-paho-mqtt, or pip install paho-mqtt.').
step(mqtt, broker,
     'Does it run, at that port, and may you use it? Say its URL, as \c
      mqtt://localhost:1883.').
step(mqtt, 'round trip',
     'The broker must let you publish and subscribe to typhon/diagnosed.').

%   check(Bridge-Arguments, Step, Found): Found is what there is to say

check(_, python, Found) :-
    python_says('import sys; print(sys.executable, sys.version.split()[0])',
                python3, Found).
check(_, paho, Found) :-
    python_says('import paho.mqtt as p; print(p.__version__)', paho, Found).
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

ten_times(Goal, Found) :-
    get_time(Start),
    forall(between(1, 10, _), Goal),
    get_time(End),
    MilliSeconds is (End-Start)*100,
    format(atom(Found), '~1f ms', [MilliSeconds]).

python_says(Code, Module, Text) :-
    helper_python([], Python),
    catch(process_create(Python, ['-c', Code],
                         [ stdout(pipe(Out)), stderr(null), process(Pid) ]),
          error(_, _),
          throw(error(existence_error(python, Python), _))),
    read_string(Out, _, Said),
    close(Out),
    process_wait(Pid, Status),
    (   Status == exit(0)
    ->  split_string(Said, "", "\n ", [Line]),
        atom_string(Text, Line)
    ;   throw(error(existence_error(python_module, Module), _))
    ).
