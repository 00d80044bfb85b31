:- module(typhon_loaded,
          [ program_load/6              % +Spec, -Program, -Initial, -Hash,
                                        % -Kinds, -Places
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../base/prolog_faults', [forget_erased/0]).
:- use_module(paths, [program_file/2]).
:- use_module(programs, [program_hash/2, program_read/7]).
:- use_module(source, [source_same/1, source_settled/1]).

/** <module> A cache of the programs that were read

A program file is read, checked and analysed when the first agent is created
from it, and again when it, or a file that it includes, has changed.  A program
of clauses is read once for all variants of it.  The imports of a library are
its exports at the time of reading.

*Threading*: any thread. One mutex to add a program; readers need none.
*/

:- setting(files, nonneg, 64, "Programs remembered as they were read").

:- multifile
    was_read/2,                 % File, Hash: of the program that was read
    read_anew/4,                % File or hash of clauses, Hash, Sources,
                                % Doubtful, see program_read/7
    unknown/3.                  % Hash, State, :Offered: an agent of this
                                % program is created, with these predicates in
                                % its state: print, once for each program, those
                                % that it calls and that nothing defines, but no
                                % Problem for which call(Offered, Problem)
                                % succeeds

:- dynamic loaded/3.            % File or hash of clauses, Sources, Loaded: the
                                % oldest first

%!  program_load(+Spec, -Program, -Initial, -Hash, -Kinds, -Places) is det.
%
%   As program_read/7, with the hash of Program.  Prints warnings.

program_load(Spec, Program, Initial, Hash, Kinds, Places) :-
    load(Spec, loaded(Program, Initial, Hash, Kinds, Places)).

load(Spec, Loaded) :-
    callable(Spec),
    Spec \= clauses(_),
    !,
    program_file(Spec, File),
    load(File, File, Loaded).
load(clauses(Terms), Loaded) :-
    catch(variant_sha1(Terms, Hash), error(type_error(_, _), _), fail),
    !,
    load(Hash, clauses(Terms), Loaded).
load(Spec, Loaded) :-                   % invalid clauses: an error follows
    read_program(Spec, Loaded, _, _).

load(Key, _, Loaded) :-
    loaded(Key, Sources, Loaded0),
    source_same(Sources),
    !,
    Loaded = Loaded0.
load(Key, Spec, Loaded) :-
    read_program(Spec, Loaded, Sources, Doubtful),
    arg(3, Loaded, Hash),
    (   atom(Spec)
    ->  forall(was_read(Spec, Hash), true)
    ;   true
    ),
    debug(typhon(program), 'read ~w', [Key]),
    on_demand_load(program, read),
    forall(read_anew(Key, Hash, Sources, Doubtful), true),
    (   source_settled(Sources)
    ->  with_mutex(typhon_loaded, remember(Key, Sources, Loaded))
    ;   true
    ),
    forget_erased.

read_program(Spec, loaded(Program, Initial, Hash, Kinds, Places), Sources,
             Doubtful) :-
    program_read(Spec, Program, Initial, Kinds, Places, Sources, Doubtful),
    program_hash(Program, Hash).

remember(Key, Sources, Loaded) :-
    retractall(loaded(Key, _, _)),
    assertz(loaded(Key, Sources, Loaded)),
    forget_oldest.

forget_oldest :-
    predicate_property(loaded(_, _, _), number_of_clauses(Count)),
    setting(files, Max),
    Count > Max,
    loaded(Key, _, _),
    !,
    retractall(loaded(Key, _, _)),
    forget_oldest.
forget_oldest.
