%   Memory cells: antigens that return after others.

:- include(ground).
:- use_module(rounds, [population/3, waits/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, sum_list/2]).

study(return, "An antigen that returns after others").
text("00000 attacks for six rounds, then two other antigens for two or for \c
eight; clones live five rounds. Then 00000 returns, together with 00001, \c
which is similar, and 11011, which is new. No antibody answers two of 00000, \c
11011 and the others.").

vary(memory_cells, [0, 1]).
vary(others, [2, 8]).
fixed(memory_wins, 2, tuned("as in study memory")).
fixed(calls, 6, tuned("hosts generate antibodies only after 7.2 s")).
fixed(topology, random(30, 0.2), assumed("small: it costs less")).
fixed(attacked, 3, tuned("few hosts generate antibodies, which do not age")).
fixed(round, 8, assumed("20 hops")).
fixed(omega, 100, assumed("lives of five rounds, as in Figure 3.5")).

plan(Case, [ ['00000']-6, ['11100', '10110']-Case.others,
             ['00000', '00001', '11011']-1 ]).

label(0, "without memory cells").
label(1, "with memory cells").
label(others, "Rounds of other antigens in between").
label(first, "First response: waiting time of a host (s)").
label(second, "Second response (s)").
label(similar, "Response to 00001, which is similar (s)").
label(stranger, "Response to 11011, which is new (s)").
label(left, "Agents that can answer 00000 when it returns").
label(cells, "Memory cells appointed").

measure(first, Rounds, Seconds) :-
    waited(Rounds, 1, '00000', Seconds).
measure(Name, Rounds, Seconds) :-
    member(Name-Antigen, [ second-'00000', similar-'00001',
                           stranger-'11011' ]),
    length(Rounds, Last),
    waited(Rounds, Last, Antigen, Seconds).
measure(left, Rounds, Count) :-
    length(Rounds, Last),
    Before is Last - 1,
    population(Rounds, Before, Population),
    aggregate_all(sum(N), ( member(N-Kind, Population), answers(Kind) ),
                  Count).
measure(cells, Rounds, Count) :-
    aggregate_all(count, ( member(round(Events), Rounds),
                           member(memory_cell(_), Events) ), Count).

waited(Rounds, R, Antigen, Mean) :-
    waits(Rounds, R, Antigen, Waits),
    Waits = [_|_],
    sum_list(Waits, Sum),
    length(Waits, Count),
    Mean is Sum/Count.

%   An antibody answers 00000 if at most one of its bits is 0.

answers(Kind) :-
    aggregate_all(count, sub_atom(Kind, _, _, _, '1'), Ones),
    Ones >= 4.

claim("with memory cells the second response takes less than half as long as \c
the first", [ours],
      at([memory_cells=1], second < first/2)).
claim("after eight rounds memory cells make the second response faster",
      [ours],
      at([memory_cells=1, others=8], second < at([memory_cells=0], second))).
claim("without them it takes longer after eight rounds than after two", [ours],
      at([memory_cells=0], rises(second, along(others)))).
claim("after two rounds, while clones live, memory cells save less time than \c
after eight", [ours],
      at([memory_cells=0, others=2], second)
      - at([memory_cells=1, others=2], second)
      < at([memory_cells=0, others=8], second)
        - at([memory_cells=1, others=8], second)).
claim("after eight rounds memory cells do not delay a similar antigen",
      [ours],
      at([memory_cells=1, others=8],
         similar =< at([memory_cells=0], similar))).
claim("a new antigen is answered as late as the first one", [ours],
      stranger >= 0.95*first).

plot(return, "00000 returns after other antigens",
     lines([ x(others), y([second, similar, left]), line(memory_cells),
             rule(second, 7.2), rule(similar, 7.2),
             subtitle("lines at 7.2 s: first response, and that to a new \c
antigen") ])).
