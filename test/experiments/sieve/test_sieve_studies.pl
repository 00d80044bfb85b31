:- use_module('../../lib/common', [with_tmp_dir/1, with_tmp_dir/2]).
:- use_module('../../lib/project_studies').
:- use_module(library(aggregate)).
:- use_module(library(lists)).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(plunit)).
:- use_module('../../../experiments/engine/studies', [study_call/2]).

/** <module> The studies of chapter 3: their claims, and small runs
*/

study(Name, Study) :-
    atom_concat('sieve/', Name, File),
    project_study(File, Study).

a_study(Name) :-
    member(Name, [ figure_3_3, figure_3_4, figure_3_5, beyond_memory,
                   beyond_return, beyond_programs, study_comparisons ]).

%   round_of(+Kinds, -Round): a clone of each is born.

round_of(Kinds, round(Events)) :-
    findall(born(clone, Kind), member(Kind, Kinds), Events).

%   made_up(+Study, +Rounds, -Points): the points of a run of these rounds.

made_up(Study, Rounds, [case{}-Measures]) :-
    findall(Name-Value, study_call(Study, measure(Name, Rounds, Value)),
            Pairs),
    dict_create(Measures, ms, Pairs).

%   helds(+Study, +Points, -Helds): of each claim, whether it holds.

helds(Study, Points, Helds) :-
    verdicts(Study, Points, Verdicts),
    pairs_values(Verdicts, Helds).

rounds_hold(Name, Rounds, Helds) :-
    study(Name, Study),
    made_up(Study, Rounds, Points),
    helds(Study, Points, Helds).

:- begin_tests(sieve_claims).

test(well_formed, [forall(a_study(Name)), Problems == []]) :-
    study(Name, Study),
    invalid_claims(Study, Problems).
test(complements_alone, Helds == [true, true, false, true, true, true]) :-
    findall(Round,
            ( between(1, 15, _),
              round_of(['11111', '00000', '01010'], Round) ), Rounds),
    rounds_hold(figure_3_3, Rounds, Helds).
test(other_kind_survives,
     Helds == [false, false, false, false, true, false]) :-
    findall(Round,
            ( between(1, 15, R),
              ( R =< 5 -> Third = '01010' ; Third = '11110' ),
              round_of(['11111', '00000', Third], Round) ), Rounds),
    rounds_hold(figure_3_3, Rounds, Helds).
test(generic_antibody_survives, Helds == [true, true, true, true, true]) :-
    findall(Round,
            ( between(1, 15, _),
              round_of(['11110', '11110', '11110', '11111'], Round) ),
            Rounds),
    rounds_hold(figure_3_4, Rounds, Helds).
test(no_generic_antibody, Helds == [false, false, false, false, false]) :-
    findall(Round, ( between(1, 15, _), round_of(['01111'], Round) ),
            Rounds),
    rounds_hold(figure_3_4, Rounds, Helds).
test(other_antibodies_follow, Helds == [true, true, true, true, true]) :-
    follow(['00010', '00010'], [died(aged, '11110')], Rounds),
    rounds_hold(figure_3_5, Rounds, Helds).
test(no_antibody_follows, Helds == [true, false, false, false, false]) :-
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
    helds(Study, Points, Found).
test(return, [ forall(member(Second-Helds,
                             [ 3-[true, true, true, true, true, true],
                               5-[false, true, true, true, true, true],
                               9-[false, false, true, false, false, true] ])),
               Found == Helds ]) :-
    returned([ r(0, 2, 2, 7), r(0, 8, 6, 7), r(1, 2, 2, 7),
               r(1, 8, Second, 7) ], Found).
test(return_with_and_without_memory_cells,
     Found == [true, false, false, false, true, false]) :-
    returned([r(0, 2, 3, 7), r(0, 8, 3, 2), r(1, 2, 2, 2), r(1, 8, 3, 2)],
             Found).

returned(Rows, Helds) :-
    study(beyond_return, Study),
    findall(case{memory_cells:Cells, others:Others}
            - ms{first:7, second:Second, similar:Second, stranger:Stranger},
            member(r(Cells, Others, Second, Stranger), Rows), Points),
    helds(Study, Points, Helds).

test(programs_improve, Helds == [true, true]) :-
    along(Along),
    rounds_hold(beyond_programs,
                [ round([generated(block(left), [], 4), born(host, [])]),
                  round([ served(block(left), Along, 3),
                          born(clone, Along) ]) ], Helds).
test(programs_that_do_not_improve, Helds == [false, false]) :-
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

check_rounds(Dir) :-
    small(Given),
    study(figure_3_5, Study),
    first_run(Study, Given, 1, Dir, _-Ms),
    findall(R, member(r(R, _, _, _, _, _, _), Ms.table), Rs),
    sort(Rs, Rounds),
    numlist(1, 10, Rounds),
    aggregate_all(count, ( member(r(_, _, N, _, _, _, _), Ms.table), N > 0 ),
                  Present),
    Present > 0.

check_return(Dir) :-
    small(Given),
    study(beyond_return, Study),
    first_run(Study, [memory_cells-1, others-2, calls-2|Given], 1, Dir, _-Ms),
    abs(Ms.first - 2.4) < 0.001,
    Ms.second > 0,
    Ms.left > 0.

:- begin_tests(sieve_run).

test(ten_rounds) :-
    with_tmp_dir(check_rounds).
test(memory_cells) :-
    with_tmp_dir(Dir,
        ( small(Given),
          study(beyond_memory, Study),
          first_run(Study, [memory_cells-1|Given], 1, Dir, _-Ms),
          length(Ms.able, 16),
          Ms.first > 0 )).
test(antigen_comes_back) :-
    with_tmp_dir(check_return).

:- end_tests(sieve_run).
