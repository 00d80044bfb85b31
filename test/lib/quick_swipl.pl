:- module(test_quick_swipl,
          [ quick_swipl/2,              % +Dir, -Program
            quick_swipl/3               % +Start, +Dir, -Program
          ]).

/** <module> A Prolog with a saved state of library(typhon)

Loading the library takes 0.3 seconds, and suites start thousands of processes
that load it. So test/run.pl makes a saved state with the library, see
quick_start, and runs the suites with it. The `executable` of a suite's
process is this program, too; otherwise it behaves as `swipl`.

*Threading*: any thread.
*/

:- use_module(common, [project_file/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).

%!  quick_swipl(+Dir, -Program) is det.
%!  quick_swipl(+Start, +Dir, -Program) is det.
%
%   Program is a file in Dir; or the `swipl` that runs this, if the file does
%   not run: some find their libraries of C only from where they are. Start is
%   the file that is loaded, or its name in this folder: quick_start, or
%   quick_system, which is no part of this tree.

quick_swipl(Dir, Program) :-
    quick_swipl(quick_start, Dir, Program).

quick_swipl(Name, Dir, Program) :-
    current_prolog_flag(executable, Swipl),
    directory_file_path(Dir, swipl, Quick),
    start_file(Name, Start),
    (   succeeds(Swipl, [ '-f', none, '-o', Quick, '-c', Start,
                          '--class=development', '--stand-alone=true',
                          '--autoload=false', '--on-error=print' ]),
        succeeds(Quick, ['-g', true, '-t', halt])
    ->  Program = Quick
    ;   Program = Swipl
    ).

start_file(Start, Start) :-
    is_absolute_file_name(Start),
    !.
start_file(Name, Start) :-
    format(atom(File), 'test/lib/~w.pl', [Name]),
    project_file(File, Start).

succeeds(Program, Args) :-
    process_create(Program, Args,
                   [ stdin(null), stdout(null), stderr(null),
                     process(Pid) ]),
    process_wait(Pid, exit(0)).
