:- module(test_letters, []).
:- use_module('../../../lib/common').
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../lib/cutting_proxy').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/travellers').

/** <module> Messages to processes that are unreachable, die or restart

A message waits as long as the process of its agent may be alive. If the
process is dead, that is reported to the sender.
*/

:- begin_tests(unreachable_process).

test(mail_waits, forall(member(Goal, [ waits_for_way, waits_in_order,
                                       waits_behind_tried,
                                       waits_where_it_comes ]))) :-
    with_peers([ a-[setup(hurried)], b,
                 c-[proxy(true), setup(calls_nobody)] ],
               ( noting_on_c(Id), cut_off, call(Goal, Id) )).
test(reported_once_to_the_sender_when_the_process_is_dead) :-
    with_peers([a, b, c], told_when_dead).

:- end_tests(unreachable_process).

%   noting(+Host, -Id): an agent created on a goes to the host of Host; b knows
%   only its home.

noting(Peer, Id) :-
    peer_host(Peer, Host),
    peer_agent(a, [ (:- agent(noting, [state([to/1])])),
                    (main :- to(To), go(To)),
                    (go(To) :-
                         catch(move(To),
                               error(host_unreachable(_), _),
                               go(To))),
                    (on_message(_, go(To)) :- move(To)),
                    (on_message(_, n(N)) :- leave(noted(N)))
                  ], [to(Host)], Id),
    wait_until(peer_do(Peer, agent_here(Id)), 30),
    wait_until(\+ peer_do(a, agent_here(Id)), 30).

noting_on_c(Id) :-
    noting(c, Id).

%   b sends messages with these numbers to Id.

sends(Id, From, To) :-
    peer_do(b, forall(between(From, To, N), agent_send(Id, n(N)))).

notes_all(Count) :-
    wait_until(( noted(Noted), length(Noted, Count) ), 20),
    numlist(1, Count, Noted).

noted(Numbers) :-
    peer_do(c, remote(c, findall(N, sense(noted(N)), Numbers))).

%   a can no longer reach c, nor c any process: the proxy accepts connections,
%   and is silent.

cut_off :-
    peer_proxy(c, Proxy),
    proxy_hold(Proxy, up),
    proxy_hold(Proxy, down),
    proxy_cut(Proxy),
    peer_host(c, C),
    wait_until(\+ peer_do(a, connected_to(C)), 30).

reconnected :-
    peer_proxy(c, Proxy),
    proxy_release(Proxy, up),
    proxy_release(Proxy, down),
    proxy_cut(Proxy).

waits_for_way(Id) :-
    sends(Id, 1, 20),
    wait_until(peer_do(a, kept(Id)), 30),
    wait_until(peer_do(a, tried_in_vain(Id)), 30),
    reconnected,
    notes_all(20),
    \+ said(a, " lost: ", Id),
    \+ said(b, " lost: ", Id).

waits_in_order(Id) :-
    sends(Id, 1, 20),
    wait_until(peer_do(a, kept(Id)), 30),
    reconnected,
    sends(Id, 21, 40),
    notes_all(40).

%   More messages arrive during and after the first attempts.

waits_behind_tried(Id) :-
    sends(Id, 1, 20),
    wait_until(peer_do(a, tried_in_vain(Id)), 30),
    sends(Id, 21, 40),
    wait_until(peer_do(a, tried_in_vain(Id)), 30),
    reconnected,
    sends(Id, 41, 60),
    notes_all(60),
    wait_until(peer_do(a, \+ kept(Id)), 20).

%   The agent moves to the process in which its mail waits. Earlier mail comes
%   first.

waits_where_it_comes(Id) :-
    numlist(1, 20, Numbers),
    sends(Id, 1, 20),
    wait_until(peer_do(a, tried_in_vain(Id)), 30),
    peer_host(a, A),
    reconnected,
    peer_do(c, agent_move(Id, A)),
    wait_until(( noted(OnC),
                 peer_do(a, remote(a, findall(N, sense(noted(N)), OnA))),
                 append(OnC, OnA, Noted),
                 same_length(Noted, Numbers) ), 30),
    Noted == Numbers,
    wait_until(peer_do(a, \+ kept(Id)), 20).

told_when_dead :-
    noting_on_c(Id),
    peer_kill(c),
    peer_do(b, agent_send(Id, n(1))),
    wait_until(said(b, " lost: ", Id), 20),
    \+ said(a, " lost: ", Id).         % once

said(Peer, Text, Id) :-
    peer_messages(Peer, Lines),
    member(Line, Lines),
    sub_string(Line, _, _, _, Text),
    sub_string(Line, _, _, _, Id),
    !.

:- begin_tests(process_started_again).

test(home_and_process_agree_that_the_agent_ended) :-
    with_peers([a, b, c-[setup(count_messages)]], no_storm).
test(restarted_home_learns_the_hosts_of_its_agents) :-
    with_peers([a, b, c], home_learns).
test(newest_news_of_each_agent_are_kept) :-
    with_peers([a, b, c], dead_home).

:- end_tests(process_started_again).

%   The agent died with c; a hundred messages for it do not go to and fro
%   between its home and the new process at the address of c.

no_storm :-
    noting_on_c(Id),
    peer_kill(c),
    peer_restart(c),
    sends(Id, 1, 100),
    wait_until(said(b, " lost: ", Id), 30),
    wait_until(peer_do(a, \+ kept(Id)), 30),
    peer_do(c, messages_seen(Seen)),
    Seen =< 1000,
    peer_try(a, agent_send(Id, n(0)), Outcome),
    Outcome = raised(error(existence_error(agent, Id), _)).

%   The restarted home accepts the news of the agent's next hop.

home_learns :-
    peer_host(c, C),
    noting(b, Id),
    peer_kill(a),
    peer_restart(a),
    peer_do(b, agent_send(Id, go(C))),
    wait_until(peer_do(c, agent_here(Id)), 30),
    wait_until(peer_do(a, agent_property(Id, host(C))), 20),
    peer_do(a, agent_send(Id, n(1))),
    wait_until(noted([1]), 30).

%   The home of four agents is dead: this does not make their hops more
%   expensive.

dead_home :-
    peer_host(b, B),
    peer_host(c, C),
    Program = clauses([ (:- agent(to_and_fro, [state([left/1])])),
                        (main :- left(N), go(N)),
                        (go(0) :- !, here(Here), leave(stopped(Here))),
                        (go(N) :- move(B), move(C), N1 is N-1, go(N1)) ]),
    findall(Id,
            ( between(1, 4, _),
              peer_do(a, agent_create(Program, Id, [facts([left(300)])])) ),
            Ids),
    wait_until(forall(member(Id, Ids), peer_do(a, \+ agent_here(Id))), 30),
    peer_kill(a),
    wait_until(( peer_do(c, remote(c, findall(x, sense(stopped(_)), Stopped))),
                 length(Stopped, 4) ), 60),
    forall(member(Peer, [b, c]),
           ( peer_do(Peer, news_kept(News)),
             News =< 4 )).
