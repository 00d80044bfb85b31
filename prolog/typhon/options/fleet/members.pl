:- module(typhon_members,
          [ join_fleet/2,               % +Fleet, +Options
            leave_fleet/1,              % +Fleet
            fleet_joined/2,             % ?Fleet, -Options
            fleet_member/3,             % ?Fleet, -Endpoint, -Token
            fleet_host/3,               % ?Host, ?Fleet, -Tags
            must_be_fleet/1,            % +Fleet
            fleet_beat/1,               % +Fleet
            fleet_told/1,               % +Fleet
            fleet_lease/2,              % +Options, -Seconds
            fleet_host_beats/2,         % +Fleet, +Host
            fleet_host_leaves/2,        % +Fleet, +Host
            fleet_reports/1             % +Fleet
          ]).
:- use_module(library(error), [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [append/2, append/3, member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/base/names', [must_be_name/2]).
:- use_module('../../kernel/base/on_demand', [on_demand_load/2]).
:- use_module('../../kernel/base/options', [check_options/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/base/server',
              [ server_answer/2, server_call/4, server_cast/2, server_start/4,
                server_stop/1 ]).
:- use_module('../../kernel/host', [host/3, host_load/2, host_option/2]).
:- use_module('../../kernel/wire', [endpoint_address/1]).
:- use_module(engine, [engine_close/1, engine_open/2, engine_script/4]).

/** <module> The members of a fleet

Each fleet that this process has joined has a thread, which alone changes what
the engine stores of this process.  Three times in a lease it renews the lease,
with the hosts of this process, their tags and loads; it also does what other
modules add by the hooks work/1 and beaten/4.

*Threading*: any thread; the thread of the fleet where a comment says so.
*/

:- multifile
    beaten/4,                   % Fleet, Endpoint, Parked, Orphans: the engine
                                % has answered
    fenced/2,                   % Fleet, Why: another process has the address or
                                % the journal of this one
    is_gone/1,                  % Host: it has left its fleet, and runs
    is_new/1,                   % Fleet: the engine did not know this process
    journal/3,                  % Fleet, -Name, -Token: of this process
    prolog:error_message//1,
    prolog:message//1,
    recovers/1,                 % Fleet: this process opens journals of others
    stands_at/2,                % Endpoint, At: the address that leads to it
    tags_hidden/1,              % Host: it is being drained
    work/1,                     % Fleet: to be done with each report
    typhon_host_parts:changeable/1,
    typhon_host_parts:check/1,
    typhon_host_parts:ends/1,
    typhon_hosting:begins/1,
    typhon_hosting:started/1,
    typhon_names:known/2,
    typhon_options:declared/4.

:- dynamic
    fleet/3,                    % Fleet, Server, Options
    member/3.                   % Fleet, Endpoint, Token: of its lease

typhon_options:declared(host_option, fleet(X), atom, X).
typhon_options:declared(host_option, tags(X), list(atom), X).

typhon_names:known(fleet, Fleet) :-
    fleet(Fleet, _, _).

                /*******************************
                *        JOIN AND LEAVE        *
                *******************************/

%!  join_fleet(+Fleet, +Options) is det.
%!  leave_fleet(+Fleet) is det.
%
%   See fleet_join/2 and fleet_leave/1.

join_fleet(Fleet, Options) :-
    must_be_name(fleet_name, Fleet),
    check_options(fleet_option, Options),
    (   member(Engine, [redis(_), sentinel(_), engine(_)]),
        option(Engine, Options)
    ->  true
    ;   existence_error(option, redis)
    ),
    on_demand_load(fleet, joined),
    in_own_thread(with_mutex(typhon_members, join(Fleet, Options))),
    forall(( host(Host, _, _), host_option(Host, fleet(Fleet)) ),
           fleet_beat(Fleet)).

join(Fleet, _) :-
    fleet(Fleet, _, _),
    !,
    permission_error(join, fleet, Fleet).
join(Fleet, Options) :-
    engine_open(Fleet, Options),
    catch(( served(Fleet, Options, Server),
            assertz(fleet(Fleet, Server, Options)) ),
          Ball,
          ( engine_close(Fleet), throw(Ball) )).

%   served(+Fleet, +Options, -Server): Server is `none` where alarms do its work,
%   see typhon_modelled_members.

served(_, Options, none) :-
    option(engine(modelled), Options),
    !.
served(Fleet, Options, Server) :-
    server_start(fleet, typhon_members:handle(Fleet, Options), none, Server).

typhon_options:declared(fleet_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(redis(X), compound, X).
option_type(engine(X), oneof([modelled]), X).
option_type(sentinel(X), atom, X).
option_type(sentinels(X), list, X).
option_type(user(X), atomic, X).
option_type(password(X), atomic, X).
option_type(tls(X), boolean, X).
option_type(cacert(X), text, X).
option_type(key(X), text, X).
option_type(cert(X), text, X).
option_type(lease(X), between(0.2, 86400.0), X).
option_type(report(X), between(0.05, 86400.0), X).
option_type(fsync(X), oneof([always, everysec]), X).
option_type(recover(X), boolean, X).
option_type(recover(X), list(atomic), X).

leave_fleet(Fleet) :-
    must_be_fleet(Fleet),
    in_own_thread(with_mutex(typhon_members, leave(Fleet))).

leave(Fleet) :-
    (   retract(fleet(Fleet, Server, _))
    ->  ( Server == none -> true ; server_stop(Server) ),
        retractall(member(Fleet, _, _)),
        engine_close(Fleet)
    ;   true
    ).

:- at_halt(forall(typhon_members:fleet(Fleet, _, _),
                  catch(typhon_members:leave(Fleet), error(_, _), true))).

%!  must_be_fleet(+Fleet) is det.
%
%   @error existence_error(fleet, Fleet): this process is no member of it

must_be_fleet(Fleet) :-
    must_be(atom, Fleet),
    (   fleet(Fleet, _, _)
    ->  true
    ;   existence_error(fleet, Fleet)
    ).

%!  fleet_joined(?Fleet, -Options) is nondet.
%!  fleet_member(?Fleet, -Endpoint, -Token) is nondet.
%
%   This process is a member of Fleet; its endpoint, and the token by which
%   the engine knows it, when it has a lease.

fleet_joined(Fleet, Options) :-
    fleet(Fleet, _, Options).

fleet_member(Fleet, Endpoint, Token) :-
    member(Fleet, Endpoint, Token).

%!  fleet_told(+Fleet) is semidet.
%
%   The engine knows what is true of the hosts of this process now.  Fails if it
%   does not answer within a lease.

fleet_told(Fleet) :-
    fleet(Fleet, Server, Options),
    fleet_lease(Options, Seconds),
    Server \== none,
    !,
    server_call(Server, registered, Seconds, true).
fleet_told(Fleet) :-
    fleet(Fleet, none, _).

%!  fleet_beat(+Fleet) is det.
%
%   The thread of Fleet renews the lease, and states the hosts of this process,
%   at once.

fleet_beat(Fleet) :-
    (   fleet(Fleet, Server, _),
        Server \== none
    ->  ignore(server_cast(Server, beat))
    ;   true
    ).

                /*******************************
                *             HOSTS            *
                *******************************/

%!  fleet_host(?Host, ?Fleet, -Tags) is nondet.
%
%   Host, of this process, is in Fleet.

fleet_host(Host, Fleet, Tags) :-
    host(Host, _, _),
    host_option(Host, fleet(Fleet)),
    \+ is_gone(Host),
    (   host_option(Host, tags(Tags0)),
        \+ tags_hidden(Host)
    ->  Tags = Tags0
    ;   Tags = []
    ).

typhon_host_parts:check(Options) :-
    (   option(fleet(Fleet), Options)
    ->  must_be_fleet(Fleet),
        option(tags(Tags), Options, []),
        forall(member(Tag, Tags), must_be_name(tag_name, Tag))
    ;   option(tags(_), Options)
    ->  existence_error(option, fleet)
    ;   true
    ).

typhon_host_parts:changeable(tags(_)).

typhon_hosting:begins(Host) :-
    forall(host_option(Host, fleet(Fleet)), fleet_beat(Fleet)).

typhon_host_parts:ends(_) :-
    forall(fleet(Fleet, _, _), fleet_beat(Fleet)).

%   host_start/2 waits until others can find the host.

typhon_hosting:started(Host) :-
    (   host_option(Host, fleet(Fleet)),
        fleet(Fleet, _, _)
    ->  (   fleet_told(Fleet)
        ->  true
        ;   print_message(warning, typhon(fleet_later(Host, Fleet)))
        )
    ;   true
    ).

%!  fleet_lease(+Options, -Seconds) is det.

fleet_lease(Options, Seconds) :-
    option(lease(Seconds), Options, 3).

                /*******************************
                *           THE THREAD         *
                *******************************/

%   The state is due(Beat, Report), the times of the next ones.

handle(Fleet, Options, Message, State0, State) :-
    (   Message == begin
    ->  monotonic_time(Now),
        State1 = due(Now, Now)
    ;   State1 = State0
    ),
    handled(Message, Fleet, Options, State1, State2),
    (   Message == stop
    ->  State = State2
    ;   State2 = due(Beat, Report),
        Next is min(Beat, Report),
        State = until(Next, State2)
    ).

handled(begin, _, _, State, State).
handled(timeout, Fleet, Options, due(Beat0, Report0), due(Beat, Report)) :-
    monotonic_time(Now),
    (   Now >= Beat0
    ->  beat(Fleet, Options, Beat)
    ;   Beat = Beat0
    ),
    (   Now >= Report0
    ->  report(Fleet, Options, Report)
    ;   Report = Report0
    ).
handled(beat, Fleet, Options, due(_, Report), due(Beat, Report)) :-
    beat(Fleet, Options, Beat).
handled(call(registered, Caller), Fleet, Options, due(_, Report),
        due(Beat, Report)) :-
    beat(Fleet, Options, Beat, Known),
    server_answer(Caller, Known).
handled(stop, Fleet, _, State, State) :-
    quietly(reports(Fleet)),
    quietly(gives_back(Fleet)).

%   An engine that does not answer is no news: all is tried again.

quietly(Goal) :-
    catch(ignore(Goal), error(Formal, Context),
          ( Formal = resource_error(fleet(_))
          -> true
          ;  print_message(error, error(Formal, Context)) )).

%   A report takes at most a sixth of the time.

report(Fleet, Options, Next) :-
    monotonic_time(Start),
    quietly(reports(Fleet)),
    monotonic_time(Now),
    option(report(Each), Options, 1),
    Next is max(Now+Each, Now+5*(Now-Start)).

reports(Fleet) :-
    member(Fleet, _, _),
    forall(work(Fleet), true).

beat(Fleet, Options, Next) :-
    beat(Fleet, Options, Next, _).

%   Known is `true` if the engine has answered.

beat(Fleet, Options, Next, Known) :-
    fleet_lease(Options, Lease),
    Third is Lease/3,
    deadline(Third, Next),
    quietly(( beat(Fleet, Options), Known = true )),
    ignore(Known = false).

beat(Fleet, Options) :-
    findall(Row, known_host(Fleet, _, Row), Hosts),
    endpoint_address(Endpoint),
    Hosts \== [],
    !,
    (   member(Fleet, Other, _),
        Other \== Endpoint
    ->  gives_back(Fleet)
    ;   true
    ),
    fleet_lease(Options, Lease),
    renewed(Fleet, Lease, Endpoint, Hosts).
beat(Fleet, _) :-
    gives_back(Fleet).

known_host(Fleet, Host, [Address,Load,Count|Tags]) :-
    fleet_host(Host, Fleet, Tags),
    host(Host, Address, _),
    host_load(Host, Load),
    length(Tags, Count).

renewed(Fleet, Lease, Endpoint, Hosts) :-
    (   member(Fleet, Endpoint, Token)
    ->  First = 0
    ;   Token is random(1<<60),
        First = 1
    ),
    Ttl is integer(1000*Lease),
    ( stands_at(Endpoint, At) -> true ; At = Endpoint ),
    current_prolog_flag(pid, Pid),
    ( journal(Fleet, Journal, Secret) -> true ; Journal = '', Secret = '' ),
    ( recovers(Fleet) -> Recovers = 1 ; Recovers = 0 ),
    append([[Endpoint,Token,Ttl,First,At,Pid,Journal,Secret,Recovers]|Hosts],
           Args),
    engine_script(Fleet, beat, Args, [Status0|Rest]),
    atom_string(Status, Status0),
    answered(Status, Rest, Fleet, Endpoint, Token).

answered(ok, [Parked,Orphans], Fleet, Endpoint, Token) :-
    has_lease(Fleet, Endpoint, Token),
    forall(beaten(Fleet, Endpoint, Parked, Orphans), true).
answered(new, Rest, Fleet, Endpoint, Token) :-
    forall(is_new(Fleet), true),
    answered(ok, Rest, Fleet, Endpoint, Token).
answered(fenced, _, Fleet, _, _) :-
    forall(fenced(Fleet, address), true).
answered(usurped, _, Fleet, _, _) :-
    forall(fenced(Fleet, journal), true).

has_lease(Fleet, Endpoint, Token) :-
    (   member(Fleet, Endpoint, Token)
    ->  true
    ;   assertz(member(Fleet, Endpoint, Token))
    ).

gives_back(Fleet) :-
    findall([Endpoint,Token], member(Fleet, Endpoint, Token), All),
    forall(member([Endpoint,Token], All),
           ( retractall(member(Fleet, Endpoint, Token)),
             engine_script(Fleet, leave, [Endpoint,Token], _) )).

                /*******************************
                *        WITHOUT A THREAD      *
                *******************************/

%!  fleet_host_beats(+Fleet, +Host) is det.
%!  fleet_host_leaves(+Fleet, +Host) is det.
%!  fleet_reports(+Fleet) is det.
%
%   For a fleet whose engine is modelled: renew the lease of Host, which stands
%   for a process, or give it back; report what is new.

fleet_host_beats(Fleet, Host) :-
    fleet(Fleet, _, Options),
    fleet_lease(Options, Lease),
    host(Host, Address, _),
    (   known_host(Fleet, Host, Row)
    ->  quietly(renewed(Fleet, Lease, Address, [Row]))
    ;   fleet_host_leaves(Fleet, Host)
    ).

fleet_host_leaves(Fleet, Host) :-
    (   host(Host, Address, _),
        retract(member(Fleet, Address, Token))
    ->  engine_script(Fleet, leave, [Address,Token], _)
    ;   true
    ).

fleet_reports(Fleet) :-
    quietly(reports(Fleet)).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:error_message(permission_error(join, fleet, Fleet)) -->
    [ 'This process is a member of the fleet ~w already'-[Fleet] ].

prolog:message(typhon(fleet_later(Host, Fleet))) -->
    [ 'Host ~w is not known in the fleet ~w yet, whose engine does not answer; \c
       it will be when it does'-[Host, Fleet] ].
