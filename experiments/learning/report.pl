:- module(learning_report,
          [ print_parameters/2,         % +Stream, +Options
            print_cases/2,              % +Stream, +CaseRuns
            runs_table/3,               % +CaseRuns, -Header, -Rows
            load_result/2               % +Directory, -Result
          ]).
:- use_module('../lib/report',
              [print_options/3, print_settings/3, print_table/3]).
:- use_module(cases, [case_name/2]).
:- use_module(metrics, [executions/2, mean/2, sharing/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, sum_list/2]).
:- use_module(library(readutil), [read_file_to_terms/3]).

:- dynamic setting/2.
:- include('../../agents/learning/parameters').

/** <module> The numbers behind the figures of chapter 4

CaseRuns are pairs Case-Runs; Runs are terms run(Directory, Result), see
learning_run.

*Threading*: no state; any thread.
*/

%!  print_parameters(+Stream, +Options) is det.
%
%   A table of Options, and of what agents have by default where
%   settings(Pairs) says nothing else.

print_parameters(Stream, Options) :-
    memberchk(settings(Settings), Options),
    print_options(Stream, Options, [nodes, agents, single]),
    nl(Stream),
    findall(Name-Value, ( default(Name, Value), Name \== seed ), Defaults),
    print_settings(Stream, Defaults, Settings),
    nl(Stream),
    flush_output(Stream).

%!  print_cases(+Stream, +CaseRuns) is det.
%
%   A line for each case: the means of its runs.  Beside what is to be
%   learnt from it stands what it took: the host clock, host seconds for a
%   hop and the stay after it, and real seconds of a run.

print_cases(Stream, CaseRuns) :-
    findall([Name, Count, Lost, Executions, Sharing, Hops, Duration, Rate,
             PerHop, Real],
            ( member(Case-Runs, CaseRuns),
              Runs \== [],
              case_name(Case, Name),
              length(Runs, Count),
              results(Runs, Results),
              executions(Results, Executions),
              sharing(Results, Sharing),
              means(Results,
                    [unfinished, hops, duration, clock, per_hop, real_time],
                    [Lost, Hops, Duration, Rate, PerHop, Real]) ),
            Rows),
    print_table(Stream,
                [case, runs, 'not converged', 'executions/agent',
                 'sharings/execution', 'hops/agent', 'host s', clock,
                 'host s/hop', 'real s'], Rows).

results(Runs, Results) :-
    findall(Result, member(run(_, Result), Runs), Results).

means(Results, Names, Means) :-
    maplist(mean_of(Results), Names, Means).

mean_of(Results, Name, Mean) :-
    findall(Value, ( member(Result, Results), measure(Name, Result, Value) ),
            Values),
    (   mean(Values, Mean0)
    ->  Mean is float(Mean0)
    ;   Mean = '-'
    ).

%!  runs_table(+CaseRuns, -Header, -Rows) is det.
%
%   A line for each run.

runs_table(CaseRuns, [case|Names], Rows) :-
    Names = [ nodes, agents, seed, executions, sharings, unfinished, hops,
              duration, unanswered, least_degree, most_degree, clock,
              per_hop, real_time ],
    findall([CaseName|Values],
            ( member(Case-Runs, CaseRuns),
              case_name(Case, CaseName),
              member(run(_, Result), Runs),
              maplist(cell(Result), Names, Values) ),
            Rows).

cell(Result, Name, Value) :-
    (   measure(Name, Result, Value0)
    ->  Value = Value0
    ;   Value = ''
    ).

%   measure(+Name, +Result, -Value) is semidet.

measure(executions, Result, Count) :-
    !,
    counted(Result, learner(Lengths, _, _), Lengths, Count).
measure(sharings, Result, Count) :-
    !,
    counted(Result, learner(_, Shared, _), Shared, Count).
measure(unfinished, Result, Count) :-
    !,
    memberchk(agents(Agents), Result),
    memberchk(learners(Learners), Result),
    aggregate_all(count, member(learner(_, _, converged(_, _, _)), Learners),
                  Converged),
    Count is Agents - Converged.
measure(hops, Result, Mean) :-
    !,
    findall(Hops, converged(Result, _, Hops), All),
    mean(All, Mean).
measure(per_hop, Result, Mean) :-
    !,
    findall(Seconds,
            ( converged(Result, Time, Hops), Hops > 0,
              Seconds is Time/Hops ),
            All),
    mean(All, Mean).
measure(least_degree, Result, Degree) :-
    !,
    memberchk(degrees(Degree-_), Result).
measure(most_degree, Result, Degree) :-
    !,
    memberchk(degrees(_-Degree), Result).
measure(Name, Result, Value) :-
    functor(Option, Name, 1),
    memberchk(Option, Result),
    arg(1, Option, Value).

converged(Result, Time, Hops) :-
    memberchk(learners(Learners), Result),
    member(learner(_, _, converged(Time, Hops, _)), Learners).

counted(Result, Learner, List, Count) :-
    memberchk(learners(Learners), Result),
    findall(N, ( member(Learner, Learners), length(List, N) ), Ns),
    sum_list(Ns, Count).

%!  load_result(+Directory, -Result) is semidet.
%
%   What a run has left there; fails if it did not come so far.

load_result(Directory, Result) :-
    directory_file_path(Directory, 'result.pl', File),
    exists_file(File),
    read_file_to_terms(File, [result(Result)], [encoding(utf8)]).
