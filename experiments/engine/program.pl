:- module(study_program,
          [ run_option/4,               % ?Option, ?Type, ?Meta, ?Help
            run_program/1               % :Goal
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(signals, [stopping_on_signals/1]).

/** <module> What the programs that make runs of studies have in common

*Threading*: the main thread.
*/

:- meta_predicate run_program(0).

%!  run_option(?Option, ?Type, ?Meta, ?Help) is nondet.
%
%   The options of study_plan and study_work.  Type is a type of argv_options/3,
%   Meta the name of the value in the help.

run_option(runs, natural, 'N',
           "Runs of each case, with consecutive seeds [3]").
run_option(seed, integer, 'N',
           "The first seed [1]").
run_option(jobs, natural, 'N',
           "Runs at the same time [2]").
run_option(set, atom, 'NAME=VALUE',
           "A parameter of the study; a list, [1,2], is varied. May be \c
repeated; `study.pl -- STUDY --help` lists parameters").
run_option(list, boolean, '',
           "Print a line for each run, and make none [false]").
run_option(collect, boolean, '',
           "Make no runs; show the existing ones [false]").
run_option(out, atom, 'DIRECTORY',
           "Directory for runs, tables and pictures [out/studies]").

%!  run_program(:Goal) is det.
%
%   Calls Goal, the work of a program, once.  Its output is UTF-8; an error is
%   printed, and the status of the process is 1; signals end it in order.

run_program(Goal) :-
    maplist(in_utf8, [user_output, user_error]),
    catch(stopping_on_signals(Goal),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            halt(1) )).

in_utf8(Stream) :-
    set_stream(Stream, encoding(utf8)).
