:- module(test_page_server, []).

% The messages and orders of a page, and their authorization.

:- use_module('../../../../app/packaging/parts', [installed/1]).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/pages').
:- use_module('../../../lib/peers', [peer_agent/4, with_peers/2]).
:- use_module('../../../lib/texts', [write_file/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(http/websocket), [ws_receive/3]).
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module(library(plunit)).
:- use_module(library(process),
              [process_create/3, process_kill/2, process_wait/2]).
:- use_module(library(socket)).
:- use_module(library(typhon)).
:- use_module('../../../../prolog/typhon/tools/page/reception', [json_reply/4]).
:- use_module('../../../../prolog/typhon/kernel/base/monotonic',
              [monotonic_time/1]).

% page(+Options, -Base, :Goal): two hosts, linked, and a page.

:- meta_predicate
    page(+, -, 0),
    page(-, 0).

page(Base, Goal) :-
    page([], Base, Goal).

page(Options, Base, Goal) :-
    with_hosts([alpha, beta],
               ( link(alpha, beta), with_page(Options, Base, Goal) )).

site(Base, Site) :-
    atomic_list_concat([Scheme, '', Authority|_], /, Base),
    atomic_list_concat([Scheme, '', Authority, ''], /, Site).

answer(Base, Message, Answer) :-
    ask(Base, Message, Told),
    (   get_dict(error, Told, Error)
    ->  throw(error(page_said(Error), _))
    ;   Answer = Told.answer
    ).

fails(Base, Message, Words) :-
    ask(Base, Message, Told),
    forall(member(Word, Words),
           assertion(sub_string(Told.error, _, _, _, Word))).

done(Base, Message, Done) :-
    answer(Base, Message, Answer),
    Done = Answer.done.

%   raised(+Ball, -Got): Got is what comes of Ball that an answer raises.

raised(Ball, Got) :-
    catch(setup_call_cleanup(
              process_create(path(printf), ['{}'], % a stream with timeouts
                             [stdout(pipe(In, [type(binary)]))]),
              with_output_to(string(Text),
                             json_reply(In, [ method(post), content_length(2),
                                              content_type('application/json') ],
                                        100, test_page_server:raises(Ball))),
              close(In)),
          Raised, true),
    ( var(Raised) -> Got = text(Text) ; Got = raised(Raised) ).

raises(Ball, _, _) :-
    throw(Ball).

:- begin_tests(page_guard).

test(end_of_a_thread_is_no_answer, Got == raised(unwind(thread_exit(x)))) :-
    raised(unwind(thread_exit(x)), Got).
test(error_of_an_answer_is_its_text) :-
    raised(error(existence_error(thing, x), _), text(Text)),
    assertion(sub_string(Text, _, _, 0, "does not exist\"}")),
    raised(ball, text(_)).

%   path(-Path, -Status, -Without): what is answered with the token, and
%   without. A zero byte does not hide the rest of a name.

path('', 200, 403).
path('style.css', 200, 403).
path(Path, Status, 403) :-
    member(Path-Status,
           [ 'nothing.js'-404, '.hidden'-404, '..%2fserver.pl'-404,
             '%2e%2e/server.pl'-404, 'index.html%00.js'-404, '%00.css'-404,
             'style.css%00'-404, '00000000000000000000000000000000/'-404 ]).
path(Path, any, 403) :-
    member(Path, [feed, metrics, ask]).

test(requests_need_the_token, Deviations == []) :-
    page(Base, ( site(Base, Site),
                 findall(Path-[With,Without],
                         ( path(Path, With0, Without0),
                           answered(Base, Path, With),
                           answered(Site, Path, Without),
                           \+ ( memberchk(With0, [any, With]),
                                Without == Without0 ) ),
                         Deviations) )).

answered(Start, Path, Status) :-
    atom_concat(Start, Path, Address),
    got(Address, [], Status).

test(files_are_only_read,
     Statuses == [get-200, head-200, post-404, put-404, delete-404]) :-
    page(Base, findall(Method-Status,
                       ( member(Method, [get, head, post, put, delete]),
                         asked_for(Method, Base, Status) ),
                       Statuses)).

asked_for(Method, Base, Status) :-
    http_open:http_open(Base, In, [method(Method), status_code(Status)]),
    close(In).

%   A listener counts the connections that queries of a viewer cause.

test(queries_lead_to_no_other_address,
     [forall(member(ReadOnly, [true,false])), true(Count-Shown == 0-2)]) :-
    page([read_only(ReadOnly)], Base,
         with_listener(Port, Count,
             ( forall(elsewhere(Port, Message), fails(Base, Message, [])),
               findall(x, ( member(Host, [alpha,beta]),
                            host_property(Host, address(Address)),
                            atom_string(Address, Text),
                            answer(Base, _{ask:"host", host:Text}, _) ),
                       Found),
               length(Found, Shown) ))).

elsewhere(Port, Message) :-
    member(Kind-Key, ["host"-host, "agent"-agent]),
    member(Name, [x, 'x.0@y', 'x.abc.0@y', 'a@b@c', '']),
    member(Interface, ['127.0.0.1', localhost, '127.0.0.2']),
    format(string(Text), '~w@~w:~w', [Name, Interface, Port]),
    dict_pairs(Message, _, [ask-Kind,Key-Text]).

:- meta_predicate with_listener(-, -, 0).

with_listener(Port, Count, Goal) :-
    setup_call_cleanup(
        ( tcp_socket(Socket), tcp_bind(Socket, Port), tcp_listen(Socket, 50),
          message_queue_create(Queue),
          thread_create(count_connections(Socket, 0, Queue), Thread) ),
        once(Goal),
        ( thread_send_message(Queue, end),
          tcp_connect(localhost:Port, Stream, []),
          close(Stream),
          thread_join(Thread, exited(Count)),
          tcp_close_socket(Socket),
          message_queue_destroy(Queue) )).

count_connections(Socket, Count0, Queue) :-
    tcp_accept(Socket, Client, _),
    tcp_close_socket(Client),
    (   thread_peek_message(Queue, end)
    ->  thread_exit(Count0)
    ;   Count is Count0+1,
        count_connections(Socket, Count, Queue)
    ).

test(link_with_token, Status == 303) :-
    with_hosts([alpha],
               setup_call_cleanup(
                   typhon_page:page_serve([port(0)], Link),
                   got(Link, [], Status),
                   page_stop)).

test(another_origin, Statuses == [403, 403, 403]) :-
    page(Base, findall(Status, status_from_elsewhere(Base, Status), Statuses)).

status_from_elsewhere(Base, Status) :-
    Elsewhere = [request_header('Origin'='http://evil.example')],
    atom_concat(Base, ask, Ask),
    atom_concat(Base, feed, Feed),
    (   posted(Ask, json(_{ask:"survey"}), Elsewhere, Status)
    ;   got(Base, Elsewhere, Status)
    ;   got(Feed, [ request_header('Upgrade'=websocket),
                    request_header('Connection'='Upgrade'),
                    request_header('Sec-WebSocket-Key'='AAAAAAAAAAAAAAAAAAAAAA=='),
                    request_header('Sec-WebSocket-Version'='13')
                  | Elsewhere ], Status)
    ).

test(too_large, Said == "413") :-
    page(Base,
         setup_call_cleanup(
             connected(Base, Pair),
             ( head_text(body(5 000 000), Base, Text),
               write(Pair, Text), flush_output(Pair),
               read_line_to_string(Pair, Line),
               split_string(Line, " ", "", [_, Said|_]) ),
             close(Pair, [force(true)]))).

test(headers) :-
    page(Base, ( http_open:http_open(Base, In,
                     [header(content_security_policy, Policy)]),
                 close(In) )),
    assertion(sub_atom(Policy, _, _, _, 'default-src \'none\'')),
    assertion(\+ sub_atom(Policy, _, _, _, unsafe)).

%   Every order is refused.

test(read_only) :-
    page([read_only(true)], Base,
         ( forall(member(What, [ "check", "create", "send", "move", "clone",
                                 "resume", "dispose", "save", "load", "link",
                                 "unlink", "host_start", "host_stop",
                                 "network_start", "network_stop", "mechanism",
                                 "go", "pause", "step", "speed",
                                 "any other" ]),
                  fails(Base, _{do:What, text:"", agent:"a"}, ["permission"])),
           answer(Base, _{ask:"survey"}, _{hosts:[_,_], agents:[], time:_}) )).

test(loopback_only, Addresses == ['127.0.0.1']) :-
    page(Base, ( port_of(Base, Port), listening_at(Port, Addresses) )).

port_of(Base, Port) :-
    atomic_list_concat([_, _, Authority|_], /, Base),
    atomic_list_concat([_, Text], :, Authority),
    atom_number(Text, Port).

listening_at(Port, Addresses) :-
    format(atom(Command), 'ss -Hltn sport = :~d', [Port]),
    setup_call_cleanup(
        open(pipe(Command), read, Out),
        read_string(Out, _, Text),
        close(Out)),
    split_string(Text, "\n", "\n", Lines),
    findall(Address,
            ( member(Line, Lines),
              split_string(Line, " ", " ", Words0),
              exclude(==(""), Words0, [_, _, _, Local|_]),
              split_string(Local, ":", "", [First|_]),
              atom_string(Address, First) ),
            Addresses).

test(second_page_is_refused, error(permission_error(start, page, _))) :-
    page(_, page_start([port(0)])).

test(page_that_cannot_be_started,
     [ forall(member(Options-Formal,
                     [ [prot(1)]-domain_error(page_option, prot(1)),
                       [host('x@127.0.0.1:1'), port(0)]-
                       host_unreachable(_) ])),
       error(Formal) ]) :-
    no_leaks(page_start(Options)).
test(port_taken, error(socket_error(_, _))) :-
    no_leaks(setup_call_cleanup(
                 ( socket:tcp_socket(Socket),
                   socket:tcp_bind(Socket, localhost:Port),
                   socket:tcp_listen(Socket, 1) ),
                 page_start([port(Port)]),
                 socket:tcp_close_socket(Socket))).

test(nothing_is_left_after_the_stop) :-
    no_leaks(page(Base, with_feed(Base, Feed, frame(Feed, _)))).

test(stop_without_page) :-
    page_stop.

%   Without a page no library of HTTP is loaded.

test(code_is_loaded_on_demand, Status-Err == exit(0)-"") :-
    project_file('prolog/typhon.pl', File),
    run_swipl([ '-g', '\\+ current_module(thread_httpd)', '-t', halt, File ],
              [], Status, _, Err).

%   More incomplete requests than a page has connections, and some whose next
%   byte always arrives soon: a client with the token is answered.

test(incomplete_requests_do_not_block_the_owner, Statuses == [200, 200, 200]) :-
    no_leaks(page(Base,
        setup_call_cleanup(
            ( findall(Out, ( between(1, 100, _), half_request(Base, Out) ),
                      Outs),
              thread_self(Me),
              thread_create(drip(Base, 16, Me), Drip),
              thread_get_message(dripping) ),
            findall(Status, ( between(1, 3, _), got(Base, [], Status) ),
                    Statuses),
            ( thread_send_message(Drip, stop),
              thread_join(Drip),
              forall(member(Out, Outs), close(Out, [force(true)])) )))).

%   A request must be complete in time; so must a body.

test(slow_requests_are_ended) :-
    with_settings([typhon_page_reception:request_seconds=1],
        page(Base, forall(member(Head, ['GET /', body(100 000)]),
                          ends_while_dripping(Base, Head)))).
test(body_that_ends_early_is_refused) :-
    page(Base, cut_short(Base, Answer)),
    sub_string(Answer, _, _, _, "Http length").

test(long_headers_are_refused) :-
    page(Base,
         setup_call_cleanup(
             half_request(Base, Pair),
             ( catch(( format(Pair, '~`xt~20000|', []), flush_output(Pair) ),
                     error(_, _), true),
               ends(Pair) ),
             close(Pair, [force(true)]))).

ends_while_dripping(Base, Head) :-
    head_text(Head, Base, Text),
    setup_call_cleanup(
        connected(Base, Pair),
        ( write(Pair, Text), flush_output(Pair),
          thread_create(drip_on([Pair]), Drip),
          ends(Pair),
          thread_send_message(Drip, stop),
          thread_join(Drip) ),
        close(Pair, [force(true)])).

%   The answer to a request whose body ends early.

cut_short(Base, Answer) :-
    head_text(body(100), Base, Text),
    connected(Base, Pair),
    stream_pair(Pair, In, Out),
    setup_call_cleanup(
        true,
        ( write(Out, Text), close(Out), read_string(In, _, Answer) ),
        close(In, [force(true)])).

head_text(body(Length), Base, Text) :-
    !,
    atomic_list_concat([_, _, _, Token|_], /, Base),
    format(atom(Text), 'POST /~w/ask HTTP/1.1\r\nContent-Length: ~d\r\n\c
                        Content-Type: application/json\r\n\r\n{',
           [Token, Length]).
head_text(Text, _, Text).

connected(Base, Pair) :-
    port_of(Base, Port),
    socket:tcp_connect('127.0.0.1':Port, Pair, []),
    set_stream(Pair, timeout(60)).

half_request(Base, Pair) :-
    connected(Base, Pair),
    catch(( write(Pair, 'GET / HTTP/1.1\r\nHost:'), flush_output(Pair) ),
          error(_, _), true).

%   The server closes the connection, whatever it sends before.

ends(Pair) :-
    catch(read_string(Pair, _, _), error(socket_error(_, _), _), true).

drip(Base, Count, Owner) :-
    findall(Pair, ( between(1, Count, _), half_request(Base, Pair) ), Pairs),
    thread_send_message(Owner, dripping),
    drip_on(Pairs),
    forall(member(Pair, Pairs), close(Pair, [force(true)])).

drip_on(Pairs) :-
    thread_self(Me),
    (   thread_get_message(Me, stop, [timeout(0.1)])
    ->  true
    ;   forall(member(Pair, Pairs),
               catch(( write(Pair, x), flush_output(Pair) ), error(_, _),
                     true)),
        drip_on(Pairs)
    ).

:- end_tests(page_guard).

:- begin_tests(page_queries).

test(survey) :-
    page(Base, ( create([on_message(_, _)], _, [name(bob), host(alpha)]),
                 answer(Base, _{ask:"survey"}, Scene) )),
    Scene.agents = [Agent],
    assertion(_{program:"test", status:"resident", hops:0, mail:0} :< Agent),
    assertion(( member(Host, Scene.hosts), Host.links = [[_, 1]] )).

test(agent) :-
    page(Base, ( create([ (main :- assertz(s(1)), receive(go), log(gone)),
                          s('<img src=x>') ], A, [host(alpha)]),
                 wait_state(A, waiting),
                 agent_send(A, other),
                 answer(Base, _{ask:"agent", agent:A}, Agent) )),
    assertion(_{ state:"waiting", facts:["s('<img src=x>')", "s(1)"],
                 fact_count:2, hops:0, name:"test" } :< Agent),
    assertion(Agent.mailbox = [[_, "other"]]),
    Agent.program = _{lines:Lines, here:[N]},
    nth1(N, Lines, Line),
    assertion(sub_string(Line, _, _, _, "receive(go)")).

test(ended, Outcome == "done") :-
    page(Base, ( create([main], A, [host(alpha)]),
                 joined(A, done),
                 answer(Base, _{ask:"agent", agent:A}, Agent) )),
    Outcome = Agent.outcome.

test(fault) :-
    page(Base, ( capturing(( create([(main :- atom_length(_, _))], A,
                                    [host(alpha)]),
                             wait_state(A, faulty(_)) ), _),
                 answer(Base, _{ask:"agent", agent:A}, Agent) )),
    Fault = Agent.fault,
    assertion(_{goal:"main", place:"main/0:1"} :< Fault).

test(goals_have_the_names_of_variables, Goals == ["receive(_-go(Host))",
                                                  "move(Host)"]) :-
    Text = ":- agent(p, []).\n\nmain :- receive(_-go(Host)), move(Host).\n",
    page(Base, ( answer(Base, _{do:"create", text:Text, host:"alpha"}, Done),
                 atom_string(A, Done.done),
                 wait_state(A, waiting),
                 answer(Base, _{ask:"agent", agent:A}, Agent) )),
    Goals = Agent.goals.

test(location_of_a_fault_hides_the_folder, Place == "program.pl:3") :-
    Text = ":- agent(p, []).\n\nmain :- sleep(0), fail.\n",
    page(Base, ( capturing(( answer(Base, _{do:"create", text:Text,
                                            host:"alpha"}, Done),
                             atom_string(A, Done.done),
                             wait_state(A, faulty(_)) ), _),
                 answer(Base, _{ask:"agent", agent:A}, Agent) )),
    Place = Agent.fault.place.

test(host) :-
    page(Base, ( remote(alpha, ( leave(parcel(7)), assertz(door(open)) )),
                 answer(Base, _{ask:"host", host:"alpha"}, Host) )),
    assertion(Host.tuples == ["parcel(7)"]),
    assertion(Host.place == ["door(open).\n"]),
    assertion(length(Host.links, 1)).

test(no_such_host_or_agent) :-
    page(Base, ( fails(Base, _{ask:"host", host:"gamma"}, ["gamma"]),
                 fails(Base, _{ask:"agent", agent:"x.0@y@127.0.0.1:1"}, []),
                 fails(Base, _{ask:"what"}, ["question"]),
                 fails(Base, _{do:"what"}, ["order"]),
                 fails(Base, _{what:"ask"}, []),
                 fails(Base, _{ask:1}, []) )).

test(mechanisms, condition(installed(studies))) :-
    page(Base, answer(Base, _{ask:"mechanisms"}, All)),
    member(Mechanism, All),
    Mechanism.name == "sync",
    !,
    member(Predicate, Mechanism.predicates),
    Predicate.name == "sequence_start",
    !,
    assertion(Predicate.arguments == [["+","Sequence"], ["+","Hosts"],
                                      ["+","Tasks"], ["+","Options"],
                                      ["-","Agents"]]),
    assertion(sub_string(Predicate.about, _, _, _, "settings(+Pairs)")).

test(parameters, condition(installed(studies))) :-
    page(Base, ( answer(Base, _{ask:"parameters", mechanism:"sync",
                                predicate:"sequence_start"}, All),
                 answer(Base, _{ask:"parameters", mechanism:"allocation",
                                predicate:"robot_start"}, [Watch|_]),
                 answer(Base, _{ask:"parameters", mechanism:"sync",
                                predicate:"task_fail"}, []),
                 fails(Base, _{ask:"parameters", mechanism:"../sync",
                               predicate:"task_fail"}, ["mechanism"]) )),
    member(Delta, All),
    Delta.name == "delta",
    !,
    assertion(_{ name:"watch", value:"60", values:["inf"], from:1 } :< Watch),
    assertion(_{ value:"0.5", from:0.01, to:2, step:0.01,
                 about:"penalty bias" } :< Delta).

test(programs, condition(installed(studies))) :-
    page(Base, answer(Base, _{ask:"programs"}, Names)),
    assertion(memberchk("agents(sync/traveller)", Names)),
    assertion(\+ ( member(Name, Names), sub_string(Name, _, _, _, operator) )).

%   A program begins with :- agent(Name, Options), or :- agent(Name).

test(other_files_in_folders_of_agents_are_no_programs,
     Names == ["agents('x y')", "agents(below/two)", "agents(one)"]) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, below, Below),
          make_directory(Below),
          forall(folder_file(Name, Text),
                 ( directory_file_path(Dir, Name, File),
                   write_file(File, Text) )),
          page(Base,
               setup_call_cleanup(
                   assertz(user:file_search_path(agents, Dir), Ref),
                   answer(Base, _{ask:"programs"}, All),
                   erase(Ref))) )),
    page(Base1, answer(Base1, _{ask:"programs"}, Ours)),
    findall(Name, ( member(Name, All), \+ memberchk(Name, Ours) ), Names).

