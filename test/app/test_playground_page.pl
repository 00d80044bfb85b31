:- module(test_playground_page, []).
:- use_module('../lib/common').

:- needs([page, wasm]).

/** <module> The playground, as a static site, in Chromium

*Threading*: the main thread; a server has its own.
*/

:- use_module('../lib/browser').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(http/http_dispatch), [http_reply_file/3]).
:- use_module(library(http/thread_httpd), [http_server/2, http_stop_server/2]).
:- use_module(library(lists), [append/3, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).

built(Dir) :-
    tmp_file(playground, Dir),
    project_file('app/playground/build.js', Script),
    process_create(path(node), ['--liftoff-only', Script, Dir],
                   [ stdout(null), stderr(pipe(Err)), process(Pid) ]),
    read_string(Err, _, Said),
    close(Err),
    process_wait(Pid, Status),
    assertion(Said-Status == ""-exit(0)).

:- public reply/2.

reply(Dir, Request) :-
    memberchk(path(Path0), Request),
    ( Path0 == / -> Path = '/index.html' ; Path = Path0 ),
    atom_concat(Dir, Path, File),
    http_reply_file(File, [unsafe(true), cache(false)], Request).

%   One browser for all scenes, as its start takes longer than they do.  The last
%   ones have no server any more.

failing(Names) :-
    built(Dir),
    http_server(test_playground_page:reply(Dir), [ port(localhost:Port), workers(4),
                                                 keep_alive_timeout(0.5) ]),
    format(atom(Address), 'http://localhost:~w/', [Port]),
    with_browser(Browser,
                 ( call_cleanup(failing(scene, Browser, Address, Names0),
                                http_stop_server(Port, [])),
                   failing(offline, Browser, Address, Names1) )),
    delete_directory_and_contents(Dir),
    append(Names0, Names1, Names).

failing(Kind, Browser, Address, Names) :-
    findall(Name, ( Head =.. [Kind, Name, Browser],
                    clause(Head, Goal),
                    \+ passes(Browser, Address, Name, Goal) ), Names).

passes(Browser, Address, Name, Goal) :-
    browser_open(Browser, 'about:blank'),
    browser_open(Browser, Address),
    catch(( waits_for_files(Browser), call(Goal) ), error(Formal, Context),
          ( print_message(informational, format("~w:", [Name])),
            print_message(error, error(Formal, Context)),
            fail )).

waits_for_files(Browser) :-
    browser_wait(Browser, "return globalThis.playground?.page?.files.size > 0").

set_up(Browser) :-
    browser_click(Browser, "#play button"-"Set up"),
    browser_wait(Browser, "return [...typhon.store.hosts.values()]\c
        .some(h => h.state === 'running')", 60).

go(Browser) :-
    browser_run(Browser, "typhon.app.run.speed(null)", _),
    browser_click(Browser, ".run-bar button"-"Go").

:- begin_tests(playground_page).

test(scenes, Failing == []) :-
    failing(Failing).

:- end_tests(playground_page).

                /*******************************
                *            SCENES            *
                *******************************/

%   No worker begins.

scene(nothing_runs_before_a_click, Browser) :-
    browser_run(Browser, "return typhon.app.connection.there", There),
    There == false.
scene(session_runs, Browser) :-
    set_up(Browser),
    go(Browser),
    browser_wait(Browser, "return playground.page.said.textContent\c
        .includes('Outcome = done')", 30),
    browser_run(Browser, "return typhon.store.counts.arrived", Hops),
    Hops == 3,
    browser_complaints(Browser, Texts),
    Texts == [].
scene(time_is_paused_until_go, Browser) :-
    show(Browser, [], [ "?- network_start(ring(3), N, [clock(virtual)]).",
                        "?- network_advance($N, 7)." ]),
    set_up(Browser),
    browser_run(Browser, "return typhon.app.run.now.time", Time),
    Time =:= 0,
    go(Browser),
    browser_wait(Browser, "return typhon.app.run.now.time >= 7", 30).
scene(study_has_sliders, Browser) :-
    browser_run(Browser, "location.hash = 'doc=examples/studies/coverage.pl'", _),
    browser_wait(Browser, "return playground.page.file === 'coverage.pl'"),
    browser_click(Browser, "#play button"-"Set up"),
    browser_wait(Browser, "return document.querySelector('[aria-label=\"side, slider\"]')\c
        ?.max === '9'", 60),
    browser_click(Browser, ".model-form button"-"Set up"),
    browser_wait(Browser, "return typhon.store.hosts.size === 9", 30),
    go(Browser),
    browser_wait(Browser, "return typhon.app.views.get('model').samples.length > 0 \c
        && typhon.app.views.get('model').seen.state === 'finished'", 60).
scene(editor_marks_mistakes, Browser) :-
    set_up(Browser),
    browser_run(Browser, "playground.page.editor.value = \c
        ':- agent(a).\\nmain :-\\n    foo(.\\n'", _),
    browser_wait(Browser, "return document.querySelector('.advice .error') !== null", 20).
scene(shared_link_has_the_program, Browser) :-
    show(Browser, [["a.pl", ":- agent(a).\nmain.\n"]], ["?- true."]),
    browser_click(Browser, "#play button"-"Share"),
    browser_wait(Browser, "return location.hash.startsWith('#p=')"),
    browser_run(Browser, "return location.href", Link),
    browser_open(Browser, 'about:blank'),
    browser_open(Browser, Link),
    browser_wait(Browser, "return globalThis.playground?.page?.files.get('a.pl') \c
        === ':- agent(a).\\nmain.\\n'"),
    browser_run(Browser, "return typhon.app.connection.there", There),
    There == false.
scene(damaged_link_is_reported, Browser) :-
    browser_run(Browser, "location.hash = 'p=AAAA'", _),
    browser_wait(Browser, "return document.querySelector('.note.error') !== null").
scene(endless_goal_is_stopped, Browser) :-
    show(Browser, [], ["?- repeat, fail."]),
    browser_click(Browser, "#play button"-"Set up"),
    browser_wait(Browser, "return typhon.app.state === 'open'", 60),
    browser_click(Browser, "#play button"-"Stop"),
    show(Browser, [], ["?- network_start(ring(2), N, [clock(virtual)])."]),
    set_up(Browser).
scene(no_way_to_javascript, Browser) :-
    show(Browser, [],
         [ "?- catch((call(wasm:(:=), X, 'self'), format(\"reached~n\")), E, (print(E), nl)).",
           "?- catch((js_run_script('1'), format(\"reached~n\")), E, (print(E), nl)).",
           "?- catch((system:'$js_call'(X, 'Date'), format(\"reached~n\")), E, (print(E), nl)).",
           "?- catch((abolish(system:'$js_call'/2), system:'$js_call'(X, 'Date'), format(\"reached~n\")), E, (print(E), nl)).",
           "?- network_start(ring(2), N, [clock(virtual)])." ]),
    set_up(Browser),
    browser_run(Browser, "return playground.page.said.textContent", Said),
    \+ sub_string(Said, _, _, _, "\nreached").
scene(fits_a_phone, Browser) :-
    browser_size(Browser, 400, 800),
    browser_run(Browser, "return document.documentElement.scrollWidth", Width),
    Width =< 400,
    browser_size(Browser, 1200, 800).
scene(files_are_kept, Browser) :-
    browser_wait(Browser, "return navigator.serviceWorker.controller?.state \c
        === 'activated'", 30).

%   All comes from the store of the browser.

offline(works_without_a_server, Browser) :-
    set_up(Browser).


show(Browser, Files, Queries) :-
    browser_run(Browser, "playground.page.show({files: arguments[0], \c
        queries: arguments[1]})", [Files, Queries], _).
