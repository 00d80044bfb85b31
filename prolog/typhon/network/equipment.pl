:- module(typhon_equipment,
          [ network_endpoint/4,         % +Network, +Plan, +Port, -Interface
            network_log/4,              % +Network, +File, +Options, -Address
            network_dynamics/2,         % +Network, +Dynamics
            part/2,                     % ?Network, ?Part
            dynamics_end/1,             % +Network
            log_end/1,                  % +Network
            endpoint_end/1,             % +Network
            equipment_forget/1          % +Network
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/host', [runtime_acquire/2, runtime_release/1]).
:- use_module(changes, [dynamics_stop/1]).
:- use_module(log, [log_server_start/2, log_server_stop/1]).
:- use_module(plan, [plan_option/2, plan_time/2]).

/** <module> What a network has beside hosts and links

The endpoint of this process, as one of its users; a log server; what
changes its links.

*Threading*: the thread that starts or stops the network.
*/

:- dynamic
    part/2.                     % Network, log(Address, File),
                                % or dynamics(Dynamics)

%!  network_endpoint(+Network, +Plan, +Port, -Interface) is det.
%!  network_log(+Network, +File, +Options, -Address) is det.
%!  network_dynamics(+Network, +Dynamics) is det.
%!  part(?Network, ?Part) is nondet.
%
%   This process is reached at Interface, and at Port if that is not 0; there is
%   a log server, with options as of log_server_start/2; it has these dynamics.
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
    log_server_start([file(File), name(Name)|Options], Address),
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
    ->  log_server_stop(Address)
    ;   true
    ).

endpoint_end(Network) :-
    runtime_release(network(Network)).

equipment_forget(Network) :-
    retractall(part(Network, _)).
