:- module(simulation_model,
          [ simulate/2                  % +Options, -Run
          ]).
:- use_module(failure, [failure_trace/6]).
:- use_module(reading,
              [ reading_full/1, reading_revived/3, reading_step/5 ]).
:- use_module(world,
              [ world_agents/6, world_change/4, world_hosts/2,
                world_network/5 ]).
:- use_module('../../prolog/typhon/base/chance',
              [ chance_seed/2, chance_uniform/5 ]).
:- use_module('../../prolog/typhon/language/strategy', [next_host/6]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(heaps), [add_to_heap/4, get_from_heap/4]).
:- use_module(library(lists), [last/2, nth1/3, reverse/2, selectchk/3]).
:- use_module(library(option), [option/2, option/3]).

/** <module> Algorithm 2 of the thesis, simulated

The same as agents/sync/traveller.pl does in a network, by events on a
queue instead of hops of agents: the equations are those of the agents (see
simulation_reading), the strategy, the topologies and the dynamic links are
those of the platform. There is no platform below, so hops and tasks take
exactly as long as is drawn for them, and a run of a minute is over in a
tenth of a second.

The only events are arrivals of agents. A host is a term
host(Free, Last, Done, Failed): until Free it executes the task Last; bit T
of Done is set when task T was begun there, and T-First is in Failed when it
was lost by a failure that began with First. An agent is a term
agent(Host, Memory, Drives), Drives a term with an argument for each task.

*Threading*: pure from outside. Inside, terms of the run are changed by
setarg/3.
*/

%!  simulate(+Options, -Run) is det.
%
%   Run is run(Executions, Failures, Ended, Hops, Penalties): Executions a
%   list of execution(Task, Host, Start, End) in the order of Start, of
%   those that were completed; Failures a list of failure(Time, Host,
%   Task); hosts and tasks are numbers from 1. Ended is `true` if all agents
%   had ended before the limit; Hops and Penalties are what all agents had
%   together.
%   Options:
%
%     - topology(T), agents(N), tasks(M), delta(D), seed(S)
%     - hop_time(Min-Max)
%       Host seconds; Max is above 0.
%     - task_time(Time)
%       Time is a number of host seconds, a range Min-Max, or a list of
%       these, one for each task. Default 1.
%     - dynamic(Model)
%       Of typhon_dynamics, or `none`, the default.
%     - failure(Failure)
%       atomic(Task, N, During): N hosts lose Task when During begins.
%       cascaded(Task, N, During): and with it all later ones. Default
%       `none`.
%     - reading(Reading)
%       See simulation_reading; default `chosen`.
%     - service(Service)
%       `exclusive`, the default: a host that executes is passed.
%       `printed`: as Algorithm 2 is printed, a host is serviced again for
%       the task it is executing.
%     - starts(Starts)
%       `drawn`, the default, or `even`: every so many hosts.
%     - strategy(Strategy)
%       Of typhon_strategy, or `orderly`: see simulation_world. Default
%       `conscientious`.
%     - limit(Seconds)
%       Host seconds after which the run is broken off; default 10,000.
%
%   @error domain_error(hop_time, X), and those of topology_edges/4 and
%   dynamics_model/2

simulate(Options, run(Executions, Failures, Ended, Hops, Penalties)) :-
    option(seed(Seed), Options),
    rules(Options, Rules),
    world_network(Options, Seed, N, Links, Changes),
    world_hosts(N, Hosts),
    chance_seed(Seed, Chance0),
    world_agents(Options, N, Agents, Queue, Chance0, Chance),
    World = world(Rules, Hosts, Agents, Links),
    option(failure(Failure), Options, none),
    events(Queue, World,
           state(Chance, Changes, trace([], Failure, []), 0, 0),
           state(_, _, trace(Reversed, _, Failures), Hops, Penalties),
           Ended),
    reverse(Reversed, Executions).

rules(Options, rules(Reading, Delta, Service, Strategy-Hop, Times, Limit)) :-
    option(delta(Delta), Options),
    option(hop_time(Hop), Options),
    check_hop_time(Hop),
    option(task_time(Times), Options, 1),
    option(reading(Reading), Options, chosen),
    option(service(Service), Options, exclusive),
    option(strategy(Strategy), Options, conscientious),
    option(limit(Limit), Options, 10000).

check_hop_time(Min-Max) :-
    number(Min), number(Max),
    0 =< Min, Min =< Max, 0 < Max,
    !.
check_hop_time(Hop) :-
    domain_error(hop_time, Hop).

                /*******************************
                *            EVENTS            *
                *******************************/

events(Queue0, World, State0, State, Ended) :-
    get_from_heap(Queue0, Now, Number, Queue),
    !,
    World = world(rules(_, _, _, _, _, Limit), _, _, _),
    (   Now > Limit
    ->  Ended = false,
        State = State0
    ;   arrival(Now, Number, World, Queue, Queue1, State0, State1),
        events(Queue1, World, State1, State, Ended)
    ).
events(_, _, State, State, true).

%   An agent without potential has ended: it does not return to the queue.

arrival(Now, Number, World, Queue0, Queue, State0, State) :-
    World = world(_, _, Agents, _),
    arg(Number, Agents, Agent),
    Agent = agent(_, _, Drives),
    (   current(Drives, Task)
    ->  visit(Now, Agent, Task, World, State0, State1),
        travel(Now, Agent, World, Wait, State1, State),
        Next is Now + Wait,
        add_to_heap(Queue0, Next, Number, Queue)
    ;   Queue = Queue0,
        State = State0
    ).

%   The task it searches for: the first that has potential left.

current(Drives, Task) :-
    arg(Task, Drives, drive(Potential, _)),
    Potential =\= 0,
    !.

