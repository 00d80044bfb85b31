:- module(typhon_modelled_members, []).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/host',
              [ alarm_in/3, host/3, host_option/2, time_apart/2,
                time_kind/1 ]).
:- use_module(members,
              [ fleet_host_beats/2, fleet_host_leaves/2, fleet_joined/2,
                fleet_lease/2, fleet_reports/1 ]).
:- use_module(modelled, [modelled/1]).

/** <module> Members of a fleet in virtual time

All hosts are in one process, so each stands for a process of its own: it has a
lease, which alarms renew, and loses it while it is away.

*Threading*: that of virtual time; hosts start in any.
*/

:- multifile
    prolog:error_message//1,
    typhon_host_parts:begins/3,
    typhon_hosting:begins/1,
    typhon_hosting:closes/1,
    typhon_members:is_gone/1,
    typhon_on_demand:joins/2,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- dynamic
    beats/2,                    % Host, N: by alarms with N
    reports/1.                  % Fleet: by alarms

typhon_on_demand:joins(fleet, joined).

typhon_host_parts:begins(_, _, Options) :-
    (   option(fleet(Fleet), Options),
        modelled(Fleet),
        \+ ( time_kind(Kind), time_apart(Kind, _) )
    ->  permission_error(model, fleet, Fleet)
    ;   true
    ).

typhon_hosting:begins(Host) :-
    forall(modelled_of(Host, Fleet, Options), begin(Host, Fleet, Options)).

modelled_of(Host, Fleet, Options) :-
    host(Host, _, _),
    host_option(Host, fleet(Fleet)),
    modelled(Fleet),
    fleet_joined(Fleet, Options).

begin(Host, Fleet, Options) :-
    fleet_host_beats(Fleet, Host),
    flag(typhon_modelled_members, N, N+1),
    retractall(beats(Host, _)),
    assertz(beats(Host, N)),
    fleet_lease(Options, Lease),
    share(Host, Share),
    First is Lease/3*Share,
    alarm_in(First, Host, fleet_beat(N)),
    (   reports(Fleet)
    ->  true
    ;   assertz(reports(Fleet)),
        report_later(Fleet, Options)
    ).

%   Hosts that start together do not beat together.

share(Host, Share) :-
    term_hash(Host, Hash),
    Share is (Hash mod 997)/997.

report_later(Fleet, Options) :-
    option(report(Seconds), Options, 1),
    alarm_in(Seconds, Fleet, fleet_report).

typhon_scheduler:fire(Host, fleet_beat(N)) :-
    !,
    (   beats(Host, N),
        modelled_of(Host, Fleet, Options)
    ->  ( host_option(Host, away(true)) -> true ; fleet_host_beats(Fleet, Host) ),
        fleet_lease(Options, Lease),
        Third is Lease/3,
        alarm_in(Third, Host, fleet_beat(N))
    ;   true
    ).
typhon_scheduler:fire(Fleet, fleet_report) :-
    !,
    (   reports(Fleet),
        fleet_joined(Fleet, Options)
    ->  fleet_reports(Fleet),
        report_later(Fleet, Options)
    ;   true
    ).

typhon_scheduler:over(Host, fleet_beat(N)) :-
    \+ beats(Host, N).
typhon_scheduler:over(Fleet, fleet_report) :-
    \+ reports(Fleet).

%   It reports nothing meanwhile.

typhon_members:is_gone(Host) :-
    host_option(Host, away(true)).

typhon_hosting:closes(Host) :-
    forall(modelled_of(Host, Fleet, _),
           ( retractall(beats(Host, _)),
             fleet_host_leaves(Fleet, Host),
             ( beats(_, _) -> true ; retractall(reports(Fleet)) ) )).

prolog:error_message(permission_error(model, fleet, Fleet)) -->
    [ 'The engine of the fleet ~w is modelled: its hosts need clock(virtual)'-
      [Fleet] ].
