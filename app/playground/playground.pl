:- module(typhon_playground,
          [ begin/0
          ]).
:- use_module('../../prolog/typhon', []).
:- use_module('../../prolog/typhon/options/concurrency', []).
:- use_module('../../prolog/typhon/options/host_log', []).
:- use_module('../../prolog/typhon/options/virtual', []).
:- use_module('../../prolog/typhon/tools/page/tab', [tab_start/0]).
:- use_module(session, [session_begin/2]).
:- use_module(library(filesex), [make_directory_path/1]).

%   There is no index of libraries to load from.  Programs have these.

:- user:use_module(library(aggregate)).
:- user:use_module(library(apply)).
:- user:use_module(library(assoc)).
:- user:use_module(library(dicts)).
:- user:use_module(library(error)).
:- user:use_module(library(gensym)).
:- user:use_module(library(heaps)).
:- user:use_module(library(listing)).
:- user:use_module(library(lists)).
:- user:use_module(library(nb_set)).
:- user:use_module(library(option)).
:- user:use_module(library(ordsets)).
:- user:use_module(library(pairs)).
:- user:use_module(library(random)).
:- user:use_module(library(rbtrees)).
:- user:use_module(library(readutil)).
:- user:use_module(library(solution_sequences)).
:- user:use_module(library(strings)).
:- user:use_module(library(ugraphs)).
:- user:use_module(library(yall)).
:- use_module(library(dcg/basics), []).

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
    set_prolog_flag(verbose, normal),
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