visit(Now, Agent, Task, World, State0, State) :-
    World = world(Rules, Hosts, _, _),
    arg(1, Agent, Here),
    arg(Here, Hosts, Host),
    Rules = rules(_, _, Service, _, _, _),
    decide(Service, Now, Host, Task, What),
    act(What, Now, Agent, Task, World, State0, State).

%   decide(+Service, +Now, +Host, +Task, -What): what an agent that searches
%   for Task does at Host.  The lowest bit not set in Done is the first task
%   missing there.

decide(exclusive, Now, host(Free, _, _, _), _, pass) :-
    Now < Free,
    !.
decide(printed, Now, host(Free, Last, _, _), Task, service(Last)) :-
    Now < Free,
    Last =< Task,
    !.
decide(_, _, host(_, _, Done, _), Task, What) :-
    Missing is msb(\Done /\ (Done + 1)),
    (   Missing =< Task
    ->  What = service(Missing)
    ;   What = penalty
    ).

act(pass, _, _, _, _, State, State).
act(penalty, _, Agent, Task, world(Rules, _, _, _), State0, State) :-
    State0 = state(Chance, Changes, Trace, Hops, Penalties0),
    Penalties is Penalties0 + 1,
    State = state(Chance, Changes, Trace, Hops, Penalties),
    step(penalty, Task, Agent, Rules).
act(service(Missing), Now, Agent, Task, World, State0, State) :-
    World = world(Rules, Hosts, _, _),
    State0 = state(Chance0, Changes, Trace0, Hops, Penalties),
    State = state(Chance, Changes, Trace, Hops, Penalties),
    Agent = agent(Here, _, Drives),
    Rules = rules(_, _, _, _, Times, _),
    heal(Here, Hosts, Missing, Task, Drives),
    (   current(Drives, Next),
        Next =:= Missing
    ->  duration(Times, Missing, Duration, Chance0, Chance1),
        End is Now + Duration,
        execute(Here, Hosts, Missing, Now, End),
        step(reward, Missing, Agent, Rules),
        failure_trace(execution(Missing, Here, Now, End), Hosts, Trace0,
                      Trace, Chance1, Chance)
    ;   Trace = Trace0,
        Chance = Chance0
    ).

%   Of two executions of one task at the same time, which only Service =
%   `printed` makes, the first to end completes the task.

execute(Here, Hosts, Task, Now, End) :-
    arg(Here, Hosts, host(Free0, Last, Done0, Failed0)),
    (   Last =:= Task,
        Now < Free0
    ->  Free is min(Free0, End)
    ;   Free = End
    ),
    Done is Done0 \/ (1 << Task),
    (   selectchk(Task-_, Failed0, Failed)
    ->  true
    ;   Failed = Failed0
    ),
    setarg(Here, Hosts, host(Free, Task, Done, Failed)).

duration(Times, Task, Duration, Chance0, Chance) :-
    is_list(Times),
    !,
    nth1(Task, Times, Time),
    duration(Time, Task, Duration, Chance0, Chance).
duration(Min-Max, _, Duration, Chance0, Chance) :-
    !,
    chance_uniform(Min, Max, Duration, Chance0, Chance).
duration(Duration, _, Duration, Chance, Chance).

%   What an agent that searches for Task does when it finds Missing; see
%   heal/2 of the travelling agents.

heal(Here, Hosts, Missing, Task, Drives) :-
    arg(Here, Hosts, host(_, _, _, Failed)),
    memberchk(Missing-Root, Failed),
    once(( Root =:= Missing ; Missing =\= Task )),
    !,
    reading_full(Full),
    functor(Drives, _, Last),
    refill(Last, Root, Task, Full, Drives).
heal(_, _, Task, Task, _) :-
    !.
heal(_, _, Missing, Task, Drives) :-
    arg(Task, Drives, drive(_, History)),
    last(History, Theta),
    arg(Missing, Drives, Drive),
    reading_revived(Drive, Theta, Revived),
    setarg(Missing, Drives, Revived).

%   refill(+Next, +Root, +Task, +Full, +Drives): all tasks behind Root, and
%   Root if it is not the one searched for.

refill(Root, Root, Task, Full, Drives) :-
    !,
    (   Root =:= Task
    ->  true
    ;   setarg(Root, Drives, Full)
    ).
refill(Next, Root, Task, Full, Drives) :-
    setarg(Next, Drives, Full),
    Next1 is Next - 1,
    refill(Next1, Root, Task, Full, Drives).

step(What, Task, agent(_, _, Drives), rules(Reading, Delta, _, _, _, _)) :-
    arg(Task, Drives, Drive0),
    reading_step(Reading, What, Delta, Drive0, Drive),
    setarg(Task, Drives, Drive).

                /*******************************
                *            TRAVEL            *
                *******************************/

%   An isolated agent looks again after a second.

travel(Now, Agent, world(Rules, _, _, Links), Wait, State0, State) :-
    State0 = state(Chance0, Changes0, Trace, Hops0, Penalties),
    State = state(Chance, Changes, Trace, Hops, Penalties),
    Agent = agent(Here, Memory0, _),
    world_change(Now, Links, Changes0, Changes),
    arg(Here, Links, Neighbours),
    Rules = rules(_, _, _, Strategy-(Min-Max), _, _),
    (   next_host(Strategy, Neighbours, Here, Memory0, There, Memory)
    ->  setarg(1, Agent, There),
        setarg(2, Agent, Memory),
        chance_uniform(Min, Max, Wait, Chance0, Chance),
        Hops is Hops0 + 1
    ;   Wait = 1,
        Chance = Chance0,
        Hops = Hops0
    ).
