:- module(test_playground_firefox, []).
:- use_module('../lib/common').

:- needs([firefox, 'page-tools', wasm]).

/** <module> The playground, as a static site, in Firefox

*Threading*: the main thread; a server has its own.
*/

:- use_module('../lib/browser', [with_firefox/2]).
:- use_module('../lib/playground_scenes', [failing/2]).
:- use_module(library(plunit)).

:- begin_tests(playground_firefox).

test(scenes, Failing == []) :-
    failing(with_firefox, Failing).

:- end_tests(playground_firefox).
