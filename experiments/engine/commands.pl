:- module(study_commands,
          [ print_commands/2,           % :Run, +Options
            again_command/3             % +Study, +Options, -Text
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists),
              [append/2, append/3, member/2, memberchk/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(plan, [out_directory/2]).

:- meta_predicate print_commands(3, +).

/** <module> Shell commands that repeat runs

*Threading*: no state; any thread.
*/

%!  print_commands(:Run, +Options) is det.
%
%   Prints a command for each solution of call(Run, N, Study, Seed): it makes
%   one run, of the case with the number N, from any directory.

print_commands(Run, Options) :-
    script(Script),
    prolog(Swipl),
    out_directory(Options, Out),
    command_text([Swipl, Script, '--'], Begin),
    findall(Argument, repeated(Options, Argument), More),
    append(More, ['--out', Out], Words),
    command_text(Words, End),
    forall(call(Run, N, Study, Seed),
           ( command_text([Study], File),
             format('~w ~w --case ~w --seed ~w ~w~n',
                    [Begin, File, N, Seed, End]) )).

%!  again_command(+Study, +Options, -Text:atom) is det.
%
%   Text makes all runs, from the current directory, in a readable form.

again_command(Study, Options, Text) :-
    script(Script0),
    maplist(from_here, [Script0, Study], [Script, File]),
    option(runs(Runs), Options, 3),
    option(seed(Seed), Options, 1),
    findall(Argument, repeated(Options, Argument), More),
    findall(Argument, ( option(out(Out), Options),
                        member(Argument, ['--out', Out]) ), Where),
    append([ [swipl, Script, '--', File, '--runs', Runs, '--seed', Seed],
             More, Where ], Words),
    command_text(Words, Text).

script(Script) :-
    module_property(study_commands, file(Here)),
    absolute_file_name('../study.pl', Script, [relative_to(Here)]).

%   The usual name of this program, if the path leads to it.

prolog(Swipl) :-
    current_prolog_flag(executable, Executable),
    (   absolute_file_name(path(swipl), Usual,
                           [access(execute), file_errors(fail)]),
        same_file(Usual, Executable)
    ->  Swipl = swipl
    ;   Swipl = Executable
    ).

repeated(Options, Argument) :-
    member(set(Setting), Options),
    member(Argument, ['--set', Setting]).
repeated(Options, Argument) :-
    member(Name-Option, [ '--machines'-machines(Text), '--bind'-bind(Text),
                          '--real-clock'-real_clock(Text) ]),
    option(Option, Options),
    member(Argument, [Name, Text]).
repeated(Options, Argument) :-
    member(Argument-Option, [ '--logs'-logs(true), '--real'-real(true),
                              '--replays'-replays(true) ]),
    option(Option, Options).

from_here(File, Relative) :-
    absolute_file_name('.', Here, [file_type(directory)]),
    atom_concat(Here, /, Start),
    (   atom_concat(Start, Relative, File)
    ->  true
    ;   Relative = File
    ).

command_text(Words, Text) :-
    maplist(quoted, Words, Quoted),
    atomic_list_concat(Quoted, ' ', Text).

quoted(Word, Word) :-
    atom_codes(Word, Codes),
    forall(member(Code, Codes),
           ( code_type(Code, alnum) ; memberchk(Code, `_-=,./:`) )),
    !.
quoted(Word, Quoted) :-
    atomic_list_concat(Parts, '\'', Word),
    atomic_list_concat(Parts, '\'\\\'\'', Inside),
    format(atom(Quoted), '\'~w\'', [Inside]).
