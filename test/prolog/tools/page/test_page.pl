:- module(test_page, []).
:- use_module('../../../lib/common').

:- needs([page]).

% A page in Chromium, used as by a person. All tests use one network of sixty
% hosts, one after the other.

:- use_module('../../../lib/browser').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/pages').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(settings), [set_setting/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/page), [page_serve/2]).

:- dynamic at/3.                        % Browser, Base, Network

hostile('<img src=x onerror=globalThis.hit=1>').

                /*******************************
                *           THE STAGE          *
                *******************************/

stage(Goal) :-
    no_leaks(setup_call_cleanup(
                 network_start(grid(6, 10), Network,
                               [ processes(4), seed(1), log('/dev/null'),
                                 hop_time(uniform(0.2, 0.4)) ]),
                 with_page([], Base, on_stage(Network, Base, Goal)),
                 capturing(network_stop(Network), _))).

on_stage(Network, Base, Goal) :-
    with_browser(Browser,
                 setup_call_cleanup(
                     assertz(at(Browser, Base, Network)),
                     ( browser_size(Browser, 1600, 1000),
                       browser_open(Browser, Base),
                       live(Browser),
                       call(Goal) ),
                     retractall(at(_, _, _)))).

:- meta_predicate stage(0), on_stage(+, +, 0).

live(Browser) :-
    browser_wait(Browser,
                 "return globalThis.typhon && typhon.app.state === 'open'").

nth_host(N, Host) :-
    at(_, _, Network),
    network_property(Network, hosts(Hosts)),
    nth1(N, Hosts, Host).

see(Script) :-
    at(Browser, _, _),
    browser_wait(Browser, Script).

sees(Script, Result) :-
    at(Browser, _, _),
    browser_run(Browser, Script, Result).

click(What) :-
    at(Browser, _, _),
    browser_click(Browser, What).

keys(Keys) :-
    at(Browser, _, _),
    browser_keys(Browser, Keys).

view(Name) :-
    format(string(Tab), "#tab-~w", [Name]),
    click(Tab),
    format(string(Shown), "return !document.querySelector('#panel-~w').hidden",
           [Name]),
    see(Shown).

%   A visible text in an element.

reads(Selector, Text) :-
    format(string(Script),
           "return [...document.querySelectorAll(~q)].some(e => \c
            e.checkVisibility() && e.textContent.includes(~q))",
           [Selector, Text]),
    see(Script).

%   The field beside a slider of the dialog has its value.

slide(Name, Place, Value) :-
    at(Browser, _, _),
    browser_run(Browser,
                "const slider = [...document.querySelectorAll('.parameters input')]
                     .find(i => i.ariaLabel === `${args[0]}, slider`);
                 slider.value = args[1];
                 slider.dispatchEvent(new Event('input'));
                 return slider.nextElementSibling.value;",
                [Name, Place], Shown),
    assertion(Shown == Value).

fill(Label, Text) :-
    at(Browser, _, _),
    reads("dialog label", Label),
    browser_run(Browser,
                "const label = [...document.querySelectorAll('dialog label')]
                     .find(l => l.firstChild.textContent === args[0]);
                 const field = label.control || label.querySelector('input, select');
                 field.value = args[1];
                 field.dispatchEvent(new Event('input', {bubbles: true}));
                 field.dispatchEvent(new Event('change', {bubbles: true}));",
                [Label, Text], _).

accessible :-
    at(Browser, _, _),
    browser_barriers(Browser, Problems),
    assertion(Problems == []).

                /*******************************
                *             TESTS            *
                *******************************/

:- begin_tests(page).

test(page_in_a_browser) :-
    stage(play).

%   The scenes run in order; the first that fails is reported by its name.

play :-
    forall(clause(scene(Name), Body), played(Name, Body)).

played(Name, Body) :-
    catch(( Body -> Error = none ; Error = error(failed, _) ),
          error(Formal, Context), Error = error(Formal, Context)),
    (   Error == none
    ->  true
    ;   Error = error(What, Where),
        throw(error(scene(Name, What), Where))
    ).

