:- module(typhon_editors, []).

/** <module> What editors know of agent programs

Editors see a program through library(prolog_xref) and
library(prolog_colour): PceEmacs, Sweep for Emacs, the language server
lsp_server. These learn here that a file with `:- agent(Name, Options)` has
the vocabulary of agents, calls main/0 and on_message/2, and which of its
predicates are state; and that a payload offers what it provides. What is
loaded is not concerned.

*Threading*: any thread, see prolog_load_context/2.
*/


:- use_module(library(lists), [member/2]).

:- multifile
    user:term_expansion/2,
    prolog_colour:directive_colours/2.
:- dynamic
    user:term_expansion/2.

user:term_expansion((:- Directive), Directives) :-
    current_prolog_flag(xref, true),
    means(Directive, Directives).

means(agent(Name), Directives) :-
    means(agent(Name, []), Directives).
means(agent(_, Options),
      [ (:- export([main/0, on_message/2])),
        (:- dynamic(State)),
        (:- use_module(Vocabulary))
      ]) :-
    declared(state, Options, State),
    findall(File, vocabulary(File), Vocabulary).
means(payload(_, Options), [(:- export(Provided))]) :-
    declared(provides, Options, Provided).

vocabulary(File) :-
    member(Module, [typhon_words, typhon_memory]),
    module_property(Module, file(File)).

%   What is being written may be anything.

declared(Name, Options, PIs) :-
    Option =.. [Name, PIs0],
    (   is_list(Options),
        memberchk(Option, Options),
        is_list(PIs0)
    ->  PIs = PIs0
    ;   PIs = []
    ).

prolog_colour:directive_colours(agent(_), built_in-[classify]).
prolog_colour:directive_colours(agent(_, _), built_in-[classify, classify]).
prolog_colour:directive_colours(payload(_), built_in-[classify]).
prolog_colour:directive_colours(payload(_, _), built_in-[classify, classify]).
