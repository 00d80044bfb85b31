:- module(typhon_page_sources,
          [ sources_start/1,            % +Options
            sources_stop/0,
            sources_look/1,             % -Scene
            sources_show/1,             % +Endpoint
            sources_metrics/1,          % -Text
            sources_tree/1              % -Trees
          ]).
:- use_module(library(apply), [exclude/3, maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/monotonic', [deadline/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/base/server',
              [server_cast/2, server_start/4, server_stop/1]).
:- use_module('../../kernel/host',
              [address_parts/3, runtime_acquire/2, runtime_release/1]).
:- use_module('../administration', [host_property/2]).
:- use_module('../../tools',
              [ inventory/4, inventory_agents/2, inventory_hosts/4,
                supervision_tree/3 ]).
:- use_module('../../options/watch', [metrics/2, unwatch/1, watch/3]).
:- use_module(browsers, [browsers_send/1, browsers_there/0]).
:- use_module(fleet_hosts,
              [fleet_away/2, fleet_place/1, fleets_follow/1, fleets_stop/0]).
:- use_module(protocol, [times_of/1]).

/** <module> The hosts that a page shows, and their events

The page has a watch for each process, and a further watch when it finds more
hosts there.  Events are collected only while a browser is connected.

*Threading*: any thread may query; a mutex protects the watches.  While a
browser is connected, a thread searches for new hosts every few seconds.
*/

:- setting(renew_seconds, number, 3,
           "Seconds between searches of a page for new hosts").

:- dynamic
    place/1,                    % Address: the search begins here, too
    finder/1,                   % Server
    page_watch/1,               % Watch
    watched/2,                  % Address, Watch
    shown/1.                    % Endpoint: of the hosts found last

%!  sources_start(+Options) is det.
%!  sources_stop is det.
%
%   Show the hosts of this process and of the networks that it has started, with
%   the option host(Host) also that host, and all hosts that links from these
%   lead to, and those of the fleets that it has joined; send their events to
%   browsers.  Stop doing so.
%
%   @error existence_error(host, Host), host_unreachable(Address)

sources_start(Options) :-
    (   option(host(Host), Options)
    ->  runtime_acquire(page, []),
        catch(must_be_there(Host, Address), Ball,
              ( runtime_release(page), throw(Ball) )),
        assertz(place(Address))
    ;   true
    ),
    server_start(page_finder, typhon_page_sources:handle, none, Finder),
    assertz(finder(Finder)).

must_be_there(Host, Address) :-
    host_property(Host, address(Address)),
    !.

sources_stop :-
    (   retract(finder(Finder))
    ->  server_stop(Finder)
    ;   true
    ),
    fleets_stop,
    end_watches_if(true),
    retractall(shown(_)),
    (   retract(place(_))
    ->  runtime_release(page)
    ;   true
    ).

%!  sources_look(-Scene) is det.
%
%   Scene is scene(Hosts, Agents), see inventory_hosts/4 and inventory_agents/2.
%   All these Hosts are watched before their agents are listed, so that a
%   browser gets the events of all later changes.

sources_look(scene(Hosts, Agents)) :-
    (   finder(Finder)                  % none where the page runs in a tab
    ->  ignore(server_cast(Finder, browser)),
        watch_new_hosts
    ;   true
    ),
    take_inventory(1 000 000, Seen, Hosts),
    inventory_agents(Seen, Agents).

%!  sources_metrics(-Text:string) is det.

sources_metrics(Text) :-
    take_inventory(0, _, Hosts),
    findall(Address, member(host(Address, running, _, _, _, _, _, _), Hosts),
            Addresses),
    metrics(Addresses, Text).

%!  sources_tree(-Trees:list) is det.
%
%   Trees are those of supervision_tree/3, for the places of the page.

sources_tree(Trees) :-
    findall(Address, place(Address), Places),
    supervision_tree(Places, Trees, _).

%   Without a browser the server waits until one connects.

:- public handle/3.

handle(browser, State, Next) :-
    printing_errors(fleets_follow(browsers_send)),
    search_later(State, Next).
handle(timeout, State, Next) :-
    (   browsers_there
    ->  printing_errors(fleets_follow(browsers_send)),
        printing_errors(watch_new_hosts),
        search_later(State, Next)
    ;   fleets_stop,
        printing_errors(end_watches_if(\+ browsers_there)),
        Next = State
    ).

search_later(State, until(Stamp, State)) :-
    setting(renew_seconds, Seconds),
    deadline(Seconds, Stamp).

:- meta_predicate printing_errors(0).

printing_errors(Goal) :-
    catch(Goal, error(Formal, Context),
          print_error(warning, error(Formal, Context))).

                /*******************************
                *            WATCH             *
                *******************************/

%   Watch all hosts that are known now.

watch_new_hosts :-
    take_inventory(0, _, Hosts),
    with_mutex(typhon_page_sources, watch_hosts(Hosts)),
    with_mutex(typhon_page_sources, remove_idle(Watches)),
    maplist(end_watch, Watches).

%   remove_idle(-Watches): remove the records of watches whose hosts have all
%   stopped.

remove_idle(Watches) :-
    findall(Watch, ( page_watch(Watch), \+ watched(_, Watch) ), Watches),
    forall(member(Watch, Watches), retract(page_watch(Watch))).

take_inventory(Most, Seen, Hosts) :-
    findall(Place, ( place(Place) ; fleet_place(Place) ), Places),
    inventory(Most, Places, Seen, Silent),
    inventory_hosts(Places, Seen, Silent, Hosts0),
    exclude(is_away, Hosts0, Hosts1),
    findall(host(Address, State, '', '', '', [], [], none),
            fleet_away(Address, State), Away),
    append(Hosts1, Away, Hosts),
    times_of(Hosts),
    findall(Endpoint, endpoint_of(Hosts, Endpoint), Endpoints0),
    sort(Endpoints0, Endpoints),
    with_mutex(typhon_page_sources, show(Endpoints)).

is_away(Host) :-
    arg(1, Host, Address),
    fleet_away(Address, _).

endpoint_of(Hosts, Endpoint) :-
    member(Host, Hosts),
    arg(1, Host, Address),
    address_parts(Address, _, Endpoint).

show(Endpoints) :-
    forall(( member(Endpoint, Endpoints), \+ shown(Endpoint) ),
           assertz(shown(Endpoint))),
    findall(Old, ( shown(Old), \+ memberchk(Old, Endpoints) ), Gone),
    forall(member(Old, Gone), retractall(shown(Old))).

%!  sources_show(+Endpoint) is semidet.
%
%   A host that the page shows is at Endpoint.  Queries of browsers may lead to
%   no other address.

sources_show(Endpoint) :-
    shown(Endpoint),
    !.
sources_show(Endpoint) :-
    take_inventory(0, _, _),
    shown(Endpoint).

unwatched(Hosts, Endpoint, Address) :-
    member(host(Address, running, _, _, _, _, _, _), Hosts),
    \+ watched(Address, _),
    address_parts(Address, _, Endpoint).

watch_hosts(Hosts) :-
    findall(Endpoint-Address, unwatched(Hosts, Endpoint, Address), Pairs0),
    sort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    forall(member(_-Addresses, Groups), watch_some(Addresses)).

%   If the process has ended meanwhile, the next search reports its hosts as
%   lost.

watch_some(Addresses) :-
    (   catch(watch(Addresses, typhon_page_sources:forward_event, Watch),
              error(_, _), fail)
    ->  assertz(page_watch(Watch)),
        forall(member(Address, Addresses),
               assertz(watched(Address, Watch)))
    ;   true
    ).

:- public forward_event/1.

forward_event(Event) :-
    browsers_send(Event),
    note_stop(Event).

%   A host that has stopped may be started again as a new host.

note_stop(event(_, Host, _, stopped)) =>
    retractall(watched(Host, _)).
note_stop(_) =>
    true.

%   End all watches if When holds.  The mutex serialises this check with
%   watch_hosts/1: a browser that connects meanwhile keeps the watches, or
%   begins new ones afterwards.

:- meta_predicate end_watches_if(0).

end_watches_if(When) :-
    with_mutex(typhon_page_sources,
               ( When -> watches(Watches) ; Watches = [] )),
    maplist(end_watch, Watches).

watches(Watches) :-
    retractall(watched(_, _)),
    findall(Watch, retract(page_watch(Watch)), Watches).

end_watch(Watch) :-
    catch(in_own_thread(unwatch(Watch)), error(existence_error(_, _), _), true).
