:- module(typhon_hosting,
          [ host_start/1,               % +Name
            host_start/2,               % +Name, +Options
            host_restart/2,             % +Name, +Options
            host_stop/1,                % +Name
            host_begin/2,               % +Name, +Options
            host_end/1,                 % +Name
            hosts_exclusively/1,        % :Goal
            hosts_go_on/0,
            hosts_rest/0,
            host_listed/2               % +ListOrOne, -List
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/names', [must_be_name/2]).
:- use_module('../base/monotonic', [deadline/2]).
:- use_module('../base/options', [check_options/2]).
:- use_module('../base/own_thread', [in_own_thread/1, stop_steps/1]).
:- use_module('../base/durable',
              [ durable_close/0, durable_closed/0, durable_end/0,
                sync_changes/0 ]).
:- use_module('../wire', [endpoint_address/1]).
:- use_module(time,
              [ clock_clear/1, clock_set/3, time_default/1, time_let_go/1,
                time_wanted/2 ]).
:- use_module(events, [event/4, events_forget/1]).
:- use_module(host_parts, [parts_load/1]).
:- use_module(hosts,
              [ address_parts/3, host/3, host_add/4, host_close/1,
                host_remove/1, host_resolve/2, host_unlink/2 ]).
:- use_module(place, [place_create/4, place_destroy/1]).
:- use_module(runtime, [runtime_acquire/3, runtime_release/1]).

/** <module> Starting and stopping hosts

A host owns a place, a clock, and an entry in the scheduler.  It shares the
endpoint with the other users of the process, see typhon_runtime.

*Threading*: a mutex serializes host_start/2 and host_stop/1.
*/

:- setting(stop_seconds, number, 2,
           "Seconds for agents to come to an effect when their host stops").

:- multifile
    begins/1,                   % Name: the host exists, listeners may register
    started/1,                  % Name: host_start/2 is about to return
    starts/2,                   % Name, Options: an option has started the host
    closes/1,                   % Name: the host admits agents no more
    evacuate/2.                 % Name, Deadline: end all agents on the host

:- '$clausable'(closes/1), '$clausable'(evacuate/2).

:- meta_predicate hosts_exclusively(0).

                /*******************************
                *             START            *
                *******************************/

%!  host_start(+Name) is det.
%!  host_start(+Name, +Options) is det.
%
%   Start a host in this process.  Options:
%
%     - port(+Port): of the endpoint of the process, 0 for any.  A later
%       host may have a port of its own: the process listens at it, too, as
%       long as the host runs
%     - bind(+Interface): default localhost; only for the first host
%     - advertise(+Address): the name or IPv4 address by which other machines
%       reach this process, where that is not Interface, as behind NAT; with
%       `:PORT` where the port differs, too; needed with bind('0.0.0.0'); only
%       for the first host
%     - tls(+Directory): the keys of this process, see doc/keys.md; all its
%       connections are TLS 1.3, both sides with certificates; only for the
%       first host
%     - trail(+Boolean): whether the host signs the agents that it receives and
%       sends, see agent_trail/2; default `true` where the process has keys
%     - authors(+Names): admit only agents whose program is signed by one of
%       Names, see doc/keys.md; needs tls(Directory)
%     - capacity(+N): at most N agents, or `inf`
%     - tokens(+List): admit only agents that carry one of these tokens
%     - concurrency(+N): at most N agents run at a time, default `inf`
%     - consult(+Files): clause files consulted into its place
%     - services(+Modules): modules whose exports its place offers
%     - place(+Module): a module all of whose predicates its place offers
%     - log(+Address), log(+Address, +Kinds): the log server.  It gets events
%       when agents begin and end, the terms that agents log, and the events of
%       Kinds: a list of `hops`, `messages` or messages(content), `facts`,
%       `faults`, `links` and `hosts`, see watch/3
%     - remote(+Boolean): whether remote/2 is answered, default `true`
%     - python(+Boolean): whether agents may deliver Python, see doc/bridges.md,
%       default `false`
%     - clock(virtual): time is virtual, see doc/time.md, for all hosts of the
%       process, which other processes cannot reach
%     - clock(+Epoch, +Rate): see typhon_time
%     - hop_time(uniform(Min, Max)): a delay drawn from it is added to each hop
%     - seed(+Integer): for the choices of migration strategies
%     - journal(+Where): the state of this process outlives it, see
%       doc/journal.md; only for the first host.  Where is a directory,
%       postgresql(Url), or such a URL.  All hosts of the journal are restored;
%       host_start/2 may then be called once for each of them, and changes
%       nothing
%     - sync(+How): `normal`, the default, if the journal must survive the
%       end of the process, `full` if also a power cut
%     - policy(+Policy): what agents may do on this host: `trusted`, everything,
%       which is the default; `guarded`, what cannot harm others, see
%       typhon_guard and doc/security.md; or a file of rules
%     - cell(+Kind): with a policy, agents run in processes that the operating
%       system confines: `owner`, one for each owner of agents, the default
%       where the system supports it, `host`, one for all, or `none`, see
%       doc/security.md
%     - peer(+Rules): which processes may do what, see typhon_access
%     - audit(+File): record refusals and orders in File
%     - quota(+List): how much agents may use: each agent, the agents of one
%       owner, and all agents, see typhon_quotas
%
%   @error permission_error(start, host, Name) if it runs already
%   @error domain_error(host_option, Option)
%   @error permission_error(open, journal, Where): another process has it,
%          or this one has hosts already; journal_damaged(Where, Why),
%          journal_version(Where, Version), journal_unreachable(Where, Why)

host_start(Name) :-
    host_start(Name, []).

host_start(Name, Options) :-
    must_be_name(host_name, Name),
    check_options(host_option, Options),
    parts_load(Options),
    forall(typhon_host_parts:check(Options), true),
    with_mutex(typhon_hosting, start(Name, Options)),
    forall(started(Name), true).

start(Name, Options) :-
    starts(Name, Options),
    !.
start(Name, Options) :-
    must_be_new(Name),
    start_reported(Name, Options),
    sync_changes.

must_be_new(Name) :-
    (   host(Name, _, _)
    ->  permission_error(start, host, Name)
    ;   true
    ).

%!  host_restart(+Name, +Options) is det.
%
%   As host_start/2, for a host that existed before: no event reports its start.

host_restart(Name, Options) :-
    with_mutex(typhon_hosting,
               ( must_be_new(Name), start_unreported(Name, Options) )).

start_reported(Name, Options) :-
    start_unreported(Name, Options),
    event(hosts, Name, none, started).

start_unreported(Name, Options) :-
    parts_load(Options),                % the host may be from a journal
    kind_of_time(Options, Kind),
    append(Kind, Options, Options1),
    runtime_acquire(host(Name), Options1, Endpoint),
    catch(start_host(Name, Endpoint, Options), Ball,
          ( runtime_release(host(Name)), throw(Ball) )).

%!  host_begin(+Name, +Options) is det.
%
%   For options, in the course of host_start/2: start another host.

host_begin(Name, Options) :-
    hosts_exclusively(start_reported(Name, Options)).

%!  host_end(+Name) is det.
%
%   For options, in the course of host_start/2: stop a host.

host_end(Name) :-
    hosts_exclusively(stop(Name)).

%!  hosts_exclusively(:Goal) is semidet.
%
%   As once(Goal), while no other thread starts or stops hosts.

hosts_exclusively(Goal) :-
    with_mutex(typhon_hosting, Goal).

                /*******************************
                *     A PROCESS AS A WHOLE     *
                *******************************/

%!  hosts_go_on is det.
%
%   Resume all that was restored.

hosts_go_on :-
    forall(typhon_durable:go_on, true).

%!  hosts_rest is det.
%
%   Stop all hosts of the process, also while time is held.  The journal keeps
%   its contents, and the process sends nothing until its endpoint has stopped.

hosts_rest :-
    in_own_thread(with_mutex(typhon_hosting, rest)).

%   Turns stay paused until all hosts have stopped, so that no agent observes
%   that other agents are gone.

rest :-
    findall(Name, host(Name, _, _), Names),
    stop_steps([ durable_close,
                 forall(member(Name, Names), stop_one(Name)),
                 time_let_go(_),
                 ( endpoint_address(_) -> true ; durable_end ) ]).

%   A host with a clock is one of a network, and accepts its kind of time.

kind_of_time(Options, [time(Kind)]) :-
    time_wanted(Options, Kind),
    !.
kind_of_time(Options, []) :-
    memberchk(clock(_, _), Options),
    !.
kind_of_time(_, [time(Kind)]) :-
    time_default(Kind).

start_host(Name, Endpoint, Options) :-
    address_parts(Address, Name, Endpoint),
    (   memberchk(clock(Epoch, Rate), Options)
    ->  true
    ;   Epoch = 0, Rate = 1
    ),
    place_parts(Options, Files, Services),
    place_create(Name, Files, Services, Place),
    catch(forall(typhon_host_parts:begins(Name, Place, Options), true),
          error(Formal, Context),
          ( forall(typhon_host_parts:ends(Name), true),
            place_destroy(Place),
            throw(error(Formal, Context)) )),
    clock_set(Name, Epoch, Rate),
    host_add(Name, Address, Place, Options),
    forall(begins(Name), true),
    debug(typhon(host), '~w is started', [Address]).

place_parts(Options, Files, Services) :-
    option(consult(Files0), Options, []),
    option(services(Services0), Options, []),
    host_listed(Files0, Files),
    host_listed(Services0, Services1),
    (   option(place(Module), Options)
    ->  Services = [module(Module)|Services1]
    ;   Services = Services1
    ).

                /*******************************
                *             STOP             *
                *******************************/

%!  host_stop(+Name) is det.
%
%   Dispose of the agents on Name, a host of this process, and release all its
%   resources.  If the process has a journal, and Name is its last host, the
%   agents stay in the journal instead.  Errors on the way are printed, and the
%   host stops nevertheless.  If the caller is interrupted, the stop goes on.
%
%   @error existence_error(host, Name), also if another thread stops it

host_stop(Name) :-
    must_be(atom, Name),
    in_own_thread(with_mutex(typhon_hosting, stop(Name))).

stop(Name) :-
    stop_one(Name),
    stop_steps([( host(_, _, _) -> true ; durable_end )]).

%   The order of a stop.  The close of the journal comes first: for the journal
%   and for all peers the process ends there, and what its threads do until they
%   have stopped is dropped, see typhon_durable.

stop_one(Name0) :-
    local_name(Name0, Name),
    host(Name, Address, Place),
    stop_steps([ close_last(Name),
                 host_close(Name),
                 each(closes(Name)),
                 evacuate(Name),
                 host_unlink(_, Address),
                 event(hosts, Name, none, stopped),
                 host_remove(Name),
                 events_forget(Name),
                 each(typhon_host_parts:ends(Name)),
                 clock_clear(Name),
                 place_destroy(Place),
                 debug(typhon(host), '~w is stopped', [Address]),
                 runtime_release(host(Name)) ]).

%   With the last host the process ends: the store keeps its contents, and the
%   next start resumes them.  An agent in the journal does not end, so no event
%   reports it.

close_last(Name) :-
    (   host(Other, _, _),
        Other \== Name
    ->  true
    ;   durable_close
    ),
    (   durable_closed
    ->  events_forget(Name)
    ;   true
    ).

evacuate(Name) :-
    setting(stop_seconds, Seconds),
    deadline(Seconds, Deadline),
    stop_steps([each(evacuate(Name, Deadline))]).

local_name(Host, Name) :-
    host_resolve(Host, Where),
    (   Where = local(Name)
    ->  true
    ;   existence_error(host, Host)
    ).

                /*******************************
                *         HOST OPTIONS         *
                *******************************/

%   The options of host_start/2, where they are described; host_change/2
%   describes which of them can be changed later.

:- multifile typhon_options:declared/4.

typhon_options:declared(host_option, port(X), between(0, 65535), X).
typhon_options:declared(host_option, bind(X), atom, X).
typhon_options:declared(host_option, advertise(X), atom, X).
typhon_options:declared(host_option, capacity(X), nonneg, X).
typhon_options:declared(host_option, capacity(X), oneof([inf]), X).
typhon_options:declared(host_option, tokens(X), list, X).
typhon_options:declared(host_option, consult(X), ground, X).
typhon_options:declared(host_option, services(X), ground, X).
typhon_options:declared(host_option, place(X), atom, X).
typhon_options:declared(host_option, remote(X), boolean, X).
typhon_options:declared(host_option, clock(X, Y), list(number), [X,Y]).
typhon_options:declared(host_option, hop_time(uniform(X, Y)), list(number),
                        [X,Y]).
typhon_options:declared(host_option, seed(X), integer, X).
typhon_options:declared(host_option, python(X), boolean, X).

%!  host_listed(+ListOrOne, -List) is det.
%
%   A term that is not a list stands for a list of that term alone.

host_listed(List, List) :-
    is_list(List),
    !.
host_listed(One, [One]).
