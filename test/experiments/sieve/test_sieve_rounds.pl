:- use_module('../../lib/common').
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module('../../../experiments/sieve/kinds_panels').
:- use_module('../../../experiments/sieve/pictures').
:- use_module('../../../experiments/sieve/rounds').

/** <module> Rounds of attacks in logs made by hand, and their pictures
*/

%   Rounds begin at 0, 4 and 8.

three_rounds(Rounds) :-
    A = [1,1,0,0,0],
    event_rounds([ event(1, h, x, born(host, A)), event(2, h, x, arrived),
                   event(3, h, x, born(clone, A)),
                   event(4, h, x, born(host, b)),
                   event(5, h, x, died(suppressed, b)),
                   event(6, h, x, born(host, b)),
                   event(9, h, x, died(aged, A)) ], [0, 4, 8], Rounds).

:- begin_tests(sieve_rounds).

test(plan, Rounds == [[a], [a], [b]]) :-
    plan_rounds([[a]-2, [b]-1], Rounds).
test(kind_names, Names == ['11110', [], [(left:-wall(ahead))], block(left)]) :-
    findall(Name,
            ( member(Kind, [ [1,1,1,1,0], [], [(left:-wall(ahead))],
                             block(left) ]),
              kind_name(Kind, Name) ),
            Names).
test(populations, Populations == [ [2-'11000'], [2-'11000', 1-b],
                                   [1-b, 1-'11000'] ]) :-
    three_rounds(Rounds),
    findall(Population,
            ( between(1, 3, R), population(Rounds, R, Population) ),
            Populations).
test(counts, Counts == [2, 3, 1, 2, 1, 1, 0]) :-
    three_rounds(Rounds),
    findall(N,
            ( member(What-Kind-R, [ population-'11000'-2, population-_-2,
                                    clone-'11000'-1, host-b-2,
                                    suppressed-b-2, aged-_-3, host-_-3 ]),
              count(What, Kind, Rounds, R, N) ),
            Counts).
test(kinds, Kinds == ['11000', b]) :-
    three_rounds(Rounds),
    kinds(Rounds, Kinds).
test(waits, Waits-All == [3, 6]-[3, 5, 6]) :-
    Rounds = [round([ served(a, k, 3), served(b, k, 5),
                      generated(a, k, 6) ])],
    waits(Rounds, 1, a, Waits),
    waits(Rounds, 1, _, All).

:- end_tests(sieve_rounds).

%   Two runs of two rounds, of six kinds.

two_runs([run(case{}, 1, ms{table:One}), run(case{}, 2, ms{table:Two})]) :-
    findall(r(R, Kind, N, 1, 0, 0, 0), row(R, Kind, N), One),
    findall(r(R, Kind, N1, 1, 0, 0, 0),
            ( row(R, Kind, N), N1 is N + 2 ), Two).

row(R, Kind, N) :-
    member(R, [1, 2]),
    nth1(N, [a, b, c, d, e, f], Kind).

:- begin_tests(sieve_pictures).

test(five_kinds_and_others,
     Labels == [f, e, d, c, b, 'all others']) :-
    two_runs(Runs),
    kind_panels(Runs, [panel(_, Series)|_]),
    findall(Label, member(series(Label, _), Series), Labels).
test(points, Points-Others == [1-[6, 8], 2-[6, 8]]-[1-[1, 3], 2-[1, 3]]) :-
    two_runs(Runs),
    kind_panels(Runs, [panel(_, Series)|_]),
    memberchk(series(f, Points), Series),
    memberchk(series('all others', Others), Series).
test(rows, Medians-Dots == [[1, 3, 2, 4], gap, gap]-
                           [[1, 2], [1, 4], gap, gap]) :-
    Panels = [panel("t", [series(s, [1-[2, 4]])])],
    median_rows(Panels, Medians),
    dot_rows(Panels, Dots).
test(variables, Pairs == [ panels-2, 'Panel'-["t", "u"],
                           'Series'-[a, b, c], 'Size'-[2, 1], rounds-4 ]) :-
    panel_variables([ panel("t", [series(a, [1-[2]]), series(b, [])]),
                      panel("u", [series(c, [4-[1]])]) ], Pairs).
test(curves, Points == [1-[5, 7], 3-[6]]) :-
    curve_points(able, [ms{able:[1-5, 3-6]}, ms{able:[1-7]}, ms{}], Points).

:- end_tests(sieve_pictures).
