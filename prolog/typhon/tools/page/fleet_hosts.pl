:- module(typhon_page_fleets,
          [ fleets_follow/1,            % :OnEvent
            fleets_stop/0,
            fleet_place/1,              % -Address
            fleet_away/2                % ?Address, -State
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../options/fleet',
              [ fleet_mine/1, fleet_overview/3, fleet_unwatch/1,
                fleet_watch/3 ]).

/** <module> The fleets of this process, as a page shows them

For each fleet that this process has joined there is a watch while the page is
served, whatever the number of browsers.  It asks the engine for the hosts that
have changed; what waits for hosts that are away is asked for by the thread that
searches for new hosts.

*Threading*: that thread follows, the thread of a watch notes; any thread reads.
*/

:- meta_predicate fleets_follow(1).

:- dynamic
    following/2,                % Fleet, Watch
    seen/3.                     % Address, Fleet, State: `up` or away(...)

%!  fleets_follow(:OnEvent) is det.
%!  fleets_stop is det.
%
%   Follow the fleets that this process has joined; call call(OnEvent, Event) for
%   each event event(none, Host, none, What), where What is away(Since, Parked),
%   `back` or `stopped`.

fleets_follow(OnEvent) :-
    forall(( following(Fleet, Watch), \+ fleet_mine(Fleet) ),
           unfollow(Fleet, Watch)),
    forall(fleet_mine(Fleet),
           catch(follow(Fleet, OnEvent), error(resource_error(_), _), true)).

follow(Fleet, OnEvent) :-
    (   following(Fleet, _)
    ->  findall(Host, seen(Host, Fleet, away(_, _)), Away),
        (   Away == []
        ->  true
        ;   look(Fleet, Away, OnEvent)
        )
    ;   fleet_watch(Fleet, typhon_page_fleets:changed(Fleet, OnEvent), Watch),
        assertz(following(Fleet, Watch)),
        look(Fleet, [], OnEvent)
    ).

fleets_stop :-
    forall(following(Fleet, Watch), unfollow(Fleet, Watch)).

unfollow(Fleet, Watch) :-
    retractall(following(Fleet, _)),
    catch(in_own_thread(fleet_unwatch(Watch)), error(existence_error(_, _), _),
          true),
    retractall(seen(_, Fleet, _)).

:- public changed/3.

changed(Fleet, OnEvent, Change) :-
    arg(1, Change, Host),
    (   Change = left(_)
    ->  retractall(seen(Host, Fleet, _)),
        call(OnEvent, event(none, Host, none, stopped))
    ;   look(Fleet, [Host], OnEvent)
    ).

look(Fleet, Hosts, OnEvent) :-
    fleet_overview(Fleet, Hosts, Rows),
    forall(member(Row, Rows), note(Row, Fleet, OnEvent)).

note(host(Host, up, _, _, _, _), Fleet, OnEvent) :-
    change(Host, Fleet, up, back, OnEvent).
note(host(Host, away, _, _, Since, Parked), Fleet, OnEvent) :-
    Away = away(Since, Parked),
    change(Host, Fleet, Away, Away, OnEvent).

change(Host, Fleet, State, What, OnEvent) :-
    (   seen(Host, Fleet, State)
    ->  true
    ;   retractall(seen(Host, Fleet, _)),
        assertz(seen(Host, Fleet, State)),
        call(OnEvent, event(none, Host, none, What))
    ).

%!  fleet_place(-Address) is nondet.
%!  fleet_away(?Address, -State) is nondet.
%
%   A host of a fleet that is up; one that is away, with State away(Since,
%   Parked).

fleet_place(Address) :-
    seen(Address, _, up).

fleet_away(Address, away(Since, Parked)) :-
    seen(Address, _, away(Since, Parked)).