folder_file('one.pl', ":- agent(one, []).\n").
folder_file('below/two.pl', "% a comment\n:- agent(two).\n").
folder_file('x y.pl', ":- agent('x y', [static]).\n").
folder_file('three.pl', ":- agent(three, [], []).\n").
folder_file('none.pl', ":- agent.\n").
folder_file('late.pl', "p.\n:- agent(late, []).\n").
folder_file('module.pl', ":- module(agent, []).\n").
folder_file('fact.pl', "agent(fact, []).\n").
folder_file('wrong.pl', ":- agent(wrong, [).\n").
folder_file('text.txt', ":- agent(text, []).\n").
folder_file('empty.pl', "").

%   The page shows no host of gamma.

test(agent_of_a_host_that_is_not_shown_has_no_summary) :-
    with_peers([gamma],
        ( peer_agent(gamma, [(:- agent(there, [])), on_message(_, _)], [],
                     There),
          page(Base,
               ( create([(main :- monitor(There), receive(_))], Here,
                        [host(alpha)]),
                 wait_state(Here, waiting),
                 answer(Base, _{ask:"tree"}, [Top]) )) )),
    atom_string(There, Text),
    [Node] = Top.below,
    assertion(_{ id:Text, relation:"monitored", below:[], host:"", program:"",
                 status:"", doing:"" } :< Node).

