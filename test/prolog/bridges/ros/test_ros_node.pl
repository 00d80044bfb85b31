:- module(test_ros_node, []).

/** <module> A host and its node of ROS, which is played by a program

What depends on rclpy is in test_ros2.pl.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/ros_agents').
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/helper), [helper_file/2]).
:- use_module(library(typhon/ros)).

:- meta_predicate with_node(+, -, 0).

%   with_node(+Options, -Agent, :Goal): a host with a node, and an agent there.

with_node(Options, Agent, Goal) :-
    no_leaks(with_tmp_dir(Dir, with_node_in(Dir, Options, Agent, Goal))).

:- meta_predicate with_node_in(+, +, -, 0).

with_node_in(Dir, Options, Agent, Goal) :-
    directory_file_path(Dir, python, Python),
    project_file('test/lib/fake_ros_node.py', Node),
    helper_file(lib, Lib),
    format(string(Line), "shift; exec /usr/bin/python3 ~w ~w \"$@\"",
           [Node, Lib]),
    shell_script(Python, Line),
    setup_call_cleanup(
        host_start(alpha),
        ( ros_start(alpha, ros2, [python(Python)|Options]),
          goal_agent(alpha, Agent),
          once(Goal) ),
        host_stop(alpha)).

%   refused(Message, Error): Message is the report of the node.

refused(_{error:"no_type", type:"a/B"}, existence_error(ros_type, 'a/B')).
refused(_{error:"no_field", field:"x"}, existence_error(ros_field, x)).
refused(_{error:"wrong_value", field:"x", type:"int32", value:0.5},
        type_error(ros_field(x, int32), 0.5)).
refused(_{error:"no_rclpy"}, existence_error(python_module, rclpy)).
refused(_{error:"timeout"}, timeout_error(publish, ros(alpha))).
refused(_{error:"strange"}, helper_error(strange, ros(alpha))).

%   begun(Options, Arguments)

begun([], ["--node","typhon_alpha","--reach","localhost"]).
begun([node(lizzy),reach(subnet),domain(3)],
      ["--node","lizzy","--reach","subnet","--domain","3"]).

:- begin_tests(ros_node).

test(reports_are_errors) :-
    with_node([], Agent,
        forall(refused(Message, Expected),
               ( goal_error(alpha, Agent,
                            ros_publish('/t', 'std_msgs/String', Message),
                            Formal),
                 assertion(Formal == Expected) ))).
test(options_reach_the_node,
     [forall(begun(Options, Expected)), Arguments == Expected]) :-
    with_node(Options, Agent,
        ( does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          gets(alpha, Agent, topic('/t', Message)) )),
    Arguments = Message.arguments.
test(invalid_options,
     [ forall(member(Option-Expected,
                     [ node('a b')-domain_error(ros_name(node), 'a b'),
                       domain(233)-type_error(_, 233),
                       reach(moon)-type_error(_, moon) ])),
       error(Expected) ]) :-
    with_node([Option], _, true).

:- end_tests(ros_node).
