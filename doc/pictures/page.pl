:- module(doc_pictures_page,
          [ page_pictures/1             % +Directory
          ]).

/** <module> The pictures of the page in README and doc

Starts sixty hosts in four processes with a mechanism at work, looks at their
page in Chromium, and writes page-NAME.png for each picture/2 below.  The
network is made for the pictures alone.

*Threading*: the main thread.
*/

:- use_module('../../prolog/typhon',
              [ agent_create/3, network_property/2, network_start/3,
                network_stop/1 ]).
:- use_module('../../prolog/typhon/tools/page', [page_serve/2, page_stop/0]).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- use_module('../../test/lib/browser').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).

%!  page_pictures(+Directory) is det.

page_pictures(Directory) :-
    setup_call_cleanup(
        network_start(grid(6, 10), Network,
                      [ processes(4), seed(1), hop_time(uniform(0.5, 1.5)),
                        log('/dev/null') ]),
        pictures(Directory, Network),
        network_stop(Network)).

pictures(Directory, Network) :-
    setup_call_cleanup(
        page_serve([port(0)], Link),
        with_browser(Browser, look(Directory, Network, Link, Browser)),
        page_stop).

look(Directory, Network, Link, Browser) :-
    network_property(Network, hosts(Hosts)),
    at_work(Hosts, Ann),
    browser_size(Browser, 1600, 1000),
    browser_open(Browser, Link),
    browser_wait(Browser, "return globalThis.typhon && \c
                           typhon.app.state === 'open' && \c
                           typhon.store.hosts.size === 60", 60),
    browser_wait(Browser, "return typhon.store.counts.arrived > 60", 60),
    forall(picture(Name, Scene),
           ( call(Scene, at(Browser, Hosts, Ann)),
             shot(Browser, Directory, Name) )).

%   Travellers execute four tasks in step; couriers visit hosts.

at_work(Hosts, Ann) :-
    maplist(task, [drill, sand, paint, dry], Tasks),
    sequence_start(assembly, Hosts, Tasks,
                   [ agents(12), seed(1), settings([delta-0.3]) ], _),
    courier(Text),
    clauses(Text, Clauses),
    findall(Agent,
            ( member(Name-N, [bob-8, cleo-33, dan-48, ann-25]),
              nth1(N, Hosts, Host),
              agent_create(clauses(Clauses), Agent,
                           [host(Host), name(Name)]) ),
            Agents),
    once(( member(Ann, Agents), sub_atom(Ann, 0, _, _, ann) )).

task(Name, Name-sleep(3)).

%   What the editor shows, and what the agents run.

courier("\c
:- agent(courier, [state([visit/3])]).

main :-
    next_host(conscientious, Host),
    move(Host),
    note_visit,
    sleep(1),
    main.

note_visit :-
    here(Host),
    now(Time),
    host_load(Load),
    assertz(visit(Host, Time, Load)).

on_message(From, visits) :-
    findall(Host, visit(Host, _, _), Hosts),
    send(From, visits(Hosts)).
").

clauses(Text, Clauses) :-
    setup_call_cleanup(
        open_string(Text, In),
        read_all(In, Clauses),
        close(In)).

read_all(In, Clauses) :-
    read_term(In, Term, []),
    (   Term == end_of_file
    ->  Clauses = []
    ;   Clauses = [Term|More],
        read_all(In, More)
    ).

                /*******************************
                *           PICTURES           *
                *******************************/

%   picture(?Name, -Scene): call(Scene, At) before it is taken.

picture(map, map).
picture(agent, agent).
picture(host, host).
picture('new-agent', new_agent).

map(at(Browser, _, _)) :-
    view(Browser, map),
    browser_wait(Browser, "return typhon.store.moving.size > 4").

agent(at(Browser, _, Ann)) :-
    view(Browser, agents),
    select(Browser, agent, Ann),
    browser_wait(Browser, "return document.querySelector(\c
                           '#details .program .here')"),
    ways(Browser).

%   Agents are under way along links: what the list says is of their present
%   hop.

ways(Browser) :-
    browser_run(Browser,
                "return [...document.querySelectorAll('[role=row]')]\c
                 .map(row => [...row.children].map(e => e.textContent))\c
                 .map(([, from, , , state]) => \c
                     [from, /^in_transit to (.*)$/.exec(state)?.[1]])\c
                 .filter(([from, to]) => to && \c
                     ![...typhon.store.hosts.values()].some(host => \c
                         host.id.startsWith(`${from}@`) && \c
                         [...host.links.keys()].some(other => \c
                             other.startsWith(`${to}@`))))",
                Stale),
    (   Stale == []
    ->  true
    ;   throw(error(picture_not_clean(Stale), _))
    ).

host(at(Browser, Hosts, _)) :-
    nth1(25, Hosts, Host),
    browser_theme(Browser, dark),
    view(Browser, hosts),
    select(Browser, host, Host),
    browser_wait(Browser, "return document.querySelector(\c
                           '#details .plain')").

%   The courier, with a mistake.

new_agent(at(Browser, _, _)) :-
    browser_theme(Browser, light),
    view(Browser, map),
    browser_run(Browser, "typhon.app.select({})", _),
    browser_click(Browser, "#actions button"),
    browser_click(Browser, "[role=menuitem]"-"New agent …"),
    browser_wait(Browser, "return document.querySelector(\c
                           'dialog .code textarea')"),
    browser_run(Browser,
                "document.querySelector('.code textarea').select()", _),
    wrong(Text),
    browser_keys(Browser, [Text]),
    browser_wait(Browser, "return [...document.querySelectorAll(\c
                           '.advice .error')].some(e => \c
                           e.textContent.includes('forall'))").

wrong("\c
:- agent(courier, [state([visit/2])]).

main :-
    neighbours(Hosts),
    forall(member(Host, Hosts), visit(Host)).

visit(Host) :-
    move(Host),
    host_load(Load),
    assertz(visit(Host, Load)).
").

view(Browser, Name) :-
    browser_run(Browser, "typhon.app.show(args[0])", [Name], _).

select(Browser, Kind, Id) :-
    browser_run(Browser, "typhon.app.select({[args[0]]: args[1]})",
                [Kind, Id], _).

%   What has just been asked for is there a moment later.

shot(Browser, Directory, Name) :-
    browser_run(Browser, "await new Promise(r => setTimeout(r, 1000))", _),
    clean(Browser),
    format(atom(Base), 'page-~w.png', [Name]),
    directory_file_path(Directory, Base, File),
    browser_shot(Browser, File),
    format('~w~n', [File]).

%   Nothing is seen that is not of this network.

clean(Browser) :-
    browser_run(Browser,
                "return [[...typhon.store.hosts.values()].every(h => \c
                          h.state === 'running'), typhon.store.hosts.size, \c
                          [...typhon.store.programs.keys()].sort(), \c
                          document.querySelectorAll('.note').length]",
                Seen),
    (   Seen == [true, 60, ["courier", "traveller", "worker"], 0]
    ->  true
    ;   throw(error(picture_not_clean(Seen), _))
    ).

:- multifile prolog:error_message//1.

prolog:error_message(picture_not_clean(Seen)) -->
    [ 'The page shows what is not of the network: ~q'-[Seen] ].