test(metrics, Said == "") :-
    page(Base, ( create([on_message(_, _)], _, [host(alpha)]),
                 atom_concat(Base, metrics, Address),
                 http_client:http_get(Address, Text, [to(string)]) )),
    assertion(sub_string(Text, _, _, _,
                         "state=\"resident\"} 1")),
    (   absolute_file_name(path(promtool), _,
                           [access(execute), file_errors(fail)])
    ->  checked_by_promtool(Text, Said)
    ;   Said = ""
    ).

%   A browser sends the text of a log file; of the overlays in agents/ those
%   are listed that its events change.

test(log_of_a_browser,
     [ condition(( installed(replay), installed(studies) )),
       Names == ["clones", "task executed"] ]) :-
    findall(Line,
            ( member(What, [ created, cloned, executing(1, drill), deaths,
                             leave(deaths) ]),
              format(string(Line), '~q.~n',
                     [event(1.5, 'a@h:1', 'bob.1@a@h:1', What)]) ),
            Lines),
    atomics_to_string(Lines, Text),
    page(Base, ( answer(Base, _{ask:replay, title:"x.log", text:Text}, Log),
                 fails(Base, _{ask:replay, title:"x.log"}, []) )),
    assertion(_{title:"x.log", events:[[1.5|_]|_]} :< Log),
    assertion(member("bob.1@a@h:1", Log.names)),
    findall(Name, ( member(Overlay, Log.overlays), Name = Overlay.name ),
            Names).

