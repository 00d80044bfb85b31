:- module(test_auction_network, []).
:- use_module('../../lib/common').
:- use_module('../../lib/networks').
:- use_module('../../lib/event_log').
:- use_module('../../lib/fixtures').
:- use_module('../../lib/peers').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(option)).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module('../../../agents/allocation/auctions').
:- use_module('../../../agents/allocation/reservations').
:- use_module('../../../agents/allocation/operator').

/** <module> Murdoch and ANTA on small networks

Counts are compared with the values that follow from the graph.  Every test
checks that no robot was reserved twice, and that none is reserved at the end.
Robots of dead hosts are ignored.
*/

%   auctions(+Mechanism, +Topology, +Options, +Robots, -Hosts, -File, :Goal):
%   with robots that push on the hosts of those numbers; hosts of lower numbers
%   cost less. Of Options, auction(List) is for auction_start/3.

:- meta_predicate auctions(+, +, +, +, -, -, 0).

auctions(Mechanism, Topology, Options0, Robots, Hosts, File, Goal) :-
    select_option(auction(AuctionOptions), Options0, Options1, []),
    select_option(clock(Clock), Options1, Options, 100),
    unhurried(AuctionOptions, Unhurried),
    with_logged_network(
        Topology, [clock(Clock), seed(1)|Options], Hosts, File,
        ( forall(( member(I, Robots), nth1(I, Hosts, Host) ),
                 robot_start(Host, [push, position=p(I,0)],
                             [settings([watch-6000, patience-1000])])),
          auction_start(Mechanism, Hosts, Unhurried),
          Goal ), Events),
    reservation_faults(Events, Faults),
    exclude(died, Faults, []).

%   With the default settings no node is given up soon.

unhurried(Options0, [settings(Settings)|Options]) :-
    select_option(settings(Settings0), Options0, Options, []),
    append(Settings0, [renew-1000, contract-3000], Settings).

:- dynamic dead/1.

died(held(Host, _, _)) :-
    dead(Host).

post(Mechanism, Name, Count, Details, Host) :-
    auction_post(Mechanism,
                 task(Name, [Count-[push]], [at(p(0,0))|Details]), Host).

happened(File, What) :-
    wait_until(( so_far(File, Whats), memberchk(What, Whats) ), 40).

so_far(File, Whats) :-
    logged(File, Events),
    findall(What, member(event(_, _, _, What), Events), Whats).

%   all(+File, +Pattern, ?Found): waits until the logged events, which may lag,
%   are Found.

all(File, Pattern, Found) :-
    wait_until(( so_far(File, Whats),
                 include(subsumes_term(Pattern), Whats, Found) ), 40).

all_free(Hosts) :-
    wait_until(forall(member(Host, Hosts), free(Host)), 40).

free(Host) :-
    catch(robot_status(Host, Status), error(existence_error(robot, _), _),
          Status = free),
    Status == free.

counted(Mechanism, Hosts, Expected) :-
    wait_until(( auction_counts(Mechanism, Hosts, Counts),
                 Counts == Expected ), 40).

%   Virtual time stands still while a test checks or acts.

time_passes(Hosts, Seconds) :-
    network_property(Network, hosts(Hosts)),
    network_advance(Network, Seconds).

%   Exact counts need virtual time: in real time a bid that is late because of
%   load is forwarded separately.

to_the_last([clock(virtual), auction([slack(5)]), hop_time(uniform(0.2, 0.4))]).

%   A flood from the first of three hosts is forwarded to the third.

passed_on(Network) :-
    network_property(Network, hosts([H1,H2,H3])),
    agent_create(clauses([(:- agent(deaf, [])), on_message(_, _)]), Deaf,
                 [host(H3)]),
    agent_create(agents(allocation/murdoch), Node, [host(H2), static(true)]),
    agent_send(Node, link(0, H1, flood(77, start(x)))),
    agent_send(Node, peers([H1-Deaf, H2-Node, H3-Deaf])),
    wait_until(( agent_property(Node, facts(Facts)),
                 memberchk(sent(start, 1), Facts) ), 20).

                /*******************************
                *             FLOOD            *
                *******************************/

:- begin_tests(auction_flood_network).

test(message_before_the_peers_are_known_is_forwarded) :-
    with_network(line(3), [], Network, passed_on(Network)).

%   There are no bids, so one flood is sent: 2E - (N-1) messages.

