:- module(test_mqtt, []).

/** <module> MQTT as a service of a place

With a real broker, which is stopped and restarted, and clients of other
programs.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/3]).
:- needs([mqtt]).
:- use_module('../../../lib/brokers').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/shown').
:- use_module('../../../lib/transcript', [transcript_differences/3]).
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2, numlist/3]).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(socket),
              [ tcp_bind/2, tcp_close_socket/1, tcp_listen/2, tcp_socket/1 ]).
:- use_module(library(typhon)).
:- use_module(library(typhon/bridges/helper), [helper_pid/2]).
:- use_module(library(typhon/bridges/mqtt/incoming), [mqtt_topic/2]).

:- dynamic shared/1.                    % the broker of most tests

start_shared :-
    broker_start([], Broker),
    assertz(shared(Broker)).

stop_shared :-
    retract(shared(Broker)),
    broker_stop(Broker).

:- meta_predicate at_broker(+, 0), on_hosts(+, -, 0).

at_broker(Options, Goal) :-
    shared(Broker),
    no_leaks(with_mqtt(Broker, Options, Goal)).

%   on_hosts(+Hosts, -URL, :Goal): alpha is connected; messages are not printed.

on_hosts(Hosts, URL, Goal) :-
    shared(Broker),
    broker_url(Broker, URL),
    capturing(with_hosts(Hosts, ( mqtt_start(alpha, URL, []), Goal )), _).

%   reader(+Goals, +Count, -Agent): an agent that calls Goals, reports that it
%   is ready, and whose result are the messages that it receives.

reader(Goals, Count, Agent) :-
    create([ (main :- Goals, self(Id), leave(ready(Id)), take(Count, Ms),
              result(Ms)),
             (take(N, Ms) :- (   N > 0,
                                 receive(mqtt-M, 20)
                             ->  self(Me),
                                 leave(took(Me)),
                                 N1 is N-1,
                                 Ms = [M|Rest],
                                 take(N1, Rest)
                             ;   Ms = []
                             )) ], Agent, [host(alpha)]),
    ready(Agent).

ready(Agent) :-
    wait_until(remote(alpha, sense(ready(Agent))), 10).

took_one(Agent) :-
    wait_until(remote(alpha, sense(took(Agent))), 10).

got(Agent, Messages) :-
    joined(Agent, done),
    agent_result(Agent, Messages, 5).

payloads(Ms, Ps) :-
    findall(P, member(message(_, P, _), Ms), Ps).

sends(Topic, Text) :-
    shared(Broker),
    client_publishes(Broker, Topic, ['-m', Text]).

mqtt_helper(Signal) :-
    helper_pid(mqtt(alpha), Pid),
    process_kill(Pid, Signal).

error_of(Goal, Formal) :-
    catch(( remote(alpha, Goal), Formal0 = none ), error(Formal0, _), true),
    Formal = Formal0.

:- begin_tests(mqtt_messages, [setup(start_shared), cleanup(stop_shared)]).

test(message_from_another_client, Ms == [message('lab/t', "21.5",
                                                 [qos(0),retain(false)])]) :-
    at_broker([], ( reader(subscribe('lab/+'), 1, A),
                    sends('lab/t', '21.5'),
                    got(A, Ms) )).
test(message_to_another_client, Lines == ["lab/x 1 hello"]) :-
    shared(Broker),
    at_broker([], client_receives(Broker, ['-t', '#', '-C', 1, '-q', 1,
                                          '-F', '%t %q %p'],
                                 remote(alpha, publish('lab/x', hello,
                                                       [qos(1)])),
                                 Lines)).
test(qualities, QoS == [0,1,2]) :-
    at_broker([], ( reader(subscribe(q, [qos(2)]), 3, A),
                    forall(member(Q, [0,1,2]),
                           remote(alpha, publish(q, Q, [qos(Q),wait(true)]))),
                    got(A, Ms) )),
    findall(Q, member(message(q, _, [qos(Q)|_]), Ms), QoS).
test(granted_quality, QoS == [1]) :-
    at_broker([], ( reader(subscribe(q, [qos(1)]), 1, A),
                    remote(alpha, publish(q, x, [qos(2)])),
                    got(A, Ms) )),
    findall(Q, member(message(q, _, [qos(Q)|_]), Ms), QoS).
%   The helper is stopped, so it answers nothing.

test(message_that_may_be_lost_is_not_waited_for, Lines == ["x"]) :-
    shared(Broker),
    at_broker([timeout(1)],
              client_receives(Broker, ['-t', lossy, '-C', 1, '-F', '%p'],
                              ( mqtt_helper(stop),
                                remote(alpha, publish(lossy, x)),
                                mqtt_helper(cont) ), Lines)).
test(retained) :-
    at_broker([], ( remote(alpha, publish(r, first, [retain(true),qos(1),
                                                     wait(true)])),
                    reader(subscribe('r/#'), 2, A),
                    took_one(A),
                    sleep(1.1),
                    reader(subscribe('r/#'), 2, B),
                    took_one(B),
                    remote(alpha, publish(r, second, [qos(1)])),
                    got(A, As), got(B, Bs),
                    remote(alpha, publish(r, '', [retain(true),wait(true)])) )),
    Expected = [ message(r, "first", [qos(0),retain(true)]),
                 message(r, "second", [qos(0),retain(false)]) ],
    assertion(As == Expected),
    assertion(Bs == Expected).
test(filters, Topics == [a, 'a/b', 'a/b', 'a/b/c', 'x/b']) :-
    at_broker([], ( reader(( subscribe('a/#'), subscribe('+/b') ), 5, A),
                    forall(member(T, [a, b, 'x/b', 'a/b/c', 'x/b/c', 'a/b']),
                           remote(alpha, publish(T, m))),
                    got(A, Ms) )),
    findall(T, member(message(T, _, _), Ms), Topics0),
    msort(Topics0, Topics).
test(all_subscribers_receive_a_message, Counts == [1,1,1]) :-
    at_broker([], ( maplist(reader_of, ['e/x','e/x','e/+'], As),
                    sends('e/x', m),
                    maplist(got_count, As, Counts) )).
test(terms, Ps =@= [_{a:[1,"b",null]}, [1,2], "text", "7", "[no json"]) :-
    at_broker([], ( reader(subscribe(t), 5, A),
                    remote(alpha, ( publish(t, _{a:[1,b,null]}),
                                    publish(t, [1,2]),
                                    publish(t, text), publish(t, 7),
                                    publish(t, "[no json") )),
                    got(A, Ms) )),
    payloads(Ms, Ps0),
    maplist(plain, Ps0, Ps).
test(terms_in_the_requested_form,
     Kinds == [ "{\"a\":1}", "\000\\xff\", 7, "seven",
                "\u00e4" ]) :-
    at_broker([],
              ( reader(( subscribe(text, [payload(text)]),
                         subscribe(bytes, [payload(bytes)]),
                         subscribe(json, [payload(json)]),
                         subscribe(auto) ), 5, A),
                remote(alpha, ( publish(text, _{a:1}),
                                publish(bytes, "\000\\xff\",
                                        [payload(bytes)]),
                                publish(json, 7), publish(json, seven),
                                publish(auto, "\u00e4") )),
                got(A, Ms) )),
    payloads(Ms, Kinds).
test(json_of_other_writers,
     Ps == [ "[01]", "{\"a\":\"\u00ff\"}", "\uFFFD", "\U0001F600", [2],
             [null,null] ]) :-
    at_broker([], ( reader(( subscribe(d), subscribe(e, [payload(json)]) ),
                           6, A),
                    sends(d, '[NaN,1e999]'),
                    sends(e, '"\\ud83d\\ude00"'),
                    sends(d, '\uFEFF[2]'), sends(d, '[01]'),
                    remote(alpha, publish(d, "{\"a\":\"\u00ff\"}",
                                          [payload(bytes)])),
                    sends(e, '"\\ude00"'),
                    got(A, Ms) )),
    payloads(Ms, Ps0),
    msort(Ps0, Ps).                     % of two senders
test(a_megabyte, Lengths == [1000000, 1000000]) :-
    at_broker([], ( create([ (main :- subscribe(big), self(Id),
                              leave(ready(Id)), length_of(L1), length_of(L2),
                              result([L1,L2])),
                             (length_of(L) :-
                                  receive(mqtt-message(big, P, _)),
                                  string_length(P, L)) ], A),
                    ready(A),
                    length(Codes, 1000000),
                    maplist(=(0'x), Codes),
                    string_codes(Text, Codes),
                    remote(alpha, publish(big, Text)),
                    remote(alpha, publish(big, Text, [qos(1)])),
                    got(A, Lengths) )).
test(unsubscribed, Ms == [message(end, "m", [qos(0),retain(false)])]) :-
    at_broker([], ( reader(( subscribe(u), subscribe(end), unsubscribe(u) ),
                           1, A),
                    sends(u, m), sends(end, m),
                    got(A, Ms) )).
test(subscribed_again_with_other_options, Ps == ["[1]"]) :-
    at_broker([], ( reader(( subscribe(w), subscribe(w, [payload(text)]) ),
                           1, A),
                    sends(w, '[1]'),
                    got(A, Ms) )),
    payloads(Ms, Ps).
test(facts, Facts == ["1","2"]) :-
    at_broker([], ( remote(alpha, subscribe('f/#', [as(fact)])),
                    sends('f/a', 1), sends('f/a', 2),
                    wait_until(remote(alpha,
                                      sense(mqtt-message(_, "2", _))), 10),
                    remote(alpha, findall(P, sense(mqtt-message(_, P, _)),
                                          Facts)) )).
test(latest_facts, Facts == ['f/a'-"3",'f/b'-"2"]) :-
    at_broker([], ( remote(alpha, subscribe('f/#', [as(latest)])),
                    sends('f/a', 1), sends('f/b', 2), sends('f/a', 3),
                    wait_until(remote(alpha,
                                      sense(mqtt-message(_, "3", _))), 10),
                    remote(alpha, findall(T-P, sense(mqtt-message(T, P, _)),
                                          Facts0)),
                    msort(Facts0, Facts) )).
test(too_many_facts, [Count,Dropped] == [5,15]) :-
    at_broker([], ( remote(alpha, subscribe(f, [as(fact),queue(5)])),
                    remote(alpha, forall(between(1, 20, I), publish(f, I))),
                    wait_until(remote(alpha, sense(mqtt-dropped(_, 15))), 10),
                    remote(alpha, findall(P, sense(mqtt-message(_, P, _)),
                                          Ps)),
                    remote(alpha, sense(mqtt-dropped(_, Dropped))),
                    length(Ps, Count) )).
test(too_many_messages, [Before,Dropped] == [10,40]) :-
    at_broker([queue(10)],
              ( create([ (main :- subscribe(f), subscribe(end), self(Id),
                          leave(ready(Id)), receive(_-go), take(0)),
                         (take(N) :- receive(mqtt-M),
                          (   M = dropped(mqtt(f, auto), D)
                          ->  result([N,D])
                          ;   N1 is N+1, take(N1)
                          )) ], A),
                ready(A),
                reader(subscribe(f, [queue(1000)]), 50, Other),
                remote(alpha, forall(between(1, 50, I), publish(f, I))),
                got(Other, _),
                agent_send(A, go),
                joined(A, done),
                agent_result(A, [Before,Dropped], 5) )).
test(thousand_messages_in_order, Ps == Expected) :-
    at_broker([], ( reader(subscribe(o), 1000, A),
                    remote(alpha, forall(between(1, 1000, I),
                                         publish(o, I))),
                    got(A, Ms) )),
    payloads(Ms, Ps),
    numlist(1, 1000, Ns),
    findall(S, ( member(N, Ns), number_string(N, S) ), Expected).

test(both_directions_at_once, Results == [done,exit(0),N-true,N-true]) :-
    N = 1500,
    at_broker([pending(100000)], both_directions(N, Results)).

%   both_directions(+N, -Results): an agent publishes N messages while N others
%   arrive. Results are the ends of the publishers, the numbers of messages in
%   each direction, and whether they were in order.

both_directions(N, [Published,Status,Out,In]) :-
    shared(Broker),
    counter(N, Counter),
    Seconds is 20+N//100,
    client_receives(Broker, ['-t', 'both/out', '-C', N, '-q', 1,
                            '-W', Seconds],
                   ( client_publishes_numbers(Broker, 'both/in', N, Pid),
                     create([ (main :- count(1)),
                              (count(I) :- (   I > N
                                           ->  true
                                           ;   publish('both/out', I,
                                                       [qos(1)]),
                                               I1 is I+1,
                                               count(I1)
                                           )) ], Publisher, [host(alpha)]),
                     agent_join(Publisher, Published, Seconds),
                     process_wait(Pid, Status) ),
                   Lines),
    in_order(Lines, 1, Out),
    agent_join(Counter, _, Seconds),
    agent_result(Counter, In, 5).

%   An agent that counts messages as long as they arrive in order.

counter(N, Agent) :-
    create([ (main :- subscribe('both/in', [qos(1),queue(N)]), self(Id),
              leave(ready(Id)), count(1)),
             (count(I) :- (   I > N
                          ->  result(N-true)
                          ;   receive(mqtt-message(_, P, _), 20),
                              number_string(I, P)
                          ->  I1 is I+1,
                              count(I1)
                          ;   result(I-false)
                          )) ], Agent, [host(alpha)]),
    ready(Agent).

in_order([], Next, N-true) :-
    N is Next-1.
in_order([Line|Lines], Next, Result) :-
    (   number_string(Next, Line)
    ->  Next1 is Next+1,
        in_order(Lines, Next1, Result)
    ;   Result = Next-false
    ).

mail_or_taken(Agent) :-
    agent_property(Agent, state(waiting)),
    agent_property(Agent, mailbox([])).

reader_of(Filter, Agent) :-
    reader(subscribe(Filter), 1, Agent).

got_count(Agent, Count) :-
    got(Agent, Ms),
    length(Ms, Count).

plain(Dict0, Dict) :-
    is_dict(Dict0),
    !,
    dict_pairs(Dict0, _, Pairs),
    dict_pairs(Dict, _, Pairs).
plain(Value, Value).

:- end_tests(mqtt_messages).

:- begin_tests(mqtt_agents, [setup(start_shared), cleanup(stop_shared)]).

test(leaving_agent_is_unsubscribed, Mail == []) :-
    shared(Broker),
    on_hosts([alpha,beta], _,
        ( traveller(beta, A),
          wait_until(unsubscribed(Broker, 'leave/me'), 10),
          sends('leave/me', m),
          agent_property(A, mailbox(Mail)) )).
test(agent_leaving_for_another_process_is_unsubscribed) :-
    shared(Broker),
    broker_url(Broker, URL),
    quietly(setup_call_cleanup(
                network_start(line(2), N, [processes(2)]),
                ( network_property(N, hosts([Near,Far])),
                  mqtt_start(Near, URL, []),
                  create([ (main :- r(F), subscribe('far/away'), move(F),
                            receive(_-go)) ], A,
                         [host(Near), facts([r(Far)])]),
                  wait_until(agent_property(A, host(Far)), 10),
                  wait_until(unsubscribed(Broker, 'far/away'), 10),
                  remote(Near, publish('far/away', m, [wait(true)])),
                  agent_property(A, mailbox(Mail)),
                  mqtt_stop(Near) ),
                network_stop(N))),
    assertion(Mail == []).
test(remaining_subscriber_gets_the_message,
     Ms == [message('stay/x', "m",
                    [qos(0),retain(false)])]) :-
    shared(Broker),
    on_hosts([alpha,beta-[capacity(0)]], _,
        ( address(beta, Beta),
          reader(( subscribe('stay/x'),
                   catch(move(Beta), error(_, _), true) ),
                 1, A),
          wait_until(again(Broker), 10),
          sends('stay/x', m),
          got(A, Ms) )).
test(ended_agent_is_unsubscribed) :-
    shared(Broker),
    at_broker([], ( create([ (main :- subscribe('the/end')) ], A),
                    joined(A, done),
                    wait_until(unsubscribed(Broker, 'the/end'), 10) )).
test(faulty_agent_is_unsubscribed) :-
    shared(Broker),
    at_broker([], ( create([ (main :- subscribe('the/fault'),
                              atom_length(_, _)) ], A),
                    joined(A, raised(_)),
                    wait_until(unsubscribed(Broker, 'the/fault'), 10) )).
test(other_agents_are_still_subscribed, Count == 1) :-
    at_broker([], ( reader(subscribe('two/x'), 1, A),
                    create([ (main :- subscribe('two/x')) ], B),
                    joined(B, done),
                    sends('two/x', m),
                    got(A, Ms),
                    length(Ms, Count) )).
test(other_hosts_have_no_connection, Outcome = raised(E)) :-
    on_hosts([alpha,beta], _,
        ( create([ (main :- publish(a, b)) ], A, [host(beta)]),
          joined(A, Outcome) )),
    assertion(E = error(existence_error(procedure, _), _)).
test(two_hosts_have_two_connections, Ms == ["m"]) :-
    on_hosts([alpha,beta], URL,
        ( mqtt_start(beta, URL, []),
          reader(subscribe('hop/x'), 1, A),
          remote(beta, publish('hop/x', m)),
          got(A, Ms0) )),
    findall(P, member(message(_, P, _), Ms0), Ms).

:- meta_predicate quietly(0).

quietly(Goal) :-
    capturing(Goal, _).

traveller(Host, Agent) :-
    address(Host, Address),
    create([ (main :- r(To), subscribe('leave/me'), move(To),
              receive(_-go)) ], Agent, [host(alpha), facts([r(Address)])]),
    wait_until(agent_property(Agent, host(Address)), 10).

unsubscribed(Broker, Filter) :-
    broker_log(Broker, Text),
    sub_string(Text, At, _, _, "Received UNSUBSCRIBE"),
    sub_string(Text, At, _, 0, Rest),
    sub_string(Rest, _, _, _, Filter),
    !.

again(Broker) :-
    broker_log(Broker, Text),
    findall(At, sub_string(Text, At, _, _, "stay/x (QoS"), [_,_|_]).

:- end_tests(mqtt_agents).

:- begin_tests(mqtt_errors, [setup(start_shared), cleanup(stop_shared)]).

test(text_of_all_kinds) :-
    length(Codes, 70000),
    maplist(=(0'a), Codes),
    atom_codes(Long, Codes),
    at_broker([], forall(wrong(Long, Goal, Expected),
                         ( error_of(Goal, Formal),
                           assertion(Formal \== none),
                           assertion(Goal-Formal = Goal-Expected) ))).
%   What section 1.5.4 of the standard of MQTT 5 excludes.

test(characters_of_topics, Refused == [0-31, 127-159, 0xFDD0-0xFDEF,
                                       0xFFFE-0xFFFF, 0x1FFFE-0x1FFFF]) :-
    findall(Code,
            ( ( between(0, 0xD7FF, Code) ; between(0xE000, 0x20000, Code) ),
              \+ memberchk(Code, `+#`),
              atom_codes(Topic, [Code]),
              \+ is_topic(Topic) ),
            Codes),
    ranges(Codes, Refused).
test(length_and_depth_of_topics,
     [forall(member(Char-Most, [a-65535, '\u20ac'-21845, (/)-199]))]) :-
    More is Most+1,
    maplist(repeated(Char), [Most,More], [Longest,Longer]),
    assertion(is_topic(Longest)),
    assertion(\+ is_topic(Longer)).

is_topic(Text) :-
    catch(mqtt_topic(Text, Topic), error(domain_error(mqtt_topic, Text), _),
          fail),
    assertion(Topic == Text).

repeated(Char, Count, Atom) :-
    findall(Char, between(1, Count, _), Chars),
    atomic_list_concat(Chars, Atom).

ranges([], []).
ranges([Code|Codes], [Code-Last|Ranges]) :-
    range(Codes, Code, Last, Rest),
    ranges(Rest, Ranges).

range([Next|Codes], Code, Last, Rest) :-
    Next =:= Code+1,
    !,
    range(Codes, Next, Last, Rest).
range(Rest, Last, Last, Rest).

test(too_large_to_send, E == resource_error(mqtt_payload)) :-
    at_broker([largest(100)], ( numlist(1, 100, Ns),
                                error_of(publish(a, Ns), E) )).
test(too_large_to_receive, Ms == [ too_big(b, 101),
                                   message(b, "x", [qos(0),retain(false)]) ]) :-
    length(Codes, 101),
    maplist(=(0'a), Codes),
    atom_codes(Text, Codes),
    at_broker([largest(100)], ( reader(subscribe(b), 2, A),
                                sends(b, Text), sends(b, x),
                                got(A, Ms) )).
test(deep_json_is_text, Length == 100000) :-
    length(Codes, 100000),
    maplist(=(0'[), Codes),
    string_codes(Text, Codes),
    at_broker([], ( reader(subscribe(d), 1, A),
                    remote(alpha, publish(d, Text)),
                    got(A, [message(d, P, _)]) )),
    string_length(P, Length).
test(urls) :-
    with_hosts([alpha],
               forall(member(URL, [ 'http://x', 'mqtt://', x, 'mqtt://a:0',
                                    'mqtt://a:70000', 7 ]),
                      ( catch(mqtt_start(alpha, URL, []), error(E, _), true),
                        assertion(E == domain_error(mqtt_url, URL)) ))).
test(options) :-
    forall(member(Option-Expected,
                  [ colour(red)-domain_error(mqtt_option, colour(red)),
                    clean(false)-existence_error(mqtt_option, client),
                    keepalive(0)-_,
                    will('a/#', x)-domain_error(mqtt_topic, 'a/#'),
                    ca('/no/file')-existence_error(_, _) ]),
           ( with_hosts([alpha],
                        catch(mqtt_start(alpha, 'mqtt://127.0.0.1:1',
                                         [Option]),
                              error(E, _), true)),
             assertion(nonvar(E)),
             assertion(E = Expected) )).
test(no_broker_listens, E == mqtt_error(unreachable, alpha)) :-
    free_port(Port),
    format(atom(URL), 'mqtt://127.0.0.1:~d', [Port]),
    with_hosts([alpha], catch(mqtt_start(alpha, URL, []), error(E, _), true)).
test(silent_broker, E == timeout_error(mqtt(connect), alpha)) :-
    tcp_socket(Socket),
    tcp_bind(Socket, '127.0.0.1':Port),
    tcp_listen(Socket, 5),
    format(atom(URL), 'mqtt://127.0.0.1:~d', [Port]),
    call_cleanup(with_hosts([alpha],
                            catch(mqtt_start(alpha, URL, [timeout(3)]),
                                  error(E, _), true)),
                 tcp_close_socket(Socket)).
test(started_twice, E == permission_error(start, mqtt, alpha)) :-
    at_broker([], catch(mqtt_start(alpha, 'mqtt://x', []), error(E, _),
                        true)).
test(stopped, [A,B] == [gone, existence_error(mqtt, alpha)]) :-
    at_broker([], ( mqtt_stop(alpha),
                    error_of(publish(a, b), E),
                    catch(mqtt_stop(alpha), error(B, _), true) )),
    ( E = existence_error(procedure, _) -> A = gone ; A = E ).
test(paho_is_not_installed, E == existence_error(python_module, paho)) :-
    with_tmp_dir(no_paho(E, [])).
test(publish_times_out_without_a_broker,
     Es == [timeout_error(mqtt(publish), alpha),
            timeout_error(mqtt(publish), alpha)]) :-
    free_port(Port),
    format(atom(URL), 'mqtt://127.0.0.1:~d', [Port]),
    with_hosts([alpha],
               ( mqtt_start(alpha, URL, [wait(false),timeout(1)]),
                 findall(E, ( member(QoS, [0,1]),
                              error_of(publish(a, b, [qos(QoS),wait(true)]),
                                       E) ), Es) )).

wrong(_, publish('a/#', x), domain_error(mqtt_topic, 'a/#')).
wrong(_, publish('a/+', x), domain_error(mqtt_topic, _)).
wrong(_, publish('', x), domain_error(mqtt_topic, '')).
wrong(_, publish('a\000\b', x), domain_error(mqtt_topic, _)).
wrong(Long, publish(Long, x), domain_error(mqtt_topic, _)).
wrong(_, publish('a\u0007', x), domain_error(mqtt_topic, _)).
wrong(_, publish('a\uFFFFb', x), domain_error(mqtt_topic, _)).
wrong(_, subscribe(Deep, [as(fact)]), domain_error(mqtt_filter, Deep)) :-
    length(Levels, 300),
    maplist(=(a), Levels),
    atomic_list_concat(Levels, /, Deep).
wrong(_, publish(f(x), x), type_error(text, f(x))).
wrong(_, publish(_, x), instantiation_error).
wrong(_, publish(a, _), instantiation_error).
wrong(_, publish(a, f(x)), type_error(mqtt_payload, f(x))).
wrong(_, publish(a, [f(x)]), type_error(json_value, f(x))).
wrong(_, publish(a, "\u0101", [payload(bytes)]), type_error(bytes, _)).
wrong(_, publish(a, b, [qos(3)]), type_error(_, 3)).
wrong(_, publish(a, b, [qos(high)]), type_error(_, high)).
wrong(_, publish(a, b, [speed(3)]), domain_error(mqtt_publish_option, _)).
wrong(_, publish(a, b, [payload(xml)]), _).
wrong(_, subscribe('a/#/b', [as(fact)]), domain_error(mqtt_filter, _)).
wrong(_, subscribe('a#', [as(fact)]), domain_error(mqtt_filter, _)).
wrong(_, subscribe('a+/b', [as(fact)]), domain_error(mqtt_filter, _)).
wrong(_, subscribe('', [as(fact)]), domain_error(mqtt_filter, _)).
wrong(_, subscribe(7), type_error(text, 7)).
wrong(_, subscribe(a), existence_error(running_agent, here)).
wrong(_, subscribe(a, [as(song)]), _).
wrong(_, subscribe(a, song), type_error(list, song)).
wrong(_, publish(a, b, song), type_error(list, song)).
wrong(_, subscribe(a, [queue(0)]), type_error(_, 0)).
wrong(_, subscribe(a, [colour(red)]), domain_error(subscription_option, _)).
wrong(_, unsubscribe(a), existence_error(mqtt_subscription, a)).

%   Messages are the warnings beside the error.

no_paho(E, Messages, Dir) :-
    directory_file_path(Dir, python, File),
    write_file(File, '#!/bin/sh~nexec /usr/bin/python3 -S "$@"~n', []),
    process_create(path(chmod), ['+x', File], []),
    capturing(with_hosts([alpha],
                         catch(mqtt_start(alpha, 'mqtt://127.0.0.1:1',
                                          [python(File)]),
                               error(E, _), true)), Messages).

:- end_tests(mqtt_errors).

:- begin_tests(mqtt_brokers).

test(document_shows_the_actual_output, Differences == []) :-
    with_tmp_dir(document(Differences)).

test(broker_is_stopped_and_started, Ps == ["1","2","3","4"]) :-
    with_broker([], B, stopped_and_started(B, Ps)).
test(retained_message_arrives_again, Ps == ["1","2"]) :-
    with_broker([], B, retained_anew(B, Ps)).
test(queued_messages_are_bounded, E == resource_error(mqtt_pending)) :-
    with_broker([], B,
                with_mqtt(B, [pending(3)],
                          ( broker_signal(B, term),
                            wait_until(down, 10),
                            remote(alpha, ( publish(a, 1), publish(a, 2),
                                            publish(a, 3) )),
                            error_of(publish(a, 4), E) ))).
test(queued_messages_with_quality_are_bounded,
     E == resource_error(mqtt_pending)) :-
    with_broker([], B,
                with_mqtt(B, [pending(3)],
                          ( broker_signal(B, term),
                            wait_until(down, 10),
                            fill(200, E) ))).
test(broker_starts_later, Ps == ["1","2"]) :-
    with_broker([], B, not_there_yet(B, Ps)).
test(unresponsive_broker, E == timeout_error(mqtt(publish),
                                             alpha)) :-
    with_broker([], B,
                with_mqtt(B, [timeout(3)],
                          ( broker_signal(B, stop),
                            remote(alpha, publish(a, 1)),
                            error_of(publish(a, 2, [qos(1),wait(true)]), E),
                            broker_signal(B, cont) ))).
test(last_will, Lines == ["gone bye 1"]) :-
    with_broker([], B,
                with_mqtt(B, [will(gone, bye, [qos(1),retain(true)])],
                          client_receives(B, ['-t', gone, '-C', 1, '-q', 1,
                                             '-F', '%t %p %q'],
                                         killed, Lines))).
test(helper_dies, Ps == ["m"]) :-
    with_broker([], B,
                with_mqtt(B, [],
                          ( reader(subscribe(k), 1, A),
                            killed,
                            wait_until(subscribed_twice(B, k), 10),
                            client_publishes(B, k, ['-m', m]),
                            got(A, Ms) ))),
    payloads(Ms, Ps).
test(kept_session, Ps == ["1","2"]) :-
    with_broker([], B, kept_session(B, Ps)).
test(discarded_session, Ms == []) :-
    with_broker([], B,
                ( with_mqtt(B, [client(c)], reader(subscribe(s, [qos(1)]), 0, _)),
                  client_publishes(B, s, ['-m', 1, '-q', 1]),
                  with_mqtt(B, [client(c)],
                            ( create([ (main :- subscribe(s, [qos(1)]),
                                        ( receive(mqtt-M, 0.3) -> true
                                        ; M = none ), result(M)) ], A),
                              got(A, M) )) )),
    ( M == none -> Ms = [] ; Ms = M ).
test(password, [E,R] == [mqtt_error(refused, alpha), ok]) :-
    with_tmp_dir(password(E, R)).
test(tls, [Es,Rs] == [[mqtt_error(tls, alpha)], [ok,ok]]) :-
    with_tmp_dir(tls(Es, Rs)).
test(denied, E == permission_error(subscribe, mqtt_filter, 'no/thing')) :-
    with_tmp_dir(denied(E)).

%   With a broker on another machine.

document(Differences, Dir) :-
    Document = 'doc/bridges.md',
    directory_file_path(Dir, 'thermostat.pl', File),
    shown_in_file(Document, "```prolog\n% thermostat.pl\n", File),
    Begin = "?- host_start(alpha), mqtt_start",
    string_concat("```text\n", Begin, Text),
    shown(Document, Text, Session0),
    with_broker([], B,
                ( broker_url(B, URL),
                  atomic_list_concat(Parts, 'mqtt://localhost', Session0),
                  atomic_list_concat(Parts, URL, Session),
                  string_concat(Begin, Session, All),
                  split_string(All, "\n", "", Lines),
                  transcript_differences([1-Lines], Dir, Differences) )).

killed :-
    mqtt_helper(kill).

%   The connection is up or down, as was last reported.

connection(State) :-
    findall(S, ( printed_message(_, typhon(Message)),
                 memberchk(Message-S,
                           [mqtt_up(alpha)-up, mqtt_down(alpha)-down]) ),
            States),
    last(States, State).

down :-
    connection(down).

up :-
    connection(up).

fill(0, none) :-
    !.
fill(N, E) :-
    error_of(publish(a, N, [qos(1)]), E0),
    (   E0 == none
    ->  N1 is N-1,
        fill(N1, E)
    ;   E = E0
    ).

stopped_and_started(B, Ps) :-
    with_mqtt(B, [],
              ( remote(alpha, subscribe(s, [qos(1),as(fact)])),
                client_publishes(B, s, ['-m', 1]),
                wait_until(came("1"), 10),
                broker_signal(B, term),
                wait_until(down, 10),
                remote(alpha, ( publish(s, 2, [qos(1)]),
                                publish(s, 3) )),
                broker_restart(B),
                wait_until(up, 20),
                wait_until(subscribed_twice(B, s), 10),
                client_publishes(B, s, ['-m', 4]),
                wait_until(( came("2"), came("3"), came("4") ), 20),
                remote(alpha, findall(P, sense(mqtt-message(s, P, _)),
                                      Ps0)) )),
    msort(Ps0, Ps).

%   A retained message arrives again also for an agent that subscribed long
%   before the other one.

retained_anew(B, Ps) :-
    with_mqtt(B, [],
              ( reader(subscribe(r), 2, A),
                remote(alpha, publish(r, 1, [retain(true),wait(true)])),
                sleep(1.1),
                reader(subscribe(r), 2, _),
                broker_signal(B, term),
                wait_until(down, 10),
                broker_restart(B),
                client_publishes(B, r, ['-m', 2, '-r', '-q', 1]),
                got(A, Ms) )),
    payloads(Ms, Ps).

came(Payload) :-
    remote(alpha, sense(mqtt-message(s, Payload, _))).

not_there_yet(B, Ps) :-
    broker_signal(B, term),
    with_mqtt(B, [wait(false)],
              ( reader(subscribe(s), 2, A),
                remote(alpha, publish(s, 1)),
                broker_restart(B),
                wait_until(up, 20),
                remote(alpha, publish(s, 2)),
                got(A, Ms) )),
    payloads(Ms, Ps).

subscribed_twice(B, Filter) :-
    broker_log(B, Text),
    format(string(Line), "~w (QoS", [Filter]),
    findall(At, sub_string(Text, At, _, _, Line), [_,_|_]).

kept_session(B, Ps) :-
    Options = [client(c),clean(false)],
    with_mqtt(B, Options,
              ( create([ (main :- subscribe(s, [qos(1)]), self(Id),
                          leave(ready(Id)), receive(_-go)) ], A),
                ready(A),
                mqtt_stop(alpha) )),
    client_publishes(B, s, ['-m', 1, '-q', 1]),
    client_publishes(B, s, ['-m', 2, '-q', 1]),
    with_mqtt(B, Options, ( reader(subscribe(s, [qos(1)]), 2, C),
                            got(C, Ms) )),
    payloads(Ms, Ps).

password(E, R, Dir) :-
    directory_file_path(Dir, passwords, File),
    process_create(path(mosquitto_passwd), ['-b', '-c', File, lizzy, secret],
                   [process(Pid)]),
    process_wait(Pid, exit(0)),
    atom_concat('password_file ', File, Line),
    with_broker([anonymous(false), Line], broker(Port, _),
                ( format(atom(Bad), 'mqtt://lizzy:guess@127.0.0.1:~d', [Port]),
                  format(atom(Good), 'mqtt://lizzy@127.0.0.1:~d', [Port]),
                  start_at(Bad, [], E),
                  start_at(Good, [password(secret)], R) )).

start_at(URL, Options, Result) :-
    capturing(with_hosts([alpha],
                         catch(( mqtt_start(alpha, URL, Options),
                                 remote(alpha, publish(a, b, [qos(1),
                                                              wait(true)])),
                                 Result = ok ),
                               error(Result, _), true)), _).

%   A broker at another port, which speaks TLS.

tls(Es, Rs, Dir) :-
    certificates(Dir),
    free_port(Port),
    format(atom(Listener), 'listener ~d 127.0.0.1', [Port]),
    maplist(line_in(Dir),
            ['cafile ~w/ca.pem', 'certfile ~w/cert.pem', 'keyfile ~w/key.pem'],
            Lines),
    directory_file_path(Dir, 'ca.pem', CA),
    format(atom(URL), 'mqtts://localhost:~d', [Port]),
    format(atom(Number), 'mqtts://127.0.0.1:~d', [Port]),
    with_broker([Listener|Lines], _,
                ( start_at(URL, [], E),
                  start_at(URL, [ca(CA)], R1),
                  start_at(Number, [ca(CA),insecure(true)], R2) )),
    Es = [E],
    Rs = [R1,R2].

line_in(Dir, Format, Line) :-
    format(atom(Line), Format, [Dir]).

certificates(Dir) :-
    forall(member(Args,
                  [ [req, '-x509', '-newkey', ec, '-pkeyopt',
                     'ec_paramgen_curve:P-256', '-nodes',
                     '-keyout', 'ca.key', '-out', 'ca.pem', '-days', 2,
                     '-subj', '/CN=Test CA'],
                    [req, '-newkey', ec, '-pkeyopt',
                     'ec_paramgen_curve:P-256', '-nodes', '-keyout',
                     'key.pem', '-out', 'req.pem', '-subj', '/CN=localhost'],
                    [x509, '-req', '-in', 'req.pem', '-CA', 'ca.pem',
                     '-CAkey', 'ca.key', '-CAcreateserial', '-days', 2,
                     '-out', 'cert.pem'] ]),
           ( process_create(path(openssl), Args,
                            [cwd(Dir), stdout(null), stderr(null),
                             process(Pid)]),
             process_wait(Pid, exit(0)) )).

%   No client may subscribe to anything.

denied(E, Dir) :-
    directory_file_path(Dir, acl, File),
    write_file(File, '{"defaultACLAccess": {\c
                      "publishClientSend": true, \c
                      "publishClientReceive": true, \c
                      "subscribe": false, \c
                      "unsubscribe": true}}~n', []),
    expand_file_name('/usr/lib/*/mosquitto_dynamic_security.so', [Plugin|_]),
    atom_concat('plugin ', Plugin, Line1),
    atom_concat('plugin_opt_config_file ', File, Line2),
    with_broker([Line1, Line2], B,
                with_mqtt(B, [],
                          ( error_of(publish(a, b, [qos(1),wait(true)]), none),
                            error_of(subscribe('no/thing', [as(fact)]), E) ))).

:- end_tests(mqtt_brokers).