%   Events of hosts and links keep their kinds, and others are logs.

test(kinds_of_events_of_a_log,
     [condition(installed(replay)), Kinds == Expected]) :-
    findall(What-Kind, logged_kind(What, Kind), Pairs),
    pairs_keys_values(Pairs, Events, Expected),
    findall(Line, ( nth1(N, Events, What),
                    format(string(Line), '~q.~n',
                           [event(N, 'a@h:1', none, What)]) ), Lines),
    atomics_to_string(Lines, Text),
    page(Base, answer(Base, _{ask:replay, title:"x.log", text:Text}, Log)),
    findall(Kind, ( member([_, _, _, Index|_], Log.events),
                    nth0(Index, Log.names, Kind) ), Kinds).

logged_kind(started, "started").
logged_kind(stopped, "stopped").
logged_kind(lost, "lost").
logged_kind(link('b@h:1'), "link").
logged_kind(link('b@h:1', 2), "link").
logged_kind(unlink('b@h:1'), "unlink").
logged_kind(link(other), "log").
logged_kind(link('b@h:1', far), "log").
logged_kind(unlink(x), "log").
logged_kind(begun, "log").

checked_by_promtool(Text, Said) :-
    setup_call_cleanup(
        process_create(path(promtool), [check, metrics],
                       [ stdin(pipe(In)), stdout(pipe(Out)),
                         stderr(std), process(Pid) ]),
        ( format(In, '~s', [Text]), close(In), read_string(Out, _, Said) ),
        close(Out)),
    process_wait(Pid, exit(0)).

