:- module(robots_fleet,
          [ fleet_start/2,              % +Options, -Fleet
            fleet_add/3,                % +Fleet, +Names, -Hosts
            fleet_stop/1                % +Fleet
          ]).
:- use_module('../../prolog/typhon', [log_server_start/2, log_server_stop/1]).
:- use_module('../../prolog/typhon/base/own_thread', [in_own_thread/1]).
:- use_module('../../prolog/typhon/network/children',
              [child_close/1, child_kill/1, child_release/1, child_start/5]).
:- use_module('../../prolog/typhon/wire', [endpoint_call/5]).
:- use_module(crew, [crew_services/1]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).

/** <module> Hosts that come one by one

A network is started as a whole; robots may come later.  Each host of a
fleet is a process of its own, and can be added while the others run.  All
have the interface of robots, one log and one clock, which shows 0 when the
fleet is started.  They have no links: see link/2.

*Threading*: one thread at a time for a fleet; one thread for each process
follows it.
*/

:- dynamic
    fleet/4,                    % Fleet, Queue, Log, Options of its hosts
    vessel/3,                   % Fleet, Name, Child
    up/3,                       % Fleet, Name, Endpoint
    down/2.                     % Fleet, Name

:- multifile
    prolog:message//1.

start_seconds(60).
stop_seconds(10).

%!  fleet_start(+Options, -Fleet) is det.
%
%   A fleet without any hosts.  All Options are required: clock(Rate), in
%   host seconds per second, log(File), and hop_time(Min-Max), the emulated
%   delay of a hop.
%
%   @error those of log_server_start/2

fleet_start(Options, Fleet) :-
    option(clock(Rate), Options),
    option(log(File), Options),
    option(hop_time(Min-Max), Options),
    get_time(Epoch),
    flag(robots_fleet, Id, Id + 1),
    atom_concat(fleet, Id, Fleet),
    atom_concat(Fleet, '_log', Name),
    log_server_start([file(File), name(Name), clock(Epoch, Rate)], Log),
    crew_services(Services),
    message_queue_create(Queue),
    assertz(fleet(Fleet, Queue, Log,
                  [ clock(Epoch, Rate), log(Log), services(Services),
                    hop_time(uniform(Min, Max)) ])).

%!  fleet_add(+Fleet, +Names, -Hosts) is det.
%
%   Hosts are the addresses of new hosts, which have Names.
%
%   @error timeout_error(start, Fleet), system_error(process_ended(Name))
%   @error what host_start/2 throws

fleet_add(Fleet, Names, Hosts) :-
    fleet(Fleet, Queue, _, Options),
    forall(member(Name, Names), launch(Fleet, Name)),
    start_seconds(Seconds),
    get_time(Now),
    Deadline is Now + Seconds,
    forall(member(_, Names), await_up(Fleet, Queue, Deadline)),
    maplist(start_host(Fleet, Options), Names, Hosts).

launch(Fleet, Name) :-
    sig_atomic(( child_start(Fleet-Name, local, localhost,
                             robots_fleet:event, Child),
                 assertz(vessel(Fleet, Name, Child)) )).

event(up(Fleet-Name, Endpoint, _)) :-
    assertz(up(Fleet, Name, Endpoint)),
    fleet(Fleet, Queue, _, _),
    thread_send_message(Queue, up).
event(down(Fleet-Name, Status)) :-
    assertz(down(Fleet, Name)),
    (   fleet(Fleet, Queue, _, _)
    ->  print_message(warning, robots_fleet(down(Name, Status))),
        thread_send_message(Queue, down(Name))
    ;   true
    ).

await_up(Fleet, Queue, Deadline) :-
    get_time(Now),
    Left is max(0, Deadline - Now),
    (   thread_get_message(Queue, Event, [timeout(Left)])
    ->  true
    ;   Event = late
    ),
    came(Event, Fleet).

came(up, _).
came(down(Name), _) :-
    throw(error(system_error(process_ended(Name)), _)).
came(late, Fleet) :-
    throw(error(timeout_error(start, Fleet), _)).

start_host(Fleet, Options, Name, Host) :-
    up(Fleet, Name, Endpoint),
    start_seconds(Seconds),
    endpoint_call(Endpoint, node, hosts([Name-Options]), answer(Answer),
                  Seconds),
    started(Answer, Host).

started(done([Host]), Host).
started(raised(Formal, Text), _) :-
    throw(error(Formal, context(_, Text))).

%!  fleet_stop(+Fleet) is det.
%
%   Stops the hosts, ends their processes, in order if they can, else by
%   force, and then the log.  Takes seconds at the most.

fleet_stop(Fleet) :-
    in_own_thread(stop(Fleet)).

stop(Fleet) :-
    retract(fleet(Fleet, Queue, Log, _)),
    forall(( member(Order, [stop, flush(2)]), up(Fleet, Name, Endpoint),
             \+ down(Fleet, Name) ),
           order(Endpoint, Order)),
    forall(vessel(Fleet, _, Child), child_close(Child)),
    stop_seconds(Seconds),
    get_time(Now),
    Deadline is Now + Seconds,
    forall(vessel(Fleet, Name, Child),
           ( await_down(Fleet, Name, Child, Deadline),
             child_release(Child) )),
    retractall(vessel(Fleet, _, _)),
    retractall(up(Fleet, _, _)),
    retractall(down(Fleet, _)),
    message_queue_destroy(Queue),
    log_server_stop(Log).

order(Endpoint, Order) :-
    catch(endpoint_call(Endpoint, node, Order, _, 5), error(Formal, _),
          print_message(warning, robots_fleet(order(Order, Formal)))).

await_down(Fleet, Name, _, _) :-
    down(Fleet, Name),
    !.
await_down(Fleet, Name, Child, Deadline) :-
    get_time(Now),
    (   Now > Deadline
    ->  child_kill(Child)
    ;   sleep(0.02),
        await_down(Fleet, Name, Child, Deadline)
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(robots_fleet(down(Name, Status))) -->
    [ 'The process of ~w ended: ~p'-[Name, Status] ].
prolog:message(robots_fleet(order(Order, Formal))) -->
    [ 'A host did not do ~w: ~p'-[Order, Formal] ].
