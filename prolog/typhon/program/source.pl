:- module(typhon_source,
          [ source_terms/2,             % +Spec, -Located
            declaration/4,              % +Kind, +Term, -Name, -Options
            library_import/2,           % +Directive, -Import
            clause_parts/3              % +Clause, -Head, -Body
          ]).
:- use_module(library(lists), [append/3, memberchk/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(readutil), []).

/** <module> Clause files as terms that know where they stood

Agent programs and payloads are read here, from a file or from a list of
terms, into pairs Term-Location.  A location is `File:Line`, or clause(N)
for the N-th term of a list.  Reading never runs anything that stands in
the file: directives are terms like the others, and only `:- include(F)`
is followed.  Grammar rules are translated.  Operators that the file
imports from libraries are known from there on.

*Threading*: any thread.
*/

%!  source_terms(+Spec, -Located:list(pair)) is det.
%
%   Located are the terms of Spec, each as Term-Location, in order.
%
%   @arg Spec is a file specification as census, 'census.pl' or
%        agents(census), or clauses(Terms).
%   @error existence_error(source_sink, Spec)
%   @error syntax_error(What), with the place in the file
%   @error domain_error(program_source, Spec)

source_terms(Spec, _) :-
    var(Spec),
    !,
    throw(error(instantiation_error, _)).
source_terms(clauses(Terms), Located) :-
    !,
    must_be(list, Terms),
    number_terms(Terms, 1, Located).
source_terms(Spec, Located) :-
    must_be(callable, Spec),
    absolute_file_name(Spec, File,
                       [ extensions(['',pl]), access(read) ]),
    setup_call_cleanup(
        scratch_module(Module),
        file_terms(File, [], Module, Located),
        '$destroy_module'(Module)).

number_terms([], _, []).
number_terms([Term0|Terms0], N, [Term-clause(N)|Terms]) :-
    grammar_rule(Term0, Term, clause(N)),
    N1 is N+1,
    number_terms(Terms0, N1, Terms).

%   file_terms(+File, +Includers, +Module, -Located)

file_terms(File, Includers, Module, Located) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_terms(In, [File|Includers], Module, Located),
        close(In)).

%   Operators that the file imports from libraries live in a module of
%   their own while the file, and what it includes, is read.

scratch_module(Module) :-
    flag(typhon_scratch_module, N, N+1),
    atom_concat('typhon source ', N, Module),
    set_module(Module:class(temporary)),
    set_module(Module:base(system)).

%   read_terms(+In, +Files, +Module, -Located): Files are the file that is
%   read and those that include it.

read_terms(In, Files, Module, Located) :-
    Files = [File|_],
    read_one(In, File, Module, Term, Line),
    continue(Term, Line, In, Files, Module, Located).

read_one(In, File, Module, Term, Line) :-
    catch(read_term(In, Term,
                    [ module(Module),
                      term_position(Position),
                      syntax_errors(error)
                    ]),
          error(syntax_error(What), Where),
          syntax_error(What, Where, File)),
    stream_position_data(line_count, Position, Line).

syntax_error(What, stream(_, Line, LinePos, CharNo), File) :-
    !,
    throw(error(syntax_error(What), file(File, Line, LinePos, CharNo))).
syntax_error(What, Where, _) :-
    throw(error(syntax_error(What), Where)).

continue(Term, _, _, _, _, []) :-
    Term == end_of_file,
    !.
continue(Term, Line, In, Files, Module, Located) :-
    includes(Term, Spec),
    !,
    include_file(Spec, Files, Line, Module, Included),
    append(Included, Rest, Located),
    read_terms(In, Files, Module, Rest).
continue(Term0, Line, In, Files, Module, [Term-(File:Line)|Rest]) :-
    Files = [File|_],
    grammar_rule(Term0, Term, File:Line),
    import_operators(Term, Module),
    read_terms(In, Files, Module, Rest).

includes(Term, Spec) :-
    nonvar(Term),
    Term = (:- Directive),
    nonvar(Directive),
    Directive = include(Spec).

include_file(Spec, Files, Line, Module, Included) :-
    Files = [File|_],
    file_directory_name(File, Dir),
    catch(absolute_file_name(Spec, Path,
                             [ extensions(['',pl]), access(read),
                               relative_to(Dir) ]),
          error(Formal, _),
          throw(error(Formal, context(File:Line, 'cannot include')))),
    (   memberchk(Path, Files)
    ->  throw(error(permission_error(include, source_sink, Spec),
                    context(File:Line, 'a file cannot include itself')))
    ;   file_terms(Path, Files, Module, Included)
    ).

grammar_rule(Term0, Term, Location) :-
    (   nonvar(Term0),
        Term0 = (_-->_)
    ->  catch(dcg_translate_rule(Term0, Term), error(Formal, _),
              throw(error(Formal,
                          context(Location, 'not a grammar rule'))))
    ;   Term = Term0
    ).

%   A library that is not there is reported by typhon_programs.

import_operators((:- Directive), Module) :-
    library_import(Directive, _),
    !,
    catch(Module:Directive, error(_, _), true).
import_operators(_, _).

                /*******************************
                *             FORMS            *
                *******************************/

%!  declaration(+Kind, +Term, -Name, -Options) is semidet.
%
%   Term declares an agent or a payload.

declaration(Kind, (:- Directive), Name, Options) :-
    callable(Directive),
    (   Directive =.. [Kind, Name, Options],
        is_list(Options)
    ;   Directive =.. [Kind, Name],
        Options = []
    ),
    atom(Name).

%!  library_import(+Directive, -Import) is semidet.
%
%   Import is library(L)-all or library(L)-List.

library_import(use_module(library(L)), library(L)-all) :-
    ground(L).
library_import(use_module(library(L), Imports), library(L)-Imports) :-
    ground(L-Imports).

%!  clause_parts(+Clause, -Head, -Body) is det.

clause_parts(Var, Var, true) :-
    var(Var),
    !.
clause_parts((Head:-Body), Head, Body) :-
    !.
clause_parts(Head, Head, true).