:- end_tests(page_queries).

:- begin_tests(page_orders).

program(":- agent(p, [state([n/1])]).\n\c
         main :- receive(_-Message), assertz(n(Message)), receive(_-end).\n").

test(create_and_send, Facts =@= [n(hello(_, 'B', "c"))]) :-
    program(Text),
    page(Base, ( done(Base, _{ do:"create", text:Text, host:"beta", name:"ann",
                               options:"[lifetime(3)]" }, Agent0),
                 atom_string(Agent, Agent0),
                 done(Base, _{do:"send", agent:Agent,
                              message:"hello(X, 'B', \"c\")"}, _),
                 wait_until(agent_property(Agent, facts([_])), 10),
                 agent_property(Agent, facts(Facts)),
                 agent_property(Agent, host(Host)) )),
    assertion(sub_atom(Host, 0, _, _, beta)),
    assertion(sub_atom(Agent, 0, _, _, ann)).

test(bad_terms) :-
    page(Base, ( create([on_message(_, _)], A, [host(alpha)]),
                 fails(Base, _{do:"send", agent:A, message:"go("},
                       [ "the message cannot be read: Unexpected end of clause",
                         ", at \"go( ** here ** \"" ]),
                 fails(Base, _{do:"send", agent:A}, ["message", "missing"]),
                 fails(Base, _{do:"link"}, ["the a is missing"]),
                 fails(Base, _{do:"network_start", topology:"grid(a"},
                       ["topology"]),
                 fails(Base, _{do:"network_start", topology:"grdi(2,2)"},
                       ["grid"]) )).

%   A problem of a program is reported at its line, and the file without its
%   folder.

test(check, Said == [["error", 3], ["warning", 2], ["warning", 3]]) :-
    Text = ":- agent(p, []).\nmain :- foo(X), foo.\nmain :- forall(a, move(b)).\n",
    page(Base, ( answer(Base, _{do:"check", text:Text}, Answer),
                 Problems = Answer.said )),
    findall([Kind, Line], ( member(P, Problems),
                            _{kind:Kind, line:Line} :< P ), Said0),
    sort(Said0, Said),
    forall(( member(P, Problems), get_dict(text, P, Words) ),
           assertion(\+ sub_string(Words, _, _, _, "program.pl"))).

test(error_at_the_line_of_the_goal, Lines == [6]) :-
    Text = ":- agent(p, []).\nmain :-\n    here(_),\n    forall(true,\n\c
                       \u0020          \n        move(b)).\n",
    page(Base, ( answer(Base, _{do:"check", text:Text}, Answer),
                 Said = Answer.said )),
    findall(Line, ( member(P, Said), get_dict(line, P, Line) ), Lines).

