:- module(test_faults, []).
:- use_module('../../../lib/common').
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module('../../../lib/peers').
:- use_module('../../../lib/travellers').

/** <module> Faults of earlier platforms do not occur

Peers that are silent, killed or restarted; agents that hop without pause.
*/

:- begin_tests(silent_peer).

test(agent_in_doubt, forall(member(Goal, [ silent_then_back, killed_for_good,
                                           told_then_back, disposed_then_back,
                                           clone_then_back ]))) :-
    with_doubt([a, b], Goal).
test(end_precedes_the_answer,
     true(Outcome = raised(error(existence_error(agent, _), _)))) :-
    with_peers([a, b], ended_first(Outcome)).

:- end_tests(silent_peer).

%   Agents are marked in doubt after a short time.

with_doubt(Peers, Goal) :-
    findall(Peer-[setup(set_setting(typhon_in_doubt:shown_seconds, 0.3))],
            member(Peer, Peers), Specs),
    with_peers(Specs, Goal).

%   The agent was sent to b, which is silent, and so is in doubt.

in_doubt(Id) :-
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 2),
    peer_signal(b, stop),
    set_out(a, [B, sit, A], 3, Id),
    wait_until(peer_do(a, agent_property(Id, state(in_doubt))), 10).

silent_then_back :-
    in_doubt(Id),
    steps_at(a, Id, [0]),
    peer_signal(b, cont),
    wait_until(step_on(b, Id, 1), 10),
    wait_until(\+ peer_do(a, agent_here(Id)), 10),
    peer_do(a, agent_send(Id, go)),
    ended_done(a, Id, 3).

killed_for_good :-
    in_doubt(Id),
    peer_kill(b),
    wait_until(peer_do(a, agent_property(Id, state(in_doubt))), 10),
    peer_do(a, agent_dispose(Id)),
    ended(a, Id, disposed),
    \+ peer_do(a, agent_here(Id)).

%   The order waits for the answer of b, as long as b may answer.

told_then_back :-
    in_doubt(Id),
    peer_do(a, agent_dispose(Id)),
    peer_do(a, agent_here(Id)),
    peer_signal(b, cont),
    ended(a, Id, disposed),
    \+ peer_do(a, agent_here(Id)),
    \+ peer_do(b, agent_here(Id)).

%   The operator disposes of the agent before b answers: b is notified.

disposed_then_back :-
    peer_do(a, set_setting(typhon_reader:silence, 1)),
    in_doubt(Id),
    peer_host(b, B),
    wait_until(\+ peer_do(a, connected_to(B)), 20),
    peer_do(a, agent_dispose(Id)),
    ended(a, Id, disposed),
    peer_signal(b, cont),
    wait_until(step_on(b, Id, 1), 10),
    wait_until(\+ peer_do(b, agent_here(Id)), 10),
    \+ peer_do(a, agent_here(Id)).

clone_then_back :-
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 2),
    peer_signal(b, stop),
    cloner(a, B, Id),
    wait_until(peer_do(a, agent_property(Id, state(in_doubt))), 10),
    peer_signal(b, cont),
    ended(a, Id, done),
    peer_do(a, remote(a, sense(parent_of(Id, Clone)))),
    peer_do(a, agent_property(Clone, host(B))),
    peer_do(a, agent_send(Clone, go)),
    ended(a, Clone, done).

%   The home does not look for the agent where it was before.

ended_first(Outcome) :-
    peer_host(b, B),
    peer_do(b, keep_answers),
    set_out(a, [B], 1, Id),
    ended(a, Id, done),
    peer_do(b, give_answers),
    wait_until(\+ peer_do(a, agent_here(Id)), 10),
    peer_try(a, agent_dispose(Id), Outcome).

steps_at(Peer, Id, Steps) :-
    peer_do(Peer, steps_here(Id, Steps)).

%   The home is the source, another process, or the killed process; or it, or
%   the process that the agent had reached, is restarted without any data, while
%   others know the agent.

:- begin_tests(killed_peer).

test(agent_continues_at_its_source, forall(member(Born, [a, c, b]))) :-
    with_doubt([a, b, c], restarted(Born)).
test(agent_that_hopped_on_is_not_duplicated) :-
    with_doubt([a, b, c], got_away).
test(agent_that_hopped_on_is_not_duplicated_without_its_home,
     forall(( member(Home, [d, b]), member(Steps, [20, 4]) ))) :-
    with_doubt([a, b, c, d], got_away_from(Home, Steps)).

:- end_tests(killed_peer).

%   An agent created on Born is sent from a to b, which is stopped, killed and
%   restarted at its port.

restarted(Born) :-
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 2),
    Clauses = [ (:- agent(mover, [state([path/2])])),
                (main :- path(A1, B1), move(A1), receive(_-go),
                         catch(move(B1), error(E, _), true),
                         here(Here), leave(raised(E, Here)),
                         receive(_-end)) ],
    peer_agent(Born, Clauses, [path(A, B)], Id),
    wait_until(peer_do(a, agent_here(Id)), 10),
    peer_do(a, agent_send(Id, ping)),
    peer_signal(b, stop),
    peer_do(a, agent_send(Id, go)),
    wait_until(agent_state(a, Id, in_doubt), 10),
    peer_kill(b),
    wait_until(agent_state(a, Id, in_doubt), 10),
    peer_restart(b),
    wait_until(peer_do(a, remote(a, take(raised(E, Here)))), 20),
    E == host_unreachable(B),
    Here == A,
    \+ peer_do(b, agent_here(Id)),
    peer_do(a, agent_send(at(Id, a), end)),
    wait_until(\+ peer_do(a, agent_here(Id)), 10).

