/*  Studies: many runs of agents, what was measured, claimed and drawn.

        swipl experiments/study.pl -- 5.6 --runs 10
        swipl experiments/study.pl -- my_study.pl --set agents=20

    `--help` lists the options; doc/studies.md tells how to write a study.
*/

:- module(study, []).
:- use_module(engine/cases,
              [case_name/3, study_cases/3, study_parameter/2]).
:- use_module(engine/catalogue, [catalogue/1, studies_named/2]).
:- use_module(engine/cross_check, [cross_check/4, real_case/4]).
:- use_module(engine/outcome, [outcome/4]).
:- use_module(engine/page, [page_save/2]).
:- use_module(engine/picture, [picture/4]).
:- use_module(engine/report,
              [ claims_sentence/2, outcome_save/4, parameter_rows/3,
                print_outcome/3, print_table/3, shown_measures/3 ]).
:- use_module(engine/signals, [stopping_on_signals/1]).
:- use_module(engine/store, [run_done/3, run_result/3]).
:- use_module(engine/studies,
              [study_call/2, study_load/2, study_name/3, study_title/3]).
:- use_module(engine/work, [runs_make/4]).
:- use_module(engine/worker, [run_here/4]).
:- use_module(library(apply), [exclude/3, maplist/2, maplist/3]).
:- use_module(library(error), [domain_error/2]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), 
              [ append/2, append/3, member/2, memberchk/2, nth1/3,
                selectchk/3 ]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(library(solution_sequences), [distinct/2]).

:- initialization(main, main).

:- public main/1.

opt_type(runs,    runs,    natural).
opt_type(seed,    seed,    integer).
opt_type(jobs,    jobs,    natural).
opt_type(set,     set,     atom).
opt_type(case,    case,    atom).
opt_type(logs,    logs,    boolean).
opt_type(list,    list,    boolean).
opt_type(collect, collect, boolean).
opt_type(real,    real,    boolean).
opt_type(out,     out,     atom).

