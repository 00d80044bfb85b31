:- module(test_tartarus, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/tartarus_nodes').
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Programs written for Tartarus, as their users ran them

Each platform is a process; tests compare typed input and output.

*Threading*: one test at a time.
*/

%   tartarus(+Programs, +Steps): platforms a, b, ..., one for each program, a
%   list of lines, perform Steps: `Node:Text` types Text, `Node>Lines` waits
%   until Lines are printed, `up(Node, Token)` starts the platform of Node. In
%   all texts $1 is the port of a, $2 that of b, $3 a free one.

tartarus(Programs0, Steps) :-
    ports(3, Ports),
    maplist(maplist(with_ports(Ports)), Programs0, Programs),
    length(Programs, Count),
    length(Nodes, Count),
    with_nodes(Programs, Nodes,
               forall(member(Step, Steps), step(Step, Nodes, Ports))).

step(up(Name, Token), Nodes, Ports) :-
    nth1(N, [a, b], Name),
    format(string(Start), "start_tartarus(localhost, $~d, ~w).", [N, Token]),
    format(string(Banner), "Port = $~d", [N]),
    step(Name:Start, Nodes, Ports),
    step(Name>[Banner], Nodes, Ports).
step(Name:Text0, Nodes, Ports) :-
    node(Name, Nodes, Node),
    with_ports(Ports, Text0, Text),
    type(Node, Text).
step(Name>Lines0, Nodes, Ports) :-
    node(Name, Nodes, Node),
    maplist(with_ports(Ports), Lines0, Lines),
    printed(Node, Lines, 120).

node(Name, Nodes, Node) :-
    nth1(N, [a, b], Name),
    nth1(N, Nodes, Node).

with_ports(Ports, Text0, Text) :-
    foldl(with_port(Ports), [1, 2, 3], Text0, Text).

with_port(Ports, N, Text0, Text) :-
    nth1(N, Ports, Port),
    format(atom(Sign), "$~d", [N]),
    atomic_list_concat(Parts, Sign, Text0),
    atomic_list_concat(Parts, Port, Text1),
    atom_string(Text1, Text).

:- begin_tests(third_generation).

test(visitor_is_listed_on_its_platform) :-
    tartarus([[ ":- dynamic fly/3.",
                "go :- consult('platform.pl'),",
                "   start_tartarus(localhost, $1, 7),",
                "   create_mobile_agent(bee, (localhost,$1), fly, [7]),",
                "   writeln('off it goes'),",
                "   move_agent(bee, (localhost,$2)).",
                "fly(guid, (Ip,Port), main) :-",
                "   writeln(guid:' has come to ':Ip:Port)." ], []],
             [ up(b, 7), a:"go.",
               b > ["  \n", "bee: has come to :localhost:$2"],
               a > ["off it goes"], b:"list_agent.",
               b > [ "====Agent list====",
                     "Agent Name :bee, handler name:fly, residing on port:$2" ],
               a:"list_agent(L), writeln(agents(L)).", a > ["agents([])"] ]).
test(agent_back_before_its_move_has_returned_is_not_lost) :-
    Walker = [ ":- dynamic walker/3, left/2, next/1.",
               "walker(guid, (Ip,_), main) :-",
               "    retract(left(guid, N)),",
               "    (   N =:= 0",
               "    ->  writeln(home)",
               "    ;   N1 is N-1, assertz(left(guid, N1)),",
               "        next(P), move_agent(guid, (Ip,P))",
               "    )." ],
    tartarus([["next($2)."|Walker], ["next($1)."|Walker]],
             [ up(a, 7), up(b, 7),
               a:"create_mobile_agent(w, (localhost,$1), walker, [7]), \c
                  assertz(left(w, 100)), add_payload(w, [(left,2)]), \c
                  execute_agent(w, (localhost,$1), walker).", a > ["home"] ]).
test(payload_travels_and_its_template_stays) :-
    tartarus([[ ":- dynamic carry/3, load/2.", "load(guid, 150).",
                "carry(guid, _, main) :- load(guid, N),",
                "    writeln('it weighs ':N)." ], []],
             [ up(a, 1), up(b, 1),
               a:"create_mobile_agent(ant, (localhost,$1), carry, [1]), \c
                  add_payload(ant, [(load,2)]), \c
                  move_agent(ant, (localhost,$2)).", b > ["it weighs :150"],
               b:"findall(X-N, load(X,N), L), writeln(loads(L)).",
               b > ["loads([ant-150])"],
               a:"findall(X-N, load(X,N), L), writeln(loads(L)).",
               a > ["loads([guid-150])"] ]).
test(agent_returns_and_its_clone_prints) :-
    Program = [ ":- dynamic thanos_task/3, energy/2.",
                "next($1, $2).", "next($2, $1).", "energy(guid, 2).",
                "thanos_task(guid, (Ip,Port), main) :-",
                "   energy(guid, E), writeln(guid:at(Port):energy(E)),",
                "   next(Port, Other),",
                "   (  E > 0",
                "   -> E1 is E-1, retractall(energy(guid, _)),",
                "      assertz(energy(guid, E1)),",
                "      move_agent(guid, (Ip,Other))",
                "   ;  E =:= 0",
                "   -> retractall(energy(guid, _)), assertz(energy(guid, -1)),",
                "      clone_agent(guid, (Ip,Other), C), writeln(clone:C)",
                "   ;  true",
                "   )." ],
    tartarus([Program, Program],
             [ up(a, 1), up(b, 1),
               a:"create_mobile_agent(thanos, (localhost,$1), thanos_task, \c
                  [1]), add_payload(thanos, [(energy,2)]), \c
                  execute_agent(thanos, (localhost,$1), thanos_task).",
               a > [ "thanos:at($1):energy(2)", "thanos:at($1):energy(0)",
                     "clone:thanos1" ],
               b > ["thanos:at($2):energy(1)", "thanos1:at($2):energy(-1)"],
               b:"isexist_agent(N, L, H), writeln(N/L/H).",
               b > ["thanos1/(localhost,$2)/thanos_task"] ]).
test(agent_without_token_is_refused_and_stays) :-
    tartarus([[":- dynamic h/3.", "h(guid, _, main) :- writeln(here(guid))."],
              []],
             [ up(a, 1), up(b, 2),
               a:"create_mobile_agent(fly, (localhost,$1), h, [1]), \c
                  move_agent(fly, (localhost,$2)), writeln(told).",
               a > [ "--------negative ACK received-----------",
                     "Agent fly was not allowed to enter the destination.",
                     "--------negative ack processed-----------", "told" ],
               b:"set_token(1), writeln(trusted).", b > ["trusted"],
               a:"move_agent(fly, (localhost,$2)).", b > ["here(fly)"] ]).
test(move_to_a_dead_or_the_same_platform) :-
    tartarus([[":- dynamic h/3.", "h(guid, _, main)."]],
             [ up(a, 1),
               a:"create_mobile_agent(fly, (localhost,$1), h, [1]), \c
                  move_agent(fly, (localhost,$2)), \c
                  isexist_agent(fly, _, H), writeln(still(H)).",
               a > ["Enter a valid IP address and Port number.", "still(h)"],
               a:"move_agent(fly, ('127.0.0.1',$1)).",
               a > ["Agent is already on same platform."],
               a:"move_agent(missing, (localhost,1)), writeln(true1).",
               a > ["Move agent Failed for :missing", "true1"] ]).
test(goals_after_a_move_run_at_the_source) :-
    tartarus([[ ":- dynamic h/3, left/2.", "left(guid, old).",
                "h(guid, (_,$1), main) :- !,",
                "   move_agent(guid, (localhost,$2)), left(guid, X),",
                "   writeln(here_still(X)).",
                "h(guid, _, main) :- writeln(there(guid))." ], []],
             [ up(a, 1), up(b, 1),
               a:"create_mobile_agent(a, (localhost,$1), h, [1]), \c
                  add_payload(a, [(left,2)]), \c
                  execute_agent(a, (localhost,$1), h).",
               b > ["there(a)"], a > ["here_still(old)"],
               a:"between(1, 2000, _), findall(X, left(X,_), L), \c
                  ( L == [guid] -> true ; sleep(0.01), fail ), !, \c
                  writeln(left(L)).", a > ["left([guid])"] ]).
test(large_port) :-
    ports(1, [P]),
    Large is P+65536,
    format(string(Start), "start_tartarus(localhost, ~d, 1).", [Large]),
    format(string(Details), "localhost-~d", [Large]),
    tartarus([[]], [ a:Start, a:"get_tartarus_details(I,P), writeln(I-P).",
                     a > [Details] ]).
test(wrong_arguments_abort) :-
    with_nodes([[]], [A],
               ( type(A, "start_tartarus(localhost, x, y) ; writeln(no)."),
                 printed(A, ["Error# t1:", "Error# t2:", "errors found: 2"]),
                 type(A, "writeln(alive)."),
                 printed(A, ["alive"]),
                 node_output(A, Text),
                 \+ sub_string(Text, _, _, _, "no\n") )).

:- end_tests(third_generation).

:- begin_tests(earlier_generations).

test(first_generation) :-
    tartarus([[ ":- dynamic h/3, sum/2.", "sum(guid, 0).",
                "h(guid, (_,$1), main) :- !, sum(guid, S), S1 is S+1,",
                "   retractall(sum(guid,_)), assertz(sum(guid,S1)),",
                "   agent_move(guid, (localhost,$2)).",
                "h(guid, _, main) :- sum(guid, S), writeln(sum:S)." ], []],
             [ a:"platform_start(localhost, $1), set_token(5).",
               b:"platform_start(localhost, $2), set_token(5).",
               b > ["Port = $2"],
               a:"agent_create(add, (localhost,$1), h), \c
                  add_token(add, [5]), add_payload(add, [(sum,2)]), \c
                  agent_execute(add, (localhost,$1), h).",
               b > [ "Agent bearing add has arrived to this platform. ",
                     "sum:1" ],
               a > ["Time taken to get acknowledgement by agent add:"] ]).
test(without_a_token_no_agent_is_admitted) :-
    tartarus([[":- dynamic h/3.", "h(guid, _, main)."], []],
             [ a:"start_tartarus($1).", b:"start_tartarus(localhost,$2).",
               b > ["Port = $2"],
               a:"create_mobile_agent(m, h), add_token(m, [1]), \c
                  move_agent(m, (localhost,$2)).",
               a > ["Agent m was not allowed to enter"] ]).
test(static_agent_is_reached_at_its_port) :-
    tartarus([[ "h(guid, (Ip,Port), main) :- writeln('Hello':guid:Ip:Port).",
                "h(guid, From, What) :- writeln(heard(guid, From, What))." ],
              []],
             [ a:"start_tartarus(localhost,$1).",
               b:"start_tartarus(localhost,$2).",
               a:"create_static_agent(s, (localhost,$3), h), \c
                  execute_agent(s, (localhost,$3), h), \c
                  move_agent(s, (localhost,$2)).",
               a > ["Hello:s:localhost:$3"], a > ["Move agent Failed for :s"],
               b:"post_agent(platform, (localhost,$3), \c
                  [h,s,(localhost,$2),ping]).",
               a > ["heard(s,(localhost,$2),ping)"],
               b:"post_agent(platform, (localhost,$1), \c
                  [h,s,(localhost,$2),ping]) ; writeln(refused).",
               b > ["Ack:fail", "refused"] ]).

:- end_tests(earlier_generations).

:- begin_tests(messages).

test(message_to_any_agent_of_a_platform) :-
    tartarus([[], [ "hear(Sender, (_,_), W) :- writeln(got(Sender, W)).",
                    "bad(_, _) :- fail." ]],
             [ up(a, 1), up(b, 1),
               a:"post_agent(platform, (localhost,$2), \c
                  [hear,X,(localhost,$1),\"Hello\"]), writeln(x(X)).",
               b > ["got(platform,Hello)"], a > ["x(platform)"],
               a:"post_agent(platform, (localhost,$2), [bad,platform,1]), \c
                  writeln(accepted).",
               a > ["accepted"], b > ["Message bad(platform,1) failed"] ]).
test(message_to_unknown_agent) :-
    tartarus([[]],
             [ up(a, 1),
               a:"post_agent(platform, (localhost,$2), [f,a]) \c
                  ; writeln(failed).", a > ["failed"] ]).
test(logs) :-
    tartarus([[], []],
             [ up(a, 1), up(b, 1),
               a:"set_log_server(localhost,$2), send_log(me, done(1)).",
               b > ["me localhost $1 done(1)"],
               b:"read_file_to_string('server_log.txt', S, []), print(S), nl.",
               b > ["\"\\n", "me localhost $1 done(1)"] ]).

:- end_tests(messages).

:- begin_tests(native_agents).

%   A native agent moves to a platform, uses its predicates, receives a message
%   of Tartarus there, and returns.

test(native_agents_visit_a_platform, What == heard(ping(7), 42)) :-
    with_nodes([["answer(42)."]], [B],
               ( started(B, P), with_hosts([alpha], visit(P, B, What)) )).

started(Node, Address) :-
    ports(1, [Port]),
    step(up(a, 5), [Node], [Port, 0, 0]),
    format(atom(Address), "tartarus@127.0.0.1:~d", [Port]).

visit(Address, B, What) :-
    create([ (main :- home(Home), move(Address), answer(X),
                      writeln(native(X)), receive(_-Message), move(Home),
                      leave(heard(Message, X))) ],
           Agent, [tokens([5])]),
    printed(B, ["native(42)"]),
    atomic_list_concat([_, Port], :, Address),
    format(string(Post), "post_agent(platform, (localhost,~w), [ping,'~w',7]).",
           [Port, Agent]),
    type(B, Post),
    joined(Agent, done),
    remote(alpha, take(What0)),
    What = What0.

test(native_agents_show_their_tokens, Why == token) :-
    with_nodes([[]], [B],
               ( started(B, Address),
                 with_hosts([alpha],
                            ( create([(main :- catch(move(Address),
                                                     error(move_refused(_, W), _),
                                                     leave(W)))], Agent),
                              joined(Agent, done),
                              remote(alpha, take(Why)) )) )).

:- end_tests(native_agents).

:- begin_tests(platforms).

test(reset_takes_effect_at_once) :-
    Go = "create_mobile_agent(a, (localhost,$1), h, [1]), \c
          move_agent(a, (localhost,$2)).",
    tartarus([[":- dynamic h/3.", "h(guid, _, main) :- writeln(here)."], []],
             [ up(a, 1), up(b, 1), a:Go, b > ["here"],
               b:"reset_tartarus, list_agent(L), writeln(left(L)).",
               b > ["restarted sucessfully", "left([])"],
               a:Go, b > ["left([])", "here"],
               b:"close_tartarus.", b > ["Platform has been closed."],
               up(b, 1), b > ["closed.", "Port = $2"],
               a:Go, b > ["closed.", "here"] ]).
test(agent_made_on_another_platform) :-
    tartarus([[], [":- dynamic h/3.", "h(guid, _, main) :- writeln(ran)."]],
             [ up(a, 1), up(b, 1),
               a:"create_mobile_agent(far, (localhost,$2), h, [1]).",
               a > [ "Creating agent on platform with IP localhost and port \c
                      number $2", "true" ],
               b:"execute_agent(far, (localhost,$2), h).", b > ["ran"] ]).
test(saved_agents_are_loaded) :-
    tartarus([[ ":- dynamic h/3, n/2.", "n(guid, 1).",
                "h(guid, _, main) :- n(guid, N), writeln(guid:N)." ], []],
             [ up(a, 1), up(b, 1),
               a:"create_mobile_agent(a, _, h, [1]), \c
                  add_payload(a, [(n,2)]), save_agent(a, 'a.pl'), \c
                  save_tartarus_state('all.txt'), writeln(saved).",
               a > ["saved"],
               b:"load_tartarus_state('all.txt').", b > ["a:1"],
               b:"purge_agent(a), consult('a.pl'), n(a, X), writeln(n:X).",
               b > ["n:1"] ]).
test(local_definitions_take_precedence) :-
    tartarus([[ "agent_list(mine).", "nothing :- writeln(my_nothing).",
                "move(X) :- writeln(moving(X)).",
                ":- dynamic platform_port/1, tts/1." ]],
             [ up(a, 1),
               a:"agent_list(X), writeln(X), nothing, move(there).",
               a > ["mine", "my_nothing", "moving(there)"],
               a:"\\+ tts(a), platform_port(Q), writeln(port:Q).",
               a > ["port:$1"] ]).

:- end_tests(platforms).

:- begin_tests(other_predicates).

%   answers(+Lines, +Goals, +Texts): a platform with this program, at which
%   Goals are typed, prints Texts.

answers(Lines, Goals, Texts) :-
    findall(a:Goal, member(Goal, Goals), Typed),
    append([[up(a, 1)], Typed, [a > Texts]], Steps),
    tartarus([Lines], Steps).

test(atoms_are_replaced_in_terms_only) :-
    answers([ ":- dynamic h/3.",
              "h(guid, _, main) :- \\+ fail, writeln([guid, guidance, \"guid\", \c
               'It is', f(guid)])." ],
            [ "create_mobile_agent(bob, _, h, [1]).",
              "get_tartarus_details(I, P), execute_agent(bob, (I,P), h)." ],
            ["[bob,guidance,guid,It is,f(bob)]"]).
test(tokens_and_payloads) :-
    answers([ ":- dynamic h/3, p/2, q/2.", "h(guid, _, main).", "p(guid, 1).",
              "q(guid, X) :- X = guid." ],
            [ "create_mobile_agent(b, _, h, [1]), add_token(b, [2,1,3]), \c
               remove_token(b, [2]), agent_token(b, T), writeln(t:T).",
              "add_payload(b, [(p,2),(q,2)]), q(b, X), writeln(x:X).",
              "remove_payload(b, [(p,2)]), agent_payload(b, L), writeln(l:L), \c
               \\+ p(b, _), p(guid, Y), writeln(y:Y).",
              "purge_agent(b), \\+ q(b, _), \\+ isexist_agent(b, _, _), \c
               writeln(gone)." ],
            ["t:[1,3]", "x:b", "l:[(q,2)]", "y:1", "gone"]).
test(unbound_port_is_that_of_the_platform) :-
    answers([":- dynamic h/3.", "h(guid, _, main)."],
            [ "create_mobile_agent(y, (localhost,P), h, [5]), \c
               platform_port(P), writeln(bound).",
              "create_mobile_agent(z, ('127.0.0.1',Q), h, [5]), \c
               platform_port(Q), writeln('bound, too').",
              "agent_create(x, (I,_), h), writeln(ip:I).",
              "create_mobile_agent(w, (elsewhere,_), h, [5])." ],
            ["bound", "bound, too", "ip:localhost", "Error# ma7"]).
test(payload_named_like_a_library_predicate) :-
    tartarus([[ ":- dynamic checklist/2.", "checklist(guid, 7).",
                "partition(guid, 1, 2, 3).", ":- dynamic h/3.",
                "h(guid, _, main) :- checklist(guid, X), writeln(got:X)." ],
               []],
             [ up(a, 1), up(b, 1),
               b:"partition(atom, [1], In, Out), writeln(loaded(In, Out)).",
               b > ["loaded([],[1])"],
               a:"create_mobile_agent(c, (localhost,$1), h, [1]), \c
                  add_payload(c, [(checklist,2),(partition,4)]), \c
                  move_agent(c, (localhost,$2)).", b > ["got:7"],
               b:"partition(c, 1, 2, X), writeln(x:X).", b > ["x:3"] ]).
test(oldest_agent_comes_first) :-
    answers([":- dynamic h/3.", "h(guid, _, main)."],
            [ "create_mobile_agent(a1, _, h, [1]), \c
               create_mobile_agent(a2, _, h, [1]), \c
               create_mobile_agent(a3, _, h, [1]).",
              "isexist_agent(N, _, h), writeln(first:N).",
              "list_agent.",
              "agent_list_new(L), writeln(names:L).",
              "list_agent(L), findall(N, member((N,_,_), L), Ns), \c
               writeln(newest:Ns)." ],
            ["first:a1", "Agent Name :a1", "Agent Name :a2", "Agent Name :a3",
             "names:[a1,a2,a3]", "newest:[a3,a2,a1]"]).
test(names) :-
    answers([], [ "get_new_name(foo, N), writeln(N), get_new_name_alpha(A), \c
                   atom_length(A, L), writeln(len:L)." ],
            ["foo1_localhost_", "len:6"]).
test(execute_waits_for_the_last_agent) :-
    answers([ ":- dynamic h/3.",
              "h(guid, _, S) :- writeln(begin(S)), thread_get_message(go(S)), \c
               writeln(end(S))." ],
            [ "create_mobile_agent(b, L, h, [1]), execute_agent(b, L, h, one), \c
               tartarus_lives:last(b, T), execute_agent(b, L, h, two), \c
               writeln(both), thread_send_message(T, go(one)).",
              "tartarus_lives:last(b, T), thread_send_message(T, go(two))." ],
            ["end(one)", "begin(two)", "end(two)"]).
test(hop_times) :-
    tartarus([[":- dynamic h/3.", "h(guid, _, main) :- writeln(in)."], []],
             [ up(a, 1), up(b, 1),
               a:"in_hop_time_stat(X,Y,Z), writeln(X/Y/Z).",
               a:"create_mobile_agent(a, _, h, [1]), \c
                  move_agent(a, (localhost,$2)).", b > ["in"],
               a:"out_hop_times_details([(N,F,T,(D,M),S)]), \c
                  float(S), atom(D), writeln(N:F:T).",
               a > ["0/0/0", "a:(localhost,$1):(localhost,$2)"],
               b:"in_hop_time_stat(Max,Max,Max), in_hop_time(W,Max), \c
                  writeln(w:W).", b > ["w:a"] ]).
test(asserted_files_are_removed_by_reset) :-
    answers([":- dynamic h/3."],
            [ "open('f.pl', write, S), writeln(S, 'colour(red).'), close(S), \c
               assert_file_to_tartarus('f.pl'), call(colour, C), writeln(C).",
              "reset_tartarus, \\+ call(colour, _), writeln(faded)." ],
            ["red", "sucessfully", "faded"]).
test(python) :-
    answers([], [ "open('twice.py', write, S), \c
                   writeln(S, 'def twice(x):'), \c
                   writeln(S, '    print(\"so\"); return int(x)*2'), \c
                   writeln(S, 'def five(): return 5'), close(S).",
                  "python_call(twice, twice, 21, R), atom(R), writeln(r:R).",
                  "python_call(twice, five, R), writeln(r:R).",
                  "catch(python_call(twice, none, R), error(E, _), \c
                         (functor(E, N, _), writeln(N)))." ],
            ["r:42", "r:5", "process_error"]).
test(missing_features_are_reported) :-
    answers([], ["mpu6050(accel, X).", "create_dlg(a, b, c)."],
            ["cannot reach I2C from here", "cannot reach windows from here"]).
test(subtitles) :-
    answers([], ["tts_off, subt_on, tts(hello(1)).", "subt_off, tts(bye), \c
                  writeln(silence)."],
            ["hello(1)", "silence"]).

:- end_tests(other_predicates).
