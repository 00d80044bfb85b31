:- module(test_guests, []).
:- use_module('../../../lib/common', [wait_until/2]).
:- use_module('../../../lib/peers').
:- use_module('../../../lib/travellers').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

/** <module> Agents that arrive from another process

An arriving agent is run by the thread that has read it. An agent that blocks
or never ends keeps no other from arriving or leaving, and its host can be
stopped.

*Threading*: the main thread.
*/

%   The goals of a guest at Host that never end by themselves.

burden(blocks, [ (burden :- message_queue_create(Q),
                            call_cleanup(thread_get_message(Q, _),
                                         message_queue_destroy(Q))) ]).
burden(computes, [ (burden :- between(1, inf, _), fail) ]).
burden(loops, [ (burden :- burden) ]).
burden(walks, [ (burden :- go(b2), go(b), burden),
                (go(Host) :- catch(move(Host), error(_, _), true)) ]).

guest(Host, Kind, Id) :-
    burden(Kind, Clauses),
    peer_agent(a, [ (:- agent(guest, [state([to/1])])),
                    (main :- to(Host), move(Host), burden)
                  | Clauses ], [to(Host)], Id).

came(Id) :-
    peer_do(b, typhon:agent_property(Id, host(Host))),
    sub_atom(Host, 0, 1, _, b).

with_guests(Kind, Count, Goal) :-
    with_peers([ a, b-[setup(set_setting(typhon_hosting:stop_seconds, 0.5))] ],
               guests(Kind, Count, Goal)).

:- meta_predicate with_guests(+, +, 1), guests(+, +, 1).

guests(Kind, Count, Goal) :-
    peer_do(b, host_start(b2)),
    peer_host(b, B),
    findall(Id, ( between(1, Count, _), guest(B, Kind, Id) ), Ids),
    wait_until(forall(member(Id, Ids), came(Id)), 20),
    call(Goal, Ids).

others_travel(Ids) :-
    peer_host(a, A),
    peer_host(b, B),
    travel(a, [B, A], 60),
    travel(b, [A, B], 60),
    peer_do(b, host_stop(b)),
    peer_do(b, host_stop(b2)),
    forall(member(Id, Ids), ended(a, Id, disposed)),
    wait_until(peer_do(b, ( aggregate_all(count, thread_property(_, alias(_)),
                                          Threads),
                            Threads =< 2 )), 60).     % main and gc

:- begin_tests(guests).

test(guests_block_no_others_and_end_with_their_host,
     forall(burden(Kind, _))) :-
    with_guests(Kind, 4, others_travel).
test(guests_survive_a_too_long_answer) :-
    with_peers([ a, b-[setup(set_setting(typhon_session:frame_bytes, 70 000))] ],
               too_long_to_tell).
test(guests_end_when_disposed_of) :-
    with_guests(walks, 2, disposed).

too_long_to_tell :-
    peer_host(b, B),
    peer_do(a, agent_create(clauses([ (:- agent(heavy, [state([load/2])])),
                                      (main :- forall(between(1, 5000, I),
                                                      assertz(load(I, some))),
                                               receive(_-go)) ]),
                            Id, [host(B)])),
    wait_until(peer_do(b, agent_property(Id, state(waiting))), 10),
    peer_try(a, agent_save(Id, '/dev/null'), raised(error(Formal, _))),
    assertion(Formal == resource_error(frame_bytes)),
    wait_until(peer_do(b, agent_property(Id, state(waiting))), 10),
    peer_do(a, agent_send(Id, go)),
    ended(a, Id, done).

disposed(Ids) :-
    forall(member(Id, Ids),
           ( peer_do(a, agent_dispose(Id)),
             ended(a, Id, disposed) )).

:- end_tests(guests).
