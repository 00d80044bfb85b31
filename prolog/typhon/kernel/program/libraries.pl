:- module(typhon_libraries,
          [ library_import/2,           % +Directive, -Import
            import_fault/2,             % +Import, -Formal
            is_import/1,                % @Import
            import_library/2,           % +Module, +Import
            import_operators/2,         % +Import, +Module
            library_export/2,           % +Library, ?Export
            declared_meta/3,            % +Module, +Head, -Meta
            with_scratch_module/2       % -Module, :Goal
          ]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2, memberchk/2]).

/** <module> Libraries that programs import

A program imports libraries by name: library(Name) or library(Folder/Name),
atoms of letters, digits, `_` and `-`.  An import is Library-all, or
Library-Imports as in use_module/2.

Imports are data until the program is compiled, see typhon_code.  Reading,
receiving and checking a program loads nothing: what must be known of a library
that is not loaded is read from the directives at the beginning of its file.

*Threading*: any thread.
*/

:- meta_predicate with_scratch_module(-, 0).

%!  library_import(+Directive, -Import) is semidet.
%
%   Import may be faulty, see import_fault/2.

library_import(use_module(library(L)), library(L)-all) :-
    ground(L).
library_import(use_module(library(L), Imports), library(L)-Imports) :-
    ground(L-Imports).

%!  import_fault(+Import, -Formal) is semidet.
%
%   Formal is the reason why no program can have Import.

import_fault(Library-Imports, domain_error(library_name, Library)) :-
    \+ is_import(Library-Imports),
    !.
import_fault(Library-_, Formal) :-
    catch(( library_file(Library, _), fail ), error(Formal, _), true).

%!  is_import(@Import) is semidet.
%
%   Import has the form of an import.  It may come from a peer.

is_import(Import) :-
    ground(Import),
    Import = library(Path)-Imports,
    is_name(Path),
    ( Imports == all ; is_list(Imports) ; Imports = except(_) ),
    !.

is_name(Name) :-
    atom(Name),
    Name \== '',
    \+ ( sub_atom(Name, _, 1, _, Char),
         Char \== (-),
         \+ char_type(Char, csym) ).
is_name(Folder/Name) :-
    is_name(Folder),
    is_name(Name).

%   library_file(+Library, -File) is det.
%
%   A symbolic link could lead out of the folder of libraries.  The folder
%   itself may be one, as those of packs, and SWI-Prolog's own folder may have
%   some.
%
%   @error existence_error(library, Name), permission_error(import, library,
%   Name)

library_file(library(Name), File) :-
    (   prolog_file(library(Name), [], File)
    ->  true
    ;   existence_error(library, Name)
    ),
    (   current_prolog_flag(home, Home),
        \+ sub_atom(File, 0, _, _, Home),
        is_link(Name, File)
    ->  permission_error(import, library, Name)
    ;   true
    ).

prolog_file(Spec, Options, File) :-
    absolute_file_name(Spec, File,
                       [ file_type(prolog), access(read), file_errors(fail)
                       | Options ]).

is_link(_, File) :-
    read_link(File, _, _),
    !.
is_link(Folder/_, File) :-
    file_directory_name(File, Parent),
    is_link(Folder, Parent).

%!  import_library(+Module, +Import) is det.
%
%   Import a library into Module, and load it if it is not loaded.

import_library(Module, Library-Imports) :-
    library_file(Library, File),
    (   Imports == all
    ->  Module:use_module(File)
    ;   Module:use_module(File, Imports)
    ).

                /*******************************
                *      LIBRARIES AS DATA       *
                *******************************/

%!  library_export(+Library, ?Export) is nondet.
%
%   Library exports Export, Name/Arity or op(Priority, Type, Name).

library_export(Library, Export) :-
    catch(library_file(Library, File), error(_, _), fail),
    file_export(File, Export).

file_export(File, Export) :-
    (   module_property(Module, file(File))
    ->  member(Property, [exports(Exports), exported_operators(Exports)]),
        module_property(Module, Property),
        member(Export, Exports)
    ;   beginning(File, Directives),
        member(Directive, Directives),
        directive_export(Directive, File, Export0),
        plain_indicator(Export0, Export)
    ).

plain_indicator(Name//N, Name/Arity) :-
    !,
    plus(N, 2, Arity).
plain_indicator(Export, Export).

directive_export(Directive, _, Export) :-
    ( Directive = module(_, Exports) ; Directive = reexport(_, Exports) ),
    is_list(Exports),
    member(Export, Exports).
directive_export(reexport(Spec), File, Export) :-
    prolog_file(Spec, [relative_to(File)], Other),
    Other \== File,
    file_export(Other, Export).

%!  declared_meta(+Module, +Head, -Meta) is semidet.
%
%   meta_predicate(Meta) is declared for Head, which Module defines or imports,
%   or would autoload.  predicate_property/2 would load the library.

declared_meta(Module, Head, Meta) :-
    '$get_predicate_attribute'(Module:Head, defined, 1),
    !,
    '$get_predicate_attribute'(Module:Head, transparent, 1),
    '$get_predicate_attribute'(Module:Head, meta_predicate, Meta).
declared_meta(_, Head, Meta) :-
    functor(Head, Name, Arity),
    '$in_library'(Name, Arity, Base),
    prolog_file(Base, [], File),
    functor(Meta, Name, Arity),
    (   module_property(Library, file(File))
    ->  declared_meta(Library, Head, Meta)
    ;   beginning(File, Directives),
        member(meta_predicate(Metas), Directives),
        comma_member(Meta, Metas)
    ),
    !.

comma_member(X, (A,B)) :-
    !,
    ( comma_member(X, A) ; comma_member(X, B) ).
comma_member(X, X).

%   beginning(+File, -Directives): those before the first clause of File.

beginning(File, Directives) :-
    with_scratch_module(Module,
                        setup_call_cleanup(
                            open(File, read, In, [encoding(utf8)]),
                            directives(In, Module, Directives),
                            close(In))).

directives(In, Module, Directives) :-
    catch(read_term(In, Term, [module(Module)]), error(_, _), fail),
    subsumes_term((:- _), Term),
    !,
    Term = (:- Directive),
    Directives = [Directive|Rest],
    ( Directive = module(_, Exports) -> true ; Exports = [Directive] ),
    add_operators(Exports, Module),
    directives(In, Module, Rest).
directives(_, _, []).

                /*******************************
                *           OPERATORS          *
                *******************************/

%!  with_scratch_module(-Module, :Goal) is semidet.
%
%   Call Goal once; meanwhile Module exists, for the operators of a file that is
%   read.

with_scratch_module(Module, Goal) :-
    flag(typhon_scratch_module, N, N+1),
    atom_concat('typhon source ', N, Module),
    setup_call_cleanup(
        ( set_module(Module:class(temporary)),
          set_module(Module:base(system)) ),
        once(Goal),
        '$destroy_module'(Module)).

%!  import_operators(+Import, +Module) is det.
%
%   Add the operators of a library to Module.

import_operators(Library-Imports, Module) :-
    findall(op(P, T, Name),
            ( library_export(Library, op(P, T, Name)),
              \+ ( is_list(Imports), \+ memberchk(op(P, T, Name), Imports) ) ),
            Operators),
    add_operators(Operators, Module).

add_operators(Terms, Module) :-
    forall(member(op(P, T, Name), Terms),
           catch(op(P, T, Module:Name), error(_, _), true)).
