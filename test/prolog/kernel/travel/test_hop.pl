:- module(test_hop, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/cutting_proxy',
              [ proxy_cut/1, proxy_cut_after/3, proxy_hold/2,
                proxy_release/2, proxy_cuts/2 ]).
:- use_module(library(lists), [member/2, memberchk/2, nth0/3]).
:- use_module(library(plunit)).
:- use_module('../../../lib/peers').
:- use_module('../../../lib/travellers').

/** <module> Hops between processes: every agent makes every step once

Agents travel between processes while the connections under them are cut. Each
leaves a tuple at every step, which reveals lost and repeated steps.
*/

%   The offsets at which a connection is cut: every byte of the beginning
%   of a frame, then strides that are prime to the sizes of frames.

offset(Bytes) :-
    between(0, 6, Bytes).
offset(Bytes) :-
    between(0, 16, I),
    Bytes is 11+I*53.

with_proxied(Codec, Goal) :-
    with_peers([ a-[proxy(true), codec(Codec)],
                 b-[proxy(true), codec(Codec)] ], Goal).

:- begin_tests(connections_cut_during_hops).

test(every_step_once, forall(member(Codec-Goal,
                                    [ fast-cut_everywhere(up, down),
                                      text-cut_everywhere(down, up),
                                      fast-cut_all_the_time(8, 100),
                                      text-cut_all_the_time(8, 100) ]))) :-
    with_proxied(Codec, Goal).
test(between_hosts_of_one_process) :-
    with_peers([a-[proxy(true)]], cut_self_connection).
test(cut_before_the_answer) :-
    with_proxied(fast, cut_before_answer(10)).
test(large_agents_among_small_ones, forall(heavy(Codec, Facts))) :-
    with_peers([ a-[codec(Codec)], b-[codec(Codec)] ],
               cross_heavily(Facts)).

:- end_tests(connections_cut_during_hops).

heavy(fast, 10 000).
heavy(text, 2 000).

%   Agents with so many facts hop to and fro from both sides, with small ones
%   among them.

cross_heavily(Facts) :-
    peer_host(a, A),
    peer_host(b, B),
    findall(Peer-Id,
            ( member(Peer-Route, [a-[B, A], b-[A, B]]),
              (   between(1, 3, _),
                  heavy(Peer, Route, 4, Facts, Id)
              ;   between(1, 4, _),
                  set_out(Peer, Route, 60, Id)
              ) ),
            Ids),
    forall(member(Peer-Id, Ids),
           (   atom_concat(heavy, _, Id)
           ->  ended_done(Peer, Id, 4)
           ;   ended_done(Peer, Id, 60)
           )).

%   An agent goes from a to b and back. Data from a to b pass the proxy of b
%   upwards or, if b has connected, that of a downwards.

cut_everywhere(DirectionB, DirectionA) :-
    peer_proxy(a, ProxyA),
    peer_proxy(b, ProxyB),
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 2),               % connects, and brings the program
    forall(offset(Bytes),
           ( proxy_cut_after(ProxyA, DirectionA, Bytes),
             proxy_cut_after(ProxyB, DirectionB, Bytes),
             travel(a, [B, A], 6) )),
    proxy_cuts(ProxyA, CutsA),
    proxy_cuts(ProxyB, CutsB),
    CutsA+CutsB > 15.

%   Eight agents hop, while both proxies cut connections repeatedly: not
%   without end, since a slow machine does not connect in between.

cut_all_the_time(Agents, Hops) :-
    peer_host(a, A),
    peer_host(b, B),
    findall(Id,
            ( between(1, Agents, _),
              set_out(a, [B, A], Hops, Id)
            ),
            Ids),
    thread_create(cutter(60), Cutter),
    call_cleanup(
        forall(member(Id, Ids), ended_done(a, Id, Hops)),
        ( catch(thread_send_message(Cutter, stop), error(_, _), true),
          thread_join(Cutter, Status) )),
    Status == true.

cutter(0) :-
    !.
cutter(Cuts) :-
    Wait is 0.03+random_float*0.1,
    thread_self(Me),
    (   thread_get_message(Me, stop, [timeout(Wait)])
    ->  true
    ;   forall(peer_proxy(_, Proxy), proxy_cut(Proxy)),
        Left is Cuts-1,
        cutter(Left)
    ).

cut_self_connection :-
    peer_do(a, host_start(a2)),
    peer_do(a, host_property(a2, address(A2))),
    peer_host(a, A),
    peer_proxy(a, Proxy),
    travel(a, [A2, A], 20),
    forall(( offset(Bytes), Bytes < 200, member(Direction, [up,down]) ),
           ( proxy_cut_after(Proxy, Direction, Bytes),
             travel(a, [A2, A], 6)
           )).

%   The answer is held until the agent has arrived at the other process, where
%   it stays; then the connection is cut.

cut_before_answer(Rounds) :-
    peer_host(a, A),
    peer_host(b, B),
    forall(between(1, Rounds, _), cut_before_one_answer(A, B)).

cut_before_one_answer(A, B) :-
    travel(a, [B, A], 2),               % they have one connection
    wait_until(forall(member(Peer, [a, b]),
                      peer_do(Peer, \+ connecting)), 30),
    answers(proxy_hold),
    set_out(a, [B, sit], 2, Id),
    wait_until(step_on(b, Id, 1), 30),
    peer_do(a, agent_state_here(Id, State)),
    memberchk(State, [in_transit, in_doubt]),
    forall(peer_proxy(_, Proxy), proxy_cut(Proxy)),
    wait_until(( answers(proxy_release),
                 \+ peer_do(a, agent_here(Id)) ), 30),
    peer_do(a, agent_property(Id, host(B))),
    peer_do(a, agent_send(Id, go)),
    ended_done(a, Id, 2).

