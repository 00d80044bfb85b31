:- module(test_playground, []).
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
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).

:- meta_predicate playground(-, 0).

:- dynamic site/1, asked/1.

built(Dir) :-
    site(Dir),
    !.
built(Dir) :-
    tmp_file(playground, Dir),
    project_file('app/playground/build.js', Script),
    process_create(path(node), [Script, Dir],
                   [ stdout(null), stderr(pipe(Err)), process(Pid) ]),
    read_string(Err, _, Said),
    close(Err),
    process_wait(Pid, Status),
    assertion(Said-Status == ""-exit(0)),
    assertz(site(Dir)).

:- public reply/2.

reply(Dir, Request) :-
    memberchk(path(Path0), Request),
    ( Path0 == / -> Path = '/index.html' ; Path = Path0 ),
    assertz(asked(Path)),
    atom_concat(Dir, Path, File),
    http_reply_file(File, [unsafe(true), cache(false)], Request).

playground(Browser, Goal) :-
    built(Dir),
    retractall(asked(_)),
    setup_call_cleanup(
        http_server(test_playground:reply(Dir), [port(localhost:Port), workers(4)]),
        ( format(atom(Address), 'http://localhost:~w/', [Port]),
          with_browser(Browser, ( browser_open(Browser, Address),
                                  waits_for_files(Browser),
                                  call(Goal) )) ),
        http_stop_server(Port, [])).

waits_for_files(Browser) :-
    browser_wait(Browser, "return globalThis.playground?.page?.files.size > 0").

