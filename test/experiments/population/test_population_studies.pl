:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module('../../lib/project_studies').
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/population/pictures').

/** <module> The studies of chapter 6: their claims, a small run, pictures
*/

study(Figure, Study) :-
    atom_concat('population/figure_', Figure, File),
    project_study(File, Study).

%   good(-Points): points for which the claims of both figures hold.

good([ case{hosts:50}-Small, case{hosts:100}-Large ]) :-
    Small = ms{missing:0, out_of_order:0, overlapped:0, span_least:31,
               span_most:50, gap_least:20, gap_most:40,
               peaks_out_of_order:0, peak_least:25, peak_most:35,
               not_healed:0, again:20, lost:20, rise:8, first_peak:33,
               second_peak:12, rise_time:255, later_overlapped:0},
    Large = Small.put(_{overlapped:1, gap_most:45, peak_least:50,
                        peak_most:70, rise_time:310}).

%   worse(Size-Measures): with Measures at that Size some claim fails that held
%   before.

worse(50-_{missing:1}).
worse(100-_{out_of_order:1}).
worse(50-_{overlapped:1}).
worse(100-_{overlapped:2}).
worse(50-_{span_least:29}).
worse(100-_{span_most:61}).
worse(50-_{gap_least:0}).
worse(50-_{gap_most:90}).
worse(100-_{peaks_out_of_order:1}).
worse(50-_{peak_least:15}).
worse(100-_{peak_most:81}).

worse_after_crash(50-_{not_healed:1}).
worse_after_crash(50-_{again:21}).
worse_after_crash(50-_{rise:0}).
worse_after_crash(100-_{second_peak:40}).
worse_after_crash(50-_{rise_time:300}).
worse_after_crash(100-_{rise_time:250}).
worse_after_crash(50-_{later_overlapped:1}).

spoilt(Hosts-More, Points0, Points) :-
    select(Case-Ms, Points0, Case-Ms1, Points),
    Case.hosts =:= Hosts,
    Ms1 = Ms.put(More),
    !.

fewer_hold(Figure, Worse) :-
    study(Figure, Study),
    good(Points0),
    holding(Study, Points0, Good),
    spoilt(Worse, Points0, Points),
    holding(Study, Points, Holding),
    subtract(Good, Holding, [_|_]).

:- begin_tests(population_claims).

test(well_formed, [forall(member(Figure, ['6_3', '6_4'])), Problems == []]) :-
    study(Figure, Study),
    invalid_claims(Study, Problems).
test(all_claims_can_hold,
     [forall(member(Figure-Count, ['6_3'-9, '6_4'-14]))]) :-
    study(Figure, Study),
    good(Points),
    holding(Study, Points, Numbers),
    numlist(1, Count, Numbers).
test(each_claim_can_fail, [forall(worse(Worse))]) :-
    fewer_hold('6_3', Worse).
test(each_claim_after_a_crash_can_fail, [forall(worse_after_crash(Worse))]) :-
    fewer_hold('6_4', Worse).

:- end_tests(population_claims).

                /*******************************
                *             RUNS             *
                *******************************/

small([ hosts-8, degree-4, tasks-4, threshold-20, crash-2, tick-0.5 ]).

check_small(Study, Dir) :-
    small(Given),
    first_run(Study, Given, 4, Dir, _-Ms),
    Ms.missing =:= 0,
    Ms.out_of_order =:= 0,
    Ms.lost =:= 2,
    Ms.again =:= 2,
    Ms.not_healed =:= 0,
    Ms.crash_time < Ms.healed,
    length(Ms.rows, 4),
    Ms.span_least =< Ms.span_most,
    Ms.gap_least =< Ms.gap_most,
    check_pictures([run(case{hosts:8}, 4, Ms), run(case{hosts:8}, 5, Ms)]).

check_pictures(Runs) :-
    bar_rows(Runs, Bars),
    findall(Top, member([_, _, _, _, Top, _], Bars), Tops),
    forall(member(Top, Tops), Top > 0),
    span_rows(Runs, Spans),
    findall(Seed, member([_, _, _, _, _, _, 1, Seed], Spans), [4, 5]),
    kind_rows(Runs, Kinds),
    other_rows(Runs, Others),
    length(Kinds, K),
    length(Others, O),
    O =:= K + 1,                        % a gap before the other run
    panel_variables(Runs, Pairs),
    memberchk(crashed-1, Pairs),
    memberchk(seeds-2, Pairs).

:- begin_tests(population_run).

test(a_small_crash) :-
    study('6_4', Study),
    with_tmp_dir(check_small(Study)).

:- end_tests(population_run).

:- begin_tests(population_pictures).

test(bars_are_stacked,
     Rows == [[2.5, 2, 3, 0, 2, 1], [2.5, 2, 3, 2, 3, 2], gap, gap]) :-
    bar_rows([run(case{hosts:8}, 1, ms{started:[2.1-1, 2.7-2, 2.9-1]})],
             Rows).
test(without_a_crash_no_line, Rows == [['NaN'], gap, gap]) :-
    crash_rows([run(case{hosts:8}, 1, ms{})], Rows).
test(smaller_networks_first, Rows == [[5], gap, gap, [7], gap, gap]) :-
    crash_rows([ run(case{hosts:9}, 1, ms{crash_time:7}),
                 run(case{hosts:8}, 1, ms{crash_time:5}) ], Rows).

:- end_tests(population_pictures).
