:- use_module('../../lib/common', [project_file/2, with_tmp_dir/1]).
:- use_module(library(aggregate)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/engine/claims').
:- use_module('../../../experiments/engine/run').
:- use_module('../../../experiments/engine/store').
:- use_module('../../../experiments/engine/studies').

/** <module> The studies of chapter 3: their claims, and small runs
*/

study(Name, Study) :-
    atomic_list_concat(['experiments/sieve/', Name, '.pl'], Relative),
    project_file(Relative, File),
    study_load(File, Study).

a_study(Name) :-
    member(Name, [ figure_3_3, figure_3_4, figure_3_5, beyond_memory,
                   beyond_programs, study_comparisons ]).

claims(Study, Tests) :-
    findall(Test, study_call(Study, claim(_, _, Test)), Tests).

%   round_of(+Kinds, -Round): a clone of each is born.

round_of(Kinds, round(Events)) :-
    findall(born(clone, Kind), member(Kind, Kinds), Events).

%   made_up(+Study, +Rounds, -Points): as a run of these rounds would be.

made_up(Study, Rounds, [case{}-Measures]) :-
    findall(Name-Value, study_call(Study, measure(Name, Rounds, Value)),
            Pairs),
    dict_create(Measures, ms, Pairs).

%   holding(+Study, +Points, -Helds): of each claim, whether it holds.

holding(Study, Points, Helds) :-
    claims(Study, Tests),
    findall(Held,
            ( member(Test, Tests),
              ( \+ \+ claim_holds(Study:Test, Points, Points)
              -> Held = true
              ;  Held = false
              ) ),
            Helds).

rounds_hold(Name, Rounds, Helds) :-
    study(Name, Study),
    made_up(Study, Rounds, Points),
    holding(Study, Points, Helds).

:- begin_tests(sieve_claims).

test(well_formed, [forall(a_study(Name)), Problems == []]) :-
    study(Name, Study),
    claims(Study, Tests),
    Tests = [_|_],
    findall(P, ( member(Test, Tests), claim_shape(Study:Test, P) ),
            Problems).
test(complements_alone, Helds == [true, true, false, true, true, true]) :-
    findall(Round,
            ( between(1, 15, _),
              round_of(['11111', '00000', '01010'], Round) ), Rounds),
    rounds_hold(figure_3_3, Rounds, Helds).
test(another_kind_instead,
     Helds == [false, false, false, false, true, false]) :-
    findall(Round,
            ( between(1, 15, R),
              ( R =< 5 -> Third = '01010' ; Third = '11110' ),
              round_of(['11111', '00000', Third], Round) ), Rounds),
    rounds_hold(figure_3_3, Rounds, Helds).
test(the_generic_one, Helds == [true, true, true, true, true]) :-
    findall(Round,
            ( between(1, 15, _),
              round_of(['11110', '11110', '11110', '11111'], Round) ),
            Rounds),
    rounds_hold(figure_3_4, Rounds, Helds).
test(no_generic_one, Helds == [false, false, false, false, false]) :-
    findall(Round, ( between(1, 15, _), round_of(['01111'], Round) ),
            Rounds),
    rounds_hold(figure_3_4, Rounds, Helds).
test(others_follow, Helds == [true, true, true, true, true]) :-
    follow(['00010', '00010'], [died(aged, '11110')], Rounds),
    rounds_hold(figure_3_5, Rounds, Helds).
test(nothing_follows, Helds == [true, false, false, false, false]) :-
    follow(['11110', '11110'], [died(suppressed, '11110')], Rounds),
    rounds_hold(figure_3_5, Rounds, Helds).

%   Five rounds with a clone of 11110, and five with others, and deaths.

follow(Kinds, Deaths, Rounds) :-
    findall(Round, ( between(1, 5, _), round_of(['11110'], Round) ), Early),
    round_of(Kinds, round(Births)),
    append(Births, Deaths, Events),
    findall(round(Events), between(1, 5, _), Late),
    append(Early, Late, Rounds).

%   Case by case: without memory cells, and with.

test(memory, [ forall(member(Second-Helds,
                             [ 3-[true, true, true], 5-[true, false, true],
                               9-[false, false, true] ])),
               Found == Helds ]) :-
    study(beyond_memory, Study),
    Points = [ case{memory_cells:0}-ms{first:6, second:4, helped:0.5},
               case{memory_cells:1}-ms{first:6, second:Second, helped:0.9} ],
    holding(Study, Points, Found).
test(programs, Helds == [true, true]) :-
    along(Along),
    rounds_hold(beyond_programs,
                [ round([generated(block(left), [], 4), born(host, [])]),
                  round([ served(block(left), Along, 3),
                          born(clone, Along) ]) ], Helds).
test(programs_that_do_not_help, Helds == [false, false]) :-
    along(Along),
    rounds_hold(beyond_programs,
                [ round([ generated(block(left), Along, 4),
                          born(host, Along) ]),
                  round([served(block(left), [], 3), born(clone, [])]) ],
                Helds).

%   Goes round the block.

along([(right :- free(right), after(forward)), (left :- wall(ahead))]).

:- end_tests(sieve_claims).

                /*******************************
                *             RUNS             *
                *******************************/

small([ topology-random(12, 0.3), attacked-3, round-6, omega-30 ]).

measured(Name, Given, Seed, Measures, Dir) :-
    study(Name, Study),
    study_cases(Study, Given, [Case|_]),
    run_make(Study, Case, Seed, Dir),
    run_facts(Dir, Facts),
    findall(M-V, member(measure(M, V), Facts), Pairs),
    dict_create(Measures, ms, Pairs).

check_rounds(Dir) :-
    small(Given),
    measured(figure_3_5, Given, 1, Ms, Dir),
    findall(R, member(r(R, _, _, _, _, _, _), Ms.table), Rs),
    sort(Rs, Rounds),
    numlist(1, 10, Rounds),
    aggregate_all(count, ( member(r(_, _, N, _, _, _, _), Ms.table), N > 0 ),
                  Present),
    Present > 0.

check_memory(Dir) :-
    measured(beyond_memory,
             [memory_cells-1, topology-random(12, 0.3), attacked-3, round-6,
              omega-30],
             1, Ms, Dir),
    length(Ms.able, 16),
    Ms.first > 0.

:- begin_tests(sieve_run).

test(ten_rounds) :-
    with_tmp_dir(check_rounds).
test(memory_cells) :-
    with_tmp_dir(check_memory).

:- end_tests(sieve_run).
