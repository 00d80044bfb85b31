:- module(typhon_compile, []).

/** <module> Compile the library of an installed copy

    swipl app/typhon/compile.pl [DIR]

writes a .qlf file beside each file below DIR/prolog; default is the tree of
this file. SWI-Prolog loads it in place of the file, unless the file is newer.

*Threading*: the main thread.
*/

:- use_module(library(filesex), [directory_file_path/3, directory_member/3]).
:- use_module(library(main), [main/0]).

:- initialization(main, main).

:- public main/1.

:- dynamic root/1, library_dir/1, compiled/1.

:- prolog_load_context(directory, Dir),
   absolute_file_name('../..', Root, [relative_to(Dir)]),
   assertz(root(Root)).

main([]) :-
    root(Root),
    main([Root]).
main([Root]) :-
    directory_file_path(Root, prolog, Library),
    assertz(library_dir(Library)),
    forall(directory_member(Library, File,
                            [extensions([pl]), recursive(true)]),
           load_files(File, [if(not_loaded), imports([])])).

%   Compiles a file when it is loaded for the first time, by another file or by
%   main/1, and then imports it as usual: SWI-Prolog 9.2.9 crashes when it
%   compiles a loaded file.

:- multifile user:prolog_load_file/2.

user:prolog_load_file(_:Spec, _) :-
    library_file(Spec, File),
    \+ compiled(File),
    assertz(compiled(File)),
    file_name_extension(Stem, pl, File),
    load_files(Stem, [qcompile(auto), imports([])]),
    fail.

%   Nothing uses the libraries of parts that are left out now.

:- multifile user:message_hook/3.

user:message_hook(error(existence_error(typhon_part, _), _), _, _).

library_file(Spec, File) :-
    library_dir(Library),
    (   prolog_load_context(directory, Dir)
    ->  true
    ;   Dir = Library
    ),
    absolute_file_name(Spec, File,
                       [ file_type(source), access(read), file_errors(fail),
                         relative_to(Dir) ]),
    sub_atom(File, 0, _, _, Library).
