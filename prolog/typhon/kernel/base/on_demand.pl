:- module(typhon_on_demand,
          [ on_demand_part/2,           % +Seam, +What
            on_demand_missing/2,        % +Seam, +What
            on_demand_load/2,           % +Seam, +What
            on_demand_call/3,           % +Seam, +What, +Goal
            on_demand_later/1           % :Goal
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(compiling, [compiling/1, own_file/1]).
:- use_module(index, [part_file/2, part_joins/3, part_setting/6]).
:- use_module(own_thread, [uncounted/1]).

/** <module> Code that is loaded on first use

A process loads the kernel, and other parts on demand: a part, such as a
network or an option, is loaded when one of its predicates is called, one of
its options is given, or a peer asks for it. The index, which
`doc/layers.pl -- index` makes from the sources, maps names to parts.

Where no name leads to a part, the part itself declares when it is needed, by
the hook joins(Seam, What): the kernel, or another part, calls on_demand_load/2
for these.

  | untrusted   | any      | a host admits agents that it does not trust |
  | keys        | any      | the process has keys                        |
  | spied       | program  | a predicate of a program is spied or traced |
  | environment | Variable | Variable is set when an endpoint starts     |
  | program     | text     | a program or a payload is to be read        |
  | program     | read     | a program was read                          |
  | program     | runs     | a program is about to run                   |
  | fault       | report   | an agent has failed, or raised an error     |
  | fault       | location | an agent has failed, or raised an error     |
  | payload     | any      | an agent gets, loses or delivers a payload  |
  | recipient   | external | a message is for no agent, but a bridge     |

Other threads run meanwhile, and call hooks. So clauses of hooks are compiled
when the rest of their file is loaded: a hook works from the moment it is
visible.

A part may be left out of an installation.  Then what would load it raises an
error that names it.

*Threading*: any thread but those of the endpoint, which pass the goal to a
worker by on_demand_later/1.
*/

:- multifile
    joins/2,                    % Seam, What: the part is loaded there, too
    worker_call/1,              % Goal: call it once in a worker
    prolog:error_message//1.

:- dynamic
    loaded/1,                   % Part
    directory/1,                % Directory of the parts
    present/1.                  % File: of a part, which Prolog has loaded

:- module_property(typhon_on_demand, file(Source)),
   file_directory_name(Source, Base),
   file_directory_name(Base, Kernel),
   file_directory_name(Kernel, Typhon),
   retractall(directory(_)),
   assertz(directory(Typhon)).

%!  on_demand_part(+Seam, +What) is semidet.
%
%   A part, loaded or not, defines the hook Seam for What.

on_demand_part(Seam, What) :-
    part_joins(Seam, What, _),
    !.

%!  on_demand_missing(+Seam, +What) is semidet.
%
%   A part that is not loaded defines the hook Seam for What.

on_demand_missing(Seam, What) :-
    part_joins(Seam, What, Part),
    \+ loaded(Part),
    !.

%!  on_demand_load(+Seam, +What) is det.
%
%   Load all parts that define the hook Seam for What.

on_demand_load(Seam, What) :-
    forall(( part_joins(Seam, What, Part), \+ loaded(Part) ), load(Part)).

%!  on_demand_call(+Seam, +What, +Goal) is nondet.
%
%   Load the parts that define Seam for What, and call Goal, Module:Plain.

on_demand_call(Seam, What, Module:Goal) :-
    on_demand_load(Seam, What),
    call(Module:Goal).

load(Part) :-
    forall(( part_file(Part, File), path(File, Path) ),
           use_module(Path, [])),
    assertz(loaded(Part)).

%   Whoever uses a part first may have little stack or a limit on inferences,
%   and may be interrupted: a file of which Prolog has loaded a part is not
%   loaded again.  So all files that are loaded later, also by autoload/2, are
%   loaded in a thread of their own.

:- multifile user:prolog_load_file/2.
:- dynamic user:prolog_load_file/2.

user:prolog_load_file(Module:File, Options) :-
    \+ memberchk(typhon(later), Options),
    typhon_on_demand:is_later(File),
    uncounted(compiling(load_files(Module:File, [typhon(later)|Options]))).

:- public is_later/1.

is_later(File) :-
    atom(File),
    directory(Directory),
    atom_concat(Directory, _, File),
    \+ source_location(_, _),           % as a part of another file
    \+ source_file(File),
    file_name_extension(File, pl, Path),
    \+ source_file(Path),
    (   left_out(Path, Part)
    ->  existence_error(typhon_part, Part)
    ;   true
    ).

%   Settings of parts that are not loaded can be set.

:- multifile settings:current_setting/6.

settings:current_setting(Name, Module, Type, Default, Text, Path:0) :-
    part_setting(Name, Module, Type, Default, Text, File),
    \+ present(File),
    path(File, Path),
    (   source_file(Path)
    ->  assertz(present(File)),         % asked often; files remain loaded
        fail
    ;   true
    ).

path(File, Path) :-
    directory(Directory),
    atomic_list_concat([Directory, /, File, '.pl'], Path).

%!  on_demand_later(:Goal) is semidet.
%
%   Queue Goal for a worker, which calls it once; fails if there are no workers.

:- meta_predicate on_demand_later(0).

on_demand_later(Goal) :-
    worker_call(Goal).

                /*******************************
                *        PARTS LEFT OUT        *
                *******************************/

%   left_out(+Path, -Part) is semidet: the file at Path, with its extension, is
%   not there.  Part is the library, or the name of the topmost folder, that is
%   incomplete without it.

left_out(Path, Part) :-
    \+ exists_file(Path),
    topmost_missing(Path, Missing),
    file_base_name(Missing, Base),
    file_name_extension(Name, _, Base),
    (   library_of(Name, Library)
    ->  Part = library(Library)
    ;   Part = Name
    ).

library_of(Name, Library) :-
    directory(Typhon),
    file_directory_name(Typhon, Directory),
    member(Library, [typhon/Name, Name]),
    format(atom(File), '~w/~w.pl', [Directory, Library]),
    exists_file(File),
    !.

topmost_missing(Path, Missing) :-
    file_directory_name(Path, Dir),
    (   exists_directory(Dir)
    ->  Missing = Path
    ;   topmost_missing(Dir, Missing)
    ).

prolog:error_message(existence_error(typhon_part, Part)) -->
    [ '~w is not part of this installation: install the full archive'-[Part] ].

%   without_part(+Directive, -Terms) is semidet: Directive imports from a file
%   that is left out.  Predicates that are declared by autoload/2 raise the
%   error when they are called; a library of the part is not read further.

:- public without_part/2.

without_part(autoload(Spec, PIs), []) :-
    imported_file(Spec, Path),
    left_out(Path, Part),
    findall((Head :- error:existence_error(typhon_part, Part)),
            ( member(Name/Arity, PIs), functor(Head, Name, Arity) ),
            Clauses),
    compile_aux_clauses(Clauses).
without_part(Import, [(:- print_message(error, Error)), end_of_file]) :-
    Error = error(existence_error(typhon_part, Part), _),
    compound(Import),
    compound_name_arguments(Import, Name, [Spec|_]),
    memberchk(Name, [reexport, use_module]),
    prolog_load_context(directory, Directory),
    directory(Typhon),
    ( Directory == Typhon ; file_directory_name(Typhon, Directory) ),
    !,
    imported_file(Spec, Path),
    left_out(Path, Part).

imported_file(Spec, Path) :-
    Spec \= library(_),
    prolog_load_context(source, Source),
    own_file(Source),
    file_directory_name(Source, Dir),
    absolute_file_name(Spec, File, [relative_to(Dir)]),
    file_name_extension(File, pl, Path).

system:term_expansion((:- Directive), Terms) :-
    typhon_on_demand:without_part(Directive, Terms).

                /*******************************
                *    HOOKS COME LAST IN FILES  *
                *******************************/

:- multifile system:term_expansion/2.
:- dynamic system:term_expansion/2.

:- thread_local held/2.                 % File, Clause: of a hook

:- public
    hold_hook/2,
    held_hooks/1.

%   hold_hook(+Module, +Clause) is semidet: compile Clause, for a hook of
%   Module, a module of this library, later. Not in the kernel, which is loaded
%   before there are threads.

hold_hook(Module, Clause) :-
    atom(Module),
    sub_atom(Module, 0, _, _, typhon_),
    prolog_load_context(module, Other),
    Other \== Module,
    prolog_load_context(source, File),
    directory(Directory),
    atom_concat(Directory, Path, File),
    \+ sub_atom(Path, 0, _, _, '/kernel/'),
    assertz(held(File, Clause)).

held_hooks(Clauses) :-
    prolog_load_context(source, File),
    held(File, _),
    !,
    findall(Clause, retract(held(File, Clause)), Clauses, [end_of_file]).

system:term_expansion((Module:Head:-Body), []) :-
    typhon_on_demand:hold_hook(Module, (Module:Head:-Body)).
system:term_expansion(Module:Head, []) :-
    typhon_on_demand:hold_hook(Module, Module:Head).
system:term_expansion(end_of_file, Clauses) :-
    typhon_on_demand:held_hooks(Clauses).

%   The other clauses of the library are stored as they are read.

system:term_expansion(Term, []) :-
    typhon_compiling:stored(Term).
