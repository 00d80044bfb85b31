:- module(typhon_fleets,
          [ fleet_join/2,               % +Fleet, +Options
            fleet_leave/1,              % +Fleet
            fleet_options/2,            % +Fleet, -Options
            fleet_hosts/3,              % +Fleet, -Hosts, +Options
            fleet_watch/3,              % +Fleet, :OnChange, -Watch
            fleet_unwatch/1,            % +Watch
            fleet_drain/2,              % +Host, +Options
            fleet_parked/2,             % +Fleet, -Parked
            fleet_park_drop/2,          % +Fleet, +Agent
            fleet_park_send/2,          % +Fleet, +Agent
            fleet_mine/1,               % ?Fleet
            fleet_overview/3,           % +Fleet, +Addresses, -Hosts
            fleet_here/1,               % +Host
            work_put/3,                 % +Fleet, +Queue, +Tasks
            work_take/4,                % +Fleet, +Queue, +Worker, -Work
            work_keep/4,                % +Fleet, +Queue, +Worker, +Work
            work_done/4,                % +Fleet, +Queue, +Work, +Result
            work_left/3,                % +Fleet, +Queue, -Left
            work_results/3              % +Fleet, +Queue, -Results
          ]).
:- use_module(library(error), [must_be/2]).
:- autoload('fleet/drain', [drain_host/2]).
:- autoload('fleet/fleet_watches', [unwatch_fleet/1, watch_fleet/3]).
:- autoload('fleet/members',
            [fleet_joined/2, join_fleet/2, leave_fleet/1, must_be_fleet/1]).
:- autoload('fleet/parking',
            [parked_drop/2, parked_in_fleet/2, parked_send/2]).
:- autoload('fleet/overview', [host_here/1, overview_of_fleet/3]).
:- autoload('fleet/tags', [hosts_of_fleet/3]).
:- autoload('fleet/work',
            [ done_work/4, keep_work/4, left_work/3, put_work/3,
              results_of_work/3, take_work/4 ]).

/** <module> Fleets: hosts on many machines, which come, vanish and come back

The members of a fleet are processes that have joined it.  What they know of
each other is in an engine, a server of Redis or Valkey: members and their
leases, hosts with tags, where agents are and how they ended, agents and
messages that wait for a host, and journals.  Agents hop directly, and no hop
waits for the engine.

This is the interface of the layer; its modules are loaded when they are used.

*Threading*: any thread that may wait.
*/

:- meta_predicate fleet_watch(+, :, -).

%!  fleet_join(+Fleet, +Options) is det.
%
%   This process becomes a member of Fleet.  Its hosts with the option
%   fleet(Fleet) are known to all members from now on.  Options:
%
%     - redis(Host:Port): the engine; or sentinel(Name) and sentinels(List), the
%       addresses of sentinels that know it; or engine(modelled), in this process,
%       for hosts in virtual time, each of which stands for a process: without
%       journals, watches, queues of work, fleet_overview/3 and fleet_park_send/2
%     - user(User), password(Password): default user is `default`
%     - tls(true), with cacert(File), key(File) and cert(File); the name of the
%       server is not compared with its certificate
%     - lease(Seconds): a member that is silent for so long is away; default 3
%     - report(Seconds): how often it is reported where agents are; default 1
%     - fsync(When): `always` if the engine confirms nothing that it could lose,
%       or `everysec`, the default
%     - recover(How): this process asks for journals in the engine whose processes
%       have gone.  With `true` it starts a process on this machine that stands in
%       for each; with a list, the program and arguments of a command, that
%       command does, with `{endpoint}` and `{journal}` replaced
%
%   @error permission_error(join, fleet, Fleet): it is a member already
%   @error existence_error(option, Option): `redis`, or a file for TLS
%   @error permission_error(model, engine_command, Command): of each predicate
%   below for which a modelled engine has no Command
%   @error domain_error(fleet_option, Option), domain_error(fleet_name, Fleet)
%   @error resource_error(fleet(Fleet)): the engine does not answer
%   @error permission_error(authenticate, fleet, Fleet): the engine refuses the
%   user, the password or a command; each predicate below may raise it, too

