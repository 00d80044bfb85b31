/*  Readings of what the thesis does not print: which of its claims do they reach?

        swipl experiments/readings.pl -- sync --runs 2
        swipl experiments/readings.pl -- sync --runs 10 --reading choices=in_order

    doc/fidelity/readings.md explains the tables, and has results.
*/

:- module(readings, []).
:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(engine/catalogue, [studies_named/2]).
:- use_module(engine/estimate, [longest_first/2]).
:- use_module(engine/outcome, [outcome/4]).
:- use_module(engine/plan,
              [out_directory/2, planned/4, planned_seed/2, plans/3,
               runs_directory/2]).
:- use_module(engine/report, [print_table/3]).
:- use_module(engine/signals, [stopping_on_signals/1]).
:- use_module(engine/sources, [sources_hash/2]).
:- use_module(engine/store, [run_result/3]).
:- use_module(engine/studies, [study_load/2, study_title/3]).
:- use_module(engine/work, [runs_make/4]).
:- use_module(readings/designs, [readings/4]).
:- use_module(readings/unprinted, [evidence/2, unprinted/4]).
:- use_module(readings/verdicts,
              [best_first/2, gained/3, holds_mostly/1, reachable/3,
               verdicts/4]).
:- use_module(library(apply), [foldl/4, include/3, maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/2, append/3, list_to_set/2, member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).

:- initialization(main, main).

:- public main/1.

opt_type(runs,    runs,    natural).
opt_type(seed,    seed,    integer).
opt_type(jobs,    jobs,    natural).
opt_type(design,  design,  term).
opt_type(reading, reading, atom).
opt_type(study,   study,   atom).
opt_type(collect, collect, boolean).
opt_type(out,     out,     atom).

opt_help(help(header),
"Tries readings of what the thesis does not print, and lists the claims that hold\n").
opt_help(help(usage), " -- CHAPTER [options]

CHAPTER is sync (5) or population (6).  A claim holds with a reading if it held
for half of the seeds.").
opt_help(runs,    "Seeds of each case [2]").
opt_help(seed,    "The first seed [1]").
opt_help(jobs,    "Runs at the same time [2]").
opt_help(design,  "one: each value alone; pairs: each two values, too; \c
random(N): N combinations of all [one]").
opt_help(reading, "NAME=VALUE,...: only this reading, beside the study as it is. \c
May be repeated").
opt_help(study,   "A study whose claims decide, in place of those of the \c
chapter.  May be repeated").
opt_help(collect, "Make no runs; show the existing ones [false]").
opt_help(out,     "Directory of the runs and of the tables [out/readings]").

opt_meta(design,  'DESIGN').
opt_meta(reading, 'READING').
opt_meta(study,   'STUDY').
opt_meta(out,     'DIRECTORY').

main(Argv) :-
    set_stream(user_output, encoding(utf8)),
    set_stream(user_error, encoding(utf8)),
    arguments(Argv, Words, Given),
    append(Given, [runs(2), out('out/readings')], Options),
    catch(stopping_on_signals(command(Words, Options)),
          error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            halt(1) )).

command([Chapter], Options) :-
    evidence(Chapter, _),
    !,
    studies(Chapter, Options, Studies),
    tried_readings(Chapter, Options, Readings),
    findall(Reading-Plans,
            ( member(Reading, Readings),
              plans_of(Reading, Studies, Options, Plans) ),
            Tries),
    make(Tries, Options, Failed),
    findall(Reading-Verdicts,
            ( member(Reading-Plans, Tries),
              foldl(verdicts_of(Options), Plans, [], Verdicts) ),
            Tried),
    report(Tried, user_output),
    save(Chapter, Studies, Tried, Options),
    ( Failed =:= 0 -> true ; halt(1) ).
command(Words, _) :-
    existence_error(chapter, Words).

studies(Chapter, Options, Studies) :-
    findall(Name, member(study(Name), Options), Names0),
    ( Names0 == [] -> evidence(Chapter, Names) ; Names = Names0 ),
    studies_named(Names, Files),
    maplist(study_load, Files, Studies).

tried_readings(_, Options, [[]|Readings]) :-
    findall(Reading, ( member(reading(Text), Options), reading(Text, Reading) ),
            Readings),
    Readings \== [],
    !.
tried_readings(Chapter, Options, Readings) :-
    option(design(Design), Options, one),
    option(seed(Seed), Options, 1),
    findall(Parameter-Values, unprinted(Chapter, Parameter, Values, _), Open),
    readings(Design, Seed, Open, Readings).

reading(Text, Reading) :-
    atomic_list_concat(Parts, ',', Text),
    maplist(changed, Parts, Reading).

changed(Part, Name-Value) :-
    atomic_list_concat([Name, ValueText], =, Part),
    term_to_atom(Value, ValueText).

plans_of(Reading, Studies, Options, Plans) :-
    findall(set(Set),
            ( member(Name-Value, Reading),
              format(atom(Set), '~w=~q', [Name, Value]) ),
            Sets),
    append(Sets, Options, All),
    plans(Studies, All, Plans).

make(_, Options, 0) :-
    option(collect(true), Options),
    !.
make(Tries, Options, Failed) :-
    findall(Run, ( member(_-Plans, Tries), planned(Plans, Options, _, Run) ),
            Runs0),
    list_to_set(Runs0, Runs1),
    longest_first(Runs1, Runs),
    runs_directory(Options, Root),
    runs_make(Runs, Root, Options, Failed).

verdicts_of(Options, plan(Study, Given, Cases), Verdicts0, Verdicts) :-
    runs_directory(Options, Root),
    findall(Seed, planned_seed(Options, Seed), Seeds),
    findall(run(Case, Seed, Measures),
            ( member(Seed, Seeds), member(Case, Cases),
              run_result(Root, run(Study, Case, Seed), Measures) ),
            Runs),
    outcome(plan(Study, Given, Cases), Seeds, Runs, Outcome),
    study_title(Study, Name, _),
    verdicts(Name, Outcome, Verdicts0, Verdicts).

                /*******************************
                *            TABLES            *
                *******************************/

report(Tried, Stream) :-
    Tried = [_-AsItIs|_],
    best_first(Tried, Sorted),
    findall([Text, Count, Gained, Lost],
            ( member(Reading-Verdicts, Sorted),
              reading_text(Reading, Text),
              counts(AsItIs, Verdicts, Count, Gained, Lost) ),
            Rows),
    length(AsItIs, Of),
    format(Stream, '~nOf ~d claims hold for half of the seeds:~n~n', [Of]),
    print_table(Stream, [reading, hold, gained, lost], Rows),
    format(Stream, '~nClaims that do not, and with which readings they do:~n~n',
           []),
    forall(reachable(Tried, Name-Text, Readings),
           ( maplist(reading_text, Readings, Texts),
             atomic_list_concat(Texts, '; ', All),
             ( All == '' -> Shown = none ; Shown = All ),
             format(Stream, '  ~w ~w~n      ~w~n', [Name, Text, Shown]) )).

counts(AsItIs, Verdicts, Count, Gained, Lost) :-
    include(holds_mostly, Verdicts, Holding),
    length(Holding, Count),
    gained(AsItIs, Verdicts, More),
    gained(Verdicts, AsItIs, Fewer),
    maplist(length, [More, Fewer], [Gained, Lost]).

reading_text([], 'as it is') :-
    !.
reading_text(Reading, Text) :-
    findall(Part, ( member(Name-Value, Reading),
                    format(atom(Part), '~w=~w', [Name, Value]) ), Parts),
    atomic_list_concat(Parts, ' ', Text).

%   One line for each reading and claim, below those that say how to get it again.

save(Chapter, Studies, Tried, Options) :-
    out_directory(Options, Out),
    make_directory_path(Out),
    atom_concat(Chapter, '.tsv', Base),
    directory_file_path(Out, Base, File),
    setup_call_cleanup(
        open(File, write, Stream, [encoding(utf8)]),
        ( save_origin(Stream, Studies, Options),
          forall(( member(Reading-Verdicts, Tried),
                   reading_text(Reading, Text),
                   member(verdict(Name-Claim, Held, Of), Verdicts) ),
                 format(Stream, '~w\t~w\t~w\t~d\t~d~n',
                        [Text, Name, Claim, Held, Of])) ),
        close(Stream)),
    format('~nEach reading and claim: ~w~n', [File]).

save_origin(Stream, Studies, Options) :-
    current_prolog_flag(version, Version),
    option(seed(First), Options, 1),
    option(runs(Runs), Options),
    Last is First + Runs - 1,
    format(Stream, '# SWI-Prolog ~w, seeds ~d to ~d~n', [Version, First, Last]),
    forall(member(Study, Studies),
           ( study_title(Study, Name, _),
             sources_hash(Study, Hash),
             format(Stream, '# ~w: sources ~w~n', [Name, Hash]) )),
    format(Stream, 'reading\tstudy\tclaim\theld\tof~n', []).
