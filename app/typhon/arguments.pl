:- module(typhon_arguments,
          [ arguments/3,                % :Argv, -Words, -Options
            arguments_complete/2        % +Script, +Argv
          ]).
:- use_module(library(lists), [append/3, last/2]).
:- use_module(library(main), [argv_options/4]).

/** <module> The arguments of the programs of the project

*Threading*: the main thread only.
*/

:- meta_predicate arguments(:, -, -).

%!  arguments(:Argv, -Words:list, -Options:list) is det.
%
%   Words and Options are the arguments of the program that is the module of
%   Argv, as of argv_options/4.  If they do not unify the program ends with
%   status 1; so it does without `--` before files, because SWI-Prolog loads
%   these, and leaves the other arguments.

arguments(Qualified, Words, Options) :-
    strip_module(Qualified, Program, Argv),
    once(( module_property(Program, file(Script))
         ; predicate_property(Program:main(_), file(Script)) )),
    catch(( arguments_complete(Script, Argv),
            argv_options(Qualified, Given, Options0, [on_error(halt(1))]),
            taken(Script, Given-Options0, Words-Options) ),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            halt(1) )).

taken(_, Given, Given) :-
    !.
taken(Script, Words-Options, _) :-
    file_base_name(Script, Base),
    append(Words, Options, Others),
    throw(error(typhon_arguments(refused(Base, Others)), _)).

%!  arguments_complete(+Script, +Argv) is det.
%
%   SWI-Prolog has not loaded files among the arguments of the file Script.
%
%   @error typhon_arguments(loaded(Script, Words)): Words are to follow `--`

arguments_complete(Script, Argv) :-
    current_prolog_flag(os_argv, Words),
    append(Before, Argv, Words),
    last(Before, File),
    file_name_extension(_, Extension, File),
    Extension \== '',
    exists_file(File),
    \+ same_file(File, Script),
    append(_, [Loaded|Taken], Before),
    exists_file(Loaded),
    same_file(Loaded, Script),
    !,
    append(Taken, Argv, All),
    throw(error(typhon_arguments(loaded(Loaded, All)), _)).
arguments_complete(_, _).

:- multifile prolog:error_message//1.

prolog:error_message(typhon_arguments(loaded(Script, Words))) -->
    { atomic_list_concat(Words, ' ', Text) },
    [ 'Arguments follow --: swipl ~w -- ~w'-[Script, Text] ].
prolog:error_message(typhon_arguments(refused(Program, Words))) -->
    [ '~w does not take these arguments: ~q'-[Program, Words] ].