fleet_join(Fleet, Options) :-
    join_fleet(Fleet, Options).

%!  fleet_leave(+Fleet) is det.
%
%   This process is no member any more; the end of Prolog does the same.  Its
%   hosts go on, and others do not find them in Fleet.
%
%   @error existence_error(fleet, Fleet)

fleet_leave(Fleet) :-
    leave_fleet(Fleet).

%!  fleet_options(+Fleet, -Options:list) is det.
%
%   This process has joined Fleet with Options, which may hold a password.
%
%   @error existence_error(fleet, Fleet)

fleet_options(Fleet, Options) :-
    must_be_fleet(Fleet),
    fleet_joined(Fleet, Options).

%!  fleet_hosts(+Fleet, -Hosts:list, +Options) is det.
%
%   Hosts are the addresses of hosts in Fleet, the least loaded first.  Options:
%
%     - tag(Tag): hosts with this tag; or with all of a list of tags
%     - state(State): `up`, or `away` if the lease of the process has lapsed
%     - near(Host): hosts that Host has links to come first, then those on the
%       same machine
%
%   @error existence_error(fleet, Fleet), resource_error(fleet(Fleet))
%   @error existence_error(tag, Tag): no host ever had it
%   @error domain_error(fleet_hosts_option, Option)

fleet_hosts(Fleet, Hosts, Options) :-
    hosts_of_fleet(Fleet, Hosts, Options).

%!  fleet_watch(+Fleet, :OnChange, -Watch) is det.
%
%   Call call(OnChange, Change) for each change of Fleet from now on, one after
%   the other, in a thread of Watch.  Change is joined(Host), away(Host),
%   back(Host) or left(Host), with the address of a host.  Failure of a call is
%   ignored, an exception is printed, and the watch goes on.
%
%   @error existence_error(fleet, Fleet), resource_error(fleet(Fleet))

fleet_watch(Fleet, OnChange, Watch) :-
    strip_module(OnChange, _, Plain),
    must_be(callable, Plain),
    watch_fleet(Fleet, OnChange, Watch).

%!  fleet_unwatch(+Watch) is det.
%
%   @error existence_error(fleet_watch, Watch)

fleet_unwatch(Watch) :-
    unwatch_fleet(Watch).

%!  fleet_drain(+Host, +Options) is det.
%
%   Host, of this process, is drained: any(Tag) chooses it no more, its agents
%   are ordered to others, and then it leaves its fleet, but goes on.  Agents that
%   do not leave, such as static ones, stay and are listed.  Options:
%
%     - to(Tag): they go to hosts with this tag, or with all of a list of tags;
%       default the first tag of Host, or any host if it has none
%     - seconds(Seconds): how long agents have to leave; default 60
%     - stay(-Agents): the agents that stay; without it a warning lists them
%
%   @error existence_error(host, Host), existence_error(fleet_of_host, Host)
%   @error resource_error(hosts(Tag)): no other host that is up has the tag
%   @error resource_error(fleet(Fleet)), domain_error(drain_option, Option)

fleet_drain(Host, Options) :-
    drain_host(Host, Options).

%!  fleet_parked(+Fleet, -Parked:list) is det.
%
%   The agents that are parked in the engine of Fleet, the oldest first:
%   parked(Agent, Host, Since, Until).  They moved to the address Host with the
%   option wait(Seconds) when it could not be reached.  They go on there when it
%   is back, or where they were at Until, `inf` for never; or Host is where they
%   were, and they return.  Since and Until are as in get_time/1, by the clock of
%   the engine.
%
%   @error existence_error(fleet, Fleet), resource_error(fleet(Fleet))

