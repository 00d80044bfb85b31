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
:- use_module(engine/program, [run_option/4, run_program/1]).
:- use_module(engine/report, [print_table/3]).
:- use_module(engine/sources, [sources_hash/2]).
:- use_module(engine/store, [run_result/3]).
:- use_module(engine/studies, [study_load/2, study_title/3]).
:- use_module(engine/work, [runs_make/4]).
:- use_module(readings/designs, [readings/4]).
:- use_module(readings/unprinted, [evidence/3, unprinted/4]).
:- use_module(readings/verdicts,
              [best_first/2, gained/3, holds_mostly/1, reachable/3,
               verdicts/4]).
:- use_module(library(apply), [foldl/4, include/3, maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/2, last/2, list_to_set/2, member/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [pairs_values/2]).

:- initialization(main, main).

:- public main/1.

opt_type(Name,    Name,    Type) :-
    own(Name),
    run_option(Name, Type, _, _).
opt_type(design,  design,  term).
opt_type(reading, reading, atom).
opt_type(study,   study,   atom).

opt_help(help(header),
"Tries readings of what the thesis does not print, and lists the claims that hold\n").
opt_help(help(usage), " -- CHAPTER [options]

CHAPTER is sieve (3), learning (4), sync (5), population (6) or allocation (7).
A claim holds with a reading if it held for half of the seeds.").
opt_help(Name,    Help) :-
    run_option(Name, _, _, Help).
opt_help(design,  "one: each value alone; pairs: each two values, too; \c
random(N): N combinations of all [one]").
opt_help(reading, "NAME=VALUE,...: only this reading, beside the study as it is. \c
May be repeated").
opt_help(study,   "A study whose claims decide, in place of those of the \c
chapter.  May be repeated").

opt_meta(Name,    Meta) :-
    run_option(Name, _, Meta, _).
opt_meta(design,  'DESIGN').
opt_meta(reading, 'READING').
opt_meta(study,   'STUDY').

own(Name) :-
    member(Name, [runs, seed, jobs, set, collect, out]).

main(Argv) :-
    run_program(( arguments(Argv, Words, Options),
                  command(Words, Options) )).

command([Chapter], Options) :-
    evidence(Chapter, _, _),
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

%   studies(+Chapter, +Options, -Studies): pairs of a study and the values of
%   --set that select its cases.

studies(_, Options, Studies) :-
    findall(Name-[], member(study(Name), Options), Named),
    Named \== [],
    !,
    maplist(loaded, Named, Studies).
studies(Chapter, _, Studies) :-
    findall(Name-Sets, evidence(Chapter, Name, Sets), Named),
    maplist(loaded, Named, Studies).

loaded(Name-Sets, Study-Sets) :-
    studies_named([Name], [File]),
    study_load(File, Study).

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

%   The last value of a parameter counts.

plans_of(Reading, Studies, Options, Plans) :-
    findall(set(Set), ( member(Value, Reading), set_text(Value, Set) ), Sets),
    findall(Plan,
            ( member(Study-Own0, Studies),
              findall(set(Set), member(Set, Own0), Own),
              append([Own, Options, Sets], All),
              plans([Study], All, [Plan]) ),
            Plans).

%   In a list, because a value that is a list is not to be varied.

set_text(Name-Value, Set) :-
    format(atom(Set), '~w=[~q]', [Name, Value]).

make(_, Options, 0) :-
    option(collect(true), Options),
    !.
make(Tries, Options, Failed) :-
    pairs_values(Tries, Lists),
    append(Lists, Plans),
    findall(Run, planned(Plans, Options, _, Run), Runs0),
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
    format(atom(Base), 'readings-~w.tsv', [Chapter]),
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
    findall(Seed, planned_seed(Options, Seed), [First|Seeds]),
    last([First|Seeds], Last),
    format(Stream, '# SWI-Prolog ~w, seeds ~d to ~d~n', [Version, First, Last]),
    forall(member(Study-_, Studies),
           ( study_title(Study, Name, _),
             sources_hash(Study, Hash),
             format(Stream, '# ~w: sources ~w~n', [Name, Hash]) )),
    format(Stream, 'reading\tstudy\tclaim\theld\tof~n', []).
