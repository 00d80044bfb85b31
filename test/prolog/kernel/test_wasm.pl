:- module(test_wasm, []).
:- use_module('../../lib/common').
:- use_module('../../lib/single_life').
:- use_module(library(plunit)).
:- use_module(library(process)).

:- needs([wasm]).

/** <module> The kernel in SWI-Prolog for WebAssembly, which Node runs

*Threading*: the main thread.
*/

:- begin_tests(wasm).

test(agents_run, Unexpected == unexpected([], [])) :-
    project_file('test/lib/wasm/run.js', Script),
    project_file(prolog, Prolog),
    life_file(File),
    setup_call_cleanup(
        process_create(path(node), [Script, Prolog, File],
                       [ stdout(pipe(Out)), stderr(null), process(Pid) ]),
        ( read_string(Out, _, Text),
          process_wait(Pid, Status) ),
        close(Out)),
    assertion(Status == exit(0)),
    life_differences(Text, Unexpected).

:- end_tests(wasm).