fleet_parked(Fleet, Parked) :-
    parked_in_fleet(Fleet, Parked).

%!  fleet_park_drop(+Fleet, +Agent) is det.
%!  fleet_park_send(+Fleet, +Agent) is det.
%
%   Agent, which is parked, waits no more: it goes on where it was, with
%   host_unreachable(Host) raised at its move; or it is sent to its host now, by
%   this process.
%
%   @error existence_error(parked_agent, Agent), also if its host is taking it
%   @error host_unreachable(Host): it stays parked
%   @error existence_error(fleet, Fleet), resource_error(fleet(Fleet))

fleet_park_drop(Fleet, Agent) :-
    parked_drop(Fleet, Agent).

fleet_park_send(Fleet, Agent) :-
    parked_send(Fleet, Agent).

%!  fleet_mine(?Fleet) is nondet.
%
%   This process has joined Fleet.

fleet_mine(Fleet) :-
    current_module(typhon_members),
    fleet_joined(Fleet, _).

%!  fleet_overview(+Fleet, +Addresses:list, -Hosts:list) is det.
%
%   Hosts are terms host(Address, State, Load, Tags, Since, Parked) of the hosts
%   of Fleet among Addresses, or of all if that is [].  State is `up` or `away`,
%   since the time Since, by the clock of the engine, or `unknown`.  Parked is the
%   number of agents and messages that wait for the process of the host.
%
%   @error existence_error(fleet, Fleet), resource_error(fleet(Fleet))

fleet_overview(Fleet, Addresses, Hosts) :-
    overview_of_fleet(Fleet, Addresses, Hosts).

%!  fleet_here(+Host) is semidet.
%
%   Others find Host, a host of this process, in its fleet.
%
%   @error existence_error(fleet_of_host, Host), resource_error(fleet(Fleet))

fleet_here(Host) :-
    host_here(Host).

                /*******************************
                *             WORK             *
                *******************************/

%!  work_put(+Fleet, +Queue:atom, +Tasks:list) is det.
%
%   Queue has Tasks, ground terms with the numbers 1, 2, ... as of now; numbers
%   that it has or had already are left out.  So all workers may put the same
%   list.  The engine forgets Queue a week after its last use.
%
%   @error existence_error(fleet, Fleet), resource_error(fleet(Fleet))

work_put(Fleet, Queue, Tasks) :-
    put_work(Fleet, Queue, Tasks).

%!  work_take(+Fleet, +Queue:atom, +Worker, -Work) is semidet.
%
%   Work is work(Entry, N, Task) if Worker, an atomic value, is to do the Task
%   with the number N; `none` if others have all tasks that are left.  Fails if
%   there are none.  A worker that neither ends its Task nor keeps it within
%   five seconds, or so many as the setting typhon_fleet:work_seconds says,
%   loses it to another.

work_take(Fleet, Queue, Worker, Work) :-
    take_work(Fleet, Queue, Worker, Work).

%!  work_keep(+Fleet, +Queue:atom, +Worker, +Work) is semidet.
%
%   Worker is still busy with Work.  Fails if another worker has it.

work_keep(Fleet, Queue, Worker, Work) :-
    keep_work(Fleet, Queue, Worker, Work).

%!  work_done(+Fleet, +Queue:atom, +Work, +Result) is det.
%
%   Work is done; Result is ground.  Of several results the first counts.

work_done(Fleet, Queue, Work, Result) :-
    done_work(Fleet, Queue, Work, Result).

%!  work_left(+Fleet, +Queue:atom, -Left:integer) is det.
%
%   Left is the number of tasks that are not done.

work_left(Fleet, Queue, Left) :-
    left_work(Fleet, Queue, Left).

%!  work_results(+Fleet, +Queue:atom, -Results:list) is det.
%
%   Results are pairs N-Result, in the order of the tasks that are done.

work_results(Fleet, Queue, Results) :-
    results_of_work(Fleet, Queue, Results).
