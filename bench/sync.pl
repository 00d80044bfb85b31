:- use_module(common).
:- use_module(spent, [spent/4]).
:- use_module(library(typhon)).
:- use_module('../agents/sync/operator', [sequence_start/5]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(assoc), [del_assoc/4, empty_assoc/1, put_assoc/4]).
:- use_module(library(lists),
              [max_member/2, member/2, memberchk/2, nth0/3]).

/*  Synchronised execution at full speed: a grid of 60 hosts, ten agents, six
tasks that do nothing, hops without delay, in one process and in four.

    swipl bench/sync.pl -- unpinned

Most hops of these agents are not services: at delta 0.5 each agent makes 37
visits without a service before it gives up a task.  So the hops of the agents
are counted, and compared with those of agents that only travel, in the same way
and in the same network.  Of several repetitions the fastest counts. */

:- initialization(main, main).

main([_]) :-
    forall(member(Processes, [1, 4]), measure(Processes)).

measure(Processes) :-
    tmp_file(sync, Log),
    setup_call_cleanup(
        network_start(grid(6, 10), Network,
                      [processes(Processes), seed(1), log(Log)]),
        ( network_property(Network, hosts(Hosts)),
          bare(Hosts, _, _),            % warm up
          findall(Rate-Cpu,
                  ( between(1, 4, _), bare(Hosts, Rate, Cpu) ), Bares),
          findall(Run, ( between(1, 4, I), sequence(I, Hosts, Run) ), Runs)
        ),
        network_stop(Network)),
    log_events(Log, Events),
    delete_file(Log),
    maplist(rated(Events), Runs, Rated),
    max_member(Best, Rated),
    max_member(Bare, Bares),
    report(Processes, Best, Bare),
    waiting(Processes, Events).

report(Processes, Services-run(Hops, HopRate, Cpu), BareRate-BareCpu) :-
    PerService is Hops/360,
    print_figure(Processes, 'services per second', Services, '1/s'),
    print_figure(Processes, 'hops per service', PerService, hops),
    print_figure(Processes, 'hops per second', HopRate, '1/s'),
    print_figure(Processes, 'processor time of a hop', Cpu, us),
    name(Processes, 'a hop against one of bare travellers', Name1),
    ratio(Name1, BareRate, HopRate, '1/s', 'bare travellers'),
    name(Processes, 'its processor time against theirs', Name2),
    ratio(Name2, Cpu, BareCpu, us, 'bare travellers').

print_figure(Processes, What, Value, Unit) :-
    name(Processes, What, Name),
    figure(Name, Value, Unit).

name(Processes, What, Name) :-
    format(atom(Name), 'sync, ~d processes: ~w', [Processes, What]).

                /*******************************
                *           MEASURES           *
                *******************************/

%   bare(+Hosts, -Rate, -Cpu): ten agents that only travel.

bare(Hosts, Rate, Cpu) :-
    seconds(spent(Hosts, wander(Hosts), Hops, Cpu), Seconds),
    Rate is Hops / Seconds.

wander(Hosts) :-
    findall(Agent,
            ( between(1, 10, I),
              Index is I * 5,
              nth0(Index, Hosts, Host),
              wanderer(Program),
              agent_create(Program, Agent,
                           [host(Host), facts([left(200)])])
            ),
            Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, 120)).

wanderer(clauses([ (:- agent(wanderer, [state([left/1])])),
                   (main :- left(0), !),
                   (main :- retract(left(N)), N1 is N-1, assertz(left(N1)),
                            next_host(conscientious, Host), move(Host),
                            main) ])).

%   sequence(+I, +Hosts, -Run): Run is run(Sequence, Agents, Hops, Cpu).

sequence(I, Hosts, run(Sequence, Agents, Hops, Cpu)) :-
    atom_concat(bench, I, Sequence),
    findall(Task-true, between(1, 6, Task), Tasks),
    spent(Hosts,
          ( sequence_start(Sequence, Hosts, Tasks, [seed(I)], Agents),
            forall(member(Agent, Agents), agent_join(Agent, done, 120))
          ), Hops, Cpu).

%   The log has the times: services per second until the last service is
%   completed, hops per second until the last agent has ended.

rated(Events, run(Sequence, Agents, Hops, Cpu),
      Services-run(Hops, HopRate, Cpu)) :-
    aggregate_all(min(T), ( member(event(T, _, Agent, begun), Events),
                            memberchk(Agent, Agents) ), Begin),
    aggregate_all(r(count, max(T)),
                  member(event(T, _, _, completed(Sequence, _)), Events),
                  r(Count, End)),
    aggregate_all(max(T), ( member(event(T, _, Agent, _), Events),
                            memberchk(Agent, Agents) ), Last),
    Services is Count / (End - Begin),
    HopRate is Hops / (Last - Begin).

%   The latency of the worker's message: from the reward, which follows it in
%   the agent, to the end of the task.  If the worker was faster than the
%   agent's own next step it cannot be measured.

waiting(Processes, Events) :-
    empty_assoc(None),
    foldl(wait, Events, None-[], _-Waits),
    msort(Waits, Sorted),
    length(Sorted, Count),
    Middle is Count // 2,
    nth0(Middle, Sorted, Median),
    Micro is Median * 1.0e6,
    print_figure(Processes, 'from service to completion, median', Micro, us).

wait(event(Time, Host, _, reward(_, _, _)), Since0-Waits, Since-Waits) :-
    !,
    put_assoc(Host, Since0, Time, Since).
wait(event(Time, Host, _, completed(_, _)), Since0-Waits,
     Since-[Wait|Waits]) :-
    del_assoc(Host, Since0, Begin, Since),
    !,
    Wait is Time - Begin.
wait(_, State, State).
