:- module(typhon_playground,
          [ playground_begin/0
          ]).
:- use_module(library(lists), []).
:- use_module('../../prolog/typhon', []).
:- use_module('../../prolog/typhon/tools/page/tab', [tab_start/0]).
:- use_module(session, [session_begin/2]).

/** <module> What the saved state of the playground contains, beside the platform

*Threading*: one thread, in WebAssembly.
*/

:- multifile typhon_page_tab:tab_order/3.

typhon_page_tab:tab_order("play", Message, Kind) :-
    session_begin(Message, Kind).

%!  playground_begin is det.
%
%   Begin to serve the page of the tab, after platform_boot/0.  Programs cannot
%   call JavaScript: that is in the engine, whatever the state has.

playground_begin :-
    set_prolog_flag(verbose, normal),
    user:use_module('/typhon/prolog/typhon'),
    tab_start.
