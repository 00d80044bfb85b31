:- module(test_application_studies, []).
:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module('../../lib/project_studies').
:- use_module('../../../experiments/engine/studies', [study_call/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).

% The studies of the applications: claims, and small runs.

%   small(Study, Cases, Given, Measures): of a run with Given, which is short.

small(study_fire_alarm, 9, [rule-single, puffs-2, quiet-120, limit-60],
      [false_alarms]).
small(study_fire_signs, 8, [ signs-gradient, growth-0.0469, delay-(15-75),
                             people-1, limit-150 ],
      [time, last, smoke, lost]).
small(study_irrigation, 12, [strategy-carried, down-0.3, days-4],
      [water, stress, drained]).
small(study_solar, 15, [strategy-auction, capacity-30, days-2],
      [bought, wasted, fairness, crossings]).
small(study_warehouse, 15, [way-in_step, delta-2, robots-4, pallets-1, beams-1],
      [time, delivered, falls, early, held]).

study(Name, Study) :-
    atom_concat('applications/', Name, File),
    project_study(File, Study).

run(Study, Given, Measures, Dir) :-
    first_run(Study, Given, 1, Dir, _-Measures).

:- begin_tests(application_studies).

test(cases, [forall(small(Name, Count, _, _)), true(Found == Count)]) :-
    study(Name, Study),
    case_count(Study, Found).

test(claims_are_well_formed,
     [forall(small(Name, _, _, _)), true(Odd == [])]) :-
    study(Name, Study),
    invalid_claims(Study, Odd).

test(run, [forall(small(Name, _, Given, Measures))]) :-
    study(Name, Study),
    with_tmp_dir(run(Study, Given, Point)),
    forall(member(Measure, Measures),
           assertion(( get_dict(Measure, Point, Value), number(Value) ))).

%   In whatever unit.

test(correlation, [ forall(member(Unit, [0.001, 1, 1000])),
                    true(abs(R - 0.8) < 1.0e-9) ]) :-
    study(study_solar, Study),
    findall(X-Y, ( member(X0-Y0, [1-1, 2-3, 3-2, 4-4]), X is Unit*X0,
                   Y is Unit*Y0 ), Pairs),
    study_call(Study, correlation(Pairs, R)).
test(equal_numbers_have_no_correlation, fail) :-
    study(study_solar, Study),
    member(Pairs, [[1-1, 1-2], [1-1, 2-1]]),
    study_call(Study, correlation(Pairs, _)).

:- end_tests(application_studies).
