:- module(test_ros2, []).

/** <module> ROS 2 by a node of our own

The peer, ros_peer.py, is a node in another process, made with rclpy alone.
*/

:- use_module('../../../lib/common').
:- needs([ros]).
:- use_module('../../../lib/ros_agents').
:- use_module('../../../lib/shown').
:- use_module('../../../lib/transcript', [transcript_differences/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_kill/2,
                                 process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket),
              [tcp_bind/2, tcp_close_socket/1, tcp_socket/1]).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/helper), [helper_file/2, helper_pid/2]).
:- use_module(library(typhon/ros)).

:- dynamic
    peer/2,                     % Pid, its standard input
    agent/1,                    % on alpha
    held/1.                     % the socket that stands for the domain

begin :-
    domain_hold(Domain, Socket),
    assertz(held(Socket)),
    setenv('ROS_DOMAIN_ID', Domain),
    setenv('ROS_LOCALHOST_ONLY', 1),
    ros_python(Python),
    project_file('test/lib/ros_peer.py', File),
    process_create(Python, [File],
                   [ stdin(pipe(In)), stdout(pipe(Out)), process(Peer) ]),
    assertz(peer(Peer, In)),
    read_line_to_string(Out, "ready"),
    close(Out).

%   The Python that `make tools-ros` has made.

ros_python(Python) :-
    (   getenv('TYPHON_ROS', Dir)
    ->  true
    ;   getenv('XDG_CACHE_HOME', Cache),
        Cache \== ''
    ->  atom_concat(Cache, '/typhon/ros', Dir)
    ;   expand_file_name('~/.cache/typhon/ros', [Dir])
    ),
    atom_concat(Dir, '/bin/python', Python).

end :-
    retract(peer(Peer, In)),
    close(In),
    process_wait(Peer, _),
    retract(held(Socket)),
    tcp_close_socket(Socket).

%   A domain for this run alone: its number is that of the process that holds
%   the TCP port of the same number as the UDP port at which the nodes of the
%   domain discover each other.

domain_hold(Domain, Socket) :-
    between(1, 100, Domain),
    Port is 7400 + 250*Domain,
    tcp_socket(Socket),
    catch(tcp_bind(Socket, localhost:Port), error(socket_error(_, _), _),
          ( tcp_close_socket(Socket), fail )),
    !.

begin_host :-
    begin,
    host_start(alpha),
    host_start(beta),
    ros_start(alpha, ros2, [deadline(20)]),
    goal_agent(alpha, Agent),
    assertz(agent(Agent)),
    wait_until(( remote(alpha, ros_services(Services)),
                 memberchk('/peer/get_parameters', Services),
                 remote(alpha, ros_topics(Topics)),
                 memberchk('/kept'-_, Topics) ), 10).

end_host :-
    retractall(agent(_)),
    host_stop(alpha),
    host_stop(beta),
    end.

:- meta_predicate quiet(0).

quiet(Goal) :-
    setup_call_cleanup(
        asserta((user:message_hook(Term, Kind, _) :-
                     test_ros2:expected(Term, Kind)), Ref),
        Goal,
        erase(Ref)).

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

expected(typhon(ros_lost(_, _)), _).
expected(typhon(helper_ended(_, _)), _).

%   The peer may not have discovered our node yet.

published_until_received(Agent, In, Type, Sent, Out, Message) :-
    wait_until(( does(alpha, Agent, ros_publish(In, Type, Sent)),
                 soon(remote(alpha, take(got(Agent,
                                             topic(Out, Message0))))) ),
               20),
    Message = Message0.

:- meta_predicate soon(0).

soon(Goal) :-
    catch(wait_until(Goal, 0.5), error(timeout_error(_, _), _), fail).

:- begin_tests(ros2, [setup(begin_host), cleanup(end_host)]).

test(published_and_received) :-
    agent(Agent),
    does(alpha, Agent, ros_subscribe('/out', 'std_msgs/msg/String')),
    Text = "h\u00e9 \"you\"\n",
    published_until_received(Agent, '/in', 'std_msgs/msg/String', _{data:Text},
                             '/out', Message),
    assertion(Message.data == Text),
    does(alpha, Agent, ros_unsubscribe('/out')).

