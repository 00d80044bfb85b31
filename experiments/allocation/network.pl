:- module(allocation_network,
          [ on_network/5,               % +Options, +Directory, :Goal,
                                        % -Events, -Load
            await_end/5                 % +Log, +Tasks, +Options, +Note, -Ended
          ]).
:- use_module('../../prolog/typhon',
              [ log_events/2, network_property/2, network_start/3,
                network_stop/1, remote/2
              ]).
:- use_module('../../agents/allocation/reservations', [reservation_faults/2]).
:- use_module('../../agents/allocation/operator', [robot_start/3]).
:- use_module('../lib/follow', [new_lines/4]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module(ground, [case_topology/3, ground/4, options_case/2]).
:- use_module(watch,
              [watch/3, watch_done/2, watch_held/2, watch_over/1,
               watch_start/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, foldl/4, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(option), [option/2]).

/** <module> A network of robots, for one run

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run, and the network is
stopped.
*/

:- meta_predicate on_network(+, +, 3, -, -).

:- multifile
    prolog:error_message//1.

%!  on_network(+Options, +Directory, :Goal, -Events, -Load) is semidet.
%
%   Call Goal(Hosts, Ground, Ended) once on a network with robots, Ground
%   being that of ground/4.  Ended is `true` if everything was over before
%   the limit.  Events is what was logged, in Directory/events.pl.  Load is
%   what it took the computer: load(Wall, Cpu, Hops, Hop), Wall real seconds
%   from when the robots were there, Cpu those that the processes of the
%   network computed meanwhile, Hop the mean host seconds of Hops hops.  All
%   of these Options are required:
%
%     - mechanism(M), links(static|dynamic), hosts(N), eligible(N),
%       required(N), allocators(N): the case
%     - degree(D), dynamic(Model), processes(P), hop_time(Min-Max),
%       clock(Rate), seed(S): of the network
%
%   Fails or raises what Goal does.
%
%   @error reservation_faults(Faults) if a robot was reserved twice or, where
%   all tasks were completed or missed, was still held in the end

on_network(Options, Directory, Goal, Events, Load) :-
    make_directory_path(Directory),
    directory_file_path(Directory, 'events.pl', Log),
    fresh(Log),
    options_case(Options, Case),
    option(degree(Degree), Options),
    case_topology(Case, Degree, Topology),
    network_options(Options, Log, NetworkOptions),
    setup_call_cleanup(
        network_start(Topology, Network, NetworkOptions),
        ( network_property(Network, hosts(Hosts)),
          populate(Case, Options, Hosts, Ground),
          measured(Hosts, call(Goal, Hosts, Ground, Ended), Load) ),
        network_stop(Network)),
    log_events(Log, Events),
    check(Ended, Events).

fresh(File) :-
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

network_options(Options, Log,
                [ processes(Processes), seed(Seed), log(Log), clock(Rate),
                  hop_time(uniform(Min, Max))
                | More
                ]) :-
    option(processes(Processes), Options),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    (   option(links(dynamic), Options)
    ->  option(dynamic(Model), Options),
        More = [dynamic(Model)]
    ;   More = []
    ).

populate(Case, Options, Hosts, Ground) :-
    option(seed(Seed), Options),
    ground(Case, Seed, Hosts, Ground),
    Ground = ground(Able, Others, _),
    forall(member(Host, Able), robot_start(Host, [push], [])),
    forall(member(Host, Others), robot_start(Host, [carry], [])).

%   Robots that are still held are no fault of a run that was cut short.

check(Ended, Events) :-
    reservation_faults(Events, Faults0),
    (   ( Ended == true ; settled(Events) )
    ->  Faults = Faults0
    ;   exclude(still_held, Faults0, Faults)
    ),
    (   Faults == []
    ->  true
    ;   throw(error(reservation_faults(Faults), _))
    ).

settled(Events) :-
    memberchk(event(_, _, _, begun(_)), Events),
    forall(member(event(_, _, _, begun(Task)), Events),
           ( memberchk(event(_, _, _, completed(Task)), Events)
           ; memberchk(event(_, _, _, missed(Task, _)), Events) )).

still_held(held(_, _, _)).

                /*******************************
                *             LOAD             *
                *******************************/

:- meta_predicate measured(+, 0, -).

measured(Hosts, Goal, load(Wall, Cpu, Count, Hop)) :-
    cpu(Hosts, Cpu0),
    get_time(T0),
    once(Goal),
    get_time(T1),
    cpu(Hosts, Cpu1),
    Wall is T1 - T0,
    Cpu is Cpu1 - Cpu0,
    hops(Hosts, Count, Hop).

%   The processes of the hosts, and this one, which writes the log.

cpu(Hosts, Cpu) :-
    maplist(host_process, Hosts, Pairs0),
    sort(1, @<, Pairs0, Pairs),
    aggregate_all(sum(Time),
                  ( member(_-Host, Pairs),
                    remote(Host, statistics(process_cputime, Time)) ),
                  Cpu0),
    statistics(process_cputime, Own),
    Cpu is Cpu0 + Own.

host_process(Host, Process-Host) :-
    sub_atom(Host, _, _, After, @),
    !,
    sub_atom(Host, _, After, 0, Process).

hops(Hosts, Count, Mean) :-
    findall(N-Sum,
            ( member(Host, Hosts),
              sub_atom(Host, Before, _, _, @),
              sub_atom(Host, 0, Before, _, Name),
              remote(Host, typhon:host_property(Name,
                               hop_time(in, stats(N, _, Each, _)))),
              Sum is N*Each ),
            Pairs),
    aggregate_all(r(sum(N), sum(S)), member(N-S, Pairs), r(Count, Total)),
    (   Count =:= 0
    ->  Mean = none
    ;   Mean is Total/Count
    ).

                /*******************************
                *            THE END           *
                *******************************/

%!  await_end(+Log, +Tasks, +Options, +Note, -Ended) is det.
%
%   Wait until the log says that all Tasks, names, have been completed or
%   missed, all robots are free and all allocators and children have ended.
%   Ended is `true`, or `false` if that did not happen in limit(Seconds) of
%   host time.  Options are limit(Seconds) and clock(Rate).  Note is shown
%   with the progress.

await_end(Log, Tasks, Options, Note, Ended) :-
    option(limit(Limit), Options),
    option(clock(Rate), Options),
    get_time(Now),
    Deadline is Now + Limit/Rate,
    watch_start(Tasks, State),
    length(Tasks, Count),
    call_cleanup(
        follow(Log, 0, State, until(Deadline, Count, Note), Ended),
        progress_done(user_error)).

follow(Log, Position0, State0, Until, Ended) :-
    Until = until(Deadline, Count, Note),
    new_lines(Log, Position0, Position, Lines),
    foldl(look_at, Lines, State0, State),
    watch_done(State, Done),
    watch_held(State, Held),
    length(Held, HeldCount),
    format(atom(Text), '~w, ~d robots held', [Note, HeldCount]),
    progress(user_error, Done, Count, Text),
    get_time(Now),
    (   watch_over(State)
    ->  Ended = true
    ;   Now > Deadline
    ->  Ended = false
    ;   sleep(0.1),
        follow(Log, Position, State, Until, Ended)
    ).

look_at(Line, State0, State) :-
    term_string(Event, Line),
    watch(Event, State0, State).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(reservation_faults(Faults)) -->
    [ 'Robots were reserved twice, or left reserved: ~p'-[Faults] ].