test(closed_form, [ forall(member(Topology-Count,
                                  [ring(6)-7, grid(3,4)-23])) ]) :-
    auctions(murdoch, Topology,
             [ hop_time(uniform(0.1, 0.3)),
               auction([slack(5), settings([bi_min-5000])]) ],
             [], [Host|Hosts], File,
        ( All = [Host|Hosts],
          post(murdoch, t, 1, [], Host),
          happened(File, backoff(_)),
          counted(murdoch, All, [announce-Count]),
          typhon_topology:topology_edges(Topology, 1, N, Edges),
          length(Edges, E),
          Count =:= 2*E - (N - 1),
          forall(member(Other, Hosts),
                 ( remote(Other, neighbours(Neighbours)),
                   length(Neighbours, Degree),
                   auction_counts(murdoch, [Other], Counts),
                   sum(Counts, Sent),
                   Sent =:= Degree - 1 )) )).

sum(Counts, Sum) :-
    aggregate_all(sum(Count), member(_-Count, Counts), Sum).

test(level_of_a_tree) :-
    auctions(anta, ring(6),
             [ auction([slack(5), settings([level-2, bi_min-5000])]) ],
             [], Hosts, File, level(4, Hosts, File)).

level(Count, [Host|Hosts], File) :-
    post(anta, t, 1, [], Host),
    happened(File, backoff(_)),
    counted(anta, [Host|Hosts], [announce-Count]).

test(two_processes) :-
    auctions(murdoch, ring(6),
             [ processes(2), hop_time(uniform(0.1, 0.3)),
               auction([slack(5), settings([bi_min-5000])]) ],
             [], Hosts, File, two_processes(Hosts, File)).

two_processes(Hosts, File) :-
    Hosts = [Host|_],
    post(murdoch, t, 1, [], Host),
    happened(File, backoff(_)),
    counted(murdoch, Hosts, [announce-7]),
    auction_account(murdoch, Hosts),
    counted(murdoch, Hosts, []),
    wait_until(( all(File, communications(announce, _), Told),
                 aggregate_all(sum(N),
                               member(communications(announce, N), Told),
                               7) ), 40).

:- end_tests(auction_flood_network).

                /*******************************
                *           AUCTIONS           *
                *******************************/

:- begin_tests(auction_network).

%   Of five robots the three that cost least: announcement, five bids, one
%   award, three answers, the start, three that are done, the release.

test(murdoch_step_by_step) :-
    to_the_last(Options),
    auctions(murdoch, grid(2, 3), Options, [2, 3, 4, 5, 6], Hosts, File,
        ( step_by_step(murdoch, Hosts, File),
          Flood is 2*7 - 5,
          findall(Kind-Count,
                  ( member(Kind-Times, [ ack-6, announce-1, award-1, bid-5,
                                         release-1, start-1 ]),
                    Count is Times*Flood ),
                  Counts),
          counted(murdoch, Hosts, Counts) )).

%   On a chain: each of five nodes reports once; awards, the start and the
%   release go three links down, answers 1 + 2 + 3 links up, twice.

test(anta_step_by_step) :-
    to_the_last(Options),
    auctions(anta, edges([1-2, 2-3, 3-4, 4-5, 5-6]), Options, [2, 3, 4, 5, 6],
             Hosts, File,
        ( step_by_step(anta, Hosts, File),
          counted(anta, Hosts,
                  [ack-12, announce-5, award-3, bid-5, release-3, start-3]) )).

step_by_step(Mechanism, Hosts, File) :-
    Hosts = [Host|_],
    post(Mechanism, t, 3, [duration(2)], Host),
    time_passes(Hosts, 100),            % before contracts are renewed
    happened(File, completed(t)),
    all_free(Hosts),
    all(File, released(_, _, t), [_, _, _]),
    Hosts = [_, A, B, C|_],
    so_far(File, Whats0),
    exclude(of_agents, Whats0, Whats),
    Whats = [begun(t)|_],
    append(Before, [allocated(t, Robots)|Then], Whats),
    msort(Robots, [A, B, C]),
    findall(R, member(reserved(R, _, t), Before), Reserved),
    msort(Reserved, [A, B, C]),
    append(While, [completed(t)|After], Then),
    findall(R, member(executed(R, _, t), While), Executed),
    msort(Executed, [A, B, C]),
    findall(R, member(released(R, _, t), After), Released),
    msort(Released, [A, B, C]).

%   The events of agents in the logs of Hosts.

of_agents(created).
of_agents(ended(_)).

