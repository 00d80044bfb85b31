:- module(typhon_loaded,
          [ program_load/5,             % +Spec, -Program, -Initial, -Hash,
                                        % -Kinds
            program_load/6,             % +Spec, -Program, -Initial, -Hash,
                                        % -Kinds, -Places
            program_unknown/3           % +Hash, +State, :Offered
          ]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(paths, [program_file/2]).
:- use_module(advice, [problem_error/3]).
:- use_module(goal_lines, [problem_at_goal/2]).
:- use_module(programs, [program_hash/2, program_read/7]).
:- use_module(source, [source_same/1, source_settled/1]).

/** <module> Programs that were read lately

A program file is read, checked and analysed when the first agent is created
from it, and again when it, or a file that it includes, has changed; a program
of clauses once for all that are variants of it.  What a library that it
imports defines is taken as it was then.  What is doubtful about a program is
printed when it is read, and not again while it is the same.  Calls of what it
does not define are kept until an agent is created from it: what that agent
brings, or finds, may define them.

*Threading*: any thread.  One mutex is held to remember; to look needs none.
*/

:- setting(files, nonneg, 64, "Programs remembered as they were read").

%   File, Hash: of the program that was read.

:- multifile was_read/2.

:- dynamic
    loaded/3,                   % File or hash of clauses, Sources, Loaded:
                                % the oldest first
    warned/2,                   % File or hash of clauses, Sources: its
                                % warnings were printed
    unknown/2.                  % Hash, Problems: not printed yet

:- meta_predicate program_unknown(+, +, 1).

%!  program_load(+Spec, -Program, -Initial, -Hash, -Kinds) is det.
%!  program_load(+Spec, -Program, -Initial, -Hash, -Kinds, -Places) is det.
%
%   As program_read/7, with the hash of Program.  Warnings are printed.

program_load(Spec, Program, Initial, Hash, Kinds) :-
    program_load(Spec, Program, Initial, Hash, Kinds, _).

program_load(Spec, Program, Initial, Hash, Kinds, Places) :-
    load(Spec, loaded(Program, Initial, Hash, Kinds, Places)).

load(Spec, Loaded) :-
    in_file(Spec),
    !,
    program_file(Spec, File),
    load(File, File, Loaded).
load(clauses(Terms), Loaded) :-
    catch(variant_sha1(Terms, Hash), error(type_error(_, _), _), fail),
    !,
    load(Hash, clauses(Terms), Loaded).
load(Spec, Loaded) :-                   % what no program can have is in it
    read_program(Spec, Loaded, _, _).

in_file(Spec) :-
    callable(Spec),
    Spec \= clauses(_).

load(Key, _, Loaded) :-
    loaded(Key, Sources, Loaded0),
    source_same(Sources),
    !,
    Loaded = Loaded0.
load(Key, Spec, Loaded) :-
    read_program(Spec, Loaded, Sources, Warnings),
    read_from(Spec, Loaded),
    debug(typhon(program), 'read ~w', [Key]),
    warn(Key, Sources, Loaded, Warnings),
    (   source_settled(Sources)
    ->  with_mutex(typhon_loaded, remember(Key, Sources, Loaded))
    ;   true
    ).

read_from(File, loaded(_, _, Hash, _, _)) :-
    atom(File),
    !,
    forall(was_read(File, Hash), true).
read_from(_, _).

read_program(Spec, loaded(Program, Initial, Hash, Kinds, Places), Sources,
             Warnings) :-
    program_read(Spec, Program, Initial, Kinds, Places, Sources, Warnings),
    program_hash(Program, Hash).

remember(Key, Sources, Loaded) :-
    retractall(loaded(Key, _, _)),
    assertz(loaded(Key, Sources, Loaded)),
    forget_oldest(loaded(_, _, _)).

%   warn(+Key, +Sources, +Loaded, +Warnings)

warn(_, _, _, []) :-
    !.
warn(Key, Sources, loaded(_, _, Hash, _, _), Warnings0) :-
    partition(is_unknown, Warnings0, Unknown, Warnings),
    (   with_mutex(typhon_loaded, is_news(Key, Sources, Hash, Unknown))
    ->  forall(member(Warning, Warnings), print_warning(Warning))
    ;   true
    ).

is_unknown(problem(unknown_procedure(_), _, _)).

is_news(Key, _, _, _) :-
    warned(Key, Sources),
    source_same(Sources),
    !,
    fail.
is_news(Key, Sources, Hash, Unknown) :-
    retractall(warned(Key, _)),
    assertz(warned(Key, Sources)),
    forget_oldest(warned(_, _)),
    retractall(unknown(Hash, _)),
    assertz(unknown(Hash, Unknown)),
    forget_oldest(unknown(_, _)).

print_warning(Warning0) :-
    problem_at_goal(Warning0, Warning),
    problem_error(Warning, [], Error),
    print_message(warning, Error).

%!  program_unknown(+Hash, +State:list, :Offered) is det.
%
%   An agent of the program of this Hash is created, State being the predicates
%   of its state.  Print, once for each program, which predicates it calls that
%   nothing defines; call(Offered, Problem) is true of a problem that need not
%   be printed.

program_unknown(Hash, _, _) :-
    \+ unknown(Hash, _),
    !.
program_unknown(Hash, State, Offered) :-
    (   retract(unknown(Hash, Problems))
    ->  forall(( member(Problem, Problems),
                 Problem = problem(unknown_procedure(PI), _, _),
                 \+ memberchk(PI, State),
                 \+ call(Offered, Problem) ),
               print_warning(Problem))
    ;   true                            % another thread has
    ).

%   forget_oldest(+Table): keep no more than are remembered.

forget_oldest(Table) :-
    predicate_property(Table, number_of_clauses(Count)),
    setting(files, Max),
    Count > Max,
    \+ \+ retract(Table),
    !,
    forget_oldest(Table).
forget_oldest(_).
