:- module(typhon_environment,
          [ hosts/0,
            agents/0
          ]).
:- autoload(agent_words,
            [ apropos_completed/3, directive_coloured/2, directive_meant/2,
              help_shown/1, word_lines/3, words_file/1, words_only/3 ]).
:- autoload(completion, [completed/4]).
:- autoload(tables, [print_agents/2, print_hosts/1]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).

/** <module> The hooks of the top level, help/1 and editors

The modules that implement these hooks are loaded at the first call, so a
process without a top level does not load them.

*Threading*: any thread.
*/

%!  hosts is det.
%
%   Print a table of the hosts of this process, of the networks that it has
%   started, and of all hosts that links from these lead to, also in other
%   processes.  The table has the address, state, number of agents, capacity,
%   number of arrivals, and neighbours of each host.  It names processes that
%   have not answered within two seconds (the setting
%   `typhon_inventory:seconds`).

hosts :-
    print_hosts([]).

%!  agents is det.
%
%   Print a table of the agents on the hosts that hosts/0 shows: the name of an
%   agent, or its id if another has the same name; its host; its program; its
%   activity; the number of its hops, and the number of messages that wait for
%   it.

agents :-
    print_agents([], short).

                /*******************************
                *           TOP LEVEL          *
                *******************************/

:- multifile
    prolog:complete_input/4,
    prolog:error_message//1,
    user:expand_query/4.
:- dynamic
    user:expand_query/4.

%   Names of Typhon come before those of Prolog.  The hook is wrapped, since the
%   clauses of Prolog may be loaded before this module or after it.  A saved
%   state does not keep a wrapped predicate.

complete_names :-
    wrap_predicate(
        prolog:complete_input(Before, After, Delete, Completions),
        typhon, Wrapped,
        (   typhon_environment:completed(Before, After, Delete0, Completions0)
        ->  Delete = Delete0,
            Completions = Completions0
        ;   Wrapped
        )).

:- initialization(complete_names, now).

user:expand_query(Query, _, _, _) :-
    '$current_typein_module'(Module),
    typhon_environment:words_only(Query, Module, PI),
    throw(error(existence_error(procedure, PI), context(_, _))).

prolog:error_message(existence_error(procedure, Spec)) -->
    word_lines(Spec).

:- multifile
    prolog:message//1,
    prolog_help:show_html_hook/1,
    user:message_hook/3.
:- dynamic
    user:message_hook/3.

prolog_help:show_html_hook(HTML) :-
    help_shown(HTML).

user:message_hook(help(Told), _, _) :-
    typhon_environment:apropos_completed(Told, Pairs, Count),
    print_message(information, help(typhon(Pairs, Count))).

prolog:message(help(typhon(Pairs, Count))) -->
    '$messages':translate_message(help(apropos_matches(Pairs, Count))).

:- multifile
    prolog_colour:directive_colours/2,
    prolog_colour:goal_colours/3,
    user:term_expansion/2.
:- dynamic
    user:term_expansion/2.

%   Only the cross-referencer expands a declaration; loading a file does not.

user:term_expansion((:- Directive), Directives) :-
    current_prolog_flag(xref, true),
    typhon_environment:directive_meant(Directive, Directives).

prolog_colour:goal_colours(_, imported(File), built_in-classify) :-
    words_file(File).

prolog_colour:directive_colours(Directive, Colours) :-
    directive_coloured(Directive, Colours).
