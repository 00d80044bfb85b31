:- module(typhon_building,
          [ network_build/5,            % +Network, +Plan, +Kept, :Change,
                                        % -Clock
            network_endpoint/4,         % +Network, +Plan, +Port, -Interface
            network_log/4,              % +Network, +File, +Options, -Address
            log_option/3,               % +Plan, +Address, -Option
            network_dynamics/2,         % +Network, +Dynamics
            part/2,                     % ?Network, ?Part
            dynamics_end/1,             % +Network
            log_end/1,                  % +Network
            endpoint_end/1,             % +Network
            equipment_forget/1          % +Network
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/host',
              [runtime_acquire/2, runtime_release/1, time_now/1, time_seed/1]).
:- use_module(changes, [dynamics_start/4, dynamics_stop/1]).
:- use_module(lasting,
              [ kept_note/3, lasting_back/2, lasting_child/4,
                lasting_goes_on/3, lasting_open/3, lasting_restarts/4 ]).
:- use_module(log, [log_serve/2, log_serve_end/1]).
:- use_module(plan,
              [ plan_dynamics/3, plan_host_setup/2, plan_hosts/4,
                plan_links/2, plan_links_at/3, plan_log/3, plan_option/2,
                plan_processes/3, plan_time/2 ]).
:- use_module(processes, [nodes_start/5]).
:- use_module(wiring,
              [wire_goals/3, wire_hosts/4, wire_instead/3, wire_links/3]).

/** <module> Networks as they are planned

Processes, the log, hosts, links, what places offer, and what changes links, in
this order; or, where a journal knows them, as they were.

*Threading*: the thread that starts or stops the network.
*/

:- meta_predicate network_build(+, +, +, 1, -).

%!  network_build(+Network, +Plan, +Kept, :Change, -Clock) is det.
%
%   Network is what Plan says, or what is Kept of it, see kept_plan/4; its links
%   change by call(Change, link(I, J)) and such.  When this throws, what was
%   started is there still.

network_build(Network, Plan, Kept, Change, Clock) :-
    plan_processes(Plan, P, Machines),
    lasting_open(Plan, P, Machines),
    network_endpoint(Network, Plan, 0, Interface),
    plan_option(Plan, seed(Seed)),
    time_seed(Seed),
    known_log(Kept, Network, Clock, Plan, Log),
    nodes_start(Network, P, Machines, Interface,
                   lasting_child(Plan, Log)),
    clock_and_log(Network, Plan, Clock, Log),
    lasting_back(Plan, Log),
    furnished(Kept, Network, P, Plan, Clock, [Clock|Log], Time),
    start_dynamics(Network, Clock, Plan, Time, Change),
    lasting_goes_on(Network, P, Plan),
    debug(typhon(network), '~w is built, ~w processes', [Network, P]),
    lasting_restarts(Network, P, Plan, [Clock|Log]).

%   furnished(+Kept, +Network, +P, +Plan, +Clock, +Common, -Time): what a
%   journal knows need not be done again; links may have changed by themselves
%   until Time.

furnished(kept(built, _), Network, P, Plan, Clock, Common, Time) :-
    !,
    plan_hosts(Plan, P, Common, Hosts),
    wire_hosts(Network, P, hosts, Hosts),
    shown(Clock, Time),
    (   plan_links_at(Plan, Time, Links)
    ->  wire_instead(Network, P, Links)
    ;   true
    ).
furnished(_, Network, P, Plan, Clock, Common, 0) :-
    kept_note(Plan, Clock, begun),
    plan_hosts(Plan, P, Common, Hosts),
    wire_hosts(Network, P, hosts, Hosts),
    plan_links(Plan, Links),
    wire_links(Network, P, Links),
    plan_host_setup(Plan, Goals),
    wire_goals(Network, P, Goals),
    kept_note(Plan, Clock, built).

%   It begins now.

clock(Plan, clock(Epoch, Rate)) :-
    time_now(Epoch),
    (   plan_option(Plan, clock(Rate0)),
        number(Rate0)
    ->  Rate = Rate0
    ;   Rate = 1
    ).

%   What the clock shows.

shown(clock(Epoch, Rate), Time) :-
    time_now(Now),
    Time is (Now-Epoch)*Rate.

%   known_log(+Kept, +Network, -Clock, +Plan, -Log), clock_and_log(+Network,
%   +Plan, ?Clock, ?Log): of a network that is known from a journal the clock
%   goes on, and the log is there before its hosts are.

known_log(kept(_, Clock), Network, Clock, Plan, Log) :-
    start_log(Network, Clock, Plan, append, Log).
known_log(none, _, _, _, _).

clock_and_log(Network, Plan, Clock, Log) :-
    (   var(Clock)
    ->  clock(Plan, Clock),
        start_log(Network, Clock, Plan, write, Log)
    ;   true
    ).

%   start_log(+Network, +Clock, +Plan, +Mode, -HostOptions)

start_log(Network, clock(Epoch, Rate), Plan, Mode, [Option]) :-
    plan_log(Plan, Spec, _),
    !,
    network_log(Network, Spec, [mode(Mode), clock(Epoch, Rate)], Address),
    log_option(Plan, Address, Option).
start_log(_, _, _, _, []).

%!  log_option(+Plan, +Address, -Option) is det.
%
%   The option of its hosts that have the log server at Address.

log_option(Plan, Address, Option) :-
    (   plan_log(Plan, _, [Kind|Kinds])
    ->  Option = log(Address, [Kind|Kinds])
    ;   Option = log(Address)
    ).

start_dynamics(Network, Clock, Plan, Time, Change) :-
    (   plan_dynamics(Plan, Time, State)
    ->  dynamics_start(State, Clock, Change, Dynamics),
        network_dynamics(Network, Dynamics)
    ;   true
    ).

                /*******************************
                *   ENDPOINT, LOG, DYNAMICS    *
                *******************************/

:- dynamic
    part/2.                     % Network, log(Address, File),
                                % or dynamics(Dynamics)

%!  network_endpoint(+Network, +Plan, +Port, -Interface) is det.
%!  network_log(+Network, +File, +Options, -Address) is det.
%!  network_dynamics(+Network, +Dynamics) is det.
%!  part(?Network, ?Part) is nondet.
%
%   This process is reached at Interface, and at Port if that is not 0; there is
%   a log server, with options as of log_serve/2; it has these dynamics.
%   Part is log(Address, File) or dynamics(Dynamics).

network_endpoint(Network, Plan, Port, Interface) :-
    interface(Plan, Interface),
    plan_time(Plan, Kind),
    findall(Option,
            ( member(Option, [bind(_), tls(_)]),
              plan_option(Plan, Option) ),
            Options),
    runtime_acquire(network(Network), [time(Kind), port(Port)|Options]).

interface(Plan, Interface) :-
    (   plan_option(Plan, bind(Interface0))
    ->  Interface = Interface0
    ;   Interface = localhost
    ).

network_log(Network, Spec, Options, Address) :-
    absolute_file_name(Spec, File),
    atom_concat(Network, '_log', Name),
    log_serve([file(File), name(Name)|Options], Address),
    assertz(part(Network, log(Address, File))).

network_dynamics(Network, Dynamics) :-
    assertz(part(Network, dynamics(Dynamics))).

%!  dynamics_end(+Network) is det.
%!  log_end(+Network) is det.
%!  endpoint_end(+Network) is det.
%!  equipment_forget(+Network) is det.
%
%   What there is of these ends; nothing of it is known any more.

dynamics_end(Network) :-
    (   retract(part(Network, dynamics(Dynamics)))
    ->  dynamics_stop(Dynamics)
    ;   true
    ).

log_end(Network) :-
    (   retract(part(Network, log(Address, _)))
    ->  log_serve_end(Address)
    ;   true
    ).

endpoint_end(Network) :-
    runtime_release(network(Network)).

equipment_forget(Network) :-
    retractall(part(Network, _)).
