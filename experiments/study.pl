/*  Studies: many runs of agents, what was measured, claimed and drawn.

        swipl experiments/study.pl -- 5.6 --runs 10
        swipl experiments/study.pl -- my_study.pl --set agents=20

    `--help` lists the options; doc/studies.md tells how to write a study.
*/

:- module(study, []).
:- use_module(engine/catalogue, [catalogue/1, studies_named/2]).
:- use_module(engine/outcome, [outcome/4]).
:- use_module(engine/page, [page_save/3]).
:- use_module(engine/picture, [picture/4]).
:- use_module(engine/report, [outcome_save/4, print_outcome/3, print_table/3]).
:- use_module(engine/signals, [stopping_on_signals/1]).
:- use_module(engine/store, [run_result/5]).
:- use_module(engine/studies,
              [case_name/3, study_call/2, study_cases/3, study_load/2,
               study_title/3]).
:- use_module(engine/work, [run_here/3, runs_make/4]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [domain_error/2, existence_error/2]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2, nth1/3, numlist/3]).
:- use_module(library(main), [argv_options/3, main/0]).
:- use_module(library(option), [option/2, option/3]).

:- initialization(main, main).

:- public main/1.

opt_type(runs,    runs,    natural).
opt_type(seed,    seed,    integer).
opt_type(jobs,    jobs,    natural).
opt_type(set,     set,     atom).
opt_type(case,    case,    atom).
opt_type(list,    list,    boolean).
opt_type(collect, collect, boolean).
opt_type(out,     out,     atom).