test(refused_create) :-
    page(Base, fails(Base, _{do:"create", text:"main :- .", host:"alpha"},
                     ["program.pl:1"])).

%   A text is checked also if the message names a program, too.

test(text_before_program, Said-Named == Alone-[]) :-
    Bad = "main :- nothing_of_this_name(1).",
    page(Base, ( maplist(check(Base),
                         [ _{text:Bad},
                           _{text:Bad, program:"agents(supervisor)"},
                           _{program:"agents(supervisor)"} ],
                         [Alone, Said, Named]) )).

check(Base, Message, Said) :-
    answer(Base, Message.put(do, "check"), Answer),
    Said = Answer.said.

test(faulty_agent_is_resumed, Outcome == done) :-
    page(Base, ( capturing(( create([(main :- receive(_-go, 0))], A,
                                    [host(alpha)]),
                             joined(A, failed) ), _),
                 agent_send(A, go),
                 done(Base, _{do:"resume", agent:A}, _),
                 joined(A, Outcome) )).

test(move_clone_dispose) :-
    page(Base, ( create([on_message(_, _)], A, [host(alpha)]),
                 done(Base, _{do:"move", agent:A, host:"beta"}, _),
                 address(beta, There),
                 wait_until(agent_property(A, host(There)), 10),
                 done(Base, _{do:"clone", agent:A}, Clone0),
                 atom_string(Clone, Clone0),
                 done(Base, _{do:"dispose", agent:A}, _),
                 done(Base, _{do:"dispose", agent:Clone0, force:1}, _),
                 joined(A, disposed),
                 joined(Clone, disposed) )).

test(save_and_load, Facts == [s(1)]) :-
    page(Base, ( create([s(1), on_message(_, _)], A, [host(alpha)]),
                 done(Base, _{do:"save", agent:A}, Text),
                 done(Base, _{do:"load", text:Text, host:"beta"}, B0),
                 atom_string(B, B0),
                 assertion(A \== B),
                 agent_property(B, facts(Facts)) )).

test(links, Costs == [2.5]) :-
    page(Base, ( done(Base, _{do:"unlink", a:"alpha", b:"beta"}, _),
                 assertion(host_property(alpha, neighbours([]))),
                 done(Base, _{do:"link", a:"alpha", b:"beta", cost:"2.5"}, _),
                 answer(Base, _{ask:"survey"}, Scene) )),
    findall(Cost, ( member(Host, Scene.hosts), member([_, Cost], Host.links) ),
            Costs0),
    sort(Costs0, Costs).

test(hosts, Load == 0) :-
    page(Base, ( done(Base, _{do:"host_start", name:"gamma",
                              options:"[capacity(3)]"}, _),
                 host_property(gamma, capacity(3)),
                 host_property(gamma, load(Load)),
                 done(Base, _{do:"host_stop", host:"gamma"}, _),
                 assertion(\+ host_property(_, capacity(3))) )).

test(networks) :-
    page(Base, ( done(Base, _{do:"network_start", topology:"ring(4)",
                              options:"[processes(2)]"}, Name),
                 answer(Base, _{ask:"networks"}, [Network]),
                 assertion(length(Network.hosts, 4)),
                 Network.hosts = [First|_],
                 done(Base, _{do:"host_start", name:"extra", at:First}, Extra),
                 assertion(sub_string(Extra, 0, _, _, "extra@")),
                 answer(Base, _{ask:"host", host:Extra}, _),
                 done(Base, _{do:"host_stop", host:Extra}, _),
                 done(Base, _{do:"network_stop", network:Name}, _),
                 answer(Base, _{ask:"networks"}, []) )).

test(mechanism, [condition(installed(studies)), Done == ["[]"]]) :-
    page(Base, ( findall(A, host_property(_, address(A)), Hosts),
                 done(Base, _{ do:"mechanism", mechanism:"sync",
                               predicate:"sequence_start",
                               arguments:["s", Hosts, "[a-true]",
                                          "[agents(0)]", ""] }, Done),
                 fails(Base, _{ do:"mechanism", mechanism:"sync",
                                predicate:"sequence_start",
                                arguments:["s", Hosts, "[a-true]",
                                           _{ options:"[agents(0)]",
                                              settings:_{delta:"0"} }, ""] },
                       ["delta", "above 0"]),
                 fails(Base, _{ do:"mechanism", mechanism:"sync",
                                predicate:"halt", arguments:[] }, ["halt/0"]),
                 fails(Base, _{ do:"mechanism", mechanism:"../sync",
                                predicate:"halt", arguments:[] },
                       ["mechanism"]),
                 fails(Base, _{ do:"mechanism", mechanism:"sync",
                                predicate:"sequence_start", arguments:[5] },
                       ["text", "5"]),
                 agents_are_gone )).

agents_are_gone :-
    findall(A, agent_property(A, state(_)), Agents),
    forall(member(A, Agents), agent_dispose(A)).

:- end_tests(page_orders).

:- begin_tests(page_feed).

test(initial_state_is_sent, [Hosts, ReadOnly] == [2, false]) :-
    page(Base, with_feed(Base, Feed, frame(Feed, _{snapshot:Scene}))),
    length(Scene.hosts, Hosts),
    ReadOnly = Scene.read_only.

test(page_that_stops_closes_the_connection_in_order, Code == 1000) :-
    page(Base, with_feed(Base, Feed, ( frame(Feed, _),
                                       page_stop,
                                       feed_closed(Feed, Code) ))).

