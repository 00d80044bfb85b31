:- module(typhon_loading,
          [ load_network/3              % +File, -Network, +Options
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [domain_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module('../kernel/base/options', [check_options/2]).
:- use_module('../kernel/host',
              [address_parts/3, alarm_set/3, time_kind/1, time_now/1]).
:- use_module(nodes, [node_order/4]).
:- use_module(changes, [dynamics_again/5]).
:- use_module(log_file, [log_goes_on/2]).
:- use_module(networks,
              [ appointments_again/2, network_begin/4, network_change/2,
                network_goes_on/2 ]).
:- use_module(building,
              [ log_option/3, network_dynamics/2, network_endpoint/4,
                network_log/4 ]).
:- use_module(plan,
              [plan_joins/2, plan_processes/3, plan_time/2, plan_without/3]).
:- use_module(processes, [nodes_start/5]).
:- use_module(saving, [saved_read/2]).
:- use_module(wiring, [wire_hosts/4, wired_hosts/2]).

/** <module> Loading networks from restore points

Hosts are started with their saved options, and their contents restored, before
time runs.  No event reports their start.

*Threading*: as network_start/3.
*/

:- multifile
    typhon_options:declared/4,
    prolog:error_message//1.

%!  load_network(+File, -Network, +Options) is det.
%
%   See network_load/3.

load_network(File, Network, Options) :-
    must_be(var, Network),
    must_be(ground, File),
    check_options(network_load_option, Options),
    saved_read(File, Terms),
    (   saved(Terms, Saved)
    ->  true
    ;   domain_error(saved_network, File)
    ),
    Saved = saved(Name, Plan, _, _, _, _),
    must_be_alone(Plan, Name),
    network_begin(Name, Plan, rebuild(Saved, Options), Network).

typhon_options:declared(network_load_option, log(File), ground, File).

%   saved(+Terms, -Saved): Saved is saved(Name, Plan, Clock, Log, Then, Parts).

saved([network(Name, Plan0), Clock, Log, Dynamics|Rest],
      saved(Name, Plan, Clock, Log, Dynamics-Due, Rest)) :-
    Clock = clock(_, clock(_, _)),
    Log = log(_, _, _),
    Dynamics = dynamics(_, _, _),
    plan_without(Plan0, [journal, sync, restart], Plan),
    findall(due(N, Stamp, Goal), member(due(N, Stamp, Goal), Rest), Due).

must_be_alone(Plan, Name) :-
    (   plan_time(Plan, virtual),
        time_kind(virtual)
    ->  permission_error(load, virtual_time, Name)
    ;   true
    ).

                /*******************************
                *             BUILD            *
                *******************************/

rebuild(Saved, Options, Network) :-
    Saved = saved(_, Plan, clock(Then, Clock0), Log, Due, Terms),
    plan_time(Plan, Kind),
    plan_processes(Plan, P, Machines),
    own_port(P-Machines, Terms, Port),
    network_endpoint(Network, Plan, Port, Listens),
    nodes_start(Network, P, Machines, Listens, child_options(Plan, Terms)),
    shift(Kind, Then, Shift),
    shift_clock(Shift, Clock0, Clock),
    restart_log(Options, Log, Network, Plan, Clock, LogOptions),
    restart_hosts(Network, P, Terms, Clock, Log, LogOptions),
    truncate_log(Options, Log),
    forall(between(1, P, At), restore_items(Network, At, Kind, Terms)),
    restore_due(Due, Network, Clock, Kind, Shift),
    forall(between(1, P, At), resume_process(Network, At, Kind, Terms)),
    network_goes_on(Network, Clock).

%   Port is the saved port of the hosts, if this process runs them, else 0.

own_port(1-[local], Terms, Port) :-
    !,
    port_of(1, Terms, Port).
own_port(_, _, 0).

child_options(Plan, Terms, P, [port(Port)|Joins]) :-
    port_of(P, Terms, Port),
    plan_joins(Plan, Joins).

port_of(P, Terms, Port) :-
    memberchk(host(P, _, _, Address, _), Terms),
    port(Address, Port).

%   Shift is the number of seconds since the network was saved.

shift(virtual, _, 0).
shift(real, Then, Shift) :-
    time_now(Now),
    Shift is Now-Then.

shift_clock(0, Clock, Clock) :-
    !.
shift_clock(Shift, clock(Epoch0, Rate), clock(Epoch, Rate)) :-
    Epoch is Epoch0+Shift.

%   restart_log(+Options, +Log, +Network, +Plan, +Clock, -HostOptions)

restart_log(Options, _, Network, Plan, clock(Epoch, Rate), [Option]) :-
    memberchk(log(File), Options),
    !,
    network_log(Network, File, [clock(Epoch, Rate)], Address),
    log_option(Plan, Address, Option).
restart_log(_, log(none, _, _), _, _, _, []) :-
    !.
restart_log(_, log(_, File, _), Network, Plan, clock(Epoch, Rate),
            [Option]) :-
    network_log(Network, File, [mode(append), clock(Epoch, Rate)], Address),
    log_option(Plan, Address, Option).

%   Truncate the log to its Size at the save.  This happens before any new
%   event, and only when no step can fail any more: after an error the old log
%   must still be complete.

truncate_log(Options, log(Address, File, Size)) :-
    (   ( memberchk(log(_), Options) ; Address == none )
    ->  true
    ;   log_goes_on(File, Size)
    ).

%   Hosts must get their saved addresses, as agents and links refer to them.

restart_hosts(Network, P, Terms, clock(Epoch, Rate), log(Log, _, _),
              LogOptions) :-
    findall(host(At, I, Name, Options),
            ( member(host(At, I, Name, Address, Options0), Terms),
              exclude(is_replaced(Log), Options0, Options1),
              port(Address, Port),
              append([clock(Epoch, Rate), port(Port)|LogOptions], Options1,
                     Options) ),
            Hosts),
    wire_hosts(Network, P, again, Hosts),
    findall(Address, member(host(_, _, _, Address, _), Terms), Wanted),
    wired_hosts(Network, Addresses),
    (   Addresses == Wanted
    ->  true
    ;   subtract(Wanted, Addresses, [Missing|_]),
        throw(error(existence_error(host, Missing), _))
    ).

is_replaced(Log, log(Log)).
is_replaced(Log, log(Log, _)).
is_replaced(_, clock(_, _)).
is_replaced(_, port(_)).
is_replaced(_, journal(_)).
is_replaced(_, sync(_)).

port(Address, Port) :-
    address_parts(Address, _, Endpoint),
    atomic_list_concat([_,Text], ':', Endpoint),
    atom_number(Text, Port).

restore_items(Network, P, Kind, Terms) :-
    findall(Item, member(P:Item, Terms), Items),
    node_order(Network, P, fill(Kind, Items), ok).

%   In virtual time the saved state of time includes the alarms.

restore_due(Dynamics-Due, Network, Clock, Kind, Shift) :-
    restore_dynamics(Dynamics, Network, Clock, Kind, Shift),
    findall(N-Goal, member(due(N, _, Goal), Due), Pairs),
    appointments_again(Network, Pairs),
    forall(member(due(N, Stamp, _), Due),
           due_at(Kind, Shift, Stamp, Network, at(N))).

restore_dynamics(dynamics(none, _, _), _, _, _, _) :-
    !.
restore_dynamics(dynamics(Name, Stamp, Then), Network, Clock, Kind, Shift) :-
    dynamics_again(Name, Then, Clock, network_change(Network), Dynamics),
    network_dynamics(Network, Dynamics),
    due_at(Kind, Shift, Stamp, Dynamics, links).

due_at(virtual, _, _, _, _).
due_at(real, Shift, Stamp0, Owner, Token) :-
    Stamp is Stamp0+Shift,
    alarm_set(Stamp, Owner, Token).

resume_process(Network, P, Kind, Terms) :-
    memberchk(time(P, Time), Terms),
    findall(Id, member(P:item(stands, Id, _, _), Terms), Agents),
    node_order(Network, P, goes_on(Kind, Time, Agents), ok).

prolog:error_message(permission_error(load, virtual_time, Network)) -->
    [ 'This process has virtual time already: ~w cannot begin in it'-
      [Network] ].
