:- module(typhon_source,
          [ source_terms/2              % +Spec, -Located
          ]).
:- use_module(library(lists), [append/3]).
:- use_module(library(error), [must_be/2, domain_error/2]).
:- use_module(library(readutil), []).

/** <module> Clause files as terms that know where they stood

Agent programs and payloads are read here, from a file or from a list of
terms, into pairs Term-Location.  A location is `File:Line`, or clause(N)
for the N-th term of a list.  Reading never runs anything that stands in
the file: directives are terms like the others, and only `:- include(F)`
is followed.  Grammar rules are translated.

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
    file_terms(File, Located).

number_terms([], _, []).
number_terms([Term0|Terms0], N, [Term-clause(N)|Terms]) :-
    grammar_rule(Term0, Term),
    N1 is N+1,
    number_terms(Terms0, N1, Terms).

file_terms(File, Located) :-
    setup_call_cleanup(
        ( open(File, read, In, [encoding(utf8)]),
          scratch_module(Module)
        ),
        read_terms(In, File, Module, Located),
        ( close(In),
          '$destroy_module'(Module)
        )).

%   Operators that the file imports from libraries live in a module of
%   their own while the file is read.

scratch_module(Module) :-
    flag(typhon_scratch_module, N, N+1),
    atom_concat('typhon source ', N, Module),
    set_module(Module:class(temporary)),
    set_module(Module:base(system)).

read_terms(In, File, Module, Located) :-
    read_one(In, File, Module, Term, Line),
    continue(Term, Line, In, File, Module, Located).

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
continue((:- include(Spec)), Line, In, File, Module, Located) :-
    !,
    include_file(Spec, File, Line, Included),
    append(Included, Rest, Located),
    read_terms(In, File, Module, Rest).
continue(Term0, Line, In, File, Module, [Term-(File:Line)|Rest]) :-
    grammar_rule(Term0, Term),
    import_operators(Term, Module),
    read_terms(In, File, Module, Rest).

include_file(Spec, File, Line, Included) :-
    file_directory_name(File, Dir),
    catch(absolute_file_name(Spec, Path,
                             [ extensions(['',pl]), access(read),
                               relative_to(Dir) ]),
          error(Formal, _),
          throw(error(Formal, context(File:Line, 'cannot include')))),
    (   Path == File
    ->  throw(error(permission_error(include, source_sink, Spec),
                    context(File:Line, 'a file cannot include itself')))
    ;   file_terms(Path, Included)
    ).

grammar_rule(Term0, Term) :-
    (   nonvar(Term0),
        Term0 = (_-->_)
    ->  dcg_translate_rule(Term0, Term)
    ;   Term = Term0
    ).

import_operators((:- use_module(library(Library))), Module) :-
    ground(Library),
    !,
    catch(Module:use_module(library(Library)), error(_, _), true).
import_operators(_, _).