test(too_few_robots) :-
    auctions(anta, ring(4),
             [ clock(virtual),
               auction([slack(15), settings([bi_min-5, bi_max-10])]) ],
             [2, 3], Hosts, File,
        ( Hosts = [Host, _, _, Last],
          post(anta, t, 3, [duration(1)], Host),
          time_passes(Hosts, 20),
          happened(File, backoff(Interval)),
          Interval >= 5,
          Interval =< 20,                     % 5 or 10, and up to 10
          all(File, reserved(_, _, _), []),
          robot_start(Last, [push, position=p(4,0)], []),
          time_passes(Hosts, 200),
          happened(File, completed(t)),
          all_free(Hosts) )).
test(two_auctions_that_need_all_robots,
     [forall(member(Mechanism, [murdoch, anta]))]) :-
    auctions(Mechanism, grid(2, 3),
             [ clock(virtual), hop_time(uniform(0.1, 0.3)),
               auction([slack(15), settings([bi_min-2, bi_max-20])]) ],
             [1, 2, 3, 4, 5, 6], Hosts, File,
        ( Hosts = [First|_],
          last(Hosts, Last),
          post(Mechanism, a, 6, [duration(2)], First),
          post(Mechanism, b, 6, [duration(2)], Last),
          time_passes(Hosts, 5000),
          happened(File, completed(a)),
          happened(File, completed(b)),
          all_free(Hosts),
          forall(member(Name, [a, b]),
                 ( all(File, executed(_, _, Name), Executed),
                   length(Executed, 6) )) )).
test(urgent_auction_comes_first) :-
    auctions(murdoch, ring(4),
             [ clock(virtual),
               auction([slack(15), settings([bi_min-2, bi_max-20])]) ],
             [1, 2, 3, 4], Hosts, File,
        ( Hosts = [First, _, Third|_],
          post(murdoch, slow, 4, [duration(2)], First),
          post(murdoch, quick, 4, [duration(2), priority(5)], Third),
          time_passes(Hosts, 500),
          happened(File, completed(slow)),
          all_free(Hosts),
          all(File, completed(_), Completed),
          Completed == [completed(quick), completed(slow)] )).
test(a_deadline_is_missed) :-
    auctions(murdoch, ring(4), [clock(virtual), auction([slack(15)])],
             [1, 2, 3, 4], Hosts, File, missed(murdoch, Hosts, File)).

missed(Mechanism, Hosts, File) :-
    Hosts = [First|_],
    post(Mechanism, t, 4, [duration(1000), deadline(60)], First),
    time_passes(Hosts, 100),
    happened(File, allocated(t, _)),
    happened(File, missed(t, 60)),
    all_free(Hosts).

test(a_failed_robot_is_replaced) :-
    auctions(anta, ring(5), [clock(virtual), auction([slack(15)])],
             [1, 2, 3, 4], Hosts, File,
        ( Hosts = [First, Second, _, Fourth, _],
          post(anta, t, 3, [duration(60)], First),
          time_passes(Hosts, 30),
          robot_status(Second, executing(_, t)),
          robot_fail(Second),
          time_passes(Hosts, 300),
          happened(File, completed(t)),
          exclude(==(Second), Hosts, Others),
          all_free(Others),
          happened(File, executed(Fourth, _, t)),
          all(File, executed(Second, _, t), []) )).

%   A node of the chain whose parent is cut off has another path.

test(a_parent_has_vanished) :-
    auctions(anta, edges([1-2, 2-3, 3-4]),
             [clock(virtual), auction([slack(15)])], [4], Hosts, File,
        ( Hosts = [First, _, Third, Fourth],
          post(anta, t, 1, [duration(1)], First),
          time_passes(Hosts, 1),
          remote(Fourth, sense(node(anta, Node))),
          agent_property(Node, facts(Facts)),
          memberchk(gathered(_, _, Fourth, _), Facts),
          link(First, Fourth),
          unlink(Third, Fourth),
          time_passes(Hosts, 100),
          happened(File, completed(t)),
          all_free(Hosts) )).

:- end_tests(auction_network).

                /*******************************
                *          HOSTS DIE           *
                *******************************/

stops(Host) :-
    dies(Host),
    host_stop(Host).

dies(Host) :-
    assertz(dead(Host)).

quick([slack(15), settings([renew-50, contract-160, bi_min-5])]).

%   In real time, on a busy machine.

patient([slack(60), settings([renew-100, contract-400, bi_min-5])]).

%   Errors are raised at once.

:- begin_tests(auction_operator).

%   Hosts and links count, not which they are.

