:- module(typhon_source,
          [ source_terms/5,             % +Spec, -Located, -Sources, -Errors,
                                        % -Warnings
            source_clause/2,            % +Location, -Clause
            source_settled/1,           % +Sources
            source_same/1,              % +Sources
            declaration/4,              % +Kind, +Term, -Name, -Options
            reader_directive/1,         % +Directive
            program_file/2,             % +Spec, -File
            files_beside/3              % +File, +Dir, -Files
          ]).

/** <module> Clause files as terms with their locations

Agent programs and payloads are read here, from a file or from a list of terms,
into pairs Term-Location.  A location is `File:Line`, or clause(N) for the N-th
term of a list.  Reading never runs anything in the file: directives are terms
like the others, and only `:- include(F)` is followed.  Grammar rules are
translated, and terms Map.key become calls.  Operators that the file declares,
or imports from libraries, are known from there on, in this file alone.  A first
line `#!` is skipped.

A term that cannot be read, or looks like a typing error, is a problem as in
typhon_programs, and reading goes on after it.  The location of a syntax error is
file(File, Line, LinePos, CharNo).

A result of reading can be compared with the present files.  A file has changed
when its size or its time has changed.  A file that was changed within two
seconds before it was read may change again without changing either: it is not
settled, and callers must not rely on it.

*Threading*: any thread.
*/

:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- autoload(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).
:- use_module('../kernel/base/names', [names_near/3]).
:- use_module('../kernel/program', [with_scratch_module/2]).
:- use_module(dict_calls, [dict_calls/2]).
:- use_module(library_data, [import_operators/2, library_import/2]).

:- multifile typhon_names:known/2.

%!  source_terms(+Spec, -Located:list(pair), -Sources:list, -Errors:list,
%!               -Warnings:list) is det.
%
%   Located are the terms of Spec, each as Term-Location, in order.  Sources
%   are the files that were read, for source_same/1, with the names of their
%   variables, for places_named/4.  Errors are terms that cannot be read and
%   files that cannot be included, Warnings variables that occur once; both are
%   problems, in order.
%
%   @arg Spec is a file specification as census, 'census.pl' or
%        agents(census), or clauses(Terms).
%   @error existence_error(source_sink, Spec)
%   @error domain_error(program_source, Spec)

source_terms(Spec, Located, Sources, Errors, Warnings) :-
    items(Spec, Items),
    findall(Term-Location, member(term(Term, Location), Items), Located),
    findall(Source, member(source(Source), Items), Sources),
    findall(Problem, member(error(Problem), Items), Errors),
    findall(Problem, member(warning(Problem), Items), Warnings).

%   items(+Spec, -Items): Items are, in order, term(Term, Location),
%   source(Source), error(Problem) and warning(Problem).

items(Spec, Items) :-
    nonvar(Spec),
    Spec = clauses(Terms),
    !,
    must_be(list, Terms),
    findall(Item,
            ( nth1(N, Terms, Term), grammar_rule(Term, clause(N), Item) ),
            Items).
items(Spec, Items) :-
    program_file(Spec, File),
    with_scratch_module(Module,
                        findall(Item,
                                file_item(File, reading([], Module), Item),
                                Items)).

%   file_item(+File, +Reading, -Item) is nondet: Reading is reading(Files,
%   Module), where Files include File.

file_item(File, _, source(file(File, Stamp, Now))) :-
    get_time(Now),
    file_stamp(File, Stamp).
file_item(File, reading(Files, Module), Item) :-
    setup_call_cleanup(
        open_source(File, In),
        item_in(In, reading([File|Files], Module), Item),
        close(In)).