opt_help(help(header),
"Makes runs of studies, and tables, claims and pictures of them\n").
opt_help(help(usage),
" -- STUDY ... [options]

A STUDY is a file, a figure of the thesis, as 5.6, a folder of experiments/, or
`thesis`: all. Without any, those of the thesis are listed. What has been run
stays, and is not run again.").
opt_help(runs,    "Runs of each case, with consecutive seeds [3]").
opt_help(seed,    "The first seed [1]").
opt_help(jobs,    "Runs at the same time [2]").
opt_help(set,     "NAME=VALUE: a parameter of the study; a list, [1,2], is \c
varied. May be given again; `STUDY --help` lists them").
opt_help(case,    "Make one run, of this case with the first seed, in this \c
process: its number, or its name, as delta=0.5,topology=ring").
opt_help(logs,    "Keep the log of each run, events.pl [false]").
opt_help(list,    "Print a command for each run, and make none [false]").
opt_help(collect, "Make no runs; show those that are there [false]").
opt_help(real,    "Make one case on real sockets, too, and say whether what \c
it gives lies within what virtual time gives [false]").
opt_help(out,     "Directory for runs, tables and pictures [out/studies]").

opt_meta(set,  'NAME=VALUE').
opt_meta(case, 'CASE').
opt_meta(out,  'DIRECTORY').

main(Argv) :-
    set_stream(user_output, encoding(utf8)),
    set_stream(user_error, encoding(utf8)),
    parsed(Argv, Names, Options),
    catch(stopping_on_signals(command(Names, Options)),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            halt(1) )).

parsed(Argv0, Names, [help(true)|Options]) :-
    member(Help, ['--help', '-h']),
    selectchk(Help, Argv0, Argv),
    argv_options(Argv, Names, Options),
    Names \== [],
    !.
parsed(Argv, Names, Options) :-
    argv_options(Argv, Names, Options).

command([], _) :-
    !,
    catalogue(Rows),
    print_table(user_output, [study, title], Rows).
command(Names, Options) :-
    studies_named(Names, Files),
    maplist(study_load, Files, Studies),
    (   option(help(true), Options)
    ->  maplist(print_help, Studies)
    ;   given(Options, Given),
        findall(plan(Study, Given, Cases),
                ( member(Study, Studies), study_cases(Study, Given, Cases) ),
                Plans),
        perform(Plans, Options)
    ).

%   What a study may be told by --set.

print_help(Study) :-
    study_title(Study, Name, Title),
    format('~w: ~w~n~n', [Name, Title]),
    parameter_rows(Study, [], Rows),
    print_table(user_output, [parameter, value, why], Rows).

%   given(+Options, -Given): what --set says, as pairs; the last counts.

given(Options, Given) :-
    findall(Name-Value,
            ( append(_, [set(Text)|Later], Options),
              setting(Text, Name, Value),
              \+ ( member(set(Other), Later), setting(Other, Name, _) ) ),
            Given).

setting(Text, Name, Value) :-
    (   sub_atom(Text, B, _, A, =)
    ->  sub_atom(Text, 0, B, _, Name),
        sub_atom(Text, _, A, 0, ValueText),
        value(ValueText, Value)
    ;   domain_error('NAME=VALUE', Text)
    ).

%   What is no term is text, as is what Prolog takes for a variable; but what
%   should be one is not.

value(Text, Value) :-
    catch(term_to_atom(Value, Text), error(syntax_error(_), _), fail),
    !,
    ( ground(Value) -> true ; Value = Text ).
value(Text, _) :-
    sub_atom(Text, _, 1, _, Char),
    memberchk(Char, ['[', ']', '(', ')', '{', '}', ',']),
    domain_error(value, Text).
value(Text, Text).

                /*******************************
                *             RUNS             *
                *******************************/

perform(Plans, Options) :-
    option(list(true), Options),
    !,
    forall(planned(Plans, Options, N, run(Study, _, Seed)),
           print_command(Study, N, Seed, Options)).
perform(Plans, Options) :-
    option(case(Text), Options),
    !,
    (   member(plan(Study, _, Cases), Plans),
        the_case(Text, Study, Cases, Case)
    ->  make_one(Study, Case, Options)
    ;   findall(Name, ( member(plan(Study, _, Cases), Plans),
                        member(Case, Cases),
                        case_name(Study, Case, Name) ),
                Names),
        throw(error(no_study_case(Text, Names), _))
    ).
perform(Plans, Options) :-
    option(collect(true), Options),
    !,
    collect(Plans, Options).
perform(Plans, Options) :-
    findall(Run, planned(Plans, Options, _, Run), Runs),
    root(Options, Root),
    runs_make(Runs, Root, Options, Outcomes),
    findall(Run, real(Plans, Options, Run), RealRuns),
    tell_if_none_is_real(Options, RealRuns),
    runs_make(RealRuns, Root, [jobs(1)|Options], RealOutcomes),
    collect(Plans, Options),
    (   memberchk(failed, Outcomes)
    ->  halt(1)
    ;   memberchk(failed, RealOutcomes)
    ->  halt(1)
    ;   true
    ).

%   planned(+Plans, +Options, -N, -Run): the first run of every case comes
%   first.  N is the number of the case.

planned(Plans, Options, N, run(Study, Case, Seed)) :-
    seed(Options, Seed),
    member(plan(Study, _, Cases), Plans),
    nth1(N, Cases, Case).

%   In real time runs disturb each other: they are made one by one.

real(Plans, Options, run(Study, Real, Seed)) :-
    option(real(true), Options),
    member(plan(Study, _, Cases), Plans),
    real_case(Study, Cases, _, Real),
    seed(Options, Seed).

tell_if_none_is_real(Options, []) :-
    option(real(true), Options),
    !,
    print_message(warning, study_none_is_real).
tell_if_none_is_real(_, _).

seed(Options, Seed) :-
    option(seed(First), Options, 1),
    option(runs(Runs), Options, 3),
    Last is First + Runs - 1,
    between(First, Last, Seed).

root(Options, Root) :-
    out(Options, Out),
    directory_file_path(Out, runs, Root).

out(Options, Out) :-
    option(out(Out0), Options, 'out/studies'),
    absolute_file_name(Out0, Out).

%   The parts of a name may stand in any order.

the_case(Text, Study, Cases, Case) :-
    (   atom_number(Text, N)
    ->  nth1(N, Cases, Case)
    ;   parts(Text, Parts),
        member(Case, Cases),
        case_name(Study, Case, Name),
        parts(Name, Parts)
    ),
    !.

parts(Name, Sorted) :-
    atomic_list_concat(Parts, ',', Name),
    msort(Parts, Sorted).

make_one(Study, Case, Options) :-
    option(seed(Seed), Options, 1),
    Run = run(Study, Case, Seed),
    root(Options, Root),
    run_here(Run, Root, Options, Outcome),
    (   Outcome = failed(Directory)
    ->  directory_file_path(Directory, output, File),
        read_file_to_string(File, Text, [encoding(utf8)]),
        format(user_error, '~w~nThe run failed; this is in ~w~n',
               [Text, File]),
        halt(1)
    ;   run_result(Root, Run, Measures),
        dict_pairs(Measures, _, Pairs),
        findall([Name, Value],
                ( member(Name-Value, Pairs), number(Value) ), Rows),
        print_table(user_output, [measure, value], Rows),
        format('~nIn ~w~n', [Measures.directory])
    ).

                /*******************************
                *           COMMANDS           *
                *******************************/

%   One line of a shell for each run, for any directory.

print_command(Study, N, Seed, Options) :-
    module_property(study, file(Script)),
    prolog(Swipl),
    out(Options, Out),
    findall(Argument, repeated(Options, Argument), More),
    append([ [Swipl, Script, '--', Study, '--case', N, '--seed', Seed],
             More, ['--out', Out] ], Words),
    command_text(Words, Text),
    format('~w~n', [Text]).

%   By its usual name, if that is who this is.

prolog(Swipl) :-
    current_prolog_flag(executable, Executable),
    (   absolute_file_name(path(swipl), Usual,
                           [access(execute), file_errors(fail)]),
        same_file(Usual, Executable)
    ->  Swipl = swipl
    ;   Swipl = Executable
    ).

%   Of all runs, for people, and from here.

again(Study, Options, Text) :-
    module_property(study, file(Script0)),
    maplist(from_here, [Script0, Study], [Script, File]),
    option(runs(Runs), Options, 3),
    option(seed(Seed), Options, 1),
    findall(Argument, repeated(Options, Argument), More),
    findall(Argument, ( option(out(Out), Options),
                        member(Argument, ['--out', Out]) ), Where),
    append([ [swipl, Script, '--', File, '--runs', Runs, '--seed', Seed],
             More, Where ], Words),
    command_text(Words, Text).

repeated(Options, Argument) :-
    member(set(Setting), Options),
    member(Argument, ['--set', Setting]).
repeated(Options, Argument) :-
    member(Argument-Option, ['--logs'-logs(true), '--real'-real(true)]),
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

                /*******************************
                *           FIGURES            *
                *******************************/

collect(Plans, Options) :-
    out(Options, Out),
    make_directory_path(Out),
    findall(Shown,
            ( member(Plan, Plans), show(Plan, Options, Out, Shown) ),
            All),
    page_save(Out, All),
    findall(Outcome, member(shown(_, Outcome, _, _), All), Outcomes),
    claims_sentence(Outcomes, Sentence),
    directory_file_path(Out, 'index.html', Page),
    format('~n~w~nTables, pictures, claims: ~w~n', [Sentence, Page]),
    tell_missing(Plans, Options).

tell_missing(Plans, Options) :-
    root(Options, Root),
    findall(Run, planned(Plans, Options, _, Run), Runs),
    exclude(run_done(Root, false), Runs, Missing),
    length(Runs, Count),
    length(Missing, MissingCount),
    (   Missing == []
    ->  true
    ;   format('~d of ~d runs are not there~n', [MissingCount, Count])
    ).

show(plan(Study, Given, Cases), Options, Out,
     shown(Study, Outcome, Again, Directory)) :-
    root(Options, Root),
    findall(run(Case, Seed, Measures),
            ( seed(Options, Seed), member(Case, Cases),
              run_result(Root, run(Study, Case, Seed), Measures) ),
            Runs),
    outcome(Study, Cases, Runs, Outcome0),
    checks(Study, Cases, Runs, Outcome0.rows, Options, Checks),
    Outcome = Outcome0.put(_{given:Given, checks:Checks}),
    study_title(Study, Name, _),
    directory_file_path(Out, Name, Figures),
    make_directory_path(Figures),
    outcome_save(Study, Outcome, Runs, Figures),
    forall(study_call(Study, plot(Plot, Title, Picture)),
           picture(Study, plot(Plot, Title, Picture), Runs, Figures)),
    print_outcome(user_output, Study, Outcome),
    forall(never_measured(Study, Runs, Where, Measure),
           print_message(warning, study_measure(Where, Measure))),
    again(Study, Options, Again),
    (   Runs = [run(_, _, First)|_]
    ->  Directory = First.directory
    ;   Directory = none
    ).

%   checks(+Study, +Cases, +Runs, +Rows, +Options, -Checks): of the case that
%   is made on real sockets as well.

checks(Study, Cases, Runs, Rows, Options, Checks) :-
    option(real(true), Options),
    real_case(Study, Cases, Case, Real),
    !,
    root(Options, Root),
    findall(Ms, member(run(Case, _, Ms), Runs), Virtual),
    findall(Ms, ( seed(Options, Seed),
                  run_result(Root, run(Study, Real, Seed), Ms) ),
            OnSockets),
    shown_measures(Study, Rows, Measures),
    cross_check(Virtual, OnSockets, Measures, Checks).
checks(_, _, _, _, _, []).

%   A name that no run has given.

never_measured(Study, Runs, Where, Name) :-
    Runs = [_|_],
    distinct(Where-Name, study_name(Study, Where, Name)),
    \+ study_parameter(Study, Name),
    \+ ( member(run(_, _, Measures), Runs), get_dict(Name, Measures, _) ).

:- multifile
    prolog:error_message//1,
    prolog:message//1.

prolog:error_message(no_study_case(Text, Names)) -->
    [ 'case ~w does not exist; there are '-[Text] ],
    first_names(Names).

first_names(Names) -->
    { length(Some, 4),
      append(Some, [_|_], Names),
      !,
      atomic_list_concat(Some, '  ', Shown) },
    [ '~w  ...'-[Shown] ].
first_names(Names) -->
    { atomic_list_concat(Names, '  ', Shown) },
    [ '~w'-[Shown] ].

prolog:message(study_none_is_real) -->
    [ '--real: no case that is made has real/2, which names it'-[] ].

prolog:message(study_measure(Where, Name)) -->
    [ '~p: no run has given ~q'-[Where, Name] ].
