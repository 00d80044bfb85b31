:- module(test_playground_scenes,
          [ with_playground/3,          % -Dir, -Address, :Goal
            failing/2                   % :With, -Names
          ]).

/** <module> What readers do with the playground, in any browser

*Threading*: one thread; a server has its own.
*/

:- use_module(browser).
:- use_module(common, [project_file/2]).
:- use_module(made_once, [made_once/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(http/http_dispatch), [http_reply_file/3]).
:- use_module(library(http/thread_httpd), [http_server/2, http_stop_server/2]).
:- use_module(library(lists), [append/3, memberchk/2]).
:- use_module(library(process), [process_create/3, process_wait/2]).

:- meta_predicate
    with_playground(-, -, 0),
    failing(2, -).

build(Dir) :-
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

%!  with_playground(-Dir, -Address, :Goal) is semidet.
%
%   Call Goal once while the playground, in the folder Dir, is at Address.

with_playground(Dir, Address, Goal) :-
    setup_call_cleanup(
        ( made_once(playground, build, Dir),
          http_server(test_playground_scenes:reply(Dir),
                      [ port(localhost:Port), workers(4),
                        keep_alive_timeout(0.5) ]) ),
        ( format(atom(Address), 'http://localhost:~w/', [Port]),
          once(Goal) ),
        catch(http_stop_server(Port, []), error(_, _), true)).

%!  failing(:With, -Names:list) is det.
%
%   Names are those of the scenes that fail in the browser that call(With,
%   Browser, Goal) gives: one for all scenes, as its start takes longer than they
%   do.  The last ones have no server any more.

failing(With, Names) :-
    with_playground(_, Address,
                    call(With, Browser,
                         test_playground_scenes:all_failing(Browser, Address,
                                                            Names))).

all_failing(Browser, Address, Names) :-
    failing(scene, Browser, Address, Names0),
    atom_concat('http://localhost:', Rest, Address),
    atom_concat(Port0, /, Rest),
    atom_number(Port0, Port),
    http_stop_server(Port, []),
    failing(offline, Browser, Address, Names1),
    append(Names0, Names1, Names).

failing(Kind, Browser, Address, Names) :-
    findall(Name, ( Head =.. [Kind, Name, Browser],
                    clause(Head, Goal),
                    \+ passes(Browser, Address, Name, Goal) ), Names).

%   Only Chromium reports what its console has.

passes(firefox(_, _), _, nothing_is_complained_about, _) :-
    !.
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
    Hops == 3.
scene(nothing_is_complained_about, Browser) :-
    browser_complaints(Browser, _),
    set_up(Browser),
    browser_complaints(Browser, Texts),
    Texts == [].
scene(time_is_paused_until_go, Browser) :-
    show(Browser, [], [ "?- network_start(ring(3), N, [clock(virtual)]).",
                        "?- network_advance($N, 7)." ]),
    set_up(Browser),
    browser_wait(Browser, "return typhon.app.run.now.time !== null"),
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
scene(mechanism_has_sliders, Browser) :-
    set_up(Browser),
    browser_click(Browser, "#actions button"),
    browser_click(Browser, "[role=menuitem]"-"Start a mechanism …"),
    browser_wait(Browser, "return document.querySelector('dialog select')", 20),
    browser_run(Browser, "const s = document.querySelector('dialog select'); s.value = \c
        [...s.options].find(o => o.text === 'sync: sequence start').value; \c
        s.dispatchEvent(new Event('change'))", _),
    browser_wait(Browser, "return document.querySelector('[aria-label=\"delta, slider\"]')\c
        ?.nextElementSibling.value === '0.5'", 20).
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
scene(memory_is_bounded, Browser) :-
    show(Browser, [], [ "?- format(atom(A), '~*c', [10000000, 0'a]), between(1, 1000, N), \c
                          atom_concat(A, N, B), assertz(big(B)), fail." ]),
    browser_click(Browser, "#play button"-"Set up"),
    browser_wait(Browser, "return playground.page.said.textContent\c
        .includes('too much memory')", 60),
    show(Browser, [], ["?- network_start(ring(2), N, [clock(virtual)])."]),
    set_up(Browser).
scene(no_way_to_javascript, Browser) :-
    ways(Program),
    show(Browser, [["ways.pl", Program]],
         [ "?- [ways], ways, format(\"all tried~n\").",
           "?- catch((abolish(system:'$js_call'/2), system:'$js_call'(X, 'Date'), \c
               format(\"reached~n\")), E, (print(E), nl)).",
           "?- network_start(ring(2), N, [clock(virtual)])." ]),
    set_up(Browser),
    browser_run(Browser, "return playground.page.said.textContent", Said),
    sub_string(Said, _, _, _, "\nall tried"),
    \+ sub_string(Said, _, _, _, "\nreached").
scene(fits_a_phone, Browser) :-
    browser_size(Browser, 400, 800),
    browser_run(Browser, "return document.documentElement.scrollWidth <= innerWidth",
                Fits),
    Fits == true,
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

%   A program that calls all predicates of library(wasm), and those of C below
%   them, with scripts.

ways("ways :- forall(way(Way), catch(ignore(Way), _, true)).\n\c
     way(Module:Goal) :-\n\c
         way(Module, Name/Arity), length(Args, Arity), maplist(arg, Args),\n\c
         Goal =.. [Name|Args].\n\c
     way(wasm, PI) :- module_property(wasm, exports(PIs)), member(PI, PIs).\n\c
     way(system, Name/Arity) :-\n\c
         predicate_property(system:Head, visible), functor(Head, Name, Arity),\n\c
         member(Part, [js, await, wasm]), once(sub_atom(Name, _, _, _, Part)).\n\c
     arg(Script) :- script(Script).\n\c
     arg(eval(Script)) :- script(Script).\n\c
     arg(_).\n\c
     script(\"postMessage({said: ['reached']})\").\n").