set_up(Browser) :-
    browser_click(Browser, "#play button"-"Set up"),
    browser_wait(Browser, "return [...typhon.store.hosts.values()]\c
        .some(h => h.state === 'running')", 60).

said(Browser, Text) :-
    browser_run(Browser, "return playground.page.said.textContent", Text).

go(Browser) :-
    browser_run(Browser, "typhon.app.run.speed(null)", _),
    browser_click(Browser, ".run-bar button"-"Go").

:- begin_tests(playground, [cleanup(forall(retract(site(Dir)),
                                            delete_directory_and_contents(Dir)))]).

%   Nothing but the files of the page is fetched, and no worker begins.

test(nothing_runs_before_a_click) :-
    playground(Browser, (
        browser_run(Browser, "return typhon.connection === undefined && \c
            typhon.app.connection.there", There),
        assertion(There == false) )).

test(session_runs, true(sub_string(Said, _, _, _, "Outcome = done"))) :-
    playground(Browser, (
        set_up(Browser),
        go(Browser),
        browser_wait(Browser, "return playground.page.said.textContent\c
            .includes('Outcome = done')", 30),
        said(Browser, Said),
        browser_run(Browser, "return typhon.store.counts.arrived", Hops),
        assertion(Hops == 3),
        browser_complaints(Browser, Texts),
        assertion(Texts == []) )).

test(time_is_paused_until_go, Time =:= 0) :-
    playground(Browser, (
        show(Browser, [], ["?- network_start(ring(3), N, [clock(virtual), hop_time(uniform(1,2))]).",
                           "?- network_advance($N, 7)."]),
        set_up(Browser),
        browser_run(Browser, "return typhon.app.run.now.time", Time),
        go(Browser),
        browser_wait(Browser, "return typhon.app.run.now.time >= 7", 30) )).

test(study_has_sliders) :-
    playground(Browser, (
        browser_run(Browser, "location.hash = 'doc=examples/studies/coverage.pl'", _),
        browser_wait(Browser, "return playground.page.file === 'coverage.pl'"),
        browser_click(Browser, "#play button"-"Set up"),
        browser_wait(Browser, "return document.querySelector('[aria-label=\"side, slider\"]')\c
            ?.max === '9'", 60),
        browser_click(Browser, ".model-form button"-"Set up"),
        browser_wait(Browser, "return typhon.store.hosts.size === 9", 30),
        go(Browser),
        browser_wait(Browser, "return typhon.app.views.get('model').samples.length > 0 \c
            && typhon.app.views.get('model').seen.state === 'finished'", 60) )).

test(editor_marks_mistakes) :-
    playground(Browser, (
        set_up(Browser),
        browser_run(Browser, "playground.page.editor.value = \c
            ':- agent(a).\\nmain :-\\n    foo(.\\n'", _),
        browser_wait(Browser, "return document.querySelector('.advice .error') !== null", 20) )).

%   A shared link has the program, and again runs nothing by itself.

test(share_and_open) :-
    playground(Browser, (
        show(Browser, [["a.pl", ":- agent(a).\nmain.\n"]], ["?- true."]),
        browser_click(Browser, "#play button"-"Share"),
        browser_wait(Browser, "return location.hash.startsWith('#p=')"),
        browser_run(Browser, "return location.href", Address),
        browser_open(Browser, 'about:blank'),
        browser_open(Browser, Address),
        browser_wait(Browser, "return globalThis.playground?.page?.files.get('a.pl') \c
            === ':- agent(a).\\nmain.\\n'"),
        browser_run(Browser, "return typhon.app.connection.there", There),
        assertion(There == false) )).

test(damaged_link) :-
    playground(Browser, (
        browser_run(Browser, "location.hash = 'p=AAAA'", _),
        browser_wait(Browser, "return document.querySelector('.note.error') !== null") )).

test(endless_goal_is_stopped) :-
    playground(Browser, (
        show(Browser, [], ["?- repeat, fail."]),
        browser_click(Browser, "#play button"-"Set up"),
        browser_wait(Browser, "return typhon.app.state === 'open'", 60),
        browser_click(Browser, "#play button"-"Stop"),
        show(Browser, [], ["?- network_start(ring(2), N, [clock(virtual)])."]),
        set_up(Browser) )).

%   With the server gone, all comes from the store of the browser.

test(works_offline) :-
    built(Dir),
    http_server(test_playground:reply(Dir), [port(localhost:Port), workers(4)]),
    format(atom(Address), 'http://localhost:~w/', [Port]),
    with_browser(Browser, (
        call_cleanup(( browser_open(Browser, Address),
                       waits_for_files(Browser),
                       browser_wait(Browser, "return navigator.serviceWorker\c
                           .controller?.state === 'activated'", 30) ),
                     http_stop_server(Port, [])),
        browser_open(Browser, Address),
        waits_for_files(Browser),
        set_up(Browser) )).

test(too_much_memory_ends_the_worker, true(sub_string(Said, _, _, _, "memory"))) :-
    playground(Browser, (
        show(Browser, [], ["?- forall(between(1, 12, N), ( numlist(1, 1 000 000, L), atom_codes(A, L), atomic_list_concat([A,A,A,A,A,A,A,A,A,A,A,A], B), nb_setval(N, B) ))."]),
        browser_click(Browser, "#play button"-"Set up"),
        browser_wait(Browser, "return /memory/.test(playground.page.said.textContent)", 60),
        said(Browser, Said) )).

%   A phone shows the program above the network.

test(narrow_screen, true(Width =< 400)) :-
    playground(Browser, (
        browser_size(Browser, 400, 800),
        browser_run(Browser, "return document.documentElement.scrollWidth", Width) )).

%   No way from a program to JavaScript.

test(no_javascript_from_prolog, true(Reached == [])) :-
    playground(Browser, (
        show(Browser, [], [
            "?- catch((call(wasm:(:=), X, 'self'), format(reached)), E, (print(E), nl)).",
            "?- catch((X := 'Date', format(reached)), E, (print(E), nl)).",
            "?- catch((js_run_script('1'), format(reached)), E, (print(E), nl)).",
            "?- catch((system:'$js_call'(X, 'Date'), format(reached)), E, (print(E), nl)).",
            "?- catch((abolish(system:'$js_call'/2), system:'$js_call'(X, 'Date'), format(reached)), E, (print(E), nl)).",
            "?- network_start(ring(2), N, [clock(virtual)])."]),
        set_up(Browser),
        said(Browser, Said) )),
    split_string(Said, "\n", "", Lines),
    findall(Line, ( member(Line, Lines), string_concat("reached", _, Line) ), Reached).

:- end_tests(playground).

show(Browser, Files, Queries) :-
    browser_run(Browser, "playground.page.show({files: arguments[0], \c
        queries: arguments[1]})", [Files, Queries], _).
