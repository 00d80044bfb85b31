:- module(test_tartarus, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/tartarus_nodes').
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Programs written for Tartarus, as their users ran them

Each platform is a process; tests compare typed input and output.

*Threading*: one test at a time.
*/

line(Format, Arguments, Line) :-
    format(string(Line), Format, Arguments).

%   A query that starts a platform, and its banner.

up(Node, Port, Token) :-
    line("start_tartarus(localhost, ~w, ~w).", [Port, Token], Start),
    type(Node, Start),
    line("Port = ~w", [Port], Banner),
    printed(Node, [Banner]).

:- begin_tests(third_generation).

test(visitor_is_listed_on_its_platform) :-
    ports(2, [P1,P2]),
    line("   start_tartarus(localhost, ~w, 7),", [P1], Start),
    line("   create_mobile_agent(bee, (localhost,~w), fly, [7]),", [P1], Create),
    line("   move_agent(bee, (localhost,~w)).", [P2], Move),
    with_nodes([[ ":- dynamic fly/3.",
                  "go :- consult('platform.pl'),", Start, Create,
                  "   writeln('off it goes'),", Move,
                  "fly(guid, (Ip,Port), main) :-",
                  "   writeln(guid:' has come to ':Ip:Port)." ],
                []],
               [A,B],
               ( up(B, P2, 7),
                 type(A, "go."),
                 line("bee: has come to :localhost:~w", [P2], Come),
                 printed(B, ["  \n", Come]),
                 printed(A, ["off it goes"]),
                 type(B, "list_agent."),
                 line("Agent Name :bee, handler name:fly, residing on port:~w",
                      [P2], Row),
                 printed(B, ["====Agent list====", Row]),
                 type(A, "list_agent(L), writeln(agents(L))."),
                 printed(A, ["agents([])"]) )).
test(agent_back_before_its_move_has_returned_is_not_lost) :-
    ports(2, [P1,P2]),
    Walker = [ ":- dynamic walker/3, left/2, next/1.",
               "walker(guid, (Ip,_), main) :-",
               "    retract(left(guid, N)),",
               "    (   N =:= 0",
               "    ->  writeln(home)",
               "    ;   N1 is N-1, assertz(left(guid, N1)),",
               "        next(P), move_agent(guid, (Ip,P))",
               "    )." ],
    line("next(~w).", [P2], Next1),
    line("next(~w).", [P1], Next2),
    line("create_mobile_agent(w, (localhost,~w), walker, [7]), assertz(left(w, 400)), add_payload(w, [(left,2)]), execute_agent(w, (localhost,~w), walker).",
         [P1,P1], Send),
    with_nodes([[Next1|Walker], [Next2|Walker]],
               [A,B],
               ( up(A, P1, 7), up(B, P2, 7),
                 type(A, Send),
                 printed(A, ["home"], 120) )).
test(payload_travels_and_its_template_stays) :-
    ports(2, [P1,P2]),
    with_nodes([[ ":- dynamic carry/3, load/2.",
                  "load(guid, 150).",
                  "carry(guid, _, main) :- load(guid, N),",
                  "    writeln('it weighs ':N)." ],
                []],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 line("create_mobile_agent(ant, (localhost,~w), carry, [1]), \c
                       add_payload(ant, [(load,2)]), \c
                       move_agent(ant, (localhost,~w)).", [P1,P2], Go),
                 type(A, Go),
                 printed(B, ["it weighs :150"]),
                 type(B, "findall(X-N, load(X,N), L), writeln(loads(L))."),
                 printed(B, ["loads([ant-150])"]),
                 type(A, "findall(X-N, load(X,N), L), writeln(loads(L))."),
                 printed(A, ["loads([guid-150])"]) )).
test(agent_returns_and_its_clone_prints) :-
    ports(2, [P1,P2]),
    line("next(~w, ~w).", [P1,P2], N1),
    line("next(~w, ~w).", [P2,P1], N2),
    Program = [ ":- dynamic thanos_task/3, energy/2.",
                N1, N2,
                "energy(guid, 2).",
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
    with_nodes([Program,Program], [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 line("create_mobile_agent(thanos, (localhost,~w), \c
                       thanos_task, [1]), \c
                       add_payload(thanos, [(energy,2)]), \c
                       execute_agent(thanos, (localhost,~w), thanos_task).",
                      [P1,P1], Go),
                 type(A, Go),
                 line("thanos:at(~w):energy(2)", [P1], L1),
                 line("thanos:at(~w):energy(1)", [P2], L2),
                 line("thanos:at(~w):energy(0)", [P1], L3),
                 line("thanos1:at(~w):energy(-1)", [P2], L4),
                 printed(A, [L1,L3,"clone:thanos1"]),
                 printed(B, [L2,L4]),
                 type(B, "isexist_agent(N, L, H), writeln(N/L/H)."),
                 line("thanos1/(localhost,~w)/thanos_task", [P2], L5),
                 printed(B, [L5]) )).
test(agent_without_token_is_refused_and_stays) :-
    ports(2, [P1,P2]),
    with_nodes([[ ":- dynamic h/3.", "h(guid, _, main) :- writeln(here(guid))."],
                []],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 2),
                 line("create_mobile_agent(fly, (localhost,~w), h, [1]), \c
                       move_agent(fly, (localhost,~w)), writeln(told).",
                      [P1,P2], Go),
                 type(A, Go),
                 printed(A, ["--------negative ACK received-----------",
                             "Agent fly was not allowed to enter the destination.",
                             "--------negative ack processed-----------",
                             "told"]),
                 type(B, "set_token(1), writeln(trusted)."),
                 printed(B, ["trusted"]),
                 line("move_agent(fly, (localhost,~w)).", [P2], Again),
                 type(A, Again),
                 printed(B, ["here(fly)"]) )).
