:- module(study_cross_check,
          [ cross_checks/4,             % +Plans, +Seeds, +Root, +Options
            cross_check/4               % +Runs, +RealRuns, +Measures, -Rows
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(option), [merge_options/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(numbers, [number_text/2, spread/4]).
:- use_module(report, [print_table/3]).
:- use_module(store, [run_result/3]).
:- use_module(studies, [study_call/2, study_title/3]).
:- use_module(work, [runs_make/4]).

/** <module> Are runs on real sockets like those in virtual time?

A study says by real(Where, Settings) which of its cases is made both ways,
and with which clock and how many processes.  What a real run gives should lie
between the least and the greatest of the virtual ones.

*Threading*: the main thread.
*/

%!  cross_checks(+Plans, +Seeds, +Root, +Options) is det.
%
%   Plans are plan(Study, Given, Cases); of those that have real/2 the case
%   is run with all Seeds in virtual time, and with three of them on a real
%   clock, one run at a time.  What came of it is printed.

cross_checks(Plans, Seeds, Root, Options) :-
    findall(check(Study, Case, Real),
            ( member(plan(Study, _, Cases), Plans),
              real_case(Study, Cases, Case, Real) ),
            Checks),
    findall(run(Study, Case, Seed),
            ( member(Seed, Seeds), member(check(Study, Case, _), Checks) ),
            Virtual),
    runs_make(Virtual, Root, Options, _),
    few(Seeds, Few),
    findall(run(Study, Real, Seed),
            ( member(check(Study, _, Real), Checks), member(Seed, Few) ),
            Reals),
    merge_options([jobs(1)], Options, One),
    runs_make(Reals, Root, One, _),
    forall(member(Check, Checks), show(Check, Seeds, Few, Root)).

few(Seeds, Few) :-
    (   Few = [_, _, _],
        append(Few, _, Seeds)
    ->  true
    ;   Few = Seeds
    ).

real_case(Study, Cases, Case, Real) :-
    study_call(Study, real(Where, Settings)),
    member(Case, Cases),
    forall(member(Name=Value, Where), get_dict(Name, Case, Value)),
    !,
    dict_create(Changes, case, Settings),
    Real = Case.put(Changes).

show(check(Study, Case, Real), Seeds, Few, Root) :-
    study_title(Study, Name, _),
    maplist(results(Study, Root), [Case-Seeds, Real-Few], [Runs, RealRuns]),
    length(Runs, Count),
    length(RealRuns, RealCount),
    format('~n~w: ~d runs in virtual time, ~d on ~w processes, \c
clock ×~w~n~n',
           [Name, Count, RealCount, Real.processes, Real.clock]),
    measures(Runs, Measures),
    cross_check(Runs, RealRuns, Measures, Rows),
    print_table(user_output, [measure, virtual, real, ''], Rows).

results(Study, Root, Case-Seeds, Results) :-
    findall(Result,
            ( member(Seed, Seeds),
              run_result(Root, run(Study, Case, Seed), Result) ),
            Results).

%   Not where a run is kept.

measures([], []).
measures([Run|_], Measures) :-
    dict_pairs(Run, _, Pairs),
    pairs_keys(Pairs, Names),
    subtract(Names, [directory], Measures).

%!  cross_check(+Runs:list, +RealRuns:list, +Measures:list, -Rows) is det.
%
%   Runs and RealRuns are dicts of measures.  Rows are [Measure, Virtual,
%   Real, Verdict], as text, of the measures that are numbers; Verdict says
%   where the median of the real runs lies, `inside`, `below` or `above`.

cross_check(Runs, RealRuns, Measures, Rows) :-
    findall([Measure, Virtual, Real, Verdict],
            ( member(Measure, Measures),
              measured(Measure, Runs, Least, Most, Virtual, _),
              measured(Measure, RealRuns, _, _, Real, Median),
              verdict(Least, Most, Median, Verdict) ),
            Rows).

measured(Measure, Runs, Least, Most, Text, Median) :-
    findall(Value,
            ( member(Run, Runs), get_dict(Measure, Run, Value),
              number(Value) ),
            Values),
    spread(Values, Least, Median, Most),
    maplist(number_text, [Median, Least, Most], Texts),
    format(atom(Text), '~w (~w–~w)', Texts).

verdict(Least, Most, Real, inside) :-
    Least =< Real,
    Real =< Most,
    !.
verdict(Least, _, Real, below) :-
    Real < Least,
    !.
verdict(_, _, _, above).