test(nodes_with_one_channel_take_turns,
     [ forall(member(Sending-Hosts-Links-Expected,
                     [ one_by_one(1)-2-8-4, one_by_one(0.5)-2-8-2.0,
                       one_by_one(0.5)-2-3-1,       % never less than a hop
                       at_once-2-8-1 ])),
       Turns =:= Expected ]) :-
    length(Names, Hosts),
    length(Edges, Links),
    findall(T, auction_operator:in_turn([setting(sending, Sending)], Names,
                                        Edges, T), [Turns]).

test(no_such_mechanism, error(type_error(mechanism, vickrey))) :-
    auction_start(vickrey, [], []).
test(no_such_setting, error(domain_error(setting, bid_window-3))) :-
    auction_start(anta, [], [settings([bid_window-3])]).
test(no_task, [ forall(member(Task, [ _, task(_, [1-[push]], []),
                                      task(t, [], []),
                                      task(t, [0-[push]], []),
                                      task(t, [1-push], []), t ])),
                error(type_error(task, _)) ]) :-
    auction_post(anta, Task, nowhere).
test(no_node) :-
    with_hosts([alpha],
               ( address(alpha, Address),
                 catch(auction_post(anta, task(t, [1-[push]], []), Address),
                       error(Formal, _), true),
                 Formal = existence_error(node, Address) )).
test(a_host_gets_one_node, Loads == [1, 1]) :-
    with_hosts([alpha, beta],
               ( findall(A, address(_, A), Hosts),
                 auction_start(murdoch, Hosts, []),
                 auction_start(murdoch, Hosts, []),
                 findall(Load, ( member(H, Hosts),
                                 remote(H, host_load(Load)) ), Loads) )).
test(diameter, Level == 3) :-
    auctions(anta, grid(2,3), [hop_time(uniform(0.2, 0.5)),
                               auction([slack(2)])], [], [Host|_], _,
        ( remote(Host, sense(node(anta, Node))),
          agent_property(Node, facts(Facts)),
          memberchk(setting(level, Level), Facts),
          memberchk(setting(window, Window), Facts),
          Window =:= 2*Level*0.5 + 2 )).

:- end_tests(auction_operator).

:- begin_tests(auction_dead, [cleanup(test_auction_network:forget_dead)]).

test(the_host_of_an_auctioneer_stops) :-
    quick(Quick),
    auctions(murdoch, mesh(3), [clock(virtual), auction(Quick)], [2, 3],
             Hosts, File,
        ( Hosts = [First|Others],
          Others = [Second, _],
          post(murdoch, t, 2, [duration(1000)], First),
          time_passes(Hosts, 30),
          robot_status(Second, executing(_, t)),
          stops(First),
          time_passes(Hosts, 300),
          all_free(Others),
          all(File, released(_, _, t), [_, _]),
          post(murdoch, u, 2, [duration(1)], Second),
          time_passes(Hosts, 100),
          happened(File, completed(u)),
          all_free(Others) )).

%   The host of a robot, in its own process, which ends without a goodbye.

test(a_process_is_killed) :-
    patient(Patient),
    auctions(anta, mesh(3), [auction(Patient)], [2, 3], Hosts, File,
        ( typhon_time:clock(n1, Epoch, Rate),
          typhon_hosts:host_option(n1, log(Log)),
          with_peers([gone-[host([clock(Epoch, Rate), log(Log)])]],
                     killed(anta, Hosts, File)) )).

killed(Mechanism, Hosts, File) :-
    Hosts = [First, Second, Third],
    peer_host(gone, Gone),
    dies(Gone),
    forall(member(Host, Hosts), link(Host, Gone)),
    robot_start(Gone, [push, position=p(0,0)], []),
    patient(Patient),
    auction_start(Mechanism, [Gone|Hosts], Patient),
    post_from(gone, Mechanism, First),
    wait_until(robot_status(Gone, executing(_, t)), 40),
    peer_kill(gone),
    happened(File, completed(t)),
    happened(File, executed(Third, _, t)),
    all_free([Second, Third]).

:- end_tests(auction_dead).

%   Any process with the cookie may post a task at any host.

post_from(Peer, Mechanism, Host) :-
    project_file('agents/allocation/auctions', File),
    peer_do(Peer, use_module(File)),
    Task = task(t, [2-[push]], [at(p(0,0)), duration(400)]),
    peer_do(Peer, auction_operator:auction_post(Mechanism, Task, Host)).

forget_dead :-
    retractall(dead(_)).
