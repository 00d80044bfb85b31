:- module(typhon_plan,
          [ network_plan/3,             % +Topology, +Options, -Plan
            plan_option/2,              % +Plan, ?Option
            plan_time/2,                % +Plan, -Kind
            plan_log/3,                 % +Plan, -File, -Kinds
            plan_processes/3,           % +Plan, -P, -Machines
            plan_hosts/4,               % +Plan, +P, +Common, -Hosts
            plan_links/2,               % +Plan, -Links
            plan_links_at/3,            % +Plan, +Time, -Links
            plan_costs/2,               % +Plan, -Costs
            plan_change/3,              % +Costs, +Change0, -Change
            plan_host_setup/2,          % +Plan, -Goals
            plan_dynamics/3,            % +Plan, +Time, -State
            plan_journal/4,             % +Plan, +P, -Where, -How
            plan_joins/2,               % +Plan, -Options
            plan_options/2,             % +Plan, -Options
            plan_shape/3,               % +Plan, -Names, -Edges
            plan_without/3              % +Plan0, +Names, -Plan
          ]).
:- use_module(library(apply), [exclude/3, maplist/2]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(error), [domain_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [append/3, flatten/2, member/2, nth1/3]).
:- use_module(library(option), [option/2, option/3, select_option/4]).
:- use_module(library(random), [random_between/3]).
:- use_module('../kernel/base/options', [check_options/2]).
:- autoload('../options/fleet', [fleet_options/2]).
:- use_module('../options/journal', [journal_part/3, journal_place/2]).
:- use_module(dynamics,
              [ dynamics_edges/2, dynamics_model/2, dynamics_state/5,
                dynamics_until/3 ]).
:- use_module('../kernel/base/prng',
              [chance_hash/2, chance_seed/2, chance_uniform/5]).
:- use_module(host_setup,
              [host_setup_check/2, host_setup_files/3, host_setup_goals/3]).
:- use_module(machines, [machine_checked/1]).
:- use_module(topology,
              [topology_costs/2, topology_edges/4, topology_names/2]).

/** <module> The plan of a network

A plan is derived from the arguments of network_start/3, and from a seed.

*Threading*: pure, except that a seed is drawn if none is given.
*/

:- multifile typhon_options:declared/4.

%!  network_plan(+Topology, +Options, -Plan) is det.
%
%   Check Options and derive Plan.
%
%   @error domain_error(network_option, Option), domain_error(topology, T)
%   @error permission_error(set, network_option, Option) an option of the
%   journal is set for single hosts, or without a journal

network_plan(Topology, Options0, plan(Names, Edges, Costs, Options)) :-
    check_options(network_option, Options0),
    maplist(check_option, Options0),
    check_journal(Options0),
    check_machines(Options0),
    check_virtual(Options0),
    seeded(Options0, Seed, Options),
    topology_edges(Topology, Seed, _, Edges),
    topology_names(Topology, Names),
    option(places(Places), Options, []),
    host_setup_check(Places, Names),
    topology_costs(Topology, Listed),
    list_to_assoc(Listed, Costs).

%!  plan_option(+Plan, ?Option) is semidet.
%
%   Plan has Option: it was given, or, for seed(_), drawn.

plan_option(plan(_, _, _, Options), Option) :-
    option(Option, Options).

typhon_options:declared(network_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(processes(P), positive_integer, P).
option_type(machines(Machines), list, Machines).
option_type(start(How), nonvar, How).
option_type(fleet(Fleet), atom, Fleet).
option_type(bind(Interface), atom, Interface).
option_type(advertise(Address), atom, Address).
option_type(tls(Directory), atom, Directory).
option_type(hosts(Options), list, Options).
option_type(hop_time(Time), nonvar, Time).
option_type(clock(Rate), nonvar, Rate).
option_type(cost(Cost), nonvar, Cost).
option_type(log(File), ground, File).
option_type(log(File, _), ground, File).
option_type(places(Places), nonvar, Places).
option_type(dynamic(Model), nonvar, Model).
option_type(seed(Seed), integer, Seed).
option_type(journal(Directory), text, Directory).
option_type(journal(postgresql(Url)), text, Url).
option_type(journal(redis(Path)), atom, Path).
option_type(sync(How), oneof([full, normal]), How).
option_type(restart(Restart), boolean, Restart).

%   check_options/2 has checked the types of the values before.

check_option(hosts(Options)) =>
    check_options(host_option, Options).
check_option(advertise(Address)), sub_atom(Address, _, _, _, :) =>
    throw(error(domain_error(advertised_address, Address),
                context(_, 'without a port: each process has its own'))).
check_option(start(How)) =>
    check_start(How).
check_option(fleet(Fleet)) =>
    fleet_options(Fleet, _).
check_option(log(_, Kinds)) =>
    must_be(list(event_kind), Kinds).
check_option(hop_time(Time)) =>
    check_hop_time(Time).
check_option(clock(Rate)) =>
    check_rate(Rate).
check_option(cost(Cost)) =>
    check_cost(Cost).
check_option(dynamic(Model)) =>
    dynamics_model(Model, _).
check_option(_) =>
    true.

check_start(local) =>
    true.
check_start(ssh([Machine|Machines])) =>
    maplist(machine_checked, [Machine|Machines]).
check_start(slurm(Options)) =>
    check_options(slurm_option, Options).
check_start(How) =>
    throw(error(domain_error(start, How),
                context(_, 'write start(local), \c
                            start(ssh([\'user@machine\'])) or start(slurm([nodes(2)]))'))).

check_hop_time(Time) :-
    (   interval(Time)
    ->  true
    ;   domain_error(hop_time, Time)
    ).

check_cost(Cost) :-
    (   number(Cost)
    ->  Cost >= 0
    ;   interval(Cost)
    ),
    !.
check_cost(Cost) :-
    domain_error(cost, Cost).

interval(Interval) :-
    subsumes_term(uniform(_, _), Interval),
    Interval = uniform(Min, Max),
    number(Min), number(Max),
    0 =< Min, Min =< Max.

check_rate(virtual) :-
    !.
check_rate(Rate) :-
    number(Rate),
    Rate > 0,
    !.
check_rate(Rate) :-
    throw(error(domain_error(clock_rate, Rate),
                context(_, 'write clock(virtual), or clock(Rate) with the \c
                            host seconds per second'))).

%   A journal belongs to a process, not to a host.

check_journal(Options) :-
    memberchk(hosts(Own), Options),
    member(Option, Own),
    memberchk(Option, [journal(_), sync(_)]),
    !,
    misplaced(hosts(Own),
              'journal and sync are for the whole network, not for its hosts').
check_journal(Options) :-
    memberchk(sync(How), Options),
    \+ memberchk(journal(_), Options),
    !,
    misplaced(sync(How), 'there is no journal(Directory)').
check_journal(_).

check_machines(Options) :-
    memberchk(start(How), Options),
    memberchk(machines(_), Options),
    !,
    misplaced(start(How), 'machines(_) names the machines already').
check_machines(_).

misplaced(Option, Why) :-
    throw(error(permission_error(set, network_option, Option),
                context(_, Why))).

%   A network in virtual time runs in one process, and ends with it.

check_virtual(Options) :-
    memberchk(clock(virtual), Options),
    memberchk(journal(Where), Options),
    !,
    journal_place(Where, Place),
    throw(error(permission_error(open, journal, Place),
                context(_, 'not in virtual time'))).
check_virtual(Options) :-
    (   memberchk(clock(virtual), Options),
        member(Option, Options),
        elsewhere(Option)
    ->  permission_error(carry, virtual_time, Option)
    ;   true
    ).

elsewhere(processes(P)) :-
    P > 1.
elsewhere(machines([_|_])).
elsewhere(start(How)) :-
    How \== local.
elsewhere(fleet(Fleet)) :-
    fleet_options(Fleet, Joins),
    \+ memberchk(engine(modelled), Joins).

seeded(Options, Seed, Options) :-
    option(seed(Seed), Options),
    !.
seeded(Options, Seed, [seed(Seed)|Options]) :-
    random_between(1, 0x3fffffff, Seed).

                /*******************************
                *             PARTS            *
                *******************************/

%!  plan_time(+Plan, -Kind) is det.
%
%   Kind is `real` or `virtual`.

plan_time(Plan, Kind) :-
    (   plan_option(Plan, clock(virtual))
    ->  Kind = virtual
    ;   Kind = real
    ).

%!  plan_log(+Plan, -File, -Kinds:list) is semidet.
%
%   Hosts log to File the lives of agents and events of Kinds.  Fails without a
%   log.

plan_log(Plan, File, Kinds) :-
    plan_option(Plan, log(File, Kinds)),
    !.
plan_log(Plan, File, []) :-
    plan_option(Plan, log(File)).

%!  plan_processes(+Plan, -P, -Machines) is det.
%
%   P processes run the network; each of Machines, a list or slurm(Options),
%   runs a block of them.

plan_processes(plan(Names, _, _, Options), P, Machines) :-
    machines(Options, Machines, M),
    length(Names, N),
    option(processes(P0), Options, M),
    P is min(P0, N).

machines(Options, slurm(Own), N) :-
    option(start(slurm(Own)), Options),
    !,
    option(nodes(N), Own, 1).
machines(Options, Machines, M) :-
    (   option(machines([Machine|Rest]), Options)
    ->  Machines = [Machine|Rest]
    ;   option(start(ssh(Targets)), Options)
    ->  findall(ssh(Target), member(Target, Targets), Machines)
    ;   Machines = [local]
    ),
    length(Machines, M).

%!  plan_hosts(+Plan, +P, +Common, -Hosts) is det.
%
%   Hosts are terms host(At, I, Name, HostOptions), with the options Common.
%   Host I of N is in process At = (I-1)*P//N + 1, so that all processes have
%   nearly the same number of hosts.

plan_hosts(Plan, P, Common, Hosts) :-
    Plan = plan(Names, _, _, _),
    length(Names, N),
    findall(host(At, I, Name, HostOptions),
            ( nth1(I, Names, Name),
              At is (I - 1) * P // N + 1,
              host_options(Plan, I, Common, HostOptions0),
              with_files(Plan, Name, HostOptions0, HostOptions) ),
            Hosts).

%   The files of places(Places) are consulted after those of hosts(Own).

with_files(Plan, Name, Options0, Options) :-
    plan_option(Plan, places(Places)),
    host_setup_files(Places, Name, Files),
    Files \== [],
    !,
    select_option(consult(Own), Options0, Options1, []),
    flatten([Own, Files], All),
    Options = [consult(All)|Options1].
with_files(_, _, Options, Options).

%!  plan_host_setup(+Plan, -Goals) is det.
%
%   Goals are pairs I-Goal: Goal is called in the place of host I after its
%   start.

plan_host_setup(Plan, Goals) :-
    Plan = plan(Names, _, _, _),
    findall(I-Goal,
            ( plan_option(Plan, places(Places)),
              nth1(I, Names, Name),
              host_setup_goals(Places, Name, All),
              member(Goal, All) ),
            Goals).

%   Options of hosts(Own) override those of the network.

host_options(Plan, I, Common, HostOptions) :-
    plan_option(Plan, seed(Seed)),
    HostSeed is Seed * 65536 + I,
    findall(Option,
            ( member(Option, [hop_time(_), fleet(_)]),
              plan_option(Plan, Option) ),
            Planned),
    append([seed(HostSeed)|Planned], Common, Given),
    (   plan_option(Plan, hosts(Own))
    ->  exclude(overridden(Own), Given, Ours),
        append(Own, Ours, HostOptions)
    ;   HostOptions = Given
    ).

overridden(Own, Option) :-
    functor(Option, Name, Arity),
    functor(General, Name, Arity),
    memberchk(General, Own).

%!  plan_links(+Plan, -Links) is det.
%
%   Links are terms link(I, J, Cost).

plan_links(Plan, Links) :-
    Plan = plan(_, Edges, _, _),
    links_of(Edges, Plan, Links).

%!  plan_links_at(+Plan, +Time, -Links) is semidet.
%
%   Links are the links at Time, in host seconds after the start.  Fails for a
%   network without dynamics.

plan_links_at(Plan, Time, Links) :-
    plan_dynamics(Plan, Time, State),
    dynamics_edges(State, Edges),
    links_of(Edges, Plan, Links).

links_of(Edges, Plan, Links) :-
    findall(link(I, J, Cost),
            ( member(I-J, Edges), cost(Plan, I-J, Cost) ),
            Links).

%!  plan_costs(+Plan, -Costs) is det.
%
%   Costs is the part of Plan that holds the costs of links: copying a whole
%   plan takes longer than changing a link.

plan_costs(Plan, plan([], [], Costs, Options)) :-
    Plan = plan(_, _, Costs, _),
    findall(Option,
            ( member(Option, [cost(_), seed(_)]), plan_option(Plan, Option) ),
            Options).

%!  plan_change(+Costs, +Change0, -Change) is det.
%
%   Change0 is link(I, J) or unlink(I, J).  Change is the same with the cost of
%   the link as third argument.  The cost belongs to the pair of hosts: a link
%   that is made again costs the same.

plan_change(Costs, Change0, Change) :-
    Change0 =.. [Action, A, B],
    I is min(A, B),
    J is max(A, B),
    cost(Costs, I-J, Cost),
    Change =.. [Action, I, J, Cost].

cost(plan(_, _, Costs, _), Edge, Cost) :-
    get_assoc(Edge, Costs, Cost0),
    !,
    Cost = Cost0.
cost(Plan, Edge, Cost) :-
    (   plan_option(Plan, cost(Common))
    ->  common_cost(Common, Plan, Edge, Cost)
    ;   Cost = same
    ).

common_cost(uniform(Min, Max), Plan, Edge, Cost) :-
    !,
    plan_option(Plan, seed(Seed)),
    chance_hash(cost(Seed, Edge), Hash),
    chance_seed(Hash, Chance),
    chance_uniform(Min, Max, Cost, Chance, _).
common_cost(Cost, _, _, Cost).

%!  plan_dynamics(+Plan, +Time, -State) is semidet.
%
%   State is the state of the dynamics at Time.  Fails for a network without
%   dynamics.

plan_dynamics(plan(Names, Edges, _, Options), Time, State) :-
    option(dynamic(Spec), Options),
    option(seed(Seed), Options),
    dynamics_model(Spec, Model),
    length(Names, N),
    dynamics_state(Model, N, Edges, Seed, State0),
    (   Time > 0
    ->  dynamics_until(State0, Time, State)
    ;   State = State0
    ).

%!  plan_journal(+Plan, +P, -Where, -How) is semidet.
%
%   Process P has a journal at Where.  How is `full` or `normal`, as in the
%   option sync(How).  Fails without a journal.

plan_journal(Plan, P, Part, How) :-
    plan_option(Plan, journal(Where)),
    journal_part(Where, P, Part),
    (   plan_option(Plan, sync(How0))
    ->  How = How0
    ;   How = normal
    ).

%!  plan_joins(+Plan, -Options) is det.
%
%   Options of child_start/6 for processes that belong to a fleet.

plan_joins(Plan, Options) :-
    findall(fleet(Fleet, Joins),
            ( plan_option(Plan, fleet(Fleet)), fleet_options(Fleet, Joins) ),
            Options).

%!  plan_options(+Plan, -Options) is det.
%
%   Options are all options of Plan, including a seed that was drawn.

plan_options(plan(_, _, _, Options), Options).

%!  plan_shape(+Plan, -Names, -Edges) is semidet.
%
%   Names are the hosts, Edges the initial links. Fails if Plan is not a plan.

plan_shape(plan(Names, Edges, _, _), Names, Edges).

%!  plan_without(+Plan0, +Names, -Plan) is det.

plan_without(plan(Hosts, Edges, Costs, Options0), Names,
             plan(Hosts, Edges, Costs, Options)) :-
    exclude(is_named(Names), Options0, Options).

is_named(Names, Option) :-
    functor(Option, Name, _),
    memberchk(Name, Names).
