:- module(simulation_model,
          [ simulate/2,                 % +Options, -Run
            steps_to_zero/3             % +Reading, +Delta, -Steps
          ]).
:- use_module(reading,
              [ reading_full/1, reading_revived/3, reading_step/5 ]).
:- use_module('../../prolog/typhon/chance',
              [ chance_below/4, chance_member/4, chance_seed/2,
                chance_uniform/5 ]).
:- use_module('../../prolog/typhon/dynamics',
              [ dynamics_event/4, dynamics_model/2, dynamics_state/5 ]).
:- use_module('../../prolog/typhon/strategy',
              [ next_host/6, strategy_memory/2 ]).
:- use_module('../../prolog/typhon/topology', [topology_edges/4]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(heaps),
              [ add_to_heap/4, get_from_heap/4, list_to_heap/2 ]).
:- use_module(library(lists),
              [ last/2, member/2, nth1/3, numlist/3, reverse/2,
                selectchk/3 ]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(ordsets), [ord_add_element/3, ord_del_element/3]).

/** <module> Algorithm 2 of the thesis, simulated

The same as agents/sync/traveller.pl does in a network, by events on a
queue instead of hops of agents: the equations are those of the agents (see
simulation_reading), the strategy, the topologies and the dynamic links are
those of the platform. There is no platform below, so hops and tasks take
exactly as long as is drawn for them, and a run of a minute is over in a
tenth of a second.

The only events are arrivals of agents. A host is a term
host(Free, Last, Done): until Free it executes the task Last; bit T of Done
is set when task T was begun there. An agent is a term
agent(Host, Memory, Drives), Drives a term with an argument for each task.

*Threading*: pure from outside. Inside, terms of the run are changed by
setarg/3.
*/

%!  simulate(+Options, -Run) is det.
%
%   Run is run(Executions, Ended, Hops, Penalties): Executions a list of
%   execution(Task, Host, Start, End) in the order of Start, Hosts and
%   tasks being numbers from 1; Ended is `true` if all agents had ended
%   before the limit; Hops and Penalties are what all agents had together.
%   Options:
%
%     - topology(T), agents(N), tasks(M), delta(D), seed(S)
%     - hop_time(Min-Max)
%       Host seconds; Max is above 0.
%     - task_time(Time)
%       Time is a number of host seconds, a range Min-Max, or a list of
%       these, one for each task. Default 1.
%     - links(Model)
%       Of typhon_dynamics, or `static`, the default.
%     - reading(Reading)
%       See simulation_reading; default `chosen`.
%     - service(Service)
%       `exclusive`, the default: a host that executes is passed.
%       `printed`: as Algorithm 2 is printed, a host is serviced again for
%       the task it is executing.
%     - limit(Seconds)
%       Host seconds after which the run is broken off; default 10,000.
%
%   @error domain_error(hop_time, X), and those of topology_edges/4 and
%   dynamics_model/2

simulate(Options, run(Executions, Ended, Hops, Penalties)) :-
    option(seed(Seed), Options),
    rules(Options, Rules),
    network(Options, Seed, N, Links, Changes),
    hosts(N, Hosts),
    chance_seed(Seed, Chance0),
    agents(Options, N, Agents, Queue, Chance0, Chance),
    World = world(Rules, Hosts, Agents, Links),
    events(Queue, World, state(Chance, Changes, [], 0, 0),
           state(_, _, Reversed, Hops, Penalties), Ended),
    reverse(Reversed, Executions).

rules(Options, rules(Reading, Delta, Service, Hop, Times, Limit)) :-
    option(delta(Delta), Options),
    option(hop_time(Hop), Options),
    check_hop_time(Hop),
    option(task_time(Times), Options, 1),
    option(reading(Reading), Options, chosen),
    option(service(Service), Options, exclusive),
    option(limit(Limit), Options, 10000).

check_hop_time(Min-Max) :-
    number(Min), number(Max),
    0 =< Min, Min =< Max, 0 < Max,
    !.
check_hop_time(Hop) :-
    domain_error(hop_time, Hop).

                /*******************************
                *          BEGINNING           *
                *******************************/

