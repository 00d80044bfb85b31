:- module(typhon_ros_connection,
          [ way_open/3,                 % +Host, +Where, +Options
            way_close/1,                % +Host
            way_option/3,               % +Host, ?Option, +Default
            way_state/3,                % ?Host, -Where, -Connected
            way_send/2,                 % +Host, +Op
            way_note/2,                 % +Host, +Op
            way_await/5,                % +Host, +Id, +Op, +Seconds, -Answer
            answer_come/2,              % +Id, +Answer
            answers_fail/2,             % +Host, +Why
            node_python/2               % +Options, -Python
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/base/fifo', [fifo_send/2]).
:- use_module('../../kernel/base/monotonic', [wait_within/2]).
:- use_module('../helper',
              [ helper_call/5, helper_close/1, helper_file/2, helper_note/2,
                helper_open/3, helper_pid/2 ]).
:- use_module(messages, [op_frame/2, ros_word/2]).
:- use_module(rosbridge,
              [ rosbridge_close/1, rosbridge_open/4, rosbridge_send/3,
                rosbridge_up/1 ]).

/** <module> The connection of a host to ROS

A host is connected through a node of Typhon, or through a rosbridge server;
both use the same frames.

The node is a helper, bridges/ros/node.py, which runs in the Python that
`make tools-ros` has installed.

*Threading*: any thread.  A caller that waits for an answer has its own queue,
so late answers are dropped.
*/

:- multifile
    prolog:error_message//1.

:- dynamic
    way/4.                      % Host, node or server, Where, Options

%!  way_open(+Host, +Where, +Options) is det.
%
%   Connect Host.  Where is `ros2` or a URL.
%
%   @error the errors of node_open/2 and rosbridge_open/4

way_open(Host, Where, Options) :-
    kind(Where, Kind),
    assertz(way(Host, Kind, Where, Options)),
    open_way(Kind, Host, Where, Options).

kind(ros2, node) :-
    !.
kind(_, server).

open_way(node, Host, _, Options) :-
    node_open(Host, Options).
open_way(server, Host, URL, Options) :-
    option(connect_deadline(Seconds), Options, 5),
    option(silence(Silence), Options, 30),
    rosbridge_open(Host, URL, Seconds, Silence).

%!  way_close(+Host) is det.

way_close(Host) :-
    (   way(Host, Kind, _, _)
    ->  close_way(Kind, Host),
        retractall(way(Host, _, _, _))
    ;   true
    ).

close_way(node, Host) :-
    helper_close(ros(Host)).
close_way(server, Host) :-
    rosbridge_close(Host).

%!  way_option(+Host, ?Option, +Default) is det.
%
%   As option/3, for the options with which Host was connected.
%
%   @error existence_error(ros, Host)

way_option(Host, Option, Default) :-
    host_way(Host, _, Options),
    option(Option, Options, Default).

host_way(Host, Kind, Options) :-
    (   way(Host, Kind0, _, Options0)
    ->  Kind = Kind0,
        Options = Options0
    ;   existence_error(ros, Host)
    ).

%!  way_state(?Host, -Where, -Connected:boolean) is nondet.
%
%   Host uses ROS at Where, and is connected now or not.

way_state(Host, Where, Connected) :-
    way(Host, Kind, Where, _),
    (   connected(Kind, Host)
    ->  Connected = true
    ;   Connected = false
    ).

connected(node, Host) :-
    helper_pid(ros(Host), _).
connected(server, Host) :-
    rosbridge_up(Host).

%!  way_send(+Host, +Op) is det.
%
%   Send Op.  The node of Typhon reports errors in Op; a server does not.
%
%   @error existence_error(ros, Host), the errors of node_send/3 and
%          rosbridge_send/3

way_send(Host, Op) :-
    host_way(Host, Kind, Options),
    option(deadline(Seconds), Options, 5),
    op_frame(Op, Frame),
    debug(typhon(ros), '~w sends ~p', [Host, Op]),
    send_frame(Kind, Host, Frame, Seconds).

send_frame(node, Host, Frame, Seconds) :-
    node_send(Host, Frame, Seconds).
send_frame(server, Host, Frame, Seconds) :-
    rosbridge_send(Host, Frame, Seconds).

%!  way_note(+Host, +Op) is det.
%
%   Send Op, which is not essential, if that needs no waiting.  Op is dropped if
%   Host is not connected, or the queue is full.

way_note(Host, Op) :-
    op_frame(Op, Frame),
    debug(typhon(ros), '~w notes ~p', [Host, Op]),
    catch(( host_way(Host, Kind, _), note(Kind, Host, Frame) ),
          error(Formal, _),
          debug(typhon(ros), '~w has not sent ~p: ~p', [Host, Op, Formal])).

note(node, Host, Frame) :-
    helper_note(ros(Host), _{do:frame, frame:Frame}).
note(server, Host, Frame) :-
    rosbridge_send(Host, Frame, 0).

                /*******************************
                *           ANSWERS            *
                *******************************/

:- dynamic
    awaited/3.                  % Id, Host, Queue

%!  way_await(+Host, +Id, +Op, +Seconds, -Answer) is det.
%
%   Send Op, and wait for the answer to Id that another thread passes to
%   answer_come/2.  Answer is that answer, lost(Why), or `timeout`.

way_await(Host, Id, Op, Seconds, Answer) :-
    setup_call_cleanup(
        ( message_queue_create(Queue),
          assertz(awaited(Id, Host, Queue)) ),
        ( way_send(Host, Op),
          wait(Queue, Seconds, Answer) ),
        ( retractall(awaited(Id, _, _)),
          message_queue_destroy(Queue) )).

wait(Queue, Seconds, Answer) :-
    (   wait_within(Seconds, thread_get_message(Queue, answer(Answer0)))
    ->  Answer = Answer0
    ;   Answer = timeout
    ).

%!  answer_come(+Id, +Answer) is semidet.
%
%   Pass Answer to the caller that waits for Id.  Fails if no caller waits.

answer_come(Id, Answer) :-
    retract(awaited(Id, _, Queue)),
    !,
    fifo_send(Queue, answer(Answer)).

%!  answers_fail(+Host, +Why) is det.
%
%   Callers on Host that wait for an answer get lost(Why).

answers_fail(Host, Why) :-
    findall(Id, awaited(Id, Host, _), Ids),
    forall(member(Id, Ids), ignore(answer_come(Id, lost(Why)))).

                /*******************************
                *       THE NODE OF TYPHON     *
                *******************************/

%   node_open(+Host, +Options) is det.
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
    catch(node_send(Host, _{op:hello}, Seconds), Ball,
          ( helper_close(ros(Host)),
            throw(Ball) )).

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

%   ROS allows only letters, digits and `_` in names, so others become `_`.

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
%   Python is that of python(File) in Options, or by default the Python that
%   bridges/ros/install has installed.
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

%   node_send(+Host, +Frame:dict, +Seconds) is det.
%
%   The node carries out Frame.
%
%   @error existence_error(ros_type, Type), existence_error(ros_field, Field)
%   @error type_error(ros_field(Field, Type), Value)
%   @error timeout_error(Op, ros(Host)), and the errors of helper_call/5

node_send(Host, Frame, Seconds) :-
    helper_call(ros(Host), _{do:frame, frame:Frame}, Seconds,
                failure(Host, Frame), _).

failure(Host, Frame, said(Dict), error(Formal, context(_, Text))) :-
    _{error:Kind, message:Text} :< Dict,
    (   Kind == "timeout"
    ->  Formal = timeout_error(Op, ros(Host)),
        get_dict(op, Frame, Op)
    ;   formal(Kind, Dict, Formal)
    ).

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
