:- module(test_page_replay, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/texts', [write_file/2, write_file/3]).
:- use_module('../../../lib/networks').

:- needs([chromium, 'chromium-driver']).

:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(sgml), [load_structure/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/page), [page_export/3]).
:- use_module('../../../lib/browser').
:- use_module('../../../lib/pages').

/*  A log is made, opened as one file in Chromium, and used as by a person.
    All tests look at the same page, one after the other. */

:- dynamic replayed/3.                  % Browser, Log, Dir

hostile('<img src=x onerror=alert(1)></script><script>alert(2)</script>').

program(talker, "
:- agent(talker, [state([left/1])]).
overlay('rounds left', bar, log(left(N)), N).
left(6).
main :- receive(_-go(Other)), rounds(Other).
rounds(Other) :-
    retract(left(N)), N > 0, !,
    M is N-1, assertz(left(M)), log(left(M)),
    send(Other, round(N)),
    neighbours(Hosts), last(Hosts, Last), move(Last),
    rounds(Other).
rounds(_).
on_message(_, _).
").

with_replay(Goal) :-
    with_tmp_dir(replay_in(Goal)).

:- meta_predicate with_replay(0), replay_in(0, +).

replay_in(Goal, Dir) :-
    maplist(directory_file_path(Dir), ['talker.pl', 'a<b>.log', 'log.html'],
            [Program, Log, Html]),
    make_log(Program, Log),
    page_export(Log, Html, [overlays([Program])]),
    with_browser(Browser,
                 ( atom_concat('file://', Html, Address),
                   browser_open(Browser, Address),
                   browser_wait(Browser, "return globalThis.typhon"),
                   setup_call_cleanup(
                       assertz(replayed(Browser, Log, Dir)),
                       call(Goal),
                       retractall(replayed(_, _, _))) )).

make_log(Program, Log) :-
    program(talker, Text),
    write_file(Program, Text),
    no_leaks(run(Program, Log)).

run(Program, Log) :-
    with_network(grid(3, 4),
                 [ clock(virtual), seed(1), hop_time(uniform(0.5, 1.5)),
                   log(Log, [hops, messages(content), links, hosts]) ], Network,
        talk(Program, Network)).

talk(Program, Network) :-
    network_property(Network, hosts(Hosts)),
    hostile(Name),
    findall(Agent,
            ( nth1(I, [Name, bob, ann], Called),
              nth1(I, Hosts, Host),
              agent_create(Program, Agent, [host(Host), name(Called)]) ),
            [A, B, C]),
    forall(member(From-To, [A-B, B-C, C-A]), agent_send(From, go(To))),
    forall(member(Agent, [A, B, C]), agent_send(Agent, '<b>not markup</b>')),
    agent_join(A, timeout, 30),         % virtual time goes on meanwhile
    forall(member(Agent, [A, B, C]), agent_property(Agent, hops(6))).

%   logged(+From, +To, ?Kind, -Count): events from the log itself, by kind.

logged(Until, Kind, Count) :-
    replayed(_, Log, _),
    log_events(Log, Events),
    aggregate_all(count,
                  ( member(event(Time, _, _, What), Events),
                    Time =< Until,
                    kind(What, Its),
                    Its == Kind ),
                  Count).

kind(What, left) :- What = left(To), atom(To), !.
kind(arrived(_, _), arrived) :- !.
kind(created, created) :- !.
kind(sent(_), sent) :- !.
kind(sent(_, _), sent) :- !.
kind(received(_), received) :- !.
kind(received(_, _), received) :- !.
kind(ended(_), ended) :- !.
kind(What, Kind) :- functor(What, Kind, 1), arg(1, What, To), atom(To), !.
kind(What, What) :- memberchk(What, [started, stopped]), !.
kind(_, log).

counts(Counts) :-
    replayed(Browser, _, _),
    browser_run(Browser, "return typhon.store.counts", Counts).

same_counts(Until) :-
    counts(Counts),
    forall(member(Kind, [created, left, arrived, sent, received, ended, log,
                         link, unlink, started, stopped]),
           ( logged(Until, Kind, Expected),
             get_dict(Kind, Counts, Shown),
             assertion(Kind-Shown == Kind-Expected) )),
    assertion(Counts.unknown == 0).

seek(Share, Time) :-
    replayed(Browser, _, _),
    browser_run(Browser, "const p = typhon.player; p.pause(); \c
        p.seek(p.first + args[0] * (p.last - p.first)); return p.time",
        [Share], Time).

%   `make page-tools` was called.

tools_there :-
    project_file('prolog/typhon/tools/page/www/uPlot.iife.min.js', File),
    exists_file(File).

%   The replay stays open from the first test to the last, in its own thread.

:- dynamic holder/1.

open_replay :-
    thread_self(Me),
    thread_create(call_cleanup(with_replay(hold(Me)),
                               thread_send_message(Me, replay_is(over))),
                  Holder),
    assertz(holder(Holder)),
    thread_get_message(replay_is(How)),
    (   How == open
    ->  true
    ;   close_replay,
        fail
    ).

hold(Thread) :-
    thread_send_message(Thread, replay_is(open)),
    thread_get_message(close_replay).

close_replay :-
    retract(holder(Holder)),
    catch(thread_send_message(Holder, close_replay), error(_, _), true),
    thread_join(Holder, Status),
    assertion(Status == true),
    thread_get_message(replay_is(over)).

look(Script, Result) :-
    replayed(Browser, _, _),
    browser_run(Browser, Script, Result).

%   saved(+View, +Kind, -File): the file that a button of a view saves.

saved(View, svg, File) :-
    replayed(_, _, Dir),
    format(string(Script), "typhon.show(~d); \c
        await new Promise(done => setTimeout(done, 100)); \c
        return typhon.views[~d].view.toSVG()", [View, View]),
    look(Script, Text),
    format(atom(Name), 'view~d.svg', [View]),
    directory_file_path(Dir, Name, File),
    write_file(File, Text).

:- begin_tests(page_replay, [ condition(tools_there), setup(open_replay),
                              cleanup(close_replay) ]).

test(counts_at_the_end) :-
    seek(1, Time),
    same_counts(Time).
test(counts_in_between) :-
    forall(member(Share, [0.2, 0.7, 0.4, 0]),
           ( seek(Share, Time), same_counts(Time) )).
test(all_hosts_of_a_grid, Places == 12) :-
    look("typhon.show(0); \c
          await new Promise(done => setTimeout(done, 300)); \c
          return new Set([...typhon.views[0].view.places.values()]
              .map(p => p.x + ' ' + p.y)).size", Places).
test(hops_between_linked_hosts) :-
    seek(0.5, _),
    look("return [...typhon.store.links.values()].length", Links),
    assertion(Links > 3).
test(step_by_step, Steps-Back == 5-Before) :-
    seek(0, _),
    look("return typhon.player.next", Before),
    look("const p = typhon.player, times = new Set(); \c
          for (let i = 0; i < 5; i++) { p.step(1); times.add(p.time); } \c
          return times.size", Steps),
    look("const p = typhon.player; for (let i = 0; i < 5; i++) p.step(-1); \c
          return p.next", Back).
test(plays_to_the_end, End == true) :-
    seek(0, _),
    look("typhon.player.setSpeed(50); \c
          document.querySelector('[aria-label=Play]').click()", _),
    replayed(Browser, _, _),
    browser_wait(Browser, "return !typhon.player.playing"),
    look("return typhon.player.time === typhon.player.last", End),
    seek(1, Time),
    same_counts(Time).
test(agent_in_flight, Between == true) :-
    seek(1, _),
    look("const p = typhon.player; p.setSpeed(1); \c
          const [time, , id, , to, took] = p.events.find(e => \c
              e[3] === 'left' && e[5] > 0.4); \c
          p.seek(time + took / 2); \c
          const agent = typhon.store.agents.get(id); \c
          const share = typhon.store.progress(agent.hop); \c
          return agent.hop.to === to && share > 0.4 && share < 0.6", Between).
test(overlay_of_the_program, Left == [5, 0]) :-
    seek(1, _),
    look("const o = typhon.store.overlays.get('rounds left'); \c
          const values = [...o.values.values()]; \c
          return [Math.max(...values), Math.min(...values)]", Left).
test(slider_by_keyboard, Moved == true) :-
    seek(0.5, Time),
    replayed(Browser, _, _),
    look("document.querySelector('input[type=range]').focus()", _),
    browser_keys(Browser, [end]),
    look("return typhon.player.time", After),
    ( After > Time -> Moved = true ; Moved = false ).
test(map_by_keyboard, Chosen == Named) :-
    seek(0, _),
    replayed(Browser, _, _),
    look("typhon.show(0); typhon.app.select({}); \c
          document.querySelector('.view-map canvas[tabindex]').focus()", _),
    browser_keys(Browser, [right]),
    look("return typhon.views[0].view.scene.focus", First),
    assertion(sub_string(First, 0, _, _, "n1@")),
    browser_keys(Browser, [right]),
    look("return typhon.views[0].view.scene.focus", Second),
    assertion(sub_string(Second, 0, _, _, "n2@")),
    browser_keys(Browser, ["."]),
    look("return typhon.app.chosen.agent", Chosen),
    look("return [...typhon.store.agents.values()] \c
              .find(agent => agent.name.startsWith('bob')).id", Named),
    look("return document.querySelector('.view-said').textContent", Said),
    assertion(sub_string(Said, _, _, _, "on n2")).
test(views_as_svg) :-
    seek(1, _),
    forall(member(View, [0, 1, 2, 3]),
           ( saved(View, svg, File),
             load_structure(File, [element(Name, _, Content)|_],
                            [dialect(xml)]),
             assertion(Name == svg),
             length(Content, Length),
             assertion(Length > 10) )).
test(views_as_png, Sizes == [true, true, true, true]) :-
    look("const all = []; \c
          for (const [i, { view }] of typhon.views.entries()) { \c
              typhon.show(i); \c
              await new Promise(done => setTimeout(done, 100)); \c
              const blob = await view.toPNG(); \c
              all.push(blob.type === 'image/png' && blob.size > 3000); } \c
          return all", Sizes).
test(sequence_of_messages, true(Rows > 10)) :-
    seek(1, _),
    look("typhon.show(2); return typhon.views[2].view.chart().rows.length",
         Rows).
test(arrows_of_the_sequence_are_labelled_with_messages) :-
    seek(1, _),
    look("typhon.show(2); return typhon.views[2].view.toSVG()", Svg),
    load_structure(string(Svg), Tree, [dialect(xml)]),
    findall(Label, ( sub_term(element(_, _, [Label]), Tree), atom(Label),
                     sub_atom(Label, 0, _, _, 'round(') ), Labels),
    assertion(memberchk('round(6)', Labels)).
test(plots_have_points, true(Points > 5)) :-
    look("typhon.show(3); typhon.views[3].view.draw(); \c
          return typhon.views[3].view.plots[0].drawn.data[0].length", Points).
test(hidden_rows_are_not_drawn, [Hidden, Shown] == [0, true]) :-
    look("const { scene, legend } = typhon.views[0].view, p = typhon.player; \c
          let drawn = 0; \c
          const before = scene.drawTop, update = legend.update; \c
          scene.drawTop = (...all) => { drawn++; before.apply(scene, all); }; \c
          legend.update = () => { drawn++; update(); }; \c
          const playing = async view => { \c
              typhon.show(view); p.seek(p.first); \c
              p.setSpeed(1); p.play(); \c
              await new Promise(requestAnimationFrame); \c
              await new Promise(requestAnimationFrame); \c
              drawn = 0; \c
              const start = Date.now(), past = () => Date.now() - start; \c
              const enough = () => view != 0 || drawn > 2 || past() > 15000; \c
              while (past() < 400 || !enough()) \c
                  await new Promise(done => setTimeout(done, 50)); \c
              p.pause(); \c
              return drawn; }; \c
          const hidden = await playing(3), shown = await playing(0); \c
          scene.drawTop = before; \c
          legend.update = update; \c
          return [hidden, shown > 2]", [Hidden, Shown]).
test(narrow_and_dark_page, Wide == 400) :-
    replayed(Browser, _, _),
    browser_size(Browser, 400, 800),
    browser_theme(Browser, dark),
    look("return document.documentElement.scrollWidth", Wide),
    browser_size(Browser, 1600, 1000),
    browser_theme(Browser, light).
test(hostile_names_are_shown_as_text, [Images, Scripts] == [0, 0]) :-
    seek(1, _),
    hostile(Name),
    look("const a = [...typhon.store.agents.values()]; \c
          typhon.app.select({ agent: a.find(x => x.name.includes('img')).id }); \c
          for (const i of [0, 1, 2, 3]) { typhon.show(i); \c
              await new Promise(done => setTimeout(done, 150)); } \c
          typhon.show(0); \c
          const input = document.querySelector('input[type=search]'); \c
          input.value = 'img'; \c
          input.dispatchEvent(new Event('input')); \c
          typhon.views[2].view.add(a[0].id); \c
          return document.querySelectorAll('img').length", Images),
    look("return [...document.scripts].filter(s => \c
          /alert/.test(s.textContent) && s.type !== 'application/json').length",
         Scripts),
    look("return [...typhon.store.agents.values()].map(a => a.id)", Ids),
    assertion(( member(Id, Ids), sub_string(Id, 0, _, _, Name) )).
test(fetches_nothing, Fetched == []) :-
    look("return performance.getEntriesByType('resource').map(e => e.name)
          .filter(name => !name.startsWith('data:') && !name.startsWith('blob:'))",
         Fetched).
test(browser_reports_no_errors, Texts == []) :-
    replayed(Browser, _, _),
    browser_complaints(Browser, Texts).

:- end_tests(page_replay).

%   Processes report independently: the departure of an agent is reported after
%   its arrival, or end, as often as before.

with_store(Script, Result) :-
    format(string(Whole),
           "const store = new typhon.store.constructor(); ~s", [Script]),
    look(Whole, Result).

:- begin_tests(late_events, [ condition(tools_there), setup(open_replay),
                                 cleanup(close_replay) ]).

test(departure_reported_after_the_arrival,
     Seen == ["b@h:2", "running", 1, 0, 1]) :-
    with_store("store.applyEvents(
                    [[2, 'b@h:2', 'r.1', 'arrived', 'a@h:1', 0.1]]);
                store.applyEvents([[1, 'a@h:1', 'r.1', 'created'],
                    [1.5, 'a@h:1', 'r.1', 'received', 'user'],
                    [1.9, 'a@h:1', 'r.1', 'left', 'b@h:2']]);
                const { host, status, hops, received } = store.agents.get('r.1');
                return [host, status, hops,
                    store.hosts.get('a@h:1').agents.size, received]", Seen).
test(departure_reported_after_the_arrival_in_the_diagram,
     Lines == [["a@h:1", 1, 1.9], ["b@h:2", 2, 3]]) :-
    with_store("store.applyEvents([[1, 'a@h:1', 'r.1', 'created']]);
                store.applyEvents(
                    [[2, 'b@h:2', 'r.1', 'arrived', 'a@h:1', 0.1]]);
                store.applyEvents([[1.9, 'a@h:1', 'r.1', 'left', 'b@h:2'],
                    [3, 'a@h:1', '', 'unlink', 'b@h:2']]);
                const view = typhon.views[1].mount(document.body, store,
                    { chosen: {} });
                const { history } = view.sight();
                view.destroy();
                return history.stays.map(({ host, from, to }) => [host, from, to])",
               Lines).
test(departure_reported_after_the_end, Status == "ended") :-
    with_store("store.applyEvents(
                    [[2, 'b@h:2', 'r.1', 'arrived', 'a@h:1', 0.1],
                     [3, 'b@h:2', 'r.1', 'ended', 'done']]);
                store.applyEvents([[1, 'a@h:1', 'r.1', 'created'],
                    [1.9, 'a@h:1', 'r.1', 'left', 'b@h:2']]);
                return store.agents.get('r.1').status", Status).
test(clocks_that_differ, Hosts == ["b@h:2", "b@h:2"]) :-
    with_store("return [['arrived', 'a@h:1', 0.1], ['received', 'user']].map(
                    (what, n) => {
                        store.applyEvents([[5, 'a@h:1', `r.${n}`, 'created'],
                            [6, 'a@h:1', `r.${n}`, 'left', 'b@h:2'],
                            [4, 'b@h:2', `r.${n}`, ...what]]);
                        return store.agents.get(`r.${n}`).host; })", Hosts).
test(returning_agent, Seen == ["running", 1]) :-
    with_store("store.applyEvents([[1, 'a@h:1', 'r.1', 'created'],
                    [2, 'a@h:1', 'r.1', 'ended', 'done'],
                    [3, 'a@h:1', 'r.1', 'created']]);
                return [store.agents.get('r.1').status,
                    store.hosts.get('a@h:1').agents.size]", Seen).

%   Ended agents are not kept without a limit.

test(many_ends, Kept == [2000, 0, 2000]) :-
    with_store("for (let n = 0; n < 2500; n++)
                    store.applyEvents([[n, 'a@h:1', `x.${n}`, 'created'],
                        [n, 'a@h:1', `x.${n}`, 'left', 'b@h:2'],
                        [n + 0.1, 'b@h:2', `x.${n}`, 'arrived', 'a@h:1', 0.1],
                        [n + 0.2, 'b@h:2', `x.${n}`, 'ended', 'done'],
                        [n + 0.3, 'a@h:1', `x.${n}`, 'stayed', 'b@h:2'],
                        [n + 0.4, 'a@h:1', `x.${n}`, 'ended', 'done']]);
                return [store.agents.size, store.moving.size, store.ended.size]",
               Kept).

:- end_tests(late_events).

:- begin_tests(page_export, [condition(tools_there)]).

test(no_log, error(existence_error(source_sink, 'no.log'), _)) :-
    with_tmp_dir(Dir,
        ( directory_file_path(Dir, 'x.html', Html),
          page_export('no.log', Html, []) )).
test(unknown_option, error(domain_error(export_option, colour(red)), _)) :-
    page_export('a.log', 'a.html', [colour(red)]).
test(script_is_not_closed_by_a_name) :-
    with_tmp_dir(Dir,
        ( maplist(directory_file_path(Dir), ['a.log', 'a.html'], [Log, Html]),
          hostile(Name),
          write_file(Log, '~q.~n', [event(1, 'a@h:1', 'b.1@a@h:1', Name)]),
          page_export(Log, Html, []),
          read_file_to_string(Html, Text, [encoding(utf8)]),
          assertion(\+ sub_string(Text, _, _, _, "<img src=x")),
          assertion(sub_string(Text, _, _, _, "\\u003cimg src=x")) )).

:- end_tests(page_export).
