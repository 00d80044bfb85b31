:- module(typhon_building,
          [ network_build/5,            % +Network, +Plan, +Kept, :Change,
                                        % -Clock
            network_endpoint/4,         % +Network, +Plan, +Port, -At
            network_log/4,              % +Network, +File, +Options, -Address
            log_option/3,               % +Plan, +Address, -Option
            network_dynamics/2,         % +Network, +Dynamics
            part/2,                     % ?Network, ?Part
            dynamics_end/1,             % +Network
            log_end/1                   % +Network
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/host',
              [runtime_acquire/2, time_now/1, time_seed/1]).
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

/** <module> Building networks from plans

Start processes, the log, hosts, links, the contents of places, and the dynamics
of links, in this order.  A network with a journal is restored from it.

*Threading*: the thread that starts or stops the network.
*/

:- meta_predicate network_build(+, +, +, 1, -).

%!  network_build(+Network, +Plan, +Kept, :Change, -Clock) is det.
%
%   Build Network from Plan, or restore it, if Kept is not `none`, see
%   kept_plan/4.  The dynamics change links by call(Change, link(I, J)) or
%   call(Change, unlink(I, J)).  Clock is clock(Epoch, Rate).  After an
%   exception the parts that were started still run.

network_build(Network, Plan, Kept, Change, Clock) :-
    plan_processes(Plan, P, Machines),
    lasting_open(Plan, P, Machines),
    network_endpoint(Network, Plan, 0, At),
    plan_option(Plan, seed(Seed)),
    time_seed(Seed),
    known_log(Kept, Network, Clock, Plan, Log),
    nodes_start(Network, P, Machines, At,
                   lasting_child(Plan, Log)),
    clock_and_log(Network, Plan, Clock, Log),
    lasting_back(Plan, Log),
    start_hosts(Kept, Network, P, Plan, Clock, [Clock|Log], Time),
    start_dynamics(Network, Clock, Plan, Time, Change),
    lasting_goes_on(Network, P, Plan),
    debug(typhon(network), '~w is built, ~w processes', [Network, P]),
    lasting_restarts(Network, P, Plan, [Clock|Log]).

%   start_hosts(+Kept, +Network, +P, +Plan, +Clock, +Common, -Time): start the
%   hosts and links.  The journal has restored the contents of places.  The
%   dynamics go on meanwhile, so a restored network gets the links of the
%   present Time.

start_hosts(kept(built, _), Network, P, Plan, Clock, Common, Time) :-
    !,
    plan_hosts(Plan, P, Common, Hosts),
    wire_hosts(Network, P, hosts, Hosts),
    clock_time(Clock, Time),
    (   plan_links_at(Plan, Time, Links)
    ->  wire_instead(Network, P, Links)
    ;   true
    ).
start_hosts(_, Network, P, Plan, Clock, Common, 0) :-
    kept_note(Plan, Clock, begun),
    plan_hosts(Plan, P, Common, Hosts),
    wire_hosts(Network, P, hosts, Hosts),
    plan_links(Plan, Links),
    wire_links(Network, P, Links),
    plan_host_setup(Plan, Goals),
    wire_goals(Network, P, Goals),
    kept_note(Plan, Clock, built).

%   The clock starts now.

clock(Plan, clock(Epoch, Rate)) :-
    time_now(Epoch),
    (   plan_option(Plan, clock(Rate0)),
        number(Rate0)
    ->  Rate = Rate0
    ;   Rate = 1
    ).

clock_time(clock(Epoch, Rate), Time) :-
    time_now(Now),
    Time is (Now-Epoch)*Rate.

%   known_log(+Kept, +Network, -Clock, +Plan, -Log), clock_and_log(+Network,
%   +Plan, ?Clock, ?Log): a restored network continues with its clock, and its
%   log starts before the processes, which restore hosts that log.

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

%!  part(?Network, ?Part) is nondet.
%
%   Network has Part: log(Address, File) or dynamics(Dynamics).

%!  network_endpoint(+Network, +Plan, +Port, -At) is det.
%
%   Start the endpoint of this process, at Port if that is not 0.  At is
%   at(Interface, Advertised), where its children on this machine listen.

network_endpoint(Network, Plan, Port, at(Interface, Advertised)) :-
    plan_option(Plan, bind(Interface), localhost),
    plan_option(Plan, advertise(Advertised), none),
    plan_time(Plan, Kind),
    findall(Option,
            ( member(Option, [advertise(_), bind(_), tls(_)]),
              plan_option(Plan, Option) ),
            Options),
    runtime_acquire(network(Network), [time(Kind), port(Port)|Options]).

plan_option(Plan, Option, Default) :-
    (   plan_option(Plan, Option)
    ->  true
    ;   arg(1, Option, Default)
    ).

%!  network_log(+Network, +File, +Options, -Address) is det.
%
%   Start a log server, with options as of log_serve/2.

network_log(Network, Spec, Options, Address) :-
    absolute_file_name(Spec, File, [access(none)]),
    atom_concat(Network, '_log', Name),
    log_serve([file(File), name(Name)|Options], Address),
    assertz(part(Network, log(Address, File))).

%!  network_dynamics(+Network, +Dynamics) is det.

network_dynamics(Network, Dynamics) :-
    assertz(part(Network, dynamics(Dynamics))).

%!  dynamics_end(+Network) is det.

dynamics_end(Network) :-
    (   retract(part(Network, dynamics(Dynamics)))
    ->  dynamics_stop(Dynamics)
    ;   true
    ).

%!  log_end(+Network) is det.

log_end(Network) :-
    (   retract(part(Network, log(Address, _)))
    ->  log_serve_end(Address)
    ;   true
    ).