network(Options, Seed, N, Links, Changes) :-
    option(topology(Topology), Options),
    topology_edges(Topology, Seed, N, Edges),
    functor(Links, links, N),
    neighbours(N, Edges, Links),
    option(links(Model), Options, static),
    changes(Model, N, Edges, Seed, Changes).

neighbours(N, Edges, Links) :-
    numlist(1, N, Hosts),
    foldl(host_neighbours(Edges), Hosts, Links, Links).

host_neighbours(Edges, Host, Links, Links) :-
    findall(Other, ( member(Host-Other, Edges)
                   ; member(Other-Host, Edges)
                   ), Others0),
    sort(Others0, Others),
    arg(Host, Links, Others).

changes(static, _, _, _, none) :-
    !.
changes(Name, N, Edges, Seed, Changes) :-
    dynamics_model(Name, Model),
    dynamics_state(Model, N, Edges, Seed, State),
    next_changes(State, Changes).

next_changes(State0, changes(Time, Changes, State)) :-
    dynamics_event(State0, Time, Changes, State).

hosts(N, Hosts) :-
    functor(Hosts, hosts, N),
    all_arguments(N, Hosts, host(0, 0, 1)).

all_arguments(0, _, _) :-
    !.
all_arguments(I, Term, Value) :-
    arg(I, Term, Value),
    I1 is I - 1,
    all_arguments(I1, Term, Value).

%   The agents start on different hosts while there are any, at time 0.

agents(Options, N, Agents, Queue, Chance0, Chance) :-
    option(agents(Count), Options),
    option(tasks(Tasks), Options),
    functor(Agents, agents, Count),
    numlist(1, Count, Numbers),
    numlist(1, N, Hosts),
    foldl(agent(Tasks, Agents, Hosts), Numbers, Hosts-Chance0, _-Chance),
    findall(0-Agent, member(Agent, Numbers), Pairs),
    list_to_heap(Pairs, Queue).

agent(Tasks, Agents, Hosts, Number, []-Chance0, Left) :-
    !,
    agent(Tasks, Agents, Hosts, Number, Hosts-Chance0, Left).
agent(Tasks, Agents, _, Number, Free0-Chance0, Free-Chance) :-
    chance_member(Host, Free0, Chance0, Chance1),
    selectchk(Host, Free0, Free),
    chance_below(0x40000000, Seed, Chance1, Chance),
    strategy_memory(Seed, Memory),
    functor(Drives, drives, Tasks),
    reading_full(Full),
    all_arguments(Tasks, Drives, Full),
    arg(Number, Agents, agent(Host, Memory, Drives)).

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
    ->  change_links(Now, World, State0, State1),
        visit(Now, Agent, Task, World, State1, State2),
        travel(Agent, World, Wait, State2, State),
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

decide(exclusive, Now, host(Free, _, _), _, pass) :-
    Now < Free,
    !.
decide(printed, Now, host(Free, Last, _), Task, service(Last)) :-
    Now < Free,
    Last =< Task,
    !.
decide(_, _, host(_, _, Done), Task, What) :-
    Missing is msb(\Done /\ (Done + 1)),
    (   Missing =< Task
    ->  What = service(Missing)
    ;   What = penalty
    ).

act(pass, _, _, _, _, State, State).
act(penalty, _, Agent, Task, world(Rules, _, _, _), State0, State) :-
    State0 = state(Chance, Changes, Executions, Hops, Penalties0),
    Penalties is Penalties0 + 1,
    State = state(Chance, Changes, Executions, Hops, Penalties),
    step(penalty, Task, Agent, Rules).
act(service(Missing), Now, Agent, Task, World, State0, State) :-
    World = world(Rules, Hosts, _, _),
    State0 = state(Chance0, Changes, Executions, Hops, Penalties),
    State = state(Chance, Changes, [Execution|Executions], Hops, Penalties),
    Agent = agent(Here, _, Drives),
    Rules = rules(_, _, _, _, Times, _),
    duration(Times, Missing, Duration, Chance0, Chance),
    End is Now + Duration,
    Execution = execution(Missing, Here, Now, End),
    execute(Here, Hosts, Missing, Now, End),
    revive(Missing, Task, Drives),
    step(reward, Missing, Agent, Rules).

