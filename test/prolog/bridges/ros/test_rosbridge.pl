:- module(test_rosbridge, []).

/** <module> ROS by way of a rosbridge server

The server is a stand-in, see rosbridge_server.pl, which refuses whatever a
real one refuses.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/3]).
:- use_module('../../../lib/networks').
:- use_module('../../../lib/ros_agents').
:- use_module('../../../lib/rosbridge_server').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(base64), [base64_encoded/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(sha), [sha_hash/3]).
:- use_module(library(socket),
              [ tcp_accept/3, tcp_bind/2, tcp_close_socket/1, tcp_listen/2,
                tcp_open_socket/3, tcp_setopt/2, tcp_socket/1 ]).
:- use_module(library(typhon)).
:- use_module(library(typhon/ros)).

:- meta_predicate
    on_a_host(-, +, 0),
    on_hosts(-, +, +, 0),
    quiet(0).

%   Hosts alpha and beta; alpha has ROS, and an agent that executes goals.

on_a_host(Agent, Options, Goal) :-
    no_leaks(with_rosbridge(URL, on_hosts(Agent, URL, Options, Goal))).

on_hosts(Agent, URL, Options, Goal) :-
    setup_call_cleanup(
        ( host_start(alpha), host_start(beta) ),
        ( ros_start(alpha, URL, Options),
          goal_agent(alpha, Agent),
          once(Goal) ),
        ( host_stop(alpha), host_stop(beta) )).

quiet(Goal) :-
    setup_call_cleanup(
        asserta((user:message_hook(Term, Kind, _) :-
                     test_rosbridge:expected(Term, Kind)), Ref),
        Goal,
        erase(Ref)).

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

expected(typhon(Message), _) :-
    compound(Message),
    compound_name_arity(Message, Name, _),
    sub_atom(Name, 0, _, _, ros_).

said(Op, Frame) :-
    rosbridge_frames(Frames),
    member(Frame, Frames),
    Frame.op == Op.

frame_sent(Op, Frame) :-
    wait_until(said(Op, Frame), 20).

:- begin_tests(rosbridge_topics).

test(published_and_received_as_dicts) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/chatter', 'std_msgs/String')),
          does(alpha, Agent, ros_publish('/chatter', 'std_msgs/String',
                                         _{data:"h\u00e9 \"you\"\n"})),
          gets(alpha, Agent, topic('/chatter', Message)),
          assertion(Message.data == "h\u00e9 \"you\"\n") )).

%   As servers in Python and C++ send a scan, a position without a fix, and text.

test(numbers_and_keys_of_other_writers_arrive,
     Message =@= _{ranges:[1.5,null,null], fix:null, data:"\U0001F600"}) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/scan', 'std_msgs/String')),
          rosbridge_send("{\"op\":\"publish\", \"topic\":\"/scan\", \"msg\":\c
                          {\"ranges\":[1.5,Infinity,1e400], \"fix\":1, \c
                          \"fix\":NaN, \"data\":\"\\ud83d\\ude00\"}}"),
          gets(alpha, Agent, topic('/scan', Message)) )).

test(published_and_received_as_terms) :-
    on_a_host(Agent, [messages(terms)],
        ( does(alpha, Agent, ros_subscribe('/cmd', 'geometry_msgs/msg/Twist')),
          does(alpha, Agent,
               ros_publish('/cmd', 'geometry_msgs/msg/Twist',
                           [ linear=[x=0.5,y=0.0,z=0.0],
                             angular([x(0),y(0),z(1)]) ])),
          gets(alpha, Agent, topic('/cmd', Message)),
          assertion(Message == [ angular=[x=0,y=0,z=1],
                                 linear=[x=0.5,y=0.0,z=0.0] ]) )).

test(frames_conform_to_the_protocol) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_publish('/chatter', 'std_msgs/String',
                                         [data=one])),
          does(alpha, Agent, ros_publish('/chatter', 'std_msgs/String',
                                         [data=two])),
          does(alpha, Agent, ros_subscribe('/chatter', 'std_msgs/String')),
          does(alpha, Agent, ros_unsubscribe('/chatter')),
          frame_sent("unsubscribe", _),
          rosbridge_frames(Frames),
          findall(Op, ( member(Frame, Frames), Op = Frame.op ), Ops),
          assertion(Ops == ["advertise", "publish", "publish", "subscribe",
                            "unsubscribe"]),
          Frames = [A,P|_],
          assertion(A.topic-A.type == "/chatter"-"std_msgs/String"),
          assertion(P.topic-P.msg.data == "/chatter"-"one"),
          assertion(\+ said("status", _)) )).

test(two_agents_share_one_subscription) :-
    on_a_host(Agent, [],
        ( goal_agent(alpha, Other),
          does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          does(alpha, Other, ros_subscribe('/t', 'std_msgs/String')),
          does(alpha, Agent, ros_publish('/t', 'std_msgs/String', [data=a])),
          gets(alpha, Agent, topic('/t', _)),
          gets(alpha, Other, topic('/t', _)),
          does(alpha, Agent, ros_unsubscribe('/t')),
          does(alpha, Agent, ros_publish('/t', 'std_msgs/String', [data=b])),
          gets(alpha, Other, topic('/t', Message)),
          assertion(Message.data == "b"),
          assertion(\+ remote(alpha, sense(got(Agent, topic(_, _))))),
          assertion(\+ said("unsubscribe", _)),
          does(alpha, Other, ros_unsubscribe('/t')),
          frame_sent("unsubscribe", _),
          aggregate_all(count, said("subscribe", _), Count),
          assertion(Count == 1) )).

test(leaving_agent_is_unsubscribed) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          agent_send(Agent, go(beta)),
          frame_sent("unsubscribe", Frame),
          assertion(Frame.topic == "/t"),
          goal_error(beta, Agent, ros_topics(_), Formal),
          assertion(Formal = existence_error(procedure, _)) )).

test(ended_agent_is_unsubscribed) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          agent_send(Agent, end),
          frame_sent("unsubscribe", _) )).

test(latest_message_as_a_fact) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/odom', 'std_msgs/String',
                                           [as(latest)])),
          forall(between(1, 5, N),
                 does(alpha, Agent, ros_publish('/odom', 'std_msgs/String',
                                                [data=N]))),
          wait_until(( remote(alpha, sense(ros-topic('/odom', Message))),
                       Message.data == 5 ), 5),
          remote(alpha, findall(M, sense(ros-topic(_, M)), Ms)),
          assertion(Ms = [_]) )).

test(facts_without_an_agent) :-
    on_a_host(Agent, [],
        ( remote(alpha, ros_subscribe('/odom', 'std_msgs/String',
                                      [as(latest)])),
          does(alpha, Agent, ros_publish('/odom', 'std_msgs/String',
                                         [data=here])),
          wait_until(remote(alpha, sense(ros-topic('/odom', _))), 5) )).

test(only_agents_receive_messages,
     error(existence_error(running_agent, here))) :-
    on_a_host(_, [], remote(alpha, ros_subscribe('/t', 'std_msgs/String'))).

test(dropped_messages_are_counted) :-
    on_a_host(Agent, [],
        ( agent_create(clauses([(:- agent(deaf, [])),
                                (main :- ros_subscribe('/t',
                                                       'std_msgs/String',
                                                       [queue(3)]),
                                         leave(ready),
                                         receive(user-now),
                                         collect),
                                (collect :- ( receive(ros-Message, 0.3)
                                            -> self(Me),
                                               leave(got(Me, Message)),
                                               collect
                                            ;  true ))]),
                       Deaf, [host(alpha)]),
          wait_until(remote(alpha, take(ready)), 5),
          forall(between(1, 10, N),
                 does(alpha, Agent, ros_publish('/t', 'std_msgs/String',
                                                [data=N]))),
          wait_until(( aggregate_all(count, said("publish", _), 10) ), 5),
          does(alpha, Agent, ros_call('/add_two_ints',
                                      'example_interfaces/AddTwoInts',
                                      [a=1,b=2], _)),
          agent_send(Deaf, now),
          agent_join(Deaf, done, 10),
          remote(alpha, findall(M, sense(got(Deaf, M)), Got)),
          aggregate_all(count, member(topic(_, _), Got), Kept),
          aggregate_all(sum(C), member(dropped('/t', C), Got), Dropped),
          assertion(Kept-Dropped == 3-7) )).

test(the_list_of_topics) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_publish('/b', 'std_msgs/String', [data=x])),
          does(alpha, Agent, ros_subscribe("/a", "std_msgs/msg/Bool")),
          does(alpha, Agent, ros_topics(Pairs)),
          assertion(Pairs == [ '/a'-'std_msgs/msg/Bool',
                               '/b'-'std_msgs/String' ]) )).

test(type_of_an_existing_topic) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_publish('/b', 'std_msgs/String', [data=x])),
          does(alpha, Agent, ros_subscribe('/b', Type)),
          assertion(Type == 'std_msgs/String'),
          goal_error(alpha, Agent, ros_subscribe('/nowhere', _), Formal),
          assertion(Formal == existence_error(ros_topic, '/nowhere')) )).

:- end_tests(rosbridge_topics).

:- begin_tests(rosbridge_services).

test(a_call_is_answered) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent,
               ros_call('/add_two_ints', 'example_interfaces/AddTwoInts',
                        _{a:40, b:2}, Response)),
          assertion(Response.sum == 42) )).

test(many_calls_at_a_time) :-
    on_a_host(_, [],
        ( numlist(1, 20, Ns),
          findall(N-Agent, ( member(N, Ns), goal_agent(alpha, Agent) ), Pairs),
          forall(member(N-Agent, Pairs),
                 agent_send(Agent,
                            do(( ros_call('/add_two_ints', 'a/B',
                                          _{a:N, b:N}, R),
                                 get_dict(sum, R, Sum),
                                 leave(sum(N, Sum)) )))),
          forall(member(N-_, Pairs),
                 ( wait_until(remote(alpha, sense(sum(N, Sum))), 10),
                   assertion(Sum =:= 2*N) )) )).

test(errors_are_reported) :-
    on_a_host(Agent, [],
        forall(member(Goal-Expected,
                      [ ros_call('/nowhere', 'a/B', [], _)
                        - existence_error(ros_service, '/nowhere'),
                        ros_call('/add_two_ints', 'a/B', [a=x,b=1], _)
                        - ros_error(refused, '/add_two_ints'),
                        ros_call('/slow', 'a/B', [], _, [deadline(0.3)])
                        - timeout_error(ros_call, '/slow'),
                        ros_call('/a b', 'a/B', [], _)
                        - domain_error(ros_name(service), '/a b'),
                        ros_call('/a', 'B', [], _)
                        - domain_error(ros_type(srv), 'B'),
                        ros_call('/a', 'a/msg/B', [], _)
                        - domain_error(ros_type(srv), 'a/msg/B'),
                        ros_call('/a', 'a/B', [a=f(1,2)], _)
                        - type_error(ros_value, f(1,2)),
                        ros_call('/a', 'a/B', 7, _)
                        - type_error(ros_message, 7),
                        ros_publish('/1', 'std_msgs/String', [])
                        - domain_error(ros_name(topic), '/1'),
                        ros_publish('/t', 'std_msgs/String', [data=X])
                        - instantiation_error,
                        ros_unsubscribe('/t')
                        - existence_error(ros_subscription, '/t'),
                        ros_withdraw('/t')
                        - existence_error(ros_offer, '/t'),
                        ros_answer(none, [])
                        - existence_error(ros_request, none),
                        ros_cancel(none)
                        - existence_error(ros_goal, none)
                      ]),
               ( goal_error(alpha, Agent, Goal, Formal),
                 X = X,
                 assertion(Formal == Expected) ))).

test(a_late_answer_is_dropped) :-
    on_a_host(Agent, [],
        ( goal_error(alpha, Agent,
                     ros_call('/slow', 'a/B', [], _, [deadline(0.2)]), _),
          frame_sent("call_service", Frame),
          rosbridge_send(_{op:service_response, id:Frame.id, service:"/slow",
                           values:_{late:true}, result:true}),
          does(alpha, Agent, ros_call('/add_two_ints', 'a/B', [a=1,b=1], R)),
          assertion(R.sum == 2) )).

test(service_offered_by_an_agent) :-
    on_a_host(Agent, [],
        ( goal_agent(alpha, Server),
          does(alpha, Server, ros_offer('/add', 'example_interfaces/AddTwoInts',
                                        [])),
          agent_send(Agent, do(ros_call('/add', 'a/B', [a=3,b=4], _))),
          gets(alpha, Server, request(Id, '/add', Request)),
          Sum is Request.a+Request.b,
          does(alpha, Server, ros_answer(Id, [sum=Sum])),
          wait_until(remote(alpha, take(did(Agent, Result))), 5),
          Result = yes(ros_call(_, _, _, Response)),
          assertion(Response.sum == 7),
          goal_error(alpha, Server, ros_answer(Id, [sum=Sum]), Formal),
          assertion(Formal == existence_error(ros_request, Id)),
          goal_error(alpha, Agent, ros_offer('/add', 'std_srvs/Empty', []),
                     Taken),
          assertion(Taken == permission_error(offer, ros_service, '/add')) )).

%   A call is refused if the queue of the agent is full; it is not counted
%   among the calls that wait for agents.

test(a_call_that_is_dropped) :-
    with_settings([typhon_ros_requests:most=2], on_a_host(_, [],
        ( offers_slowly('/s', _),
          offers_slowly('/t', Other),
          forall(member(Id, [c1, c2, c3]), calls(Id, '/s')),
          forall(member(Id, ["c2", "c3"]),
                 wait_until(( said("service_response", Frame),
                              Frame.id == Id, Frame.result == false ), 5)),
          calls(c4, '/t'),
          wait_until(agent_property(Other, mailbox([_])), 5) ))).

offers_slowly(Service, Agent) :-
    agent_create(clauses([ (:- agent(slow, [state([service/1])])),
                           (main :- service(S),
                                    ros_offer(S, 'std_srvs/Empty', [queue(1)]),
                                    receive(_-never)) ]),
                 Agent, [host(alpha), facts([service(Service)])]),
    frame_sent("advertise_service", _).

calls(Id, Service) :-
    rosbridge_send(_{op:call_service, id:Id, service:Service, args:_{}}).

test(a_service_that_fails) :-
    on_a_host(Agent, [],
        ( goal_agent(alpha, Server),
          does(alpha, Server, ros_offer('/no', 'std_srvs/Empty', [])),
          agent_send(Agent, do(ros_call('/no', 'std_srvs/Empty', [], _))),
          gets(alpha, Server, request(Id, _, _)),
          does(alpha, Server, ros_refuse(Id)),
          wait_until(remote(alpha, take(did(Agent, Result))), 5),
          assertion(Result == raised(ros_error(refused, '/no'))) )).

test(leaving_agent_refuses_its_open_calls) :-
    on_a_host(Agent, [],
        ( goal_agent(alpha, Server),
          does(alpha, Server, ros_offer('/no', 'std_srvs/Empty', [])),
          agent_send(Agent, do(ros_call('/no', 'std_srvs/Empty', [], _))),
          gets(alpha, Server, request(_, _, _)),
          agent_send(Server, go(beta)),
          wait_until(remote(alpha, take(did(Agent, Result))), 5),
          assertion(Result == raised(ros_error(refused, '/no'))),
          frame_sent("unadvertise_service", _) )).

test(parameters_are_services_of_nodes) :-
    on_a_host(Agent, [],
        ( goal_agent(alpha, Node),
          forall(member(Service, [get_parameters, set_parameters]),
                 ( atom_concat('/n/', Service, Path),
                   does(alpha, Node, ros_offer(Path, 'std_srvs/Empty', [])) )),
          forall(parameter(Type, Key, Value),
                 ( parameter_is_read(Agent, Node, Type, Key, Value),
                   parameter_is_set(Agent, Node, Type, Key, Value) )) )).

%   parameter(Type, Key, Value): as rcl_interfaces/msg/ParameterType has them.

parameter(1, bool_value, false).
parameter(2, integer_value, 7).
parameter(3, double_value, 0.5).
parameter(4, string_value, "x").
parameter(5, byte_array_value, "AQI=").
parameter(6, bool_array_value, [true,false]).
parameter(7, integer_array_value, [1,2]).
parameter(8, double_array_value, [0.5,1.5]).
parameter(9, string_array_value, ["x","y"]).

parameter_is_read(Agent, Node, Type, Key, Value) :-
    agent_send(Agent, do(ros_parameter('/n', speed, _))),
    gets(alpha, Node, request(Id, '/n/get_parameters', Request)),
    assertion(Request.names == ["speed"]),
    does(alpha, Node, ros_answer(Id, [values=[[type=Type,Key=Value]]])),
    wait_until(remote(alpha, take(did(Agent, Result))), 5),
    assertion(Result = yes(ros_parameter(_, _, Value))).

parameter_is_set(_, _, 5, _, _) :-
    !.                                  % it would be set as text
parameter_is_set(Agent, Node, Type, Key, Value) :-
    agent_send(Agent, do(ros_set_parameter('/n', speed, Value))),
    gets(alpha, Node, request(Id, '/n/set_parameters', Request)),
    Request.parameters = [Parameter],
    assertion(Parameter.name == "speed"),
    dict_pairs(Parameter.value, _, Pairs),
    assertion(Pairs == [Key-Value,type-Type]),
    does(alpha, Node, ros_answer(Id, [results=[[successful=true]]])),
    wait_until(remote(alpha, take(did(Agent, yes(_)))), 5).

test(parameter_that_is_no_value, Formal == type_error(ros_parameter, f(x))) :-
    on_a_host(Agent, [],
              goal_error(alpha, Agent, ros_set_parameter('/n', speed, f(x)),
                         Formal)).

:- end_tests(rosbridge_services).

:- begin_tests(rosbridge_actions).

test(goal_feedback_result) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_goal('/fibonacci',
                                      'example_interfaces/action/Fibonacci',
                                      [order=5], Id)),
          gets(alpha, Agent, feedback(Id, Feedback)),
          assertion(Feedback.sequence == [0,1,1]),
          gets(alpha, Agent, result(Id, Status, Result)),
          assertion(Status-Result.sequence == succeeded-[0,1,1,2,3,5]),
          goal_error(alpha, Agent, ros_cancel(Id), Formal),
          assertion(Formal == existence_error(ros_goal, Id)) )).

test(a_goal_is_cancelled) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_goal('/fibonacci', 'a/Fibonacci',
                                      [order=1000], Id)),
          gets(alpha, Agent, feedback(Id, _)),
          does(alpha, Agent, ros_cancel(Id)),
          gets(alpha, Agent, result(Id, canceled, _)) )).

test(leaving_agent_cancels_its_goals) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_goal('/fibonacci', 'a/Fibonacci',
                                      [order=1000], Id)),
          agent_send(Agent, go(beta)),
          frame_sent("cancel_action_goal", Frame),
          assertion(atom_string(Id, Frame.id)) )).

test(agent_that_stayed_is_notified) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          does(alpha, Agent, ros_goal('/fibonacci', 'a/Fibonacci',
                                      [order=1000], Id)),
          host_change(beta, capacity(0)),
          agent_send(Agent, do_move(beta)),
          gets(alpha, Agent, result(Id, failed, _)),
          does(alpha, Agent, ros_publish('/t', 'std_msgs/String', [data=x])),
          gets(alpha, Agent, topic('/t', _)) )).

test(no_server) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_goal('/none', 'a/Fibonacci', [], Id)),
          gets(alpha, Agent, result(Id, Status, Text)),
          assertion(Status-Text == failed-"No action server available") )).

:- end_tests(rosbridge_actions).

%   Servers that accept connections but neither read nor answer; one of them
%   completes the handshake of a WebSocket before.

:- meta_predicate
    with_silent_port(-, 0),
    with_deaf_server(-, 0),
    with_alpha(0).

with_silent_port(URL, Goal) :-
    setup_call_cleanup(
        listening_socket(Socket, URL),
        once(Goal),
        tcp_close_socket(Socket)).

listening_socket(Socket, URL) :-
    tcp_socket(Socket),
    tcp_setopt(Socket, reuseaddr),
    tcp_bind(Socket, localhost:Port),
    tcp_listen(Socket, 5),
    format(atom(URL), 'ws://localhost:~d/', [Port]).

with_deaf_server(URL, Goal) :-
    setup_call_cleanup(
        ( listening_socket(Socket, URL),
          thread_create(deaf(Socket), Thread) ),
        once(Goal),
        ( thread_send_message(Thread, end),
          thread_join(Thread, _),
          tcp_close_socket(Socket) )).

deaf(Socket) :-
    tcp_accept(Socket, Client, _),
    setup_call_cleanup(
        tcp_open_socket(Client, In, Out),
        ( accept_key(In, Accept),
          format(Out, "HTTP/1.1 101 Switching Protocols\r\n\c
                       Upgrade: websocket\r\nConnection: Upgrade\r\n\c
                       Sec-WebSocket-Accept: ~w\r\n\r\n", [Accept]),
          flush_output(Out),
          thread_get_message(end) ),
        ( close(In, [force(true)]),
          close(Out, [force(true)]) )).

accept_key(In, Accept) :-
    read_line_to_string(In, Line),
    (   string_concat("Sec-WebSocket-Key: ", Key, Line)
    ->  string_concat(Key, "258EAFA5-E914-47DA-95CA-C5AB0DC85B11", Text),
        sha_hash(Text, Hash, []),
        string_codes(Bytes, Hash),
        base64_encoded(Bytes, Accept, [as(string), encoding(octet)]),
        rest_of_header(In)
    ;   accept_key(In, Accept)
    ).

rest_of_header(In) :-
    read_line_to_string(In, Line),
    (   Line == ""
    ->  true
    ;   rest_of_header(In)
    ).

with_alpha(Goal) :-
    setup_call_cleanup(host_start(alpha), once(Goal), host_stop(alpha)).

:- begin_tests(rosbridge_errors).

test(no_server, error(socket_error(econnrefused, _))) :-
    free_port(Port),
    format(atom(URL), 'ws://localhost:~d/', [Port]),
    no_leaks(with_alpha(ros_start(alpha, URL, []))).

test(host_in_no_process, error(existence_error(host, gamma))) :-
    with_alpha(ros_start(gamma, 'ws://localhost:1/', [])).
test(no_url, error(domain_error(ros, 'http://localhost/'))) :-
    with_alpha(ros_start(alpha, 'http://localhost/', [])).
test(unknown_option, error(domain_error(ros_option, speed(1)))) :-
    with_alpha(ros_start(alpha, 'ws://localhost:1/', [speed(1)])).
test(not_started, error(existence_error(ros, alpha))) :-
    with_alpha(ros_stop(alpha)).
test(started_twice, error(permission_error(start, ros, alpha))) :-
    with_rosbridge(URL, with_alpha(( ros_start(alpha, URL, []),
                                     ros_start(alpha, URL, []) ))).

test(properties_of_a_host_in_another_process) :-
    no_leaks(with_rosbridge(URL,
        with_network(line(2), [processes(2)], _, [_,Far],
            ( assertion(\+ typhon:ros_property(Far, _)),
              ros_start(Far, URL, []),
              findall(P, typhon:ros_property(Far, P), Ps),
              catch(typhon:ros_property(nowhere, _), error(E, _), true) )))),
    assertion(memberchk(way(URL), Ps)),
    assertion(memberchk(connected(true), Ps)),
    assertion(E == existence_error(host, nowhere)).

test(halting_program_prints_nothing, Said-Status == ""-exit(0)) :-
    with_rosbridge(URL, with_tmp_dir(halted(URL, Said, Status))).

%   This server does not close its end, so the reader is interrupted.

test(halting_program_prints_nothing_at_a_deaf_server,
     Said-Status == ""-exit(0)) :-
    with_deaf_server(URL, with_tmp_dir(halted(URL, Said, Status))).

halted(URL, Said, Status, Dir) :-
    directory_file_path(Dir, 'program.pl', File),
    project_file('prolog/typhon.pl', Typhon),
    write_file(File, ':- use_module(~q).~n\c
                      main :- host_start(alpha), ros_start(alpha, ~q, []).~n',
               [Typhon, URL]),
    process_create(path(swipl), ['-g', main, '-t', halt, File],
                   [stdin(null), stderr(pipe(Err)), process(Pid)]),
    call_cleanup(read_string(Err, _, Said), close(Err)),
    process_wait(Pid, Status).

test(stopped_and_started_again) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          ros_property(alpha, way(URL)),
          ros_stop(alpha),
          wait_until(rosbridge_clients(0), 5),
          goal_error(alpha, Agent, ros_unsubscribe('/t'), Formal),
          assertion(Formal = existence_error(procedure, _)),
          ros_start(alpha, URL, []),
          does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')) )).

test(reconnected_server_gets_all_registrations) :-
    quiet(on_a_host(Agent, [],
        ( does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          does(alpha, Agent, ros_publish('/p', 'std_msgs/String', [data=x])),
          does(alpha, Agent, ros_offer('/s', 'std_srvs/Empty', [])),
          frame_sent("advertise_service", _),
          rosbridge_forget,
          rosbridge_cut,
          frame_sent("advertise_service", _),
          frame_sent("subscribe", S),
          frame_sent("advertise", A),
          assertion(S.topic-A.topic == "/t"-"/p"),
          wait_until(ros_property(alpha, connected(true)), 5),
          does(alpha, Agent, ros_publish('/t', 'std_msgs/String', [data=y])),
          gets(alpha, Agent, topic('/t', Message)),
          assertion(Message.data == "y") ))).

test(calls_and_goals_fail_when_the_server_disconnects) :-
    quiet(on_a_host(Agent, [],
        ( does(alpha, Agent, ros_goal('/fibonacci', 'a/F', [order=1000], Id)),
          agent_send(Agent, do(ros_call('/slow', 'a/B', [], _))),
          frame_sent("call_service", _),
          rosbridge_cut,
          wait_until(remote(alpha, take(did(Agent, Result))), 5),
          assertion(Result == raised(ros_error(lost, alpha))),
          gets(alpha, Agent, result(Id, failed, _)) ))).

test(publishing_without_a_server_is_an_error) :-
    quiet(no_leaks(with_rosbridge(URL,
        on_hosts(Agent, URL, [],
            ( wait_until(rosbridge_clients(1), 5), % counted there, too
              rosbridge_end(URL),
              wait_until(ros_property(alpha, connected(false)), 5),
              goal_error(alpha, Agent, ros_publish('/t', 'std_msgs/String', []),
                         Formal),
              assertion(Formal == ros_error(not_connected, alpha)),
              does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
              split_string(URL, ":/", "", Parts),
              nth1(5, Parts, Text),
              number_string(Port, Text),
              rosbridge_begin(Port, _),
              frame_sent("subscribe", Frame),
              assertion(Frame.topic == "/t") ))))).

test(status_reaches_its_agent) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_publish('/t', 'no_msgs/Such', [data=x])),
          gets(alpha, Agent, error(Text)),
          assertion(sub_string(Text, _, _, _, "not_advertised")),
          does(alpha, Agent, ros_subscribe('/t2', 'no_msgs/Such')),
          gets(alpha, Agent, error(Text2)),
          assertion(sub_string(Text2, _, _, _, "unknown_type")) )).

test(one_type_per_topic) :-
    on_a_host(Agent, [],
        ( does(alpha, Agent, ros_publish('/t', 'std_msgs/String', [])),
          does(alpha, Agent, ros_publish('/t', 'std_msgs/msg/String', [])),
          goal_error(alpha, Agent, ros_publish('/t', 'std_msgs/Bool', []),
                     Formal),
          assertion(Formal == permission_error(use,
                                               ros_topic('std_msgs/String'),
                                               '/t')) )).

test(invalid_frame_is_skipped) :-
    quiet(on_a_host(Agent, [],
        ( length(Codes, 100000),
          maplist(=(0'[), Codes),
          string_codes(Deep, Codes),
          forall(member(Bad, [ "", "{", "[]", "7", "nonsense", Deep,
                               "{\"op\":7}", "{\"op\":\"publish\"}",
                               "{\"op\":\"publish\",\"topic\":\"/t\",\c
                                 \"msg\":7}",
                               "{\"op\":\"fragment\",\"id\":\"a\",\"num\":0,\c
                                 \"total\":2,\"data\":\"x\"}",
                               "{\"op\":\"png\",\"data\":\"x\"}",
                               "{\"op\":\"service_response\",\"id\":[1]}",
                               "{\"op\":\"action_result\"}",
                               "{\"a\":1,\"a\":2}" ]),
                 rosbridge_send(Bad)),
          does(alpha, Agent, ros_call('/add_two_ints', 'a/B', [a=1,b=1], R)),
          assertion(R.sum == 2),
          ros_property(alpha, ignored(Count)),
          assertion(Count == 14),
          assertion(ros_property(alpha, connected(true))) ))).

test(too_long_frame_is_skipped) :-
    quiet(on_a_host(Agent, [],
        ( length(Codes, 4 500 000),
          maplist(=(0'x), Codes),
          string_codes(Long, Codes),
          rosbridge_send(_{op:publish, topic:"/t", msg:_{data:Long}}),
          does(alpha, Agent, ros_call('/add_two_ints', 'a/B', [a=1,b=1], R)),
          assertion(R.sum == 2),
          assertion(ros_property(alpha, ignored(1))) ))).

test(server_that_does_not_read) :-
    no_leaks(with_deaf_server(URL, with_alpha(
        ( ros_start(alpha, URL, [deadline(0.2)]),
          length(Codes, 5000),
          maplist(=(0'x), Codes),
          string_codes(Long, Codes),
          catch(( repeat,
                  remote(alpha, ros_publish('/t', 'std_msgs/String',
                                            [data=Long])),
                  fail ),
                error(Formal, _), true),
          assertion(Formal == resource_error(ros_queue)) )))).

test(a_silent_server, error(timeout_error(connect, URL))) :-
    no_leaks(with_silent_port(URL, with_alpha(
        ros_start(alpha, URL, [connect_deadline(0.3)])))).

test(million_characters_arrive) :-
    on_a_host(Agent, [],
        ( length(Codes, 1 000 000),
          maplist(=(0'x), Codes),
          string_codes(Long, Codes),
          does(alpha, Agent, ros_subscribe('/t', 'std_msgs/String')),
          does(alpha, Agent, ros_publish('/t', 'std_msgs/String',
                                         [data=Long])),
          gets(alpha, Agent, topic('/t', Message)),
          assertion(Message.data == Long) )).

:- end_tests(rosbridge_errors).
