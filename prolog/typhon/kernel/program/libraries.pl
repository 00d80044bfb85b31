:- module(typhon_libraries,
          [ is_import/1,                % @Import
            import_library/2,           % +Module, +Import
            library_file/2,             % +Library, -File
            prolog_file/3,              % +Spec, +Options, -File
            file_beginning/2,           % +File, -Directives
            add_operators/2,            % +Terms, +Module
            declared_meta/3,            % +Module, +Head, -Meta
            with_scratch_module/2       % -Module, :Goal
          ]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).

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

%!  library_file(+Library, -File) is det.
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

%!  prolog_file(+Spec, +Options, -File) is semidet.
%
%   File is the source file of Spec, see absolute_file_name/3.

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
    ;   file_beginning(File, Directives),
        member(meta_predicate(Metas), Directives),
        comma_member(Meta, Metas)
    ),
    !.

comma_member(X, (A,B)) :-
    !,
    ( comma_member(X, A) ; comma_member(X, B) ).
comma_member(X, X).

%!  file_beginning(+File, -Directives) is det.
%
%   Directives are those before the first clause of File.

file_beginning(File, Directives) :-
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

%!  add_operators(+Terms, +Module) is det.
%
%   Add the operators among Terms to Module.

add_operators(Terms, Module) :-
    forall(member(op(P, T, Name), Terms),
           catch(op(P, T, Module:Name), error(_, _), true)).
