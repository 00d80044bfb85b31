:- module(test_page_fleet, []).

% The page of a process that has joined a fleet: its hosts in other processes,
% which no link leads to, go away and come back.

:- use_module('../../../lib/common').
:- use_module('../../../lib/browser').
:- use_module('../../../lib/pages').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/redis').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

:- needs([fleet, page]).

:- meta_predicate with_page_of_fleet(-, -, 0).

%   with_page_of_fleet(-Base, -Beta, :Goal): alpha is in the process that serves
%   the page, beta, at the address Beta, in another.

with_page_of_fleet(Base, Beta, Goal) :-
    with_fleet([lease(1)], Redis, [alpha-[]],
               ( member_spec(Redis, beta, [lease(1)], [], Spec),
                 with_peers([Spec],
                            ( wait_until(test_page_fleet:up(beta, Beta), 20),
                              with_page([], Base, Goal) )) )).

up(Name, Address) :-
    fleet_hosts(lab, Hosts, [state(up)]),
    member(Address, Hosts),
    atomic_list_concat([Name|_], @, Address).

shown(Base, Address, Host) :-
    ask(Base, _{ask:survey}, Dict),
    member(Host, Dict.answer.hosts),
    atom_string(Address, Host.id).

in_state(Base, Address, State, Host) :-
    shown(Base, Address, Host),
    Host.state == State.

goes_and_comes(Base, Beta0) :-
    atom_string(Beta0, Beta),
    with_feed(Base, Feed,
        ( frame(Feed, _),
          wait_until(test_page_fleet:in_state(Base, Beta0, "running", _), 20),
          peer_signal(beta, stop),
          feed_event(Feed, [Beta, "", "away"], [_, _, _, _, Since, Parked]),
          get_time(Now),
          assertion(( number(Since), abs(Now-Since) < 60 )),
          assertion(Parked == 0),
          wait_until(test_page_fleet:in_state(Base, Beta0, "away", Host), 20),
          assertion(Host.since =:= Since),
          assertion([Host.load, Host.arrived, Host.parked] == ["", "", 0]),
          peer_signal(beta, cont),
          feed_event(Feed, [Beta, "", "back"], _),
          wait_until(test_page_fleet:in_state(Base, Beta0, "running", _), 20),
          peer_do(beta, fleet_leave(lab)),
          feed_event(Feed, [Beta, "", "stopped"], _) )).

%   In Chromium: the line of the state, the list, and the details.

seen_by_a_browser(Base, Beta) :-
    with_browser(Browser,
        ( browser_open(Browser, Base),
          is(Browser, Beta, running),
          peer_signal(beta, stop),
          is(Browser, Beta, away),
          browser_wait(Browser,
              "return document.querySelector('#state').textContent\c
                  .includes('1 away')"),
          browser_keys_to_hosts(Browser),
          browser_wait(Browser,
              "return /away since .*[0-9]/.test(document.querySelector(\c
                  '#table-host .row.over')?.textContent)"),
          peer_signal(beta, cont),
          is(Browser, Beta, running),
          browser_wait(Browser,
              "return !document.querySelector('#table-host .row.over')") )).

browser_keys_to_hosts(Browser) :-
    browser_run(Browser,
                "[...document.querySelectorAll('[role=tab]')].find(tab =>\c
                  tab.textContent.trim() === 'Hosts').click()", _).

is(Browser, Host, State) :-
    format(string(Script),
           "return globalThis.typhon?.app.store.hosts.get('~w')?.state === '~w'",
           [Host, State]),
    browser_wait(Browser, Script).

:- begin_tests(page_fleet).

test(hosts_of_a_fleet_are_shown_away_and_back) :-
    with_page_of_fleet(Base, Beta, goes_and_comes(Base, Beta)).
test(browser_shows_since_when_a_host_is_away) :-
    with_page_of_fleet(Base, Beta, seen_by_a_browser(Base, Beta)).

:- end_tests(page_fleet).
