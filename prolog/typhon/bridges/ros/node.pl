:- module(typhon_ros_node,
          [ node_open/2,                % +Host, +Options
            node_close/1,               % +Host
            node_say/3,                 % +Host, +Frame, +Seconds
            node_note/2,                % +Host, +Frame
            node_up/1,                  % +Host
            node_python/2               % +Options, -Python
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../helper',
              [ helper_ask/4, helper_close/1, helper_failure/3,
                helper_file/2, helper_note/2, helper_open/3, helper_pid/2 ]).
:- use_module(messages, [ros_word/2]).

/** <module> A ROS 2 node of our own

A helper, bridges/ros/node.py, is the node; it runs in the Python that
`make tools-ros` has made.

*Threading*: any thread.
*/

%!  node_open(+Host, +Options) is det.
%
%   Options are those of ros_start/3.
%
%   @error existence_error(ros_python, File)
%   @error existence_error(python_module, rclpy)
%   @error domain_error(ros_name(node), Node)

node_open(Host, Options) :-
    node_python(Options, Python),
    command(Host, Options, Args),
    helper_open(ros(Host), command(Python, Args), [restart(always)]),
    option(connect_deadline(Seconds), Options, 20),
    catch(helper_ask(ros(Host), _{do:frame, frame:_{op:hello}}, Seconds,
                     Answer),
          Ball, true),
    (   Answer = ok(_)
    ->  true
    ;   node_close(Host),
        ( nonvar(Ball) -> throw(Ball) ; node_failure(Answer, Host, hello) )
    ).

command(Host, Options, ['-u', File, '--node', Node, '--reach', Reach|Args]) :-
    helper_file('ros/node.py', File),
    (   option(node(Node), Options)
    ->  ros_word(node, Node)
    ;   default_node(Host, Node)
    ),
    option(reach(Reach), Options, localhost),
    (   option(domain(Domain), Options)
    ->  Args = ['--domain', Domain]
    ;   Args = []
    ).

%   A name of ROS has no other characters.

default_node(Host, Node) :-
    atom_codes(Host, Codes0),
    maplist(node_code, Codes0, Codes),
    atom_codes(Text, Codes),
    atom_concat(typhon_, Text, Node).

node_code(Code, Code) :-
    Code < 128,
    code_type(Code, csym),
    !.
node_code(_, 0'_).

%!  node_python(+Options, -Python) is det.
%
%   That of python(File) in Options, or where bridges/ros/install makes it.
%
%   @error existence_error(ros_python, File)

node_python(Options, Python) :-
    (   option(python(Python0), Options)
    ->  true
    ;   installed(Python0)
    ),
    (   is_absolute_file_name(Python0),
        \+ exists_file(Python0)
    ->  existence_error(ros_python, Python0)
    ;   Python = Python0
    ).

installed(Python) :-
    (   getenv('TYPHON_ROS', Dir)
    ->  true
    ;   getenv('XDG_CACHE_HOME', Cache),
        Cache \== ''
    ->  atom_concat(Cache, '/typhon/ros', Dir)
    ;   expand_file_name('~/.cache/typhon/ros', [Dir])
    ),
    atom_concat(Dir, '/bin/python', Python).

%!  node_close(+Host) is det.

node_close(Host) :-
    catch(helper_close(ros(Host)), error(existence_error(_, _), _), true).

%!  node_say(+Host, +Frame:dict, +Seconds) is det.
%
%   The node has done what Frame says.
%
%   @error existence_error(ros_type, Type), existence_error(ros_field, Field)
%   @error type_error(ros_field(Field, Type), Value)
%   @error ros_error(failed, Host), and those of helper_failure/3

node_say(Host, Frame, Seconds) :-
    helper_ask(ros(Host), _{do:frame, frame:Frame}, Seconds, Answer),
    (   Answer = ok(_)
    ->  true
    ;   get_dict(op, Frame, What),
        node_failure(Answer, Host, What)
    ).

node_failure(said(Dict), _, _) :-
    get_dict(error, Dict, Kind),
    formal(Kind, Dict, Formal),
    !,
    get_dict(message, Dict, Text),
    throw(error(Formal, context(_, Text))).
node_failure(Answer, Host, What) :-
    helper_failure(Answer, ros(Host), What).

formal("no_rclpy", _, existence_error(python_module, rclpy)).
formal("no_type", Dict, existence_error(ros_type, Type)) :-
    name(type, Dict, Type).
formal("no_field", Dict, existence_error(ros_field, Field)) :-
    name(field, Dict, Field).
formal("wrong_value", Dict, type_error(ros_field(Field, Type), Value)) :-
    name(field, Dict, Field),
    name(type, Dict, Type),
    get_dict(value, Dict, Value).

name(Key, Dict, Atom) :-
    get_dict(Key, Dict, Text),
    atom_string(Atom, Text).

%!  node_up(+Host) is semidet.

node_up(Host) :-
    helper_pid(ros(Host), _).

%!  node_note(+Host, +Frame:dict) is det.

node_note(Host, Frame) :-
    helper_note(ros(Host), _{do:frame, frame:Frame}).

:- multifile prolog:error_message//1.

prolog:error_message(existence_error(ros_python, File)) -->
    [ 'There is no Python with rclpy at ~w (make tools-ros puts it \c
       there)'-[File] ].
