:- module(test_estimate, []).

% How long runs will take: from the usual times of their cases, and from runs
% that have ended.

:- use_module('../../lib/study_files', [with_study_file/4]).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/costs', [cost/2]).
:- use_module('../../../experiments/engine/estimate').
:- use_module('../../../experiments/engine/studies', [study_load/2, study_title/3]).
:- use_module('../../../experiments/engine/catalogue', [studies_named/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).

%   Two seeds of a study with three cases; cost/2 may know its Name.

named(Name, Runs, Goal) :-
    with_named(Name, Study,
        ( of_seeds([1, 2], Study, Runs),
          Goal )).

:- meta_predicate
    named(+, -, 0),
    with_named(+, -, 0).

with_named(Name, Study, Goal) :-
    format(atom(Line), 'study(\'~w\', "A study").', [Name]),
    with_study_file([ Line, 'vary(n, [1, 2, 3]).', 'measure(m, _, 1).' ],
                    _, File,
                    ( study_load(File, Study), Goal )).

of_seeds(Seeds, Study, Runs) :-
    study_cases(Study, [], Cases),
    findall(run(Study, Case, Seed),
            ( member(Seed, Seeds), member(Case, Cases) ), Runs).

near(A, B) :-
    assertion(abs(A - B) < 0.001*max(1, abs(B))).

:- begin_tests(estimate).

test(every_study_of_the_thesis_has_its_cost) :-
    studies_named([thesis, beyond], Files),
    forall(member(File, Files),
           ( study_load(File, Study),
             study_title(Study, Name, _),
             assertion(cost(Name, _)) )).
test(longest_run_of_each_seed_is_first) :-
    cost(Short, A),
    cost(Long, B),
    A < B,
    !,
    with_named(Short, One,
        with_named(Long, Other,
            ( of_seeds([1, 2], One, Runs1),
              of_seeds([1, 2], Other, Runs2),
              append(Runs1, Runs2, Runs0),
              sort(3, @=<, Runs0, Runs),
              longest_first(Runs, Sorted),
              findall(Study-Seed, member(run(Study, _, Seed), Sorted), Found),
              assertion(Found == [ Other-1, Other-1, Other-1,
                                   One-1, One-1, One-1,
                                   Other-2, Other-2, Other-2,
                                   One-2, One-2, One-2 ]) ))).
test(runs_of_unknown_length_keep_their_order) :-
    named(unheard_of, Runs,
        ( longest_first(Runs, Sorted),
          assertion(Sorted == Runs) )).
test(known_before_any_run_has_ended) :-
    cost(Name, Seconds),
    !,
    named(Name, Runs,
        ( estimate_begin(Runs),
          estimate([], 2, Share, Left),
          Expected is 3*Seconds,         % six runs, two workers
          near(Share, 0),
          near(Left, Expected) )).
test(slow_computer_takes_longer) :-
    cost(Name, Seconds),
    !,
    named(Name, Runs,
        ( estimate_begin(Runs),
          Runs = [First|_],
          Took is 3*Seconds,
          estimate_ended(First, Took),
          estimate([], 1, Share, Left),
          Expected is 5*Took,
          near(Left, Expected),
          near(Share, Took/(Took + Expected)) )).
test(run_that_ended_tells_of_its_case) :-
    named(unheard_of, Runs,
        ( estimate_begin(Runs),
          assertion(\+ estimate([], 1, _, _)),
          Runs = [A1, B1, C1|_],
          estimate_ended(A1, 10),
          estimate_ended(B1, 2),
          estimate_ended(C1, 6),
          estimate([], 1, _, Left),
          near(Left, 18) )).
test(work_under_way_counts) :-
    named(unheard_of, Runs,
        ( estimate_begin(Runs),
          Runs = [A1, B1, C1, A2|_],
          forall(member(Run, [A1, B1, C1]), estimate_ended(Run, 10)),
          estimate([A2-4], 1, Share, Left),
          near(Left, 26),
          near(Share, 34/60),
          estimate([A2-100], 1, _, Late),
          near(Late, 20) )).
test(last_run_has_one_worker) :-
    named(unheard_of, Runs,
        ( estimate_begin(Runs),
          append(Ended, [Last], Runs),
          forall(member(Run, Ended), estimate_ended(Run, 10)),
          estimate([Last-1], 4, _, Left),
          near(Left, 9) )).
test(other_runs_are_ignored) :-
    named(unheard_of, Runs,
        ( Runs = [One, Other|_],
          estimate_begin([One]),
          estimate_ended(Other, 10),
          assertion(\+ estimate([], 1, _, _)) )).

:- end_tests(estimate).