%   Of two executions of one task at the same time, which only Service =
%   `printed` makes, the first to end completes the task.

execute(Here, Hosts, Task, Now, End) :-
    arg(Here, Hosts, host(Free0, Last, Done0)),
    (   Last =:= Task,
        Now < Free0
    ->  Free is min(Free0, End)
    ;   Free = End
    ),
    Done is Done0 \/ (1 << Task),
    setarg(Here, Hosts, host(Free, Task, Done)).

duration(Times, Task, Duration, Chance0, Chance) :-
    is_list(Times),
    !,
    nth1(Task, Times, Time),
    duration(Time, Task, Duration, Chance0, Chance).
duration(Min-Max, _, Duration, Chance0, Chance) :-
    !,
    chance_uniform(Min, Max, Duration, Chance0, Chance).
duration(Duration, _, Duration, Chance, Chance).

revive(Task, Task, _) :-
    !.
revive(Missing, Task, Drives) :-
    arg(Task, Drives, drive(_, History)),
    last(History, Theta),
    arg(Missing, Drives, Drive),
    reading_revived(Drive, Theta, Revived),
    setarg(Missing, Drives, Revived).

step(What, Task, agent(_, _, Drives), rules(Reading, Delta, _, _, _, _)) :-
    arg(Task, Drives, Drive0),
    reading_step(Reading, What, Delta, Drive0, Drive),
    setarg(Task, Drives, Drive).

                /*******************************
                *            TRAVEL            *
                *******************************/

%   An isolated agent looks again after a second.

travel(Agent, world(Rules, _, _, Links), Wait, State0, State) :-
    State0 = state(Chance0, Changes, Executions, Hops0, Penalties),
    Agent = agent(Here, Memory0, _),
    arg(Here, Links, Neighbours),
    (   next_host(conscientious, Neighbours, Here, Memory0, There, Memory)
    ->  setarg(1, Agent, There),
        setarg(2, Agent, Memory),
        Rules = rules(_, _, _, Min-Max, _, _),
        chance_uniform(Min, Max, Wait, Chance0, Chance),
        Hops is Hops0 + 1,
        State = state(Chance, Changes, Executions, Hops, Penalties)
    ;   Wait = 1,
        State = State0
    ).

change_links(Now, World, State0, State) :-
    State0 = state(Chance, changes(Time, Changes, Later0), Executions, Hops,
                   Penalties),
    Time =< Now,
    !,
    World = world(_, _, _, Links),
    foldl(change_link, Changes, Links, Links),
    next_changes(Later0, Later),
    change_links(Now, World,
                 state(Chance, Later, Executions, Hops, Penalties), State).
change_links(_, _, State, State).

change_link(link(A, B), Links, Links) :-
    change_end(ord_add_element, A, B, Links),
    change_end(ord_add_element, B, A, Links).
change_link(unlink(A, B), Links, Links) :-
    change_end(ord_del_element, A, B, Links),
    change_end(ord_del_element, B, A, Links).

change_end(Change, A, B, Links) :-
    arg(A, Links, Others0),
    call(Change, Others0, B, Others),
    setarg(A, Links, Others).

                /*******************************
                *            DECAY             *
                *******************************/

%!  steps_to_zero(+Reading, +Delta, -Steps) is semidet.
%
%   So many penalties, and no reward, take a full potential to zero. Fails
%   if 10,000 do not.

steps_to_zero(Reading, Delta, Steps) :-
    reading_full(Drive),
    steps_to_zero(Drive, Reading, Delta, 0, Steps).

steps_to_zero(drive(Potential, _), _, _, Steps, Steps) :-
    Potential =:= 0,
    !.
steps_to_zero(Drive0, Reading, Delta, Steps0, Steps) :-
    Steps0 < 10000,
    reading_step(Reading, penalty, Delta, Drive0, Drive),
    Steps1 is Steps0 + 1,
    steps_to_zero(Drive, Reading, Delta, Steps1, Steps).
