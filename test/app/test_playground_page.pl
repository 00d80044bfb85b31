:- module(test_playground_page, []).
:- use_module('../lib/common').

:- needs([page, wasm]).

/** <module> The playground, as a static site, in Chromium

*Threading*: the main thread; a server has its own.
*/

:- use_module('../lib/browser', [with_browser/2]).
:- use_module('../lib/playground_scenes', [failing/2, with_playground/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_wait/2]).

:- begin_tests(playground_page).

test(scenes, Failing == []) :-
    failing(with_browser, Failing).
test(sessions_run_to_their_end, Said == "") :-
    with_playground(Dir, _, sessions(Dir, Said)).

:- end_tests(playground_page).

%   What does not work in the sessions that the site offers.

sessions(Dir, Said) :-
    project_file('test/lib/wasm/sessions.js', Script),
    process_create(path(node), ['--liftoff-only', Script, Dir],
                   [ stdout(pipe(Out)), stderr(null), process(Pid) ]),
    read_string(Out, _, Said),
    close(Out),
    process_wait(Pid, exit(0)).
