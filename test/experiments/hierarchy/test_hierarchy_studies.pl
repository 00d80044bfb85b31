:- module(test_hierarchy_studies, []).
:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module('../../lib/project_studies').
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/engine/cases').

/** <module> The studies of hierarchies: claims, and small runs
*/

hierarchy_study(Name, Study) :-
    atom_concat('hierarchy/', Name, File),
    project_study(File, Study).

a_study(beyond_lead, 4).
a_study(beyond_lead_learning, 2).

%   made(+Held, +Name, +Control, -Measures): of which every claim holds, or none.

made(true, beyond_lead, Control, Measures) :-
    memberchk(Control-Overlaps-Total,
              [bold-90-900, cautious-0-999, leaders-50-950, observer-0-500]),
    Measures = measures{ overlaps:Overlaps, settled:0, total:Total, missing:0 }.
made(false, beyond_lead, Control, Measures) :-
    memberchk(Control-Overlaps-Total,
              [bold-0-400, cautious-0-500, leaders-50-450, observer-90-900]),
    Measures = measures{ overlaps:Overlaps, settled:9, total:Total, missing:1 }.
made(Held, beyond_lead_learning, Control, Measures) :-
    member(Held-Better, [true-observer, false-leaders]),
    ( Control == Better -> N = 50 ; N = 100 ),
    Measures = measures{ time:N, settled:N, executions:N }.

:- begin_tests(hierarchy_studies).

test(cases, [forall(a_study(Name, Count)), true(Found == Count)]) :-
    hierarchy_study(Name, Study),
    case_count(Study, Found).
test(claims_are_well_formed, [forall(a_study(Name, _)), true(Odd == [])]) :-
    hierarchy_study(Name, Study),
    invalid_claims(Study, Odd).
test(claims_can_hold_and_can_fail,
     [ forall(( a_study(Name, _), member(Held, [true, false]) )),
       true(Others == []) ]) :-
    hierarchy_study(Name, Study),
    study_cases(Study, [], Cases),
    findall(Case-Measures,
            ( member(Case, Cases), once(made(Held, Name, Case.control, Measures)) ),
            Points),
    verdicts(Study, Points, Verdicts),
    findall(Text, ( member(Text-Found, Verdicts), Found \== Held ), Others).
test(steps, Missing == 0) :-
    with_tmp_dir(small(beyond_lead, [ control-observer, rows-[[1,2]], tasks-2 ], M)),
    Missing = M.missing,
    length(M.deltas, Rounds),
    assertion(Rounds == 2).
test(learners, Rounds == 2) :-
    with_tmp_dir(small(beyond_lead_learning,
                       [control-observer, large-8, rounds-2, workers-2], M)),
    length(M.workers, Rounds).

small(Name, Given, Measures, Dir) :-
    hierarchy_study(Name, Study),
    first_run(Study, Given, 1, Dir, _-Measures).

:- end_tests(hierarchy_studies).