%   The data that b sends to a pass either proxy.

answers(What) :-
    peer_proxy(a, ProxyA),
    peer_proxy(b, ProxyB),
    call(What, ProxyA, up),
    call(What, ProxyB, down).

:- begin_tests(hop_refused).

test(without_the_token) :-
    with_peers([a, b-[host([tokens([key])])]],
               ( peer_host(b, B),
                 refused_at(B, token, [tokens([other])]),
                 travel(a, [B], 1, [tokens([other, key])]) )).
test(by_an_unknown_host) :-
    with_peers([a, b],
               ( peer_host(b, B),
                 atom_concat(b, Endpoint, B),
                 atom_concat(missing, Endpoint, Missing),
                 refused_at(Missing, unknown_host, []) )).
test(two_agents_swap_hosts) :-
    with_peers([ a-[host([capacity(1)])],
                 b-[host([capacity(1)])],
                 c ], swap(200)).

:- end_tests(hop_refused).

refused_at(Host, Reason, Options) :-
    peer_do(a, try_move(Host, Options, Error)),
    Error == error(move_refused(Host, Reason)).

%   Two agents on hosts of capacity one change places: one of them has to wait
%   on a third host. No agent is lost or duplicated.

swap(Rounds) :-
    peer_host(a, A),
    peer_host(b, B),
    peer_host(c, C),
    swapper(a, [A, B, C], Rounds, Id1),
    swapper(b, [B, A, C], Rounds, Id2),
    peer_do(a, agent_send(Id1, go)),
    peer_do(a, agent_send(Id2, go)),
    ended(a, Id1, done),
    ended(b, Id2, done),
    wait_until(forall(member(Peer, [a, b, c]),
                      peer_do(Peer, host_property(Peer, load(0)))), 10).

:- begin_tests(hop_messages).

test(arrive_once_each, forall(member(Codec-Count, [fast-400, text-200]))) :-
    with_peers([ a-[codec(Codec)], b-[codec(Codec)], c-[codec(Codec)] ],
               chase(Count)).
test(follow_in_several_frames, Numbers == [1, 2, 3, 4, 5, 6, 7]) :-
    Small = setup(set_setting(typhon_session:frame_bytes, 20000)),
    with_peers([ a-[proxy(true), Small], b-[proxy(true)] ],
               follow_big(7, 6000, Numbers)).
test(ordered_to_end_while_hopping) :-
    with_peers([a, b, c], dispose_hopping(10)).

:- end_tests(hop_messages).

%   An agent hops without pause between three processes until it has received
%   as many messages as three processes have sent, and adds them up. It stays
%   for a moment: a duplicate would be counted.

chase(Count) :-
    peer_host(a, A),
    peer_host(b, B),
    peer_host(c, C),
    All is 3*Count,
    collector(a, [B, C, A], All, Id),
    forall(member(Peer, [a, b, c]),
           peer_do(Peer, send_in_background(Id, Count))),
    peer_do(c, agent_join(Id, Outcome, 60)),
    Outcome == done,
    Sum is 3*Count*(Count+1)//2,
    findall(S, ( member(Peer, [a, b, c]), collected(Peer, Id, S) ), Sums),
    Sums == [All-Sum].

%   While the answer to its hop is held an agent gets more mail than one frame
%   of the source holds.

follow_big(Count, Bytes, Numbers) :-
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 2),               % they are connected
    answers(proxy_hold),
    reader(a, B, Count, Id),
    wait_until(peer_do(b, agent_here(Id)), 10),
    format(string(Text), '~`x~t~*|', [Bytes]),
    forall(between(1, Count, I),
           peer_do(a, agent_send(Id, I-Text))),
    answers(proxy_release),
    peer_do(a, agent_join(Id, done, 20)),
    peer_do(b, remote(b, findall(I, sense(noted(I)), Numbers))).

dispose_hopping(Rounds) :-
    peer_host(a, A),
    peer_host(b, B),
    peer_host(c, C),
    forall(between(1, Rounds, I),
           ( set_out(a, [B, C, A], 1 000 000, Id),
             N is I mod 3,
             nth0(N, [a, b, c], Peer),
             peer_do(Peer, agent_dispose(Id)),
             peer_do(b, agent_join(Id, Outcome, 20)),
             Outcome == disposed )),
    wait_until(forall(member(Peer, [a, b, c]),
                      peer_do(Peer, \+ agent_here(_))), 10).

:- begin_tests(hop_program).

test(program_travels_once) :-
    with_peers([a-[setup(unhurried)], b-[setup(unhurried)]],
               programs_sent_once).
test(program_is_requested_again) :-
    with_peers([a, b-[setup(set_setting(typhon_code:programs, 0))]],
               programs_evicted).

:- end_tests(hop_program).

%   Programs in the frames that arrive at b are counted there: one for a
%   connection.

programs_sent_once :-
    peer_host(a, A),
    peer_host(b, B),
    peer_do(b, count_programs),
    forall(between(1, 5, _), travel(a, [B, A], 10)),
    peer_do(b, programs_seen(Seen)),
    Seen == 1.

%   b discards unused programs, and requests them when they are needed.

programs_evicted :-
    peer_host(a, A),
    peer_host(b, B),
    forall(between(1, 5, I),
           ( travel(a, [B, A], 4),
             other_program(a, B, I) )).
