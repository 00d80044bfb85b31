:- module(typhon_compiling,
          [ compiling_begin/1,          % -Flags
            compiling_end/1,            % +Flags
            compiling/1,                % :Goal
            own_file/1,                 % +File
            topics/1                    % +Names
          ]).
:- ':'(system, set_module(':'(typhon_compiling, base(system)))).
:- use_module(library(debug), [debugging/2, nodebug/1]).
:- use_module(library(lists), [member/2]).

:- meta_predicate compiling(0).

/** <module> How the library is compiled

Arithmetic is compiled; debug/3 is kept. Predicates are imported, or declared
by autoload/2, and not searched for: with a search library(settings) would load
library(predicate_options), which takes as long as ten modules of this library.

Modules of Typhon inherit from `system`, as those of SWI-Prolog's library do.
The declaration of a module is expanded to that, and library(typhon) needs no
directive in its files.  So no predicate, operator, expansion or flag of module
`user` changes them.

*Threading*: any thread; the flags are those of the thread.
*/

%!  compiling_begin(-Flags:list) is det.
%
%   Files that this thread loads from now on are compiled with these flags.
%   Flags restores the former ones, see compiling_end/1.

compiling_begin(Flags) :-
    findall(Name=Value,
            ( flag(Name, _), current_prolog_flag(Name, Value) ), Flags),
    forall(flag(Name, Value), set_prolog_flag(Name, Value)).

%!  compiling_end(+Flags:list) is det.

compiling_end(Flags) :-
    forall(member(Name=Value, Flags), set_prolog_flag(Name, Value)).

%!  compiling(:Goal) is semidet.
%
%   Call once(Goal), which loads files, with these flags.

compiling(Goal) :-
    setup_call_cleanup(
        compiling_begin(Flags),
        once(Goal),
        compiling_end(Flags)).

flag(optimise, true).
flag(optimise_debug, false).
flag(iso, false).                       % libraries of Prolog do not load so
flag(autoload, explicit) :-             % else what is declared is loaded now
    \+ current_prolog_flag(autoload, false).

                /*******************************
                *           MODULES            *
                *******************************/

:- dynamic library/1.                   % Directory of typhon.pl

:- module_property(typhon_compiling, file(File)),
   atom_concat(Library, 'typhon/kernel/base/compiling.pl', File),
   retractall(library(_)),
   assertz(library(Library)).

%!  own_file(+File) is semidet.
%
%   File belongs to Typhon, and is no program of an agent or a user in the same
%   directory.  In a distribution the folder of the
%   library is `prolog`, and the others are beside it.

own_file(File) :-
    library(Library),
    (   atom_concat(Library, Path, File),
        member(Part, ['typhon/', 'typhon.pl', tartarus])
    ;   atom_concat(Root, 'prolog/', Library),
        atom_concat(Root, Path, File),
        member(Part, [ 'agents/', 'app/', 'bench/', 'doc/', 'examples/',
                       'experiments/', 'test/' ])
    ),
    sub_atom(Path, 0, _, _, Part),
    !.

%   Files that load this module have been declared before it.

:- forall(( current_module(Module), module_property(Module, file(File)),
            own_file(File) ),
          set_module(Module:base(system))).

:- multifile system:term_expansion/2.
:- dynamic system:term_expansion/2.

:- public inherits_from_system/1.

inherits_from_system(Module) :-
    atom(Module),
    prolog_load_context(source, File),
    own_file(File),
    note_plain(File).

system:term_expansion((:- module(Module, Exports)),
                      [ (:- module(Module, Exports)),
                        (:- system:set_module(Module:base(system))) ]) :-
    typhon_compiling:inherits_from_system(Module).

                /*******************************
                *            CLAUSES           *
                *******************************/

:- dynamic plain/1.                     % File: nothing in it is to be expanded

note_plain(File) :-
    (   is_plain(File),
        \+ plain(File)
    ->  assertz(plain(File))
    ;   true
    ).

%!  topics(+Names:list) is det.
%
%   Declare topics typhon(Name) of debug/3, as its expansion would.

topics(Names) :-
    forall(( member(Name, Names), \+ debugging(typhon(Name), _) ),
           nodebug(typhon(Name))).

:- topics([ agent, connect, frame, hop, host, mail, network, program,
            scheduler, security, session ]).

%   is_plain(+File) is semidet: clauses in File are stored as they are read, as
%   they have neither lambda expressions nor functions on dicts, see
%   doc/layers/loaded.pl.  The search for these takes two fifths of the time in
%   which the library is loaded.

is_plain(File) :-
    library(Library),
    atom_concat(Library, Path, File),
    \+ sub_atom(Path, 0, _, _, 'typhon/tools/page/'),
    member(Folder, [ 'typhon/kernel/', 'typhon/language/', 'typhon/network/',
                     'typhon/options/', 'typhon/tools/' ]),
    sub_atom(Path, 0, _, _, Folder),
    !.

:- public stored/1.

%   stored(+Term) is semidet: Term is a clause, or a rule of a grammar, and has
%   been stored, not expanded, see typhon_on_demand.  Programs that only read a
%   file, as prolog_xref and editors do, get its terms.

stored(Term) :-
    prolog_load_context(source, File),
    plain(File),
    \+ not_stored(Term),
    once(system:'$load_input'(File, _)),
    ( Term = (_-->_) -> dcg_translate_rule(Term, Clause) ; Clause = Term ),
    '$compile_term'(Clause, _, File, []).

not_stored((:-_)).
not_stored(begin_of_file).
not_stored(end_of_file).
