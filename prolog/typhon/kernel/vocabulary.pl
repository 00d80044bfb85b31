:- module(typhon_vocabulary, []).

/** <module> The vocabulary: predicates that are visible to agents

This module is the import parent of all places.  It defines nothing: it imports
the predicates that modules declare by vocabulary/1 of typhon_mobile, and
libraries without state that agents may call without permission.

This is the interface of the layer: higher layers only load it.

*Threading*: not applicable, as this module only imports.
*/

:- ':'(system, set_module(':'(typhon_vocabulary, base(system)))).

:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(assoc)).
:- use_module(library(error)).
:- use_module(library(lists)).
:- use_module(library(option)).
:- use_module(library(ordsets)).
:- use_module(library(pairs)).
:- use_module(library(random)).
:- use_module(library(solution_sequences)).
:- use_module(library(yall)).
:- use_module(vocabulary/checked,
              [ '$checked'/1, '$checked'/2, '$checked'/3, '$checked'/4,
                '$checked'/5, '$checked'/6, '$checked'/7, '$checked'/8,
                '$uncaught'/1 ]).
:- use_module(vocabulary/words, []).
:- use_module(vocabulary/program_words, []).