opt_help(help(header), "Makes runs of studies, and tables, claims and pictures \c
of them\n").
opt_help(help(usage), " -- STUDY ... [options]\n\nA STUDY is a file, or a figure \c
of the thesis, as 5.6; without any, the studies\nare listed.").
opt_help(runs,    "Runs of each case, with consecutive seeds [3]").
opt_help(seed,    "The first seed [1]").
opt_help(jobs,    "Runs at the same time [2]").
opt_help(set,     "NAME=VALUE: a parameter of the study; a list is varied. May \c
be given again").
opt_help(case,    "Make this case alone, with the first seed, in this process: \c
its number, or its name").
opt_help(list,    "Print the command of each run, and make none [false]").
opt_help(collect, "Make no runs; show those that are there [false]").
opt_help(out,     "Directory for runs, tables and pictures [out/studies]").

opt_meta(set,  'NAME=VALUE').
opt_meta(case, 'CASE').
opt_meta(out,  'DIRECTORY').

main(Argv) :-
    set_stream(user_output, encoding(utf8)),
    set_stream(user_error, encoding(utf8)),
    argv_options(Argv, Named, Options),
    catch(stopping_on_signals(command(Named, Options)),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            halt(1) )).

command([], _) :-
    !,
    catalogue(Rows),
    print_table(user_output, [study, title], Rows).
command(Named, Options) :-
    studies_named(Named, Files),
    maplist(study_load, Files, Studies),
    given(Options, Given),
    findall(plan(Study, Cases),
            ( member(Study, Studies), study_cases(Study, Given, Cases) ),
            Plans),
    perform(Plans, Options).

%   given(+Options, -Given): what --set says, as pairs.

given(Options, Given) :-
    findall(Name-Value,
            ( member(set(Text), Options), setting(Text, Name, Value) ),
            Given).

setting(Text, Name, Value) :-
    (   sub_atom(Text, B, _, A, =)
    ->  sub_atom(Text, 0, B, _, Name),
        sub_atom(Text, _, A, 0, ValueText),
        catch(term_to_atom(Value0, ValueText), error(syntax_error(_), _),
              Value0 = ValueText),
        Value = Value0
    ;   domain_error('NAME=VALUE', Text)
    ).

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
    (   member(plan(Study, Cases), Plans),
        the_case(Text, Study, Cases, Case)
    ->  make_one(Study, Case, Options)
    ;   existence_error(case, Text)
    ).
perform(Plans, Options) :-
    findall(Run, planned(Plans, Options, _, Run), Runs),
    (   option(collect(true), Options)
    ->  Failed = []
    ;   root(Options, Root),
        option(jobs(Jobs), Options, 2),
        runs_make(Runs, Root, Jobs, Outcomes),
        findall(failed, member(failed, Outcomes), Failed)
    ),
    collect(Plans, Options),
    (   Failed == []
    ->  true
    ;   halt(1)
    ).

%   planned(+Plans, +Options, -N, -Run): the first run of every case comes
%   first.  N is the number of the case.

planned(Plans, Options, N, run(Study, Case, Seed)) :-
    seeds(Options, Seeds),
    member(Seed, Seeds),
    member(plan(Study, Cases), Plans),
    nth1(N, Cases, Case).

seeds(Options, Seeds) :-
    option(seed(First), Options, 1),
    option(runs(Runs), Options, 3),
    Last is First + Runs - 1,
    numlist(First, Last, Seeds).

root(Options, Root) :-
    option(out(Out), Options, 'out/studies'),
    directory_file_path(Out, runs, Root).

the_case(Text, Study, Cases, Case) :-
    (   atom_number(Text, N)
    ->  nth1(N, Cases, Case)
    ;   member(Case, Cases),
        case_name(Study, Case, Text)
    ).

make_one(Study, Case, Options) :-
    option(seed(Seed), Options, 1),
    root(Options, Root),
    Run = run(Study, Case, Seed),
    runs_here(Run, Root),
    run_result(Root, Study, Case, Seed, Measures),
    dict_pairs(Measures, _, Pairs),
    findall([Name, Value], ( member(Name-Value, Pairs), number(Value) ), Rows),
    print_table(user_output, [measure, value], Rows).

runs_here(Run, Root) :-
    run_here(Run, Root, Outcome),
    (   Outcome = failed(File)
    ->  print_message(error, format("The run failed; see ~w", [File])),
        halt(1)
    ;   true
    ).

%   One line of a shell for each run.

print_command(Study, N, Seed, Options) :-
    module_property(study, file(Script)),
    option(out(Out), Options, 'out/studies'),
    findall(Set, ( member(set(Text), Options),
                   format(atom(Set), ' --set \'~w\'', [Text]) ), Sets),
    atomic_list_concat(Sets, Settings),
    format('swipl ~w -- ~w --case ~d --seed ~d~w --out ~w~n',
           [Script, Study, N, Seed, Settings, Out]).

                /*******************************
                *           FIGURES            *
                *******************************/

collect(Plans, Options) :-
    option(out(Out), Options, 'out/studies'),
    make_directory_path(Out),
    findall(Study-Outcome,
            ( member(plan(Study, Cases), Plans),
              show(Study, Cases, Options, Out, Outcome) ),
            Outcomes),
    page_save(Out, Outcomes, Options),
    directory_file_path(Out, 'index.html', Page),
    format('~nTables, pictures, claims: ~w~n', [Page]).

show(Study, Cases, Options, Out, Outcome) :-
    seeds(Options, Seeds),
    root(Options, Root),
    findall(run(Case, Seed, Measures),
            ( member(Seed, Seeds), member(Case, Cases),
              run_result(Root, Study, Case, Seed, Measures) ),
            Runs),
    outcome(Study, Cases, Runs, Outcome),
    study_title(Study, Name, _),
    directory_file_path(Out, Name, Directory),
    make_directory_path(Directory),
    outcome_save(Study, Outcome, Runs, Directory),
    (   Runs == []
    ->  true
    ;   forall(study_call(Study, plot(Plot, Title, Picture)),
               picture(Study, plot(Plot, Title, Picture), Runs, Directory))
    ),
    print_outcome(user_output, Study, Outcome).