test(every_field_comes_back) :-
    agent(Agent),
    does(alpha, Agent, ros_subscribe('/types_out', 'test_msgs/BasicTypes')),
    Fields = _{ bool_value:true, byte_value:255, char_value:65,
                float32_value:0.5, float64_value:1.0e300, int8_value: -128,
                uint8_value:255, int16_value: -32768, uint16_value:65535,
                int32_value: -2147483648, uint32_value:4294967295,
                int64_value: -9223372036854775808,
                uint64_value:18446744073709551615 },
    published_until_received(Agent, '/types_in', 'test_msgs/BasicTypes', Fields,
                             '/types_out', Message),
    assertion(Fields :< Message).

test(arrays_come_back) :-
    agent(Agent),
    does(alpha, Agent, ros_subscribe('/arrays_out', 'test_msgs/Arrays')),
    Fields = [ bool_values=[true,false,true],
               float64_values=[1,2.5,-3],
               uint8_values="AQID",
               int32_values=[7,8,9],
               string_values=[a,"b",'c d'],
               basic_types_values=[[int8_value=1],[],[bool_value=true]] ],
    published_until_received(Agent, '/arrays_in', 'test_msgs/Arrays', Fields,
                             '/arrays_out', Message),
    assertion(Message.bool_values == [true,false,true]),
    assertion(Message.float64_values == [1.0,2.5,-3.0]),
    assertion(Message.uint8_values == "AQID"),
    assertion(Message.int32_values == [7,8,9]),
    assertion(Message.string_values == ["a","b","c d"]),
    Message.basic_types_values = [First,_,_],
    assertion(First.int8_value == 1).

test(latched_message_is_received_and_volatile_one_is_not_repeated) :-
    agent(Agent),
    does(alpha, Agent, ros_subscribe('/kept', Type)),
    assertion(Type == 'std_msgs/msg/String'),
    gets(alpha, Agent, topic('/kept', Message)),
    assertion(Message.data == "kept"),
    does(alpha, Agent, ros_subscribe('/counted', 'std_msgs/msg/Int32',
                                     [as(latest)])),
    wait_until(( remote(alpha, sense(ros-topic('/counted', _{data:N}))),
                 N > 3 ), 10),
    does(alpha, Agent, ros_unsubscribe('/counted')).

test(a_call) :-
    agent(Agent),
    does(alpha, Agent, ros_call('/flip', 'std_srvs/srv/SetBool', [data=true],
                                Response)),
    assertion(Response.success-Response.message == false-"flipped").

test(service_offered_by_an_agent) :-
    agent(Agent),
    does(alpha, Agent, ros_offer('/agent/set', 'std_srvs/srv/SetBool', [])),
    does(alpha, Agent, ros_subscribe('/asked', 'std_msgs/String')),
    does(alpha, Agent, ros_publish('/ask', 'std_msgs/String',
                                   [data='/agent/set 10'])),
    gets(alpha, Agent, request(Id, '/agent/set', Request)),
    assertion(Request.data == true),
    goal_error(alpha, Agent, ros_answer(Id, [messages=x]), Formal),
    assertion(Formal == existence_error(ros_field, messages)),
    does(alpha, Agent, ros_answer(Id, [success=true,message="by an agent"])),
    gets(alpha, Agent, topic('/asked', Message)),
    assertion(Message.data == "by an agent"),
    does(alpha, Agent, ros_publish('/ask', 'std_msgs/String',
                                   [data='/agent/set 0.5'])),
    gets(alpha, Agent, request(Id2, '/agent/set', _)),
    does(alpha, Agent, ros_refuse(Id2)),
    gets(alpha, Agent, topic('/asked', Message2)),
    assertion(Message2.data == "no answer"),
    does(alpha, Agent, ros_withdraw('/agent/set')).

