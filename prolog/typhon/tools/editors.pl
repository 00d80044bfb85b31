:- module(typhon_editors,
          [ directive_meant/2,          % +Directive, -Directives
            directive_coloured/2,       % +Directive, -Colours
            words_file/1                % ?File
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../kernel/program', [declaration/4, indicator_in/2]).
:- use_module('../kernel/vocabulary', []).

/** <module> What editors know of agent programs

Editors see a program through library(prolog_xref) and
library(prolog_colour): PceEmacs, Sweep for Emacs, the language server
lsp_server.  These learn here that in a file with `:- agent(Name, Options)`
what agents can say is built in, main/0 and on_message/2 are called, and
which of its predicates are state; and that a payload offers what it
provides.  What is loaded is not concerned.

*Threading*: any thread, see prolog_load_context/2.
*/

%!  directive_meant(+Directive, -Directives) is semidet.
%
%   Directive is a declaration of an agent or payload and stands for
%   Directives.

directive_meant(Directive, Directives) :-
    declared(Directive, Kind, Options),
    findall((:- Meant), meant(Kind, Options, Meant), Directives).

declared(Directive, Kind, Options) :-
    predicates_option(Kind, _, _),
    declaration(Kind, (:- Directive), _, Options),
    !.

meant(_, _, use_module(File)) :-
    words_file(File).
meant(agent, _, public([main/0, on_message/2])).
meant(Kind, Options, Meant) :-
    predicates_option(Kind, PIs, Option),
    member(Option, Options),
    findall(PI, indicator_in(PIs, PI), List),
    (   Meant = dynamic(List)
    ;   Kind == payload,
        Meant = public(List)            % agents that have it may call them
    ).

predicates_option(agent, PIs, state(PIs)).
predicates_option(payload, PIs, provides(PIs)).

%!  words_file(?File) is nondet.
%
%   File defines predicates that agents can call.

words_file(File) :-
    member(Module, [typhon_words, typhon_memory]),
    module_property(Module, file(File)).

%!  directive_coloured(+Directive, -Colours) is semidet.
%
%   As prolog_colour:directive_colours/2.

directive_coloured(Directive, built_in-Arguments) :-
    declared(Directive, Kind, Options),
    (   Options == []
    ->  Arguments = [identifier,classify]
    ;   findall(Colours, option_colours(Kind, Options, Colours), List),
        Arguments = [identifier,list-List]
    ).

option_colours(Kind, Options, Colours) :-
    member(Option, Options),
    (   predicates_option(Kind, _, Known),
        subsumes_term(Known, Option)
    ->  Colours = functor-[predicates]
    ;   Colours = type_error(option)
    ).