scene(sixty_hosts) :-
    see("return typhon.store.hosts.size === 60"),
    see("return document.getElementById('tab-world').hidden"),
    view(hosts),
    reads("#table-host .row", "n20"),
    reads("[role=status]", "60 hosts"),
    view(map).

scene(agent_is_created_by_the_form) :-
    program(Text),
    nth_host(13, Host),
    click("#actions button"),
    click("[role=menuitem]"-"New agent …"),
    see("return document.querySelector('dialog .code textarea')"),
    fill("Host", Host),
    fill("Name", "ann"),
    sees("document.querySelector('.code textarea').select()", _),
    keys([Text]),
    reads(".advice", "line 5"),
    reads(".advice .error", "forall"),
    corrected(Right),
    sees("document.querySelector('.code textarea').select()", _),
    keys([Right]),
    reads(".advice", "Nothing is wrong"),
    click("dialog button[type=submit]"),
    see("return !document.querySelector('dialog')"),
    reads("#details h2", "ann"),
    ann(_).

scene(travelling_agent_is_shown) :-
    see("return [...typhon.store.agents.values()].some(a => \c
         a.name.startsWith('ann') && a.hops >= 3)"),
    see("return [...typhon.store.agents.values()].some(a => \c
         a.name.startsWith('ann') && a.hop)"),
    see("return [...typhon.store.agents.values()].some(a => \c
         a.status === 'in_transit')").

%   Ids of agents name their homes.

scene(search_finds_names) :-
    nth_host(17, Host),
    agent_create(clauses([(:- agent(guard, [])), on_message(_, _)]), Agent,
                 [host(Host)]),
    view(map),
    see("return [...typhon.store.agents.values()].some(a => \c
         a.name.startsWith('guard'))"),
    searched("n17", "n17"),
    searched("guard", "guard"),
    searched("n1", "n1"),
    agent_dispose(Agent).

%   With sixty hosts only moving agents are shown at first.