test(goal_feedback_result) :-
    agent(Agent),
    does(alpha, Agent, ros_goal('/fibonacci', 'test_msgs/action/Fibonacci',
                                [order=8], Id)),
    gets(alpha, Agent, feedback(Id, Feedback)),
    assertion(Feedback.sequence = [0,1|_]),
    gets(alpha, Agent, result(Id, Status, Result)),
    assertion(Status-Result.sequence == succeeded-[0,1,1,2,3,5,8,13]).

test(a_goal_is_cancelled) :-
    agent(Agent),
    does(alpha, Agent, ros_goal('/fibonacci', 'test_msgs/action/Fibonacci',
                                [order=0], Id)),
    gets(alpha, Agent, feedback(Id, _)),
    does(alpha, Agent, ros_cancel(Id)),
    gets(alpha, Agent, result(Id, canceled, _)).

test(a_goal_is_refused) :-
    agent(Agent),
    does(alpha, Agent, ros_goal('/fibonacci', 'test_msgs/action/Fibonacci',
                                [order= -1], Id)),
    gets(alpha, Agent, result(Id, failed, Text)),
    assertion(Text == "Action goal was rejected").

test(parameters) :-
    agent(Agent),
    does(alpha, Agent, ros_parameters('/peer', Names)),
    assertion(memberchk(speed, Names)),
    does(alpha, Agent, ros_parameter('/peer', speed, Speed)),
    assertion(Speed == 0.5),
    does(alpha, Agent, ros_set_parameter('/peer', speed, 0.75)),
    does(alpha, Agent, ros_parameter('/peer', speed, Faster)),
    assertion(Faster == 0.75),
    does(alpha, Agent, ros_set_parameter('/peer', names, [c,"d"])),
    does(alpha, Agent, ros_parameter('/peer', names, List)),
    assertion(List == ["c","d"]),
    goal_error(alpha, Agent, ros_parameter('/peer', nothing, _), None),
    assertion(None == existence_error(ros_parameter, nothing)),
    goal_error(alpha, Agent, ros_set_parameter('/peer', speed, fast), Refused),
    assertion(Refused == ros_error(refused, speed)).

test(lists_topics_and_services) :-
    agent(Agent),
    does(alpha, Agent, ros_topics(Topics)),
    assertion(memberchk('/counted'-'std_msgs/msg/Int32', Topics)),
    does(alpha, Agent, ros_services(Services)),
    assertion(memberchk('/flip', Services)).

test(errors_are_reported) :-
    agent(Agent),
    forall(wrong_goal(Goal, Expected),
           ( goal_error(alpha, Agent, Goal, Formal),
             assertion(Formal == Expected) )).

wrong_goal(ros_publish('/x', 'std_msgs/msg/Nothing', []),
           existence_error(ros_type, 'std_msgs/msg/Nothing')).
wrong_goal(ros_publish('/x', 'no_msgs/msg/Nothing', []),
           existence_error(ros_type, 'no_msgs/msg/Nothing')).
wrong_goal(ros_subscribe('/x', 'no_msgs/msg/Nothing'),
           existence_error(ros_type, 'no_msgs/msg/Nothing')).
wrong_goal(ros_call('/flip', 'no_srvs/srv/Nothing', [], _),
           existence_error(ros_type, 'no_srvs/srv/Nothing')).
wrong_goal(ros_goal('/fibonacci', 'no_msgs/action/Nothing', [], _),
           existence_error(ros_type, 'no_msgs/action/Nothing')).
wrong_goal(ros_offer('/x', 'std_msgs/String', []),
           existence_error(ros_type, 'std_msgs/String')).
wrong_goal(ros_publish('/twist', 'geometry_msgs/Twist', [linear=[q=1]]),
           existence_error(ros_field, 'linear.q')).
wrong_goal(ros_publish('/twist', 'geometry_msgs/Twist', [linear=[x=a]]),
           type_error(ros_field('linear.x', double), "a")).
wrong_goal(ros_publish('/twist', 'geometry_msgs/Twist', [linear=1]),
           type_error(ros_field(linear, 'Vector3'), 1)).
wrong_goal(ros_publish('/byte', 'std_msgs/UInt8', [data=256]),
           type_error(ros_field(data, uint8), 256)).
wrong_goal(ros_call('/flip', 'std_srvs/SetBool', [data=1], _),
           type_error(ros_field(data, boolean), 1)).
