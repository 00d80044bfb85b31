%   Figure 3.5: other antigens from round 6 on.

:- include(kinds).
:- use_module(rounds, [count/5]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, min_list/2]).

study('3.5', "Other antigens from round 6 on: the populations follow").
text("For five rounds 00000, 00001 and 00011 attack, for five more 11100, \c
11101 and 11001. Antibodies against the first three are not needed any more.").

plan(_, [ ['00000', '00001', '00011']-5, ['11100', '11101', '11001']-5 ]).

label(generic_5, "Agents with 11110 at round 5").
label(other_5, "Any other kind at round 5, at most").
label(generic_10, "Agents with 11110 at round 10").
label(aged, "Agents with 11110 that died of age from round 6 on").
label(suppressed, "Agents with 11110 suppressed from round 6 on").
label(new_5, "Agents with 00010 at round 5").
label(new_10, "Agents with 00010 at round 10").
label(growth_least, "Least growth of 00010 in a round from 6 on").
label(other_10, "Any other kind at round 10, at most").

measure(generic_5, Rounds, N) :-
    count(population, '11110', Rounds, 5, N).
measure(other_5, Rounds, N) :-
    most_but(['11110'], Rounds, 5, N).
measure(generic_10, Rounds, N) :-
    count(population, '11110', Rounds, 10, N).
measure(How, Rounds, N) :-
    member(How, [aged, suppressed]),
    aggregate_all(sum(Of), ( between(6, 10, R),
                             count(How, '11110', Rounds, R, Of) ), N).
measure(new_5, Rounds, N) :-
    count(population, '00010', Rounds, 5, N).
measure(new_10, Rounds, N) :-
    count(population, '00010', Rounds, 10, N).
measure(growth_least, Rounds, Least) :-
    findall(More,
            ( between(6, 10, R),
              R0 is R - 1,
              count(population, '00010', Rounds, R0, N0),
              count(population, '00010', Rounds, R, N),
              More is N - N0 ),
            Mores),
    min_list(Mores, Least).
measure(other_10, Rounds, N) :-
    most_but(['00010'], Rounds, 10, N).

claim("11110 grows until round 5: it has the largest population then",
      [line(1543)], generic_5 > other_5).
claim("then 11110 wanes, to at most half of that at round 10",
      [line(1543), ours], generic_10 =< 0.5*generic_5).
claim("11110 wanes as its clones die of age, not by suppression", [line(1544)],
      aged > suppressed).
claim("00010 grows from round 6 on, in each round", [line(1545)],
      ( new_5 =:= 0, growth_least > 0 )).
claim("00010 has the largest population at round 10", [line(1545), ours],
      new_10 > other_10).

plot('3.5', "From round 6 on 11100, 11101 and 11001 attack",
     script('rounds.gp', [medians-panel_rows, dots-panel_dots],
            [size(1000, 1000), variables(panels)])).