scene(diagram_begins_with_moving_agents) :-
    view(space),
    see("return typhon.app.views.get('space')?.begun"),
    sees("const { messages, resting } = typhon.app.views.get('space');
          return [messages, resting]", [false, false]),
    click("#panel-space input[name=resting]"),
    see("return typhon.app.views.get('space').resting").

scene(hop_times_show_the_median) :-
    view(time),
    reads("#panel-time .u-legend", "median").

scene(agent_is_opened) :-
    view(agents),
    click("#table-agent .row[id]"),
    reads("#details h2", "ann"),
    reads("#details .program .here", "("),
    reads("#details .terms", "seen(").

%   A row that changes during a click is the same row.

scene(row_of_the_agent_is_not_replaced) :-
    sees("globalThis.row = document.querySelector('#table-agent .row[id]');
          globalThis.before = row.textContent", _),
    see("return row.textContent !== before"),
    sees("return row.isConnected", true).

%   An opened element is not replaced during a click, or while it has the
%   focus.

scene(opened_element_is_not_replaced) :-
    at(Browser, _, _),
    sees("[...document.querySelectorAll('#details summary')]
              .find(s => s.textContent.startsWith('Trail')).parentElement.open = true;
          document.querySelector('#details .trail li:last-child button').focus();
          globalThis.facts = () => document.querySelector('#details .facts').textContent;
          globalThis.before = facts()", _),
    see("return facts() !== before"),
    sees("return Boolean(document.activeElement.closest('.trail'))", true),
    sees("return document.querySelector('#details .trail button').title", Host),
    browser_hold(Browser, "#details .trail button",
                 ( sees("globalThis.before = typhon.store.counts.arrived", _),
                   see("return typhon.store.counts.arrived > before + 3") )),
    see("return typhon.app.chosen.host"),
    sees("return typhon.app.chosen.host", Host).

%   A list waits during a click, and is updated afterwards.

scene(list_is_not_updated_during_a_click) :-
    at(Browser, _, _),
    browser_hold(Browser, "#table-agent .row[id]",
                 ( sees("globalThis.shown = row.textContent;
                         globalThis.before = typhon.store.counts.arrived", _),
                   see("return typhon.store.counts.arrived > before + 2"),
                   sees("return row.textContent === shown", true) )),
    reads("#details h2", "ann"),
    see("return row.textContent !== shown").

%   A term that cannot be read is reported at its field.

scene(message_is_sent_to_the_agent) :-
    ann(Agent),
    click("#details .buttons button"-"Send a message …"),
    fill("Message", "stop("),
    click("dialog button[type=submit]"),
    reads("dialog .problem", "cannot be read"),
    fill("Message", "stop"),
    click("dialog button[type=submit]"),
    see("return !document.querySelector('dialog')"),
    wait_until(( agent_property(Agent, facts(Facts)),
                 memberchk(seen(stop), Facts) ), 10),
    reads("#details .pill", "waiting").

scene(agent_is_dragged) :-
    ann(Agent),
    nth_host(45, To),
    view(map),
    click("button.close"),
    at(Browser, _, _),
    browser_run(Browser, "await new Promise(r => setTimeout(r, 1000));
        const view = typhon.app.views.get('map'), {scene} = view,
            box = view.top.getBoundingClientRect(),
            at = p => [p.x + box.x, p.y + box.y];
        return [at(scene.agentAt(typhon.store.agents.get(args[0]),
            typhon.store.clock())), at(scene.at(args[1]))]",
        [Agent, To], [[X0, Y0], [X, Y]]),
    browser_drag(Browser, X0-Y0, X-Y),
    wait_until(agent_property(Agent, host(To)), 10),
    see("return [...typhon.store.agents.values()].find(a => \c
         a.name.startsWith('ann')).host.startsWith('n45@')").

scene(agent_is_cloned_and_disposed_of) :-
    ann(Agent),
    view(agents),
    click("#table-agent .row[id]"),
    click("#details .buttons button"-"Clone"),
    see("return [...typhon.store.agents.values()].filter(a => \c
         a.name.startsWith('ann')).length === 2"),
    click("#details .buttons button"-"Dispose"),
    wait_until(agent_join(Agent, disposed, 0), 10),
    reads("#details .pill", "ended"),
    reads("#details .facts", "disposed").

scene(hostile_names) :-
    hostile(Name),
    nth_host(1, First),
    remote(First, ( leave(Name), assertz(door(Name)) )),
    remote(First, call(typhon:host_start(Name, []))),
    remote(First, call(typhon:host_property(Name, address(Host)))),
    link(First, Host),
    agent_create(clauses([ (:- agent(Name, [state([f/1])])), f(Name),
                           (main :- log(Name), receive(_-go), move(First)),
                           on_message(_, _) ]),
                 Agent, [host(Host), name(Name)]),
    agent_send(Agent, hello(Name)),
    see("return typhon.store.hosts.size === 61"),
    at(Browser, _, _),
    forall(member(View, [map, tree, time, space, sequence, replay, hosts, agents]),
           view(View)),
    browser_run(Browser, "typhon.app.select({agent: args[0]})", [Agent], _),
    reads("#details .terms", "<img src=x"),
    reads("#details li code", "hello("),
    reads("#table-agent .row", "<img src=x"),
    agent_send(Agent, go),
    browser_run(Browser, "typhon.app.select({host: args[0]})", [First], _),
    reads("#details .terms", "<img src=x"),
    sees("return [globalThis.hit ?? 0, document.images.length]", [0, 0]),
    remote(First, call(typhon:host_stop(Name))).

scene(links_come_and_go) :-
    nth_host(2, A),
    nth_host(3, B),
    nth_host(22, C),
    see("return [...typhon.store.hosts.values()].filter(h => \c
         h.state === 'running').length === 60"),
    sees("return typhon.store.links.size", Before),
    unlink(A, B),
    links_are(Before-1),
    link(A, C),
    link(A, B),
    links_are(Before+1),
    unlink(A, C).

%   A host that an agent cannot leave.

scene(isolated_host_is_not_suggested) :-
    maplist(nth_host, [1, 2, 11], [Host, Right, Below]),
    unlink(Host, Right),
    unlink(Host, Below),
    see("return typhon.store.hosts.get([...typhon.store.hosts.keys()]\c
         .find(id => id.startsWith('n1@'))).links.size === 0"),
    sees("typhon.app.select({})", _),
    click("#actions button"),
    click("[role=menuitem]"-"New agent …"),
    reads("dialog label", "Host"),
    sees("return [...document.querySelectorAll('dialog label')].find(l => \c
          l.firstChild.textContent === 'Host').querySelector('input').value",
         Proposed),
    assertion(atom_string(Right, Proposed)),
    keys([escape]),
    link(Host, Right),
    link(Host, Below).

%   Children below their supervisor, its actions, and services on a host.

scene(supervision_tree_is_shown) :-
    nth_host(4, Host),
    Worker = clauses([(:- agent(worker, [])), (main :- receive(_-stop))]),
    Clerk = clauses([ (:- agent(clerk, [])),
                      (main :- offer(shop(tea), [price(7)]), receive(_-stop)) ]),
    agent_create(agents(supervisor), Top,
                 [ host(Host),
                   facts([child(wilma, Worker, []), child(chloe, Clerk, [])]) ]),
    view(tree),
    reads("#panel-tree .tree .tree li", "wilma"),
    reads("#panel-tree .tree .tree li", "chloe"),
    accessible,
    sees("[...document.querySelectorAll('#panel-tree .tree .tree button')]
              .find(b => b.textContent.startsWith('wilma')).click()", _),
    reads("#details h2", "wilma"),
    wait_until(( agent_property(Top, facts(Facts)),
                 memberchk(running(wilma, Wilma), Facts) ), 10),
    agent_send(Wilma, stop),
    reads("#panel-tree .log li", "restarts([wilma])"),
    at(Browser, _, _),
    browser_run(Browser, "typhon.app.select({host: args[0]})", [Host], _),
    see("return [...document.querySelectorAll('#details summary')]
              .find(s => s.textContent.startsWith('Services'))"),
    sees("[...document.querySelectorAll('#details summary')]
              .find(s => s.textContent.startsWith('Services'))
              .parentElement.open = true", _),
    reads("#details .terms", "shop(tea), by chloe"),
    agent_send(Top, stop),
    reads("#panel-tree .empty", "No agent monitors another"),
    sees("typhon.app.select({})", _),
    view(agents).

scene(two_browsers) :-
    at(Browser, Base, _),
    nth_host(7, Host),
    browser_tabs(Browser, [One]),
    browser_tab(Browser, Two),
    set_setting(typhon_page_browsers:browsers, 1),
    browser_open(Browser, Base),
    reads("#state", "Too many browsers"),
    see("return typhon.app.connection.wait > 300"),
    sees("return typhon.app.state", "refused"),
    set_setting(typhon_page_browsers:browsers, 32),
    live(Browser),
    agent_create(clauses([(:- agent(both, [])), on_message(_, _)]), _,
                 [host(Host)]),
    forall(member(Tab, [Two, One]),
           ( browser_goto_tab(Browser, Tab),
             see("return [...typhon.store.agents.values()].some(a => \c
                  a.name.startsWith('both'))") )).

scene(reload) :-
    at(Browser, _, _),
    browser_run(Browser, "location.reload()", _),
    live(Browser),
    see("return typhon.store.hosts.size === 60 && typhon.app.view === 'agents'").

%   From the top of the page to an opened host, by the keyboard alone.

scene(keyboard_alone) :-
    sees("document.querySelector('.skip').focus()", _),
    keys([tab]),
    sees("return document.activeElement.id", "tab-agents"),
    keys([right, right, left, left, left]),
    sees("return typhon.app.view", "hosts"),
    keys([tab]),
    sees("return document.activeElement.textContent", "New"),
    keys([enter]),
    reads("[role=menu]", "New agent"),
    keys([down, down, up, escape]),
    see("return document.querySelector('[role=menu]').hidden"),
    keys([tab, tab, tab, tab]),
    sees("return document.activeElement.getAttribute('role')", "grid"),
    keys([down, down, down, end, up, enter]),
    reads("#details h2", "n59"),
    keys(["2"]),
    see("return document.querySelector('#table-host [aria-sort=ascending]')\c
         .dataset.key === 'process'"),
    keys([escape]),
    see("return document.querySelector('#details').hidden").

scene(network_is_started_and_stopped) :-
    at(_, _, First),
    click("#actions button"),
    click("[role=menuitem]"-"New network …"),
    fill("Shape", "ring"),
    fill("Hosts", "5"),
    fill("Links come and go", "toggle(uniform(0.2,0.4),0.5,0.5)"),
    click("dialog button[type=submit]"),
    see("return !document.querySelector('dialog')"),
    see("return typhon.store.hosts.size >= 65"),
    see("return typhon.store.counts.unlink > 2 && typhon.store.counts.link > 2"),
    network_property(New, seed(_)),
    New \== First,
    !,
    click("#actions button"),
    click("[role=menuitem]"-"End a network …"),
    fill("Network", New),
    click("dialog button[type=submit]"),
    see("return !document.querySelector('dialog')"),
    findall(N, network_property(N, seed(_)), Left),
    assertion(Left == [First]).

scene(a_mechanism_is_started) :-
    click("#actions button"),
    click("[role=menuitem]"-"Start a mechanism …"),
    see("return document.querySelector('dialog select')"),
    sees("const s = document.querySelector('dialog select'); s.value = \c
          [...s.options].find(o => o.text === 'sync: sequence start').value; \c
          s.dispatchEvent(new Event('change'))", _),
    reads("dialog .about", "traveller.pl"),
    fill("Sequence", "line"),
    fill("Tasks", "[drill-sleep(1), paint-sleep(1)]"),
    fill("Options", "[agents(4)]"),
    sees("return [...document.querySelectorAll('.parameters input[type=range]')]\c
          .map(s => s.ariaLabel).join()", Sliders),
    assertion(Sliders == "delta, slider,theta, slider,maximum, slider,\c
                          window, slider,patience, slider"),
    slide("delta", "0.81", "0.81"),
    slide("patience", "0", "0.1"),
    click("dialog button[type=submit]"),
    see("return !document.querySelector('dialog')"),
    see("return [...typhon.store.agents.values()].filter(a => \c
         a.name.startsWith('traveller')).length === 4"),
    sees("return [...typhon.store.agents.values()].find(a => \c
          a.name.startsWith('traveller')).id", Id),
    atom_string(Agent, Id),
    agent_property(Agent, facts(Facts)),
    findall(Name-Value, member(setting(Name, Value), Facts), Settings),
    assertion(Settings == [start-order, delta-0.81, patience-0.1]),
    view(map),
    see("return document.querySelector('#details').hidden && \c
         typhon.store.counts.arrived > 20"),
    sees("document.querySelector('#notes').replaceChildren()", _).

%   Opening another log closes the one before.

scene(one_replay_at_a_time) :-
    view(replay),
    see("return typhon.app.views.get('replay')"),
    sees("const { open } = typhon.app.views.get('replay'),
              text = [0, 500].map(t => `event(${t}, 'a@h:1', 'b.1@a@h:1', created).`)
                  .join('\\n'),
              first = await open(new File([text], 'one.log'));
          first.player.setSpeed(0.01);
          first.player.play();
          const before = first.player.playing,
              second = await open(new File([text], 'two.log'));
          return [before, first.player.playing,
              document.querySelectorAll('.replay').length,
              second.player !== first.player,
              document.querySelector('#panel-replay [role=status]').textContent]",
         Seen),
    assertion(Seen == [true, false, 1, true, ""]).

scene(page_is_accessible) :-
    at(Browser, _, _),
    nth_host(1, Host),
    forall(member(View-Theme, [ map-dark, tree-light, hosts-dark, agents-light, time-light,
                                space-light, sequence-light, replay-dark ]),
           ( browser_theme(Browser, Theme),
             view(View),
             accessible )),
    browser_theme(Browser, dark),
    view(hosts),
    browser_run(Browser, "typhon.app.select({host: args[0]})", [Host], _),
    reads("#details .plain", "n2"),
    accessible,
    browser_theme(Browser, light),
    click("#actions button"),
    click("[role=menuitem]"-"New agent …"),
    reads(".advice", "wrong"),
    accessible,
    keys([escape]).

scene(narrow_window) :-
    at(Browser, _, _),
    browser_size(Browser, 400, 800),
    sees("typhon.app.select({})", _),
    forall(member(View, [map, hosts, agents, tree, time, space, sequence,
                         replay]),
           ( view(View),
             sees("return document.documentElement.scrollWidth", Width),
             assertion(Width =< 400) )),
    accessible,
    view(map),
    view(agents),
    click("#table-agent .row[id]"),
    reads("#details dd", "n"),
    click("button.close"),
    browser_size(Browser, 1600, 1000).

scene(a_process_is_killed) :-
    at(_, _, Network),
    network_property(Network, processes([_, Pid|_])),
    capturing(( process_kill(Pid, kill),
                see("return [...typhon.store.hosts.values()].filter(h => \c
                     h.state === 'lost').length === 15"),
                view(hosts),
                sees("const field = document.querySelector('#panel-hosts input');
                      field.value = 'lost';
                      field.dispatchEvent(new Event('input'))", _),
                reads("#table-host .row.over", "lost"),
                reads("#panel-hosts [role=status]", "15 hosts"),
                reads("#state", "15 lost") ), _).

scene(console_has_no_errors) :-
    at(Browser, _, _),
    browser_complaints(Browser, Texts),
    assertion(Texts == []).

%   When the page stops, that is shown, and its content stays; it continues
%   when there is a page again at the same address.

scene(connection_lost) :-
    at(_, Base, _),
    page_stop,
    reads("#state", "connection lost"),
    reads("#notes", "connection is lost"),
    click("#actions button"),
    click("[role=menuitem]"-"End a network …"),
    reads("#notes .error", "does not answer"),
    see("return typhon.store.hosts.size >= 60"),
    served_again(Base, [read_only(true)]),
    reads("#state", "live"),
    reads("#state", "only to look at"),
    sees("return document.querySelector('#actions').childElementCount", 0).

:- end_tests(page).

%   Enter opens the element Title.

searched(Text, Title) :-
    sees("const field = document.querySelector('[type=search]');
          field.value = ''; field.focus()", _),
    keys([Text, enter]),
    format(string(Opened), "return document.querySelector('#details h2')\c
                            ?.textContent.split('.')[0] === ~q", [Title]),
    see(Opened).

links_are(Count0) :-
    Count is Count0,
    format(string(Script), "return typhon.store.links.size === ~d", [Count]),
    see(Script).

%   A page at the address of an earlier one.

served_again(Base, Options) :-
    atomic_list_concat([_, _, Site, Token, _], /, Base),
    atomic_list_concat([_, Port0], :, Site),
    atom_number(Port0, Port),
    setup_call_cleanup(
        wrap_predicate(typhon_page_guard:token_new(New), same, _, New = Token),
        page_serve([port(Port)|Options], _),
        unwrap_predicate(typhon_page_guard:token_new/1, same)).

program(":- agent(ann, [state([seen/1])]).\n\c
         \n\c
         main :-\n\c
         \s   neighbours(Hosts),\n\c
         \s   forall(member(Host, Hosts), move(Host)).\n").

corrected(":- agent(ann, [state([seen/1])]).\n\c
           main :- ( receive(_-stop, 0.3) -> stay ; go, main ).\n\c
           stay :- assertz(seen(stop)), receive(_-never).\n\c
           go :- neighbours(Hosts), random_member(Host, Hosts),\n\c
           move(Host), assertz(seen(Host)).\n").

ann(Agent) :-
    at(_, _, Network),
    wait_until(( network_property(Network, agents(Agents)),
                 member(Agent, Agents),
                 sub_atom(Agent, 0, _, _, ann) ), 10),
    !.
