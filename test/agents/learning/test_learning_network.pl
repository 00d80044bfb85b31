:- module(test_learning_network, []).
:- use_module('../../lib/common').
:- use_module('../../lib/texts', [write_file/3]).
:- use_module('../../lib/networks').
:- use_module('../../lib/event_log', [logged/2]).

:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(typhon)).
:- use_module('../../../agents/learning/operator').

:- discontiguous payload/2.
payload(_, _).
:- include('../../../payloads/learning/maze').

/** <module> Agents that learn the maze on small networks

Their solutions are executed in a maze of this process.
*/

:- dynamic setting/2.

setting(size, 5).

:- meta_predicate network(+, +, -, -, 0).

network(Topology, Options, Hosts, File, Goal) :-
    with_logged_network(Topology, [clock(100), seed(1)|Options],
                        Hosts, File, Goal, _).

learn(Hosts, Options, Agents) :-
    learn(Hosts, [], Options, Agents).

%   Settings precede those that make journeys short.

learn(Hosts, Settings0, Options, Agents) :-
    append(Settings0, [size-5, rho_max-4], Settings),
    learning_start(Hosts, payloads(learning/maze),
                   [payloads(learning/greedy)],
                   [seed(1), settings(Settings)|Options], Agents).

all_end(Agents) :-
    forall(member(Agent, Agents), agent_join(Agent, done, 60)).

%   await(+File, +Pattern): waits until an event that matches Pattern is
%   logged.

await(File, Event) :-
    wait_until(( logged(File, Events), memberchk(Event, Events) ), 30).

%   at_least(+File, +Event, +Count): at least Count such events are logged.

at_least(File, Event, Count) :-
    wait_until(( logged(File, Events),
                 aggregate_all(count, member(Event, Events), Found),
                 Found >= Count ), 60).

%   The path that an agent has found at the end.

converged(Events, Agent) :-
    member(event(_, _, Agent, converged(Count, Hops, Actions)), Events),
    Count > 0,
    Hops >= 5,
    start(none, State0),
    foldl(act, Actions, State0, State),
    reached(State).

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(learning_network).

test(three_agents_in_two_processes) :-
    network(mesh(4), [processes(2)], Hosts, File,
        ( learn(Hosts, [agents(3)], Agents),
          all_end(Agents),
          at_least(File, event(_, _, _, converged(_, _, _)), 3),
          logged(File, Events),
          maplist(converged(Events), Agents),
          memberchk(event(_, _, _, shared(_, _)), Events),
          executing_processes(Events, [_, _]) )).
test(one_agent_alone) :-
    network(ring(3), [], Hosts, File,
        ( learn(Hosts, [agents(1)], [Agent]),
          all_end([Agent]),
          await(File, event(_, _, _, converged(_, _, _))),
          logged(File, Events),
          converged(Events, Agent),
          \+ memberchk(event(_, _, _, shared(_, _)), Events) )).
test(without_sharing_no_units_are_exchanged) :-
    network(mesh(3), [], Hosts, File,
        ( learn(Hosts, [size-3, sharing-false], [agents(3)], Agents),
          all_end(Agents),
          at_least(File, event(_, _, _, converged(_, _, _)), 3),
          logged(File, Events),
          \+ memberchk(event(_, _, _, shared(_, _)), Events) )).
test(full_queue) :-
    network(mesh(3), [hosts([capacity(2)])], Hosts, File,
            full_queue(Hosts, File)).

%   At A, which has lost its link, the agent retries until it succeeds.

test(isolated_host) :-
    network(edges([a-b, b-c]), [], [A, B, C], File,
        ( unlink(A, B),
          learn([A, B, C], [size-3], [agents(1), starts([A])], [Learner]),
          await(File, event(_, A, Learner, executed(1, _, _, _))),
          wait_until(lingers(Learner, First), 20),
          wait_until(( lingers(Learner, Second), Second > First ), 20),
          agent_property(Learner, hops(0)),
          link(A, B),
          all_end([Learner]),
          await(File, event(_, _, Learner, converged(_, _, _))) )).
test(peer_is_disposed_of) :-
    network(edges([a-b]), [], [A, B], File,
        ( mute(B, B, Mute),
          await(File, event(_, B, Mute, ready)),
          learn([A, B], [size-3], [agents(1), starts([A])], [Learner]),
          await(File, event(_, B, Mute, asked)),
          agent_dispose(Mute),
          all_end([Learner]),
          \+ remote(B, sense(queued(_))) )).

%   The first agent is queried before its process is killed, the second after.

test(peer_is_in_a_process_that_is_killed) :-
    network(edges([a-b, b-c, c-d]), [processes(2)], [A, B, C, _], File,
        ( mute(B, C, Mute1),
          await(File, event(_, C, Mute1, ready)),
          mute(B, C, Mute2),
          await(File, event(_, C, Mute2, ready)),
          process_of(C, Pid),
          learn([A, B], [size-3], [agents(1), starts([A])], [Learner]),
          await(File, event(_, C, Mute1, asked)),
          process_kill(Pid, kill),
          all_end([Learner]),
          \+ remote(B, sense(queued(_))),
          logged(File, Events),
          \+ memberchk(event(_, _, Mute2, asked), Events) )).

%   First an algorithm that never plans anything, then the original one.