test(events_are_sent) :-
    page(Base, with_feed(Base, Feed, happenings(Feed))).

happenings(Feed) :-
    frame(Feed, _),
    address(alpha, Alpha0),
    address(beta, Beta0),
    maplist(atom_string, [Alpha0, Beta0], [Alpha, Beta]),
    create([(main :- move(Beta0), log('<b>'), leave(f(x, "y")))], A0,
           [host(alpha)]),
    atom_string(A0, A),
    feed_event(Feed, [Alpha, A, "created"], _),
    feed_event(Feed, [Alpha, A, "left", Beta], _),
    feed_event(Feed, [Beta, A, "arrived", Alpha], [_, _, _, _, _, Seconds]),
    assertion(number(Seconds)),
    feed_event(Feed, [Beta, A, "log", "<b>"], _),
    feed_event(Feed, [Beta, A, "leave", "f(x,\"y\")"], _),
    feed_event(Feed, [Beta, A, "ended", "done"], _),
    unlink(alpha, beta),
    feed_event(Feed, [Alpha, "", "unlink", Beta], _).

%   JSON has no infinite numbers, and no NaN: a frame with one could not be
%   parsed.

test(numbers_unknown_to_json_are_sent_as_text,
     [Cost, Logged] == ["1.0Inf", "1.5NaN"]) :-
    page(Base, no_number(Base, Cost, Logged)).

no_number(Base, Cost, Logged) :-
    Inf is inf,
    link(alpha, beta, [cost(Inf)]),
    with_feed(Base, Feed,
              ( frame(Feed, First),
                member(Host, First.snapshot.hosts),
                Host.links = [[_, Cost]],
                create([(main :- X is nan, log(X))], _, [host(alpha)]),
                feed_event(Feed, [_, _, "log"], [_, _, _, _, Logged]) )).

%   Hosts with clocks of their own: each event has the time of the page, which
%   that of the snapshot before it and of the one after it are, too.

test(events_have_the_time_of_the_page, Unordered == []) :-
    monotonic_time(Now),
    with_hosts([alpha, beta-[clock(Now, 1000)]],
               with_page([], Base,
                         with_feed(Base, Feed, times(Base, Feed, All)))),
    findall(Times, ( member(Times, All), \+ msort(Times, Times) ), Unordered).

times(Base, Feed, [[Before, AtAlpha, After], [Before, AtBeta, After]]) :-
    frame(Feed, First),
    Before = First.snapshot.time,
    maplist(logged(Feed), [alpha, beta], [AtAlpha, AtBeta]),
    answer(Base, _{ask:"survey"}, Last),
    After = Last.time.

logged(Feed, Host, Time) :-
    create([(main :- log(Host))], _, [host(Host)]),
    atom_string(Host, Text),
    feed_event(Feed, [_, _, "log", Text], [Time|_]).

%   Virtual time is shown as it is.

test(virtual_time, Time == 3.0) :-
    with_hosts([alpha-[clock(virtual)]],
               with_page([], Base,
                         with_feed(Base, Feed, virtual_time(Feed, Time)))).

virtual_time(Feed, Time) :-
    frame(Feed, _),
    create([(main :- sleep(3))], A, [host(alpha)]),
    agent_join(A, done, 10),
    feed_event(Feed, [_, _, "ended", "done"], [Time|_]).

%   A new host is found, and one whose process is killed is reported.

test(browsers_connect_and_disconnect) :-
    with_settings([typhon_page_sources:renew_seconds=0.3],
        page(Base, with_feed(Base, Feed,
                             ( frame(Feed, _),
                               network_start(ring(4), N, [processes(2)]),
                               network_property(N, hosts(Hosts)),
                               network_property(N, processes([Pid|_])),
                               call_cleanup(come_and_go(Feed, Hosts, Pid),
                                            capturing(network_stop(N), _))
                             )))).

come_and_go(Feed, [First|Hosts], Pid) :-
    last(Hosts, Last),
    wait_until(is_watched(Last), 15),
    wait_until(is_watched(First), 15),
    maplist(atom_string, [First, Last], [FirstText, LastText]),
    create([main], _, [host(Last)]),
    feed_event(Feed, [LastText, _, "created"], _),
    process_kill(Pid, kill),
    feed_event(Feed, [FirstText, "", "lost"], _).

%   A browser that does not read loses some events, and gets their number;
%   others lose none.

test(slow_browser, Sum-Fast == 3000-3000) :-
    with_settings([typhon_page_browsers:frame_events=20],
                  page(Base, with_feed(Base, Slow,
                                       with_feed(Base, Quick,
                                                 slow(Slow, Quick, Sum, Fast))))).

slow(Slow, Quick, Sum, Fast) :-
    frame(Slow, _),
    frame(Quick, _),
    atom_length_of(1900, Text),
    thread_create(count(Quick, 0, Fast0, 3000), Reader),
    forall(between(1, 3000, N),
           typhon_page_browsers:browsers_send(
               event(N, 'a@b:1', none, log(Text)))),
    thread_join(Reader, exited(Fast0)),
    Fast = Fast0,
    typhon_page_browsers:browsers_send(event(0, 'a@b:1', none, log(last))),
    counted(Slow, 0, 3001, Sum0),
    Sum is Sum0-1.

%   A page that stops waits for a browser that is behind, and ends one that
%   reads nothing.  The close frame of another browser shows that it stops.

test(browser_that_is_behind_gets_a_close_frame, Said == [1000, 1000]-[]) :-
    behind(reads, Said).
