:- module(typhon_playground,
          [ playground_begin/0
          ]).
:- use_module(library(error), []).
:- use_module('../../prolog/typhon', []).
:- use_module('../../prolog/typhon/tools/page/tab', [tab_start/0]).
:- use_module('../../experiments/engine/gnuplot', []).
:- use_module(session, [session_begin/2]).

/** <module> What the saved state of the playground contains, beside the platform

*Threading*: one thread, in WebAssembly.
*/

:- multifile typhon_page_tab:tab_order/3.

typhon_page_tab:tab_order("play", Message, Kind) :-
    session_begin(Message, Kind).

%!  playground_begin is det.
%
%   Begin to serve the page of the tab, after platform_boot/0.

playground_begin :-
    forall(javascript(PI), remove(PI)),
    set_prolog_flag(verbose, normal),
    user:use_module('/typhon/prolog/typhon'),
    tab_start.

%   The ways from Prolog to JavaScript.  They are defined in C, so no program can
%   define them once they are removed.

javascript('$js_call'/2).
javascript(js_run_script/1).
javascript('$await'/2).

remove(Name/Arity) :-
    functor(Head, Name, Arity),
    redefine_system_predicate(system:Head),
    assertz((system:Head :- error:permission_error(call, javascript, Name/Arity))).