test(algorithm_is_exchanged) :-
    network(mesh(3), [], Hosts, File,
        ( learn(Hosts, [size-20], [agents(3)], Agents),
          Planned = event(_, _, _, executed(_, Length, _, _)),
          wait_until(( logged(File, Events0), member(Planned, Events0),
                       Length > 0 ), 30),
          with_tmp_dir(to_idle_and_back(Agents, File)),
          forall(member(Agent, Agents), agent_dispose(Agent)) )).
test(algorithm_is_removed) :-
    network(mesh(3), [], Hosts, File,
        ( learn(Hosts, [agents(2)], Agents),
          forall(member(Agent, Agents), payload_detach(Agent, greedy)),
          maplist(assimilates, Agents),
          logged(File, Events0),
          count_executed(Events0, Count0),
          maplist(assimilates, Agents),
          logged(File, Events1),
          count_executed(Events1, Count0),
          forall(member(Agent, Agents),
                 payload_attach(Agent, payloads(learning/greedy))),
          all_end(Agents),
          at_least(File, event(_, _, _, converged(_, _, _)), 2) )).
test(no_second_trainer) :-
    network(ring(3), [], Hosts, _,
        ( learn(Hosts, [agents(0)], []),
          learn(Hosts, [agents(0)], []),
          forall(member(Host, Hosts), remote(Host, host_load(1))) )).
test(algorithms_in_turn) :-
    network(mesh(3), [], Hosts, File,
        ( with_tmp_dir(Dir,
              ( atom_concat(Dir, '/idle.pl', Idle),
                write_idle(Idle),
                learning_start(Hosts, payloads(learning/maze),
                               [payloads(learning/greedy), Idle],
                               [agents(4), settings([size-50])], Agents) )),
          findall(Name, ( member(Agent, Agents),
                          agent_property(Agent, payloads([Name])) ), Names),
          Names == [greedy, idle, greedy, idle],
          await(File, event(_, _, _, executed(2, _, _, _))) )).
test(no_hosts, error(domain_error(hosts, []))) :-
    learn([], [agents(1)], _).

executing_processes(Events, Endpoints) :-
    findall(Endpoint,
            ( member(event(_, Host, _, executed(_, _, _, _)), Events),
              atomic_list_concat([_, Endpoint], @, Host) ),
            Endpoints0),
    sort(Endpoints0, Endpoints).

%   B has capacity for one agent besides the trainer. No plan is executed there
%   until the agent at B has left.

full_queue([A, B, C], File) :-
    learn([A, B, C], [agents(0)], []),
    lodger(B, Lodger),
    learn([A, B, C], [size-50], [agents(1), starts([A])], [Learner]),
    at_least(File, event(_, _, Learner, executed(_, _, _, _)), 5),
    agent_property(Learner, hops(Hops)),
    Hops >= 20,                         % between A and C, then
    logged(File, Events),
    \+ memberchk(event(_, B, Learner, _), Events),
    agent_dispose(Lodger),
    await(File, event(_, B, Learner, executed(_, _, _, _))),
    agent_dispose(Learner).

lodger(Host, Agent) :-
    agent_create(clauses([ (:- agent(lodger)),
                           (main :- receive(_-go)) ]),
                 Agent, [host(Host)]).

lingers(Agent, Until) :-
    agent_property(Agent, goals(Goals)),
    sub_term(Sub, Goals),
    nonvar(Sub),
    Sub = receive_until(_, Until, _),
    !.

%   mute(+Host, +Where, -Agent): an agent that waits in the queue of Host,
%   moves on to Where without notice, reports its host when asked, and does not
%   answer.

mute(Host, Where, Agent) :-
    agent_create(clauses([ (:- agent(mute)),
                           (main :- self(Me), leave(queued(Me)), move(Where),
                                    log(ready), receive(_-share(_)),
                                    log(asked), receive(_-never)) ]),
                 Agent, [host(Host)]).

process_of(Host, Pid) :-
    remote(Host, current_prolog_flag(pid, Pid)).

to_idle_and_back(Agents, File, Dir) :-
    atom_concat(Dir, '/idle.pl', Idle),
    write_idle(Idle),
    learning_exchange(Agents, greedy, Idle),
    forall(member(Agent, Agents), unplanned(File, Agent, 2)),
    learning_exchange(Agents, idle, payloads(learning/greedy)),
    forall(member(Agent, Agents), planned(File, Agent)).

write_idle(File) :-
    write_file(File, ':- payload(idle, [provides([plan/3, better/2])]).~n\c
                      plan(_, _, []).~nbetter(_, _) :- fail.~n', []).

%   The last Count executions had no plan; the last one had.

unplanned(File, Agent, Count) :-
    wait_until(( lengths(File, Agent, Lengths),
                 length(Last, Count),
                 append(Begin, Last, Lengths),
                 Begin = [_|_],
                 maplist(==(0), Last) ), 60).

planned(File, Agent) :-
    wait_until(( lengths(File, Agent, Lengths),
                 last(Lengths, Length),
                 Length > 0 ), 60).

lengths(File, Agent, Lengths) :-
    logged(File, Events),
    findall(Length,
            member(event(_, _, Agent, executed(_, Length, _, _)), Events),
            Lengths).

count_executed(Events, Count) :-
    aggregate_all(count,
                  member(event(_, _, _, executed(_, _, _, _)), Events),
                  Count).

%   The agent pauses before it assimilates again.

assimilates(Agent) :-
    wait_until(( agent_property(Agent, goals(Goals)),
                 last(Goals, assimilator) ), 30).

:- end_tests(learning_network).