agent_state(Peer, Id, State) :-
    peer_do(Peer, agent_state_here(Id, State)).

%   The answer of b to a never arrives, but the agent has moved on to c, which
%   notifies its home, a.

got_away :-
    peer_host(b, B),
    peer_host(c, C),
    peer_do(b, silence_answers),
    set_out(a, [B, C, sit], 3, Id),
    wait_until(step_on(c, Id, 2), 10),
    wait_until(agent_state(a, Id, in_doubt), 10),
    peer_kill(b),
    peer_restart(b),
    wait_until(\+ peer_do(a, agent_here(Id)), 20),
    peer_do(a, agent_property(Id, host(C))),
    peer_do(a, agent_send(Id, go)),
    ended(a, Id, done),
    steps_at(a, Id, [0]),
    steps_at(c, Id, [2, 3]).

%   After four steps the agent ends there.

got_away_from(Home, Steps) :-
    got_away(Home, Steps, Id),
    (   Steps == 4
    ->  peer_do(c, \+ agent_here(Id))
    ;   peer_do(c, agent_here(Id))
    ),
    maplist(steps_at, [a, b, c], [Id, Id, Id], [[1, 2], [], [4]]).

got_away(Home, Steps, Id) :-
    maplist(peer_host, [a, b, c], [A, B, C]),
    travel(Home, [A, C, A], 3),
    travel(Home, [A, B, C], 3),
    peer_do(b, silence_answers),
    set_out(Home, [A, sit, B, C, sit, A], Steps, Id),
    wait_until(step_on(a, Id, 1), 10),
    peer_do(a, agent_send(Id, go)),
    wait_until(step_on(c, Id, 4), 10),
    wait_until(agent_state(a, Id, in_doubt), 10),
    sort([b, Home], Dead),
    forall(member(Peer, Dead), peer_kill(Peer)),
    forall(member(Peer, Dead), peer_restart(Peer)),
    wait_until(\+ peer_do(a, agent_here(Id)), 20).

:- begin_tests(constant_hops).

test(disposed_agent_does_not_continue) :-
    with_peers([ a-[host([hop_time(uniform(0.005, 0.01))])], b ],
               disposed_while_leaving(24)).
test(agents_hop, forall(member(Goal, [ bounce, namesakes,
                                       stop_under_way(8) ]))) :-
    with_peers([a, b], Goal).

:- end_tests(constant_hops).

%   Large agents leave, and take a while to be encoded; meanwhile they are
%   disposed of. Each then ends on one of the two sides.

disposed_while_leaving(Count) :-
    peer_host(b, B),
    travel(a, [B], 1),
    findall(fact(I), between(1, 2000, I), Facts),
    Program = clauses([ (:- agent(large, [state([fact/1])])),
                        (main :- move(B), receive(_)) ]),
    forall(between(1, Count, I),
           ( peer_do(a, agent_create(Program, Id, [facts(Facts)])),
             Pause is 0.004 + 0.00025*I,
             sleep(Pause),
             peer_do(a, agent_dispose(Id)),
             ended(a, Id, disposed) )),
    wait_until(forall(member(Peer, [a, b]),
                      peer_do(Peer, \+ agent_here(_))), 10),
    peer_do(a, \+ status_here(_)).

%   Twenty agents make a hundred hops each.

bounce :-
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 2),
    findall(Id, ( between(1, 20, _), set_out(a, [B, A], 100, Id) ), Ids),
    forall(member(Id, Ids), ended_done(a, Id, 100)),
    wait_until(forall(member(Peer, [a, b]),
                      peer_do(Peer, \+ agent_here(_))), 10).

%   The first agent ends, the second is disposed of: the third continues.

namesakes :-
    peer_host(a, A),
    peer_host(b, B),
    set_out(a, [B, A, sit], 9, Id1, [name(same)]),
    set_out(a, [B, A, sit], 3, Id2, [name(same)]),
    set_out(b, [A, B, sit], 9, Id3, [name(same)]),
    Id1 \== Id2,
    Id1 \== Id3,
    peer_do(a, agent_send(Id2, go)),
    ended_done(a, Id2, 3),
    peer_do(a, agent_dispose(Id3)),
    ended(b, Id3, disposed),
    forall(between(1, 3, _), peer_do(b, agent_send(Id1, go))),
    ended_done(b, Id1, 9).

%   The host that agents are leaving stops: each agent has left, or has ended.

stop_under_way(Rounds) :-
    peer_host(a, A),
    peer_host(b, B),
    peer_do(a, host_start(a2)),
    travel(a, [B, A], 2),
    forall(between(1, Rounds, _), stop_once(A, B)).

stop_once(A, B) :-
    findall(Id,
            ( between(1, 10, _), set_out(a, [B, A], 1 000 000, Id) ),
            Ids),
    peer_do(a, host_stop(a)),
    forall(member(Id, Ids), accounted_for(Id)),
    forall(( member(Id, Ids), peer_do(b, agent_here(Id)) ),
           ( peer_do(b, agent_dispose(Id)),
             ended(b, Id, disposed) )),
    peer_do(a, host_start(a)).

accounted_for(Id) :-
    wait_until(( \+ peer_do(a, agent_here(Id)),
                 (   peer_do(b, agent_here(Id))
                 ->  \+ peer_do(a, outcome_here(Id, _))
                 ;   peer_do(a, outcome_here(Id, disposed))
                 ) ), 10).