open_source(File, In) :-
    open(File, read, In, [encoding(utf8)]),
    (   peek_string(In, 2, "#!")
    ->  skip(In, 0'\n)
    ;   true
    ).

file_stamp(File, stamp(Size, Time)) :-
    size_file(File, Size),
    time_file(File, Time).

%   item_in(+In, +Reading, -Item) is nondet: the first of the files of Reading is
%   read from In.

item_in(In, Reading, Item) :-
    repeat,
    read_one(In, Reading, Read),
    (   Read = read(Term, _, _, _),
        Term == end_of_file
    ->  !,
        fail
    ;   item(Read, Reading, Item)
    ).

%   read_one(+In, +Reading, -Read): Read is error(Problem), or read(Term,
%   Location, Bindings, Once), Once being the names of variables that occur
%   once.

read_one(In, reading([File|_], Module), Read) :-
    catch(read_located(In, File, Module, Read),
          error(syntax_error(What), Where),
          not_read(What, Where, File, Read)).

not_read(What, Where, File, error(Problem)) :-
    (   Where = stream(_, Line, LinePos, CharNo)
    ->  Location = file(File, Line, LinePos, CharNo)
    ;   Location = Where
    ),
    Problem = problem(syntax_error(What), Location, none).

read_located(In, File, Module, read(Term, File:Line, Named, Once)) :-
    read_term(In, Term,
              [ module(Module),
                term_position(Position),
                variable_names(Named),
                singletons(Bindings),
                syntax_errors(error)
              ]),
    stream_position_data(line_count, Position, Line),
    findall(Name, ( member(Name=_, Bindings), may_be_slip(Name) ), Once).

%   A variable that begins with an underscore is meant to occur once.

may_be_slip(Name) :-
    \+ sub_atom(Name, 0, _, _, '_').

item(read(Term, Location, _, _), Reading, Item) :-
    includes(Term, Spec),
    !,
    included(Spec, Location, Reading, Item).
item(read(Term0, Location, Named, Once), reading(_, Module), Item) :-
    grammar_rule(Term0, Location, Item0),
    term_operators(Term0, Module),
    (   Item = Item0
    ;   Item0 = term(Term, _),
        Named = [_|_],
        term_variables(Term, Variables),
        maplist(variable_name(Named), Variables, Names),
        Item = source(names(Location, Names))
    ;   Once = [_|_],
        Item = warning(problem(singletons(Once), Location, singletons))
    ).
item(error(Problem), _, error(Problem)).

variable_name(Named, Variable, Name) :-
    (   member(Name0=Variable0, Named),
        Variable0 == Variable
    ->  Name = Name0
    ;   Name = '_'
    ).

includes(Term, Spec) :-
    nonvar(Term),
    Term = (:- Directive),
    nonvar(Directive),
    Directive = include(Spec).

%   Reports a file that includes itself, or that does not exist.

included(Spec, Location, Reading, Item) :-
    Reading = reading([File|Files], _),
    catch(included_file(Spec, File, Path), error(Formal, _), true),
    (   nonvar(Formal)
    ->  files_meant(Formal, File, Meant),
        Item = error(problem(Formal, Location, include(Meant)))
    ;   memberchk(Path, [File|Files])
    ->  Formal = permission_error(include, source_sink, Spec),
        Item = error(problem(Formal, Location, include_itself))
    ;   Item = source(include(Spec, File, Path))
    ;   file_item(Path, Reading, Item)
    ).

files_meant(existence_error(_, Spec), Includer, Meant) :-
    atom(Spec),
    file_directory_name(Includer, Dir),
    files_beside(Spec, Dir, Files),
    !,
    names_near(Spec, Files, Meant).
files_meant(_, _, []).

grammar_rule(Term0, Location, Item) :-
    nonvar(Term0),
    Term0 = (_-->_),
    !,
    catch(( dcg_translate_rule(Term0, Term1),
            dict_calls(Term1, Term),
            Item = term(Term, Location) ),
          error(Formal, _),
          Item = error(problem(Formal, Location, grammar))).
grammar_rule(Term0, Location, term(Term, Location)) :-
    dict_calls(Term0, Term).

term_operators((:- Directive), Module) :-
    library_import(Directive, Import),
    !,
    import_operators(Import, Module).
term_operators((:- Directive), Module) :-
    for_reader(Directive),
    !,
    catch(declare(Directive, Module), error(_, _), true).
term_operators(_, _).

%   Names that are qualified would change another module.

for_reader(Directive) :-
    ground(Directive),
    directive_for_reader(Directive).

directive_for_reader(encoding(utf8)).
directive_for_reader(op(_, _, Names)) :-
    (   atom(Names)
    ->  true
    ;   is_list(Names),
        maplist(atom, Names)
    ).

declare(encoding(_), _).
declare(op(Priority, Type, Names), Module) :-
    op(Priority, Type, Module:Names).

%!  reader_directive(+Directive) is semidet.
%
%   Directive tells how the rest of a file is read: op/3, encoding(utf8).
%
%   @error those of op/3

reader_directive(Directive) :-
    for_reader(Directive),
    with_scratch_module(Module, declare(Directive, Module)).

                /*******************************
                *           ONE CLAUSE         *
                *******************************/

%!  source_clause(+Location, -Clause) is semidet.
%
%   Clause is clause(Term, Layout, Names) of the term at Location, File:Line,
%   with subterm_positions and variable_names of read_term/2.  Fails if it is
%   no longer there, or cannot be read by itself.

source_clause(File:Line, Clause) :-
    exists_file(File),
    with_scratch_module(Module,
                        catch(clause_in(File, Line, Module, Clause),
                              error(_, _), fail)).

clause_in(File, Line, Module, Clause) :-
    setup_call_cleanup(
        open_source(File, In),
        clause_at(In, Line, Module, Clause),
        close(In)).

clause_at(In, Line, Module, Clause) :-
    read_term(In, Term,
              [ module(Module), term_position(Position),
                subterm_positions(Layout), variable_names(Names),
                syntax_errors(error) ]),
    stream_position_data(line_count, Position, At),
    Term \== end_of_file,
    (   At =:= Line
    ->  Clause = clause(Term, Layout, Names)
    ;   At < Line,
        term_operators(Term, Module),
        clause_at(In, Line, Module, Clause)
    ).

                /*******************************
                *            CHANGES           *
                *******************************/

%!  source_settled(+Sources) is semidet.
%
%   source_same/1 will detect any later change of Sources.

source_settled(Sources) :-
    \+ ( member(file(_, stamp(_, Time), Read), Sources),
         Read-Time < 2 ).

%!  source_same(+Sources) is semidet.
%
%   Reading again would give the same terms from the same files.

source_same(Sources) :-
    maplist(same, Sources).

same(file(File, Stamp, _)) :-
    catch(file_stamp(File, Stamp), error(_, _), fail).
same(names(_, _)).
same(include(Spec, File, Path)) :-
    catch(included_file(Spec, File, Now), error(_, _), fail),
    Now == Path.                        % if bound, 10.1 would search

                /*******************************
                *             FORMS            *
                *******************************/

%!  declaration(+Kind, +Term, -Name, -Options) is semidet.

declaration(Kind, (:- Directive), Name, Options) :-
    callable(Directive),
    (   Directive =.. [Kind, Name, Options],
        is_list(Options)
    ;   Directive =.. [Kind, Name],
        Options = []
    ),
    atom(Name).

                /*******************************
                *            PATHS             *
                *******************************/

%!  program_file(+Spec, -File) is det.
%!  included_file(+Spec, +Includer, -File) is det.
%
%   File is the absolute name of the clause file Spec: a term such as
%   agents(census), or a file name, relative to the working directory or to
%   that of the file Includer.  The extension `.pl` may be left out.
%
%   @error existence_error(source_sink, Spec), or permission_error(open,
%   source_sink, File) if it exists, and may not be read

program_file(Text, File) :-
    string(Text),
    !,
    atom_string(Spec, Text),
    program_file(Spec, File).
program_file(Spec, File) :-
    must_be(callable, Spec),
    clause_file(Spec, [], File).

included_file(Spec, Includer, File) :-
    file_directory_name(Includer, Dir),
    clause_file(Spec, [relative_to(Dir)], File).

clause_file(Spec, Options0, File) :-
    Options = [extensions(['',pl])|Options0],
    catch(absolute_file_name(Spec, File, [access(read)|Options]),
          error(existence_error(_, _), _),
          not_to_be_read(Spec, Options)).

not_to_be_read(Spec, Options) :-
    absolute_file_name(Spec, File,
                       [access(exist), file_errors(fail)|Options]),
    exists_file(File),
    !,
    permission_error(open, source_sink, File).
not_to_be_read(Spec, _) :-
    existence_error(source_sink, Spec).

%!  files_beside(+File:atom, +Dir, -Files:list) is semidet.
%
%   Files are names, relative to Dir, that the user may have meant by File, a
%   clause file that does not exist.

files_beside(File, Dir, Files) :-
    file_directory_name(File, Folder),
    absolute_file_name(Folder, Path, [relative_to(Dir)]),
    catch(directory_files(Path, Entries), error(_, _), fail),
    findall(Name,
            ( member(Entry, Entries),
              file_name_extension(Base, pl, Entry),
              ( file_name_extension(_, pl, File) -> Named = Entry
              ; Named = Base
              ),
              in_folder(Folder, Named, Name) ),
            Files).

in_folder('.', Base, Base) :-
    !.
in_folder(Folder, Base, Name) :-
    directory_file_path(Folder, Base, Name).

%   Names as in agents(Name), also of programs in folders, but not of the files
%   that these include.

typhon_names:known(Alias, Name) :-
    member(Alias-Kind, [agents-agent, payloads-payload]),
    Spec =.. [Alias, '.'],
    absolute_file_name(Spec, Dir,
                       [ file_type(directory), solutions(all),
                         file_errors(fail)
                       ]),
    catch(program_in(Dir, Kind, Name), error(_, _), fail).

program_in(Dir, Kind, Name) :-
    directory_member(Dir, File, [extensions([pl]), recursive(true)]),
    exists_file(File),
    catch(begins_with(File, Kind), error(_, _), fail),
    directory_file_path(Dir, Relative, File),
    file_name_extension(Name, pl, Relative).

begins_with(File, Kind) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        read_term(In, (:- Declaration), []),
        close(In)),
    functor(Declaration, Kind, _).