test(move_to_a_dead_or_the_same_platform) :-
    ports(2, [P1,P2]),
    with_nodes([[":- dynamic h/3.", "h(guid, _, main)."]], [A],
               ( up(A, P1, 1),
                 line("create_mobile_agent(fly, (localhost,~w), h, [1]), \c
                       move_agent(fly, (localhost,~w)), \c
                       isexist_agent(fly, _, H), writeln(still(H)).",
                      [P1,P2], Go),
                 type(A, Go),
                 printed(A, ["Enter a valid IP address and Port number.",
                             "still(h)"]),
                 line("move_agent(fly, ('127.0.0.1',~w)).", [P1], Same),
                 type(A, Same),
                 printed(A, ["Agent is already on same platform."]),
                 type(A, "move_agent(missing, (localhost,1)), writeln(true1)."),
                 printed(A, ["Move agent Failed for :missing", "true1"]) )).
test(goals_after_a_move_run_at_the_source) :-
    ports(2, [P1,P2]),
    line("h(guid, (_,~w), main) :- !,", [P1], L1),
    line("   move_agent(guid, (localhost,~w)), left(guid, X),", [P2], L2),
    with_nodes([[ ":- dynamic h/3, left/2.", "left(guid, old).",
                  L1, L2, "   writeln(here_still(X)).",
                  "h(guid, _, main) :- writeln(there(guid))." ], []],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 line("create_mobile_agent(a, (localhost,~w), h, [1]), \c
                       add_payload(a, [(left,2)]), \c
                       execute_agent(a, (localhost,~w), h).", [P1,P1], Go),
                 type(A, Go),
                 printed(B, ["there(a)"]),
                 printed(A, ["here_still(old)"]),
                 type(A, "between(1, 2000, _), findall(X, left(X,_), L), \c
                          ( L == [guid] -> true ; sleep(0.01), fail ), !, \c
                          writeln(left(L))."),
                 printed(A, ["left([guid])"]) )).
test(large_port) :-
    ports(1, [P]),
    Large is P+65536,
    with_nodes([[]], [A],
               ( up(A, Large, 1),
                 type(A, "get_tartarus_details(I,P), writeln(I-P)."),
                 line("localhost-~w", [Large], Details),
                 printed(A, [Details]) )).
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
    ports(2, [P1,P2]),
    line("h(guid, (_,~w), main) :- !, sum(guid, S), S1 is S+1,", [P1], L1),
    line("   agent_move(guid, (localhost,~w)).", [P2], L2),
    with_nodes([[ ":- dynamic h/3, sum/2.", "sum(guid, 0).",
                  L1, "   retractall(sum(guid,_)), assertz(sum(guid,S1)),", L2,
                  "h(guid, _, main) :- sum(guid, S), writeln(sum:S)." ],
                []],
               [A,B],
               ( line("platform_start(localhost, ~w), set_token(5).", [P1], S1),
                 line("platform_start(localhost, ~w), set_token(5).", [P2], S2),
                 type(A, S1), type(B, S2),
                 line("Port = ~w", [P2], Banner), printed(B, [Banner]),
                 line("agent_create(add, (localhost,~w), h), \c
                       add_token(add, [5]), add_payload(add, [(sum,2)]), \c
                       agent_execute(add, (localhost,~w), h).", [P1,P1], Go),
                 type(A, Go),
                 printed(B, ["Agent bearing add has arrived to this platform. ",
                             "sum:1"]),
                 printed(A, ["Time taken to get acknowledgement by agent add:"])
               )).
test(without_a_token_no_agent_is_admitted) :-
    ports(2, [P1,P2]),
    with_nodes([[":- dynamic h/3.", "h(guid, _, main)."], []], [A,B],
               ( line("start_tartarus(~w).", [P1], S1),
                 line("start_tartarus(localhost,~w).", [P2], S2),
                 type(A, S1), type(B, S2),
                 line("Port = ~w", [P2], Banner), printed(B, [Banner]),
                 line("create_mobile_agent(m, h), add_token(m, [1]), \c
                       move_agent(m, (localhost,~w)).", [P2], Go),
                 type(A, Go),
                 printed(A, ["Agent m was not allowed to enter"]) )).
test(static_agent_is_reached_at_its_port) :-
    ports(3, [P1,P2,P3]),
    with_nodes([[ "h(guid, (Ip,Port), main) :- writeln('Hello':guid:Ip:Port).",
                  "h(guid, From, What) :- writeln(heard(guid, From, What))." ],
                []],
               [A,B],
               ( line("start_tartarus(localhost,~w).", [P1], S1),
                 line("start_tartarus(localhost,~w).", [P2], S2),
                 type(A, S1), type(B, S2),
                 line("create_static_agent(s, (localhost,~w), h), \c
                       execute_agent(s, (localhost,~w), h), \c
                       move_agent(s, (localhost,~w)).", [P3,P3,P2], Go),
                 type(A, Go),
                 line("Hello:s:localhost:~w", [P3], Hello),
                 printed(A, [Hello]),
                 printed(A, ["Move agent Failed for :s"]),
                 line("post_agent(platform, (localhost,~w), \c
                       [h,s,(localhost,~w),ping]).", [P3,P2], Post),
                 type(B, Post),
                 line("heard(s,(localhost,~w),ping)", [P2], Heard),
                 printed(A, [Heard]),
                 line("post_agent(platform, (localhost,~w), \c
                       [h,s,(localhost,~w),ping]) ; writeln(refused).",
                      [P1,P2], Wrong),
                 type(B, Wrong),
                 printed(B, ["Ack:fail", "refused"]) )).

:- end_tests(earlier_generations).

:- begin_tests(messages).

test(message_to_any_agent_of_a_platform) :-
    ports(2, [P1,P2]),
    with_nodes([[], [ "hear(Sender, (_,_), W) :- writeln(got(Sender, W)).",
                      "bad(_, _) :- fail." ]],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 line("post_agent(platform, (localhost,~w), \c
                       [hear,X,(localhost,~w),\"Hello\"]), writeln(x(X)).",
                      [P2,P1], Post),
                 type(A, Post),
                 printed(B, ["got(platform,Hello)"]),
                 printed(A, ["x(platform)"]),
                 line("post_agent(platform, (localhost,~w), [bad,platform,1]), \c
                       writeln(accepted).", [P2], Bad),
                 type(A, Bad),
                 printed(A, ["accepted"]),
                 printed(B, ["Message bad(platform,1) failed"]) )).
test(message_to_unknown_agent) :-
    ports(2, [P1,P2]),
    with_nodes([[]], [A],
               ( up(A, P1, 1),
                 line("post_agent(platform, (localhost,~w), [f,a]) \c
                       ; writeln(failed).", [P2], Post),
                 type(A, Post),
                 printed(A, ["failed"]) )).
test(logs) :-
    ports(2, [P1,P2]),
    with_nodes([[], []], [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 line("set_log_server(localhost,~w), send_log(me, done(1)).",
                      [P2], Log),
                 type(A, Log),
                 line("me localhost ~w done(1)", [P1], Entry),
                 printed(B, [Entry]),
                 type(B, "read_file_to_string('server_log.txt', S, []), \c
                          print(S), nl."),
                 printed(B, ["\"\\n", Entry]) )).

:- end_tests(messages).

:- begin_tests(native_agents).

%   A native agent moves to a platform, uses its predicates, receives a message
%   of Tartarus there, and returns.

test(native_agents_visit_a_platform, What == heard(ping(7), 42)) :-
    ports(1, [P]),
    with_nodes([["answer(42)."]], [B],
               ( up(B, P, 5),
                 with_hosts([alpha], visit(P, B, What)) )).

visit(P, B, What) :-
    line("tartarus@127.0.0.1:~w", [P], Address0),
    atom_string(Address, Address0),
    create([ (main :- home(Home), move(Address), answer(X),
                      writeln(native(X)), receive(_-Message), move(Home),
                      leave(heard(Message, X))) ],
           Agent, [tokens([5])]),
    printed(B, ["native(42)"]),
    line("post_agent(platform, (localhost,~w), [ping,'~w',7]).", [P, Agent],
         Post),
    type(B, Post),
    joined(Agent, done),
    remote(alpha, take(What0)),
    What = What0.

test(native_agents_show_their_tokens, Why == token) :-
    ports(1, [P]),
    with_nodes([[]], [B],
               ( up(B, P, 5),
                 line("tartarus@127.0.0.1:~w", [P], Address0),
                 atom_string(Address, Address0),
                 with_hosts([alpha],
                            ( create([(main :- catch(move(Address),
                                                     error(move_refused(_, W), _),
                                                     leave(W)))], Agent),
                              joined(Agent, done),
                              remote(alpha, take(Why)) )) )).

:- end_tests(native_agents).

:- begin_tests(platforms).

test(reset_takes_effect_at_once) :-
    ports(2, [P1,P2]),
    with_nodes([[":- dynamic h/3.", "h(guid, _, main) :- writeln(here)."], []],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 line("create_mobile_agent(a, (localhost,~w), h, [1]), \c
                       move_agent(a, (localhost,~w)).", [P1,P2], Go),
                 type(A, Go), printed(B, ["here"]),
                 type(B, "reset_tartarus, list_agent(L), writeln(left(L))."),
                 printed(B, ["restarted sucessfully", "left([])"]),
                 type(A, Go), printed(B, ["left([])", "here"]),
                 type(B, "close_tartarus."),
                 printed(B, ["Platform has been closed."]),
                 up(B, P2, 1),
                 line("Port = ~w", [P2], Again),
                 printed(B, ["closed.", Again]),
                 type(A, Go), printed(B, ["closed.", "here"]) )).
test(agent_made_on_another_platform) :-
    ports(2, [P1,P2]),
    with_nodes([[], [":- dynamic h/3.", "h(guid, _, main) :- writeln(ran)."]],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 line("create_mobile_agent(far, (localhost,~w), h, [1]).",
                      [P2], Go),
                 type(A, Go),
                 line("Creating agent on platform with IP localhost and port \c
                       number ~w", [P2], Said),
                 printed(A, [Said, "true"]),
                 line("execute_agent(far, (localhost,~w), h).", [P2], Run),
                 type(B, Run),
                 printed(B, ["ran"]) )).
test(saved_agents_are_loaded) :-
    ports(2, [P1,P2]),
    with_nodes([[ ":- dynamic h/3, n/2.", "n(guid, 1).",
                  "h(guid, _, main) :- n(guid, N), writeln(guid:N)." ], []],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 type(A, "create_mobile_agent(a, _, h, [1]), \c
                          add_payload(a, [(n,2)]), save_agent(a, 'a.pl'), \c
                          save_tartarus_state('all.txt'), writeln(saved)."),
                 printed(A, ["saved"]),
                 type(B, "load_tartarus_state('all.txt')."),
                 printed(B, ["a:1"]),
                 type(B, "purge_agent(a), consult('a.pl'), n(a, X), \c
                          writeln(n:X)."),
                 printed(B, ["n:1"]) )).
test(local_definitions_take_precedence) :-
    ports(1, [P]),
    with_nodes([[ "agent_list(mine).", "nothing :- writeln(my_nothing).",
                  "move(X) :- writeln(moving(X)).",
                  ":- dynamic platform_port/1, tts/1." ]],
               [A],
               ( up(A, P, 1),
                 type(A, "agent_list(X), writeln(X), nothing, move(there)."),
                 printed(A, ["mine", "my_nothing", "moving(there)"]),
                 type(A, "\\+ tts(a), platform_port(Q), writeln(port:Q)."),
                 line("port:~w", [P], Port),
                 printed(A, [Port]) )).

:- end_tests(platforms).

:- begin_tests(other_predicates).

%   answers(+Lines, +Goals, +Texts): a platform with this program, at which
%   Goals are typed, prints Texts.

answers(Lines, Goals, Texts) :-
    ports(1, [P]),
    with_nodes([Lines], [A],
               ( up(A, P, 1),
                 forall(member(Goal, Goals), type(A, Goal)),
                 printed(A, Texts) )).

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
    ports(2, [P1,P2]),
    Program = [":- dynamic h/3.",
               "h(guid, _, main) :- checklist(guid, X), writeln(got:X)."],
    line("create_mobile_agent(c, (localhost,~w), h, [1]), \c
          add_payload(c, [(checklist,2),(partition,4)]), \c
          move_agent(c, (localhost,~w)).", [P1,P2], Go),
    with_nodes([[":- dynamic checklist/2.", "checklist(guid, 7).",
                 "partition(guid, 1, 2, 3)."|Program], []],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 type(B, "partition(atom, [1], In, Out), \c
                          writeln(loaded(In, Out))."),
                 printed(B, ["loaded([],[1])"]),
                 type(A, Go),
                 printed(B, ["got:7"]),
                 type(B, "partition(c, 1, 2, X), writeln(x:X)."),
                 printed(B, ["x:3"]) )).
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
    ports(2, [P1,P2]),
    with_nodes([[":- dynamic h/3.", "h(guid, _, main) :- writeln(in)."], []],
               [A,B],
               ( up(A, P1, 1), up(B, P2, 1),
                 type(A, "in_hop_time_stat(X,Y,Z), writeln(X/Y/Z)."),
                 line("create_mobile_agent(a, _, h, [1]), \c
                       move_agent(a, (localhost,~w)).", [P2], Go),
                 type(A, Go), printed(B, ["in"]),
                 type(A, "out_hop_times_details([(N,F,T,(D,M),S)]), \c
                          float(S), atom(D), writeln(N:F:T)."),
                 line("a:(localhost,~w):(localhost,~w)", [P1,P2], Out),
                 printed(A, ["0/0/0", Out]),
                 type(B, "in_hop_time_stat(Max,Max,Max), in_hop_time(W,Max), \c
                          writeln(w:W)."),
                 printed(B, ["w:a"]) )).
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
    answers([], ["digitalWrite(1, 1)."],
            ["pins are not reached from here"]).
test(subtitles) :-
    answers([], ["tts_off, subt_on, tts(hello(1)).", "subt_off, tts(bye), \c
                  writeln(silence)."],
            ["hello(1)", "silence"]).

:- end_tests(other_predicates).