test(browser_that_reads_nothing_is_ended, Said == [1000, none]-[]) :-
    behind(waits, Said).

behind(What, Codes-Printed) :-
    no_leaks(with_settings([typhon_page_browsers:frame_events=20],
        page(Base, with_feed(Base, Slow,
                             with_feed(Base, Quick,
                                       capturing(stopped(What, Slow, Quick,
                                                         Codes), Printed)))))).

stopped(What, Slow, Quick, [QuickCode, SlowCode]) :-
    frame(Slow, _),
    frame(Quick, _),
    atom_length_of(1900, Text),
    forall(between(1, 6000, N),
           typhon_page_browsers:browsers_send(
               event(N, 'a@b:1', none, log(Text)))),
    thread_create(page_stop, Stopping),
    closed(Quick, QuickCode),
    (   What == reads
    ->  closed(Slow, SlowCode),
        thread_join(Stopping, true)
    ;   thread_join(Stopping, true),
        closed(Slow, SlowCode)
    ).

%   closed(+Feed, -Code): the code of the close frame, or `none`.

closed(Feed, Code) :-
    Feed = feed(Socket, _),
    catch(ws_receive(Socket, Message, []), error(_, _), Message = _{}),
    (   get_dict(code, Message, Code0)
    ->  Code = Code0
    ;   get_dict(opcode, Message, text)
    ->  closed(Feed, Code)
    ;   Code = none
    ).

atom_length_of(Length, Text) :-
    length(Codes, Length),
    maplist(=(0'x), Codes),
    atom_codes(Text, Codes).

count(Feed, _, _, Most) :-
    counted(Feed, 0, Most, Sum),
    thread_exit(Sum).

counted(_, Sum, Most, Sum) :-
    Sum >= Most,
    !.
counted(Feed, Sum0, Most, Sum) :-
    frame(Feed, Frame),
    (   get_dict(events, Frame, Events)
    ->  findall(N, ( member(E, Events), weight(E, N) ), Ns),
        sum_list([Sum0|Ns], Sum1)
    ;   Sum1 = Sum0
    ),
    counted(Feed, Sum1, Most, Sum).

weight([_, _, _, "skipped", N], N) :-
    !.
weight(_, 1).

test(no_events_are_collected_without_a_browser) :-
    with_settings([typhon_page_sources:renew_seconds=0.2],
        page(Base,
             ( with_feed(Base, Feed,
                         ( frame(Feed, _),
                           assertion(is_watched(alpha)) )),
               wait_until(\+ is_watched(alpha), 20) ))).

%   A page in its own process shows a network by one of its hosts.

test(host_in_another_process, Names == [alpha, beta]) :-
    with_hosts([alpha-[], beta-[]],
               ( link(alpha, beta),
                 address(alpha, Address),
                 project_file('app/typhon.pl', App),
                 with_swipl([App, page, '--host', Address, '--port', '0'],
                            Pid, _, Out, elsewhere(Out, Pid, Names)) )).

elsewhere(Out, Pid, Names) :-
    read_line_to_string(Out, Link0),
    atom_string(Link, Link0),
    test_pages:link_base(Link, Base),
    answer(Base, _{ask:"survey"}, Scene),
    findall(Name, ( member(Host, Scene.hosts),
                    split_string(Host.id, "@", "", [Text|_]),
                    atom_string(Name, Text) ), Names0),
    sort(Names0, Names),
    with_feed(Base, Feed,
              ( frame(Feed, _),
                create([main], A, [host(alpha)]),
                atom_string(A, Text),
                feed_event(Feed, [_, Text, "ended", "done"], _) )),
    process_kill(Pid, int),
    wait_for_end(Pid, 10, exit(0)).

%   make demo-page: sixty hosts at work, until Ctrl-C.

test(demo, [condition(installed(studies)), Count-Status == 4-exit(0)]) :-
    project_file('app/demo_page.pl', Demo),
    with_swipl([Demo, '--', '--port=0'], Pid, _, Out,
               ( read_line_to_string(Out, Link),
                 test_pages:link_base(Link, Base),
                 read_line_to_string(Out, _),
                 read_line_to_string(Out, How),
                 assertion(sub_string(How, _, _, _, "in a browser")),
                 wait_until(demo_at_work(Base, Count), 20),
                 process_kill(Pid, int),
                 wait_for_end(Pid, 20, Status) )).

test(demo_at_a_port_in_use,
     [condition(installed(studies)), Lines-Out-Status == 1-""-exit(1)]) :-
    project_file('app/demo_page.pl', Demo),
    tcp_socket(Socket),
    tcp_bind(Socket, localhost:Port),
    tcp_listen(Socket, 5),
    format(atom(Option), '--port=~d', [Port]),
    call_cleanup(run_swipl([Demo, '--', Option], [], Status, Out, Err),
                 tcp_close_socket(Socket)),
    split_string(Err, "\n", "", Split),
    length(Split, Count),
    Lines is Count-1,
    assertion(sub_string(Err, _, _, _, "PORT=0")).

demo_at_work(Base, Count) :-
    answer(Base, _{ask:"survey"}, Scene),
    length(Scene.hosts, 60),
    findall(P, ( member(H, Scene.hosts), get_dict(process, H, P) ), Ps),
    sort(Ps, Processes),
    length(Processes, Count),
    findall(P, ( member(A, Scene.agents), get_dict(program, A, P) ), Programs),
    memberchk("traveller", Programs),
    memberchk("guard", Programs).

:- end_tests(page_feed).
