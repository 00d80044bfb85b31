:- module(test_clauses_of_files, [clauses_of_files/0]).
:- use_module(library(lists), [member/2]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(typhon/kernel/base/compiling),
              [compiling_begin/1, compiling_end/1]).

/** <module> The clauses of each file of the library, as hashes

*Threading*: the main thread.
*/

%   clauses_of_files is det: print a list Module-Hash of all modules of the
%   library.  Hash is of their clauses, with the lines from which they come.

clauses_of_files :-
    compiling_begin(Flags),
    use_module(library(typhon), []),
    findall(File, ( library_file(File), typhon_compiling:is_plain(File) ),
            Files),
    forall(member(File, Files), use_module(File, [])),
    compiling_end(Flags),
    findall(Module-Hash,
            ( member(File, Files),
              module_property(Module, file(File)),
              findall(Clause, clause_in(File, Module, Clause), Clauses0),
              msort(Clauses0, Clauses),
              variant_sha1(Clauses, Hash) ),
            Hashes0),
    sort(Hashes0, Hashes),
    print(Hashes).

library_file(File) :-
    module_property(typhon_compiling, file(Compiling)),
    atom_concat(Library, '/kernel/base/compiling.pl', Compiling),
    directory_member(Library, File, [recursive(true), extensions([pl])]).

clause_in(File, Module, clause(Line, Head, Body)) :-
    '$c_current_predicate'(_, Module:Head),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    \+ '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    '$get_predicate_attribute'(Module:Head, number_of_clauses, _),
    catch(clause(Module:Head, Body, Ref), error(_, _), fail),
    clause_property(Ref, file(File)),
    clause_property(Ref, line_count(Line)).
