:- module(study_figures,
          [ figures/3                   % +Plans, +Options, -Missing
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).
:- use_module(library(solution_sequences), [distinct/2]).
:- use_module(cases, [expected_cases/3, study_parameter/2]).
:- use_module(commands, [again_command/3]).
:- use_module(cross_check, [claims_check/5, cross_check/4, real_case/5]).
:- use_module(outcome, [outcome/4, seed_points/4]).
:- use_module(page, [page_save/2]).
:- use_module(picture, [picture/4]).
:- use_module(plan,
              [ out_directory/2, planned/4, planned_seed/2, real_way/3,
                runs_directory/2 ]).
:- use_module(replays, [replays_save/3]).
:- use_module(report,
              [ claims_sentence/2, print_means/4, print_outcome/3,
                shown_measures/3 ]).
:- use_module(store, [run_result/3]).
:- use_module(studies, [study_call/2, study_name/3, study_title/3]).
:- use_module(tables, [outcome_save/4]).

/** <module> Evaluation of existing runs: tables, claims, pictures, the page

*Threading*: the main thread.
*/

:- multifile
    prolog:message//1.

%!  figures(+Plans, +Options, -Missing:integer) is det.
%
%   Prints the results of the existing runs of Plans, and writes them below the
%   directory of out_directory/2.  Missing is the number of missing runs.

figures(Plans, Options, Missing) :-
    out_directory(Options, Out),
    make_directory_path(Out),
    findall(Shown,
            ( member(Plan, Plans), show(Plan, Options, Out, Shown) ),
            All),
    replays_save(Plans, Options, Out),
    page_save(Out, All),
    findall(Outcome, member(shown(_, Outcome, _, _), All), Outcomes),
    claims_sentence(Outcomes, Sentence),
    directory_file_path(Out, 'index.html', Page),
    format('~n~w~nTables, pictures, claims: ~w~n', [Sentence, Page]),
    aggregate_all(sum(Count), ( member(Outcome, Outcomes),
                                Count = Outcome.missing ), Missing),
    report_missing(Missing, Plans, Options).

report_missing(0, _, _) :-
    !.
report_missing(Missing, Plans, Options) :-
    aggregate_all(count, planned(Plans, Options, _, _), Count),
    format('~d of ~d runs are missing~n', [Missing, Count]).

show(plan(Study, Given, Cases), Options, Out,
     shown(Study, Outcome, Again, Directory)) :-
    found(Study, Cases, Options, Runs),
    findall(Seed, planned_seed(Options, Seed), Seeds),
    outcome(plan(Study, Given, Cases), Seeds, Runs, Outcome0),
    checks(plan(Study, Given, Cases), Runs, Outcome0.rows, Options, Checks),
    Outcome = Outcome0.put(_{given:Given, checks:Checks}),
    findall(run(Case, Seed, measures{}),
            ( member(Case, Cases), member(Seed, Seeds),
              \+ ( member(run(Case1, Seed, _), Runs), Case1 == Case ) ),
            NotMade),
    save(Study, Outcome, Runs, NotMade, Out),
    print_outcome(user_output, Study, Outcome),
    (   option(means(true), Options)
    ->  print_means(user_output, Study, Outcome, Runs)
    ;   true
    ),
    forall(never_measured(Study, Runs, Where, Measure),
           print_message(warning, study_measure(Where, Measure))),
    again_command(Study, Options, Again),
    (   Runs = [run(_, _, First)|_]
    ->  Directory = First.directory
    ;   Directory = none
    ).

found(Study, Cases, Options, Runs) :-
    runs_directory(Options, Root),
    findall(run(Case, Seed, Measures),
            ( planned_seed(Options, Seed), member(Case, Cases),
              run_result(Root, run(Study, Case, Seed), Measures) ),
            Runs).

save(Study, Outcome, Runs, NotMade, Out) :-
    study_title(Study, Name, _),
    directory_file_path(Out, Name, Directory),
    make_directory_path(Directory),
    outcome_save(Study, Outcome, Runs, Directory),
    forall(( Runs = [_|_], study_call(Study, plot(Plot, Title, Picture)) ),
           ( in_picture(Picture, Runs, NotMade, Shown),
             picture(Study, plot(Plot, Title, Picture), Shown, Directory) )).

%   Lines have a gap where a run without measures is.

in_picture(lines(_), Runs, NotMade, Shown) :-
    !,
    append(Runs, NotMade, Shown).
in_picture(_, Runs, _, Runs).

%   checks(+Plan, +Runs, +Rows, +Options, -Tables): compares the case that also
%   has real runs.

checks(plan(Study, Given, Cases), Runs, Rows, Options, [Measured, Claimed]) :-
    findall(Case-(Title-Found),
            ( real_way(Options, Title, Changes),
              real_case(Study, Cases, Changes, Case, Real),
              found(Study, [Real], Options, Found) ),
            Pairs),
    pairs_keys_values(Pairs, [Case|_], Ways0),
    !,
    findall(run(Case, Seed, Ms), member(run(Case, Seed, Ms), Runs), Virtual),
    maplist(title_measures, [virtual-Virtual|Ways0], [_-Of|OfWays]),
    shown_measures(Study, Rows, Measures),
    cross_check(Of, OfWays, Measures, Measured),
    expected_cases(Study, Given, Expected),
    findall(Seed-Points, ( planned_seed(Options, Seed),
                           seed_points(Expected, Runs, Seed, Points) ), OfSeeds),
    maplist(title_seeds, [virtual-Virtual|Ways0], Ways),
    claims_check(Study, OfSeeds, Case, Ways, Claimed).
checks(_, _, _, _, []).

title_measures(Title-Runs, Title-Measures) :-
    findall(Ms, member(run(_, _, Ms), Runs), Measures).

title_seeds(Title-Runs, Title-Seeds) :-
    findall(Seed-Measures, member(run(_, Seed, Measures), Runs), Seeds).

%   Name has no value in any run.

never_measured(Study, Runs, Where, Name) :-
    Runs = [_|_],
    distinct(Where-Name, study_name(Study, Where, Name)),
    \+ study_parameter(Study, Name),
    \+ ( member(run(_, _, Measures), Runs), get_dict(Name, Measures, _) ).

prolog:message(study_measure(Where, Name)) -->
    [ '~p: no run has a value of ~q'-[Where, Name] ].
