:- module(typhon_source,
          [ source_terms/2,             % +Spec, -Located
            source_terms/3,             % +Spec, -Located, -Sources
            source_settled/1,           % +Sources
            source_same/1,              % +Sources
            declaration/4,              % +Kind, +Term, -Name, -Options
            library_import/2,           % +Directive, -Import
            clause_parts/3              % +Clause, -Head, -Body
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(paths, [included_file/3, program_file/2]).

/** <module> Clause files as terms that know where they stood

Agent programs and payloads are read here, from a file or from a list of
terms, into pairs Term-Location.  A location is `File:Line`, or clause(N)
for the N-th term of a list.  Reading never runs anything that stands in
the file: directives are terms like the others, and only `:- include(F)`
is followed.  Grammar rules are translated.  Operators that the file
imports from libraries are known from there on.

What was read can be compared with what would be read now, for who keeps
it.  A file has changed when its size or its time has.  One that was changed
within two seconds before it was read may change again without either: it
is not settled, and must not be relied on.

*Threading*: any thread.
*/

%!  source_terms(+Spec, -Located:list(pair)) is det.
%!  source_terms(+Spec, -Located:list(pair), -Sources:list) is det.
%
%   Located are the terms of Spec, each as Term-Location, in order; Sources
%   is what they were read from, for source_same/1.
%
%   @arg Spec is a file specification as census, 'census.pl' or
%        agents(census), or clauses(Terms).
%   @error existence_error(source_sink, Spec)
%   @error syntax_error(What), with the place in the file
%   @error domain_error(program_source, Spec)

source_terms(Spec, Located) :-
    source_terms(Spec, Located, _).

source_terms(Spec, _, _) :-
    var(Spec),
    !,
    throw(error(instantiation_error, _)).
source_terms(clauses(Terms), Located, []) :-
    !,
    must_be(list, Terms),
    number_terms(Terms, 1, Located).
source_terms(Spec, Located, Sources) :-
    program_file(Spec, File),
    setup_call_cleanup(
        scratch_module(Module),
        file_terms(File, reading([], Module), Located, Sources, []),
        '$destroy_module'(Module)).

number_terms([], _, []).
number_terms([Term0|Terms0], N, [Term-clause(N)|Terms]) :-
    grammar_rule(Term0, Term, clause(N)),
    N1 is N+1,
    number_terms(Terms0, N1, Terms).

%   file_terms(+File, +Reading, -Located, -Sources, ?Rest): Reading is
%   reading(Files, Module), Files being those that include it.

file_terms(File, reading(Files, Module), Located,
           [file(File, Stamp, Now)|Sources], Rest) :-
    get_time(Now),
    file_stamp(File, Stamp),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_terms(In, reading([File|Files], Module), Located, Sources, Rest),
        close(In)).

file_stamp(File, stamp(Size, Time)) :-
    size_file(File, Size),
    time_file(File, Time).

%   Operators that the file imports from libraries live in a module of
%   their own while the file, and what it includes, is read.

scratch_module(Module) :-
    flag(typhon_scratch_module, N, N+1),
    atom_concat('typhon source ', N, Module),
    set_module(Module:class(temporary)),
    set_module(Module:base(system)).

%   read_terms(+In, +Reading, -Located, -Sources, ?Rest): the first of the
%   files of Reading is the one that is read.

read_terms(In, Reading, Located, Sources, Rest) :-
    Reading = reading([File|_], Module),
    read_one(In, File, Module, Term, Line),
    continue(Term, Line, In, Reading, Located, Sources, Rest).

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

continue(Term, _, _, _, [], Rest, Rest) :-
    Term == end_of_file,
    !.
continue(Term, Line, In, Reading, Located, Sources, Rest) :-
    includes(Term, Spec),
    !,
    include_file(Spec, Line, Reading, Included, Sources, Sources1),
    append(Included, Located1, Located),
    read_terms(In, Reading, Located1, Sources1, Rest).
continue(Term0, Line, In, Reading, [Term-(File:Line)|Located], Sources,
         Rest) :-
    Reading = reading([File|_], Module),
    grammar_rule(Term0, Term, File:Line),
    import_operators(Term, Module),
    read_terms(In, Reading, Located, Sources, Rest).

includes(Term, Spec) :-
    nonvar(Term),
    Term = (:- Directive),
    nonvar(Directive),
    Directive = include(Spec).

include_file(Spec, Line, Reading, Included,
             [include(Spec, File, Path)|Sources], Rest) :-
    Reading = reading([File|Files], _),
    catch(included_file(Spec, File, Path), error(Formal, _),
          throw(error(Formal, context(File:Line, 'cannot include')))),
    (   memberchk(Path, [File|Files])
    ->  throw(error(permission_error(include, source_sink, Spec),
                    context(File:Line, 'a file cannot include itself')))
    ;   file_terms(Path, Reading, Included, Sources, Rest)
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
                *            CHANGES           *
                *******************************/

%!  source_settled(+Sources) is semidet.
%
%   Whatever changes Sources after they were read will show.

source_settled(Sources) :-
    \+ ( member(file(_, stamp(_, Time), Read), Sources),
         Read-Time < 2 ).

%!  source_same(+Sources) is semidet.
%
%   To read once more would be to read the same from the same files.

source_same(Sources) :-
    maplist(same, Sources).

same(file(File, Stamp, _)) :-
    catch(file_stamp(File, Stamp), error(_, _), fail).
same(include(Spec, File, Path)) :-
    catch(included_file(Spec, File, Now), error(_, _), fail),
    Now == Path.                        % if bound, 10.1 looks for any

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