wrong_goal(ros_subscribe('/nowhere', _),
           existence_error(ros_topic, '/nowhere')).

test(leaving_agent_loses_its_registrations) :-
    goal_agent(alpha, Agent),
    does(alpha, Agent, ros_subscribe('/left', 'std_msgs/String')),
    does(alpha, Agent, ros_offer('/left/set', 'std_srvs/SetBool', [])),
    does(alpha, Agent, ros_goal('/fibonacci', 'test_msgs/Fibonacci',
                                [order=0], Id)),
    gets(alpha, Agent, feedback(Id, _)),
    assertion(ros_property(alpha, heard('/left', _))),
    agent_send(Agent, go(beta)),
    wait_until(\+ ros_property(alpha, heard('/left', _)), 5),
    wait_until(\+ ros_property(alpha, offered('/left/set', _)), 5),
    wait_until(( remote(alpha, ros_services(Services)),
                 \+ memberchk('/left/set', Services) ), 5).

test(dead_node_is_restarted_with_all_registrations) :-
    agent(Agent),
    does(alpha, Agent, ros_subscribe('/out', 'std_msgs/msg/String')),
    helper_pid(ros(alpha), Pid),
    quiet(( process_kill(Pid, kill),
            wait_until(( helper_pid(ros(alpha), New), New \== Pid ), 10),
            wait_until(comes_back(Agent, "again"), 30) )).

%   Earlier messages may arrive late.

comes_back(Agent, Text) :-
    published_until_received(Agent, '/in', 'std_msgs/msg/String', _{data:Text},
                             '/out', Message),
    Message.data == Text.

:- end_tests(ros2).

%   More messages arrive than are read, in Python alone.

outbox("
import sys, threading, time
sys.argv[1:], folder = [], sys.argv[1]
sys.path.insert(0, folder)
import node
said, go = [], threading.Event()
outbox = node.Outbox(lambda frame: (go.wait(), said.append(frame)))
for number in range(5000):
    outbox.put_message({'op': 'publish', 'topic': '/t'})
go.set()
end = time.time() + 10
while said[-1:] == [] or said[-1]['op'] != 'dropped':
    assert time.time() < end
    time.sleep(0.01)
print(sum(frame['op'] == 'publish' for frame in said) + said[-1]['count'],
      said[-1]['count'] >= 3999)
").

python(Code, Said) :-
    ros_python(Python),
    helper_file(ros, Folder),
    process_create(Python, ['-c', Code, Folder],
                   [ stdout(pipe(Out)), process(Pid) ]),
    read_line_to_string(Out, Said),
    close(Out),
    process_wait(Pid, _).

:- begin_tests(ros2_start).

test(overflow_is_counted, Said == "5000 True") :-
    outbox(Code),
    python(Code, Said).

test(document_shows_the_actual_output, Differences == []) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'talker.pl', File),
          shown_in_file('doc/bridges-ros.md', "% talker.pl\n", File),
          shown('doc/bridges-ros.md', "```text\n", Session),
          split_string(Session, "\n", "", Lines),
          transcript_differences([1-Lines], Dir, Differences) )).

with_alpha(Goal) :-
    setup_call_cleanup(host_start(alpha), Goal, host_stop(alpha)).

test(no_threads_and_processes_are_left) :-
    no_leaks(with_alpha(( ros_start(alpha, ros2, [node(other)]),
                          remote(alpha, ros_services(Services)),
                          assertion(memberchk('/other/get_parameters',
                                              Services)),
                          ros_stop(alpha) ))).
test(no_python, error(existence_error(ros_python, '/no/python'))) :-
    with_alpha(ros_start(alpha, ros2, [python('/no/python')])).
test(python_without_ros, error(existence_error(python_module, rclpy))) :-
    quiet(with_alpha(ros_start(alpha, ros2,
                               [python('/usr/bin/python3')]))).
test(invalid_node_name, error(domain_error(ros_name(node), 'a b'))) :-
    with_alpha(ros_start(alpha, ros2, [node('a b')])).

:- end_tests(ros2_start).
