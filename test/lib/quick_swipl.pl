:- module(test_quick_swipl,
          [ quick_swipl/2,              % +Dir, -Program
            plain_swipl/1               % -Program
          ]).

/** <module> A Prolog that need not read library(typhon)

To read the library takes 0.3 seconds, and the suites start hundreds of
processes that do.  So test/run.pl makes one program that has it loaded, and
runs the suites by it.  Whatever a suite starts as the `executable` of its
own process is that program as well; which is a `swipl` in every other way.

*Threading*: any thread.
*/

:- use_module(common, [project_file/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).

%!  quick_swipl(+Dir, -Program) is det.
%
%   Program is a file in Dir.  Where it does not run, since it does not find
%   the libraries of C of who made it, it is the `swipl` that runs this.

quick_swipl(Dir, Program) :-
    current_prolog_flag(executable, Swipl),
    setenv('TYPHON_PLAIN_SWIPL', Swipl),
    directory_file_path(Dir, swipl, Quick),
    project_file('prolog/typhon.pl', Library),
    (   succeeds(Swipl, [ '-f', none, '-o', Quick, '-c', Library,
                          '--class=development', '--stand-alone=true',
                          '--autoload=false', '--on-error=print' ]),
        succeeds(Quick, ['-g', true, '-t', halt])
    ->  Program = Quick
    ;   Program = Swipl
    ).

succeeds(Program, Args) :-
    process_create(Program, Args,
                   [ stdin(null), stdout(null), stderr(null),
                     process(Pid) ]),
    process_wait(Pid, exit(0)).

%!  plain_swipl(-Program) is det.
%
%   A `swipl` that has nothing loaded, for who looks at how it begins.

plain_swipl(Program) :-
    getenv('TYPHON_PLAIN_SWIPL', Program),
    !.
plain_swipl(Program) :-
    current_prolog_flag(executable, Program).
