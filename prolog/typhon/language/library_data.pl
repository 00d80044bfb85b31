:- module(typhon_library_data,
          [ library_import/2,           % +Directive, -Import
            import_fault/2,             % +Import, -Formal
            import_operators/2,         % +Import, +Module
            library_export/2            % +Library, ?Export
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module('../kernel/program',
              [ add_operators/2, file_beginning/2, is_import/1, library_file/2,
                prolog_file/3 ]).

/** <module> Libraries as data

What must be known of a library that a program imports, see typhon_libraries, is
read from the directives at the beginning of its file: it is not loaded.

*Threading*: any thread.
*/

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
    ;   file_beginning(File, Directives),
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

%!  import_operators(+Import, +Module) is det.
%
%   Add the operators of a library to Module.

import_operators(Library-Imports, Module) :-
    findall(op(P, T, Name),
            ( library_export(Library, op(P, T, Name)),
              \+ ( is_list(Imports), \+ memberchk(op(P, T, Name), Imports) ) ),
            Operators),
    add_operators(Operators, Module).
