:- module(typhon_playground,
          [ begin/0
          ]).
:- use_module('../../prolog/typhon', []).
:- use_module('../../prolog/typhon/options/concurrency', []).
:- use_module('../../prolog/typhon/options/host_log', []).
:- use_module('../../prolog/typhon/options/virtual', []).
:- use_module('../../prolog/typhon/tools/page/tab', [tab_start/0]).
:- use_module(session, [session_begin/2]).
:- use_module(library(aggregate), []).
:- use_module(library(apply_macros), []).
:- use_module(library(assoc), []).
:- use_module(library(dcg/basics), []).
:- use_module(library(dicts), []).
:- use_module(library(filesex), [make_directory_path/1]).
:- use_module(library(gensym), []).
:- use_module(library(heaps), []).
:- use_module(library(nb_set), []).
:- use_module(library(option), []).
:- use_module(library(ordsets), []).
:- use_module(library(pairs), []).
:- use_module(library(random), []).
:- use_module(library(rbtrees), []).
:- use_module(library(solution_sequences), []).
:- use_module(library(strings), []).
:- use_module(library(ugraphs), []).
:- use_module(library(yall), []).

/** <module> What the saved state of the playground contains

The platform, and libraries that programs may load.

*Threading*: one thread, in WebAssembly.
*/

:- multifile typhon_page_tab:tab_order/3.

typhon_page_tab:tab_order("play", Message, Kind) :-
    session_begin(Message, Kind).

%!  begin is det.
%
%   Begin to serve the page of the tab.  A saved state has autoloading off, and
%   no sources; a file that is loaded must exist to be loaded once more.

begin :-
    set_prolog_flag(autoload, true),
    forall(( source_file(File),
             sub_atom(File, 0, _, _, '/typhon/'),
             \+ exists_file(File) ),
           empty_file(File)),
    user:use_module('/typhon/prolog/typhon'),
    tab_start.

empty_file(File) :-
    file_directory_name(File, Directory),
    make_directory_path(Directory),
    open(File, write, Out),
    close(Out).
