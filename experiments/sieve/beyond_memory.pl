%   Memory cells: the second response to an antigen.

:- include(ground).
:- use_module(pictures, [curve_points/3]).
:- use_module(rounds, [population/3, waits/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, nth1/3, sum_list/2]).

study(memory, "The antigen of rounds 1 to 5 returns in round 14").
text("00000 attacks for five rounds, then 11111 for eight, until the clones \c
of the first have died of age, then 00000 again. Hosts emit three danger \c
signals before they generate an antibody. An agent that was chosen twice may \c
become a memory cell, which does not die.").

vary(memory_cells, [0, 1]).
fixed(memory_wins, 2, tuned("with 3 there were few memory cells")).
fixed(calls, 3, tuned("with 1 hosts generate antibodies too soon")).

plan(_, [['00000']-5, ['11111']-8, ['00000']-3]).

label(first, "First response: waiting time of a host (s)").
label(second, "Second response: waiting time of a host (s)").
label(helped, "Share of hosts served by agents in rounds 14 to 16").
label(cells, "Memory cells appointed").

measure(seconds, Rounds, Curve) :-
    findall(R-Mean, ( nth1(R, Rounds, _), waited(Rounds, R, Mean) ), Curve).
measure(able, Rounds, Curve) :-
    findall(R-Count, ( nth1(R, Rounds, _), able(Rounds, R, Count) ), Curve).
measure(first, Rounds, Seconds) :-
    waited(Rounds, 1, Seconds).
measure(second, Rounds, Seconds) :-
    waited(Rounds, 14, Seconds).
measure(helped, Rounds, Share) :-
    findall(How, ( between(14, 16, R), nth1(R, Rounds, round(Events)),
                   member(Event, Events), functor(Event, How, 3) ), Hows),
    length(Hows, All),
    aggregate_all(count, member(served, Hows), Served),
    All > 0,
    Share is Served/All.
measure(cells, Rounds, Count) :-
    aggregate_all(count, ( member(round(Events), Rounds),
                           member(memory_cell(_), Events) ), Count).

waited(Rounds, R, Mean) :-
    waits(Rounds, R, _, Waits),
    Waits = [_|_],
    sum_list(Waits, Sum),
    length(Waits, Count),
    Mean is Sum/Count.

%   able(+Rounds, +R, -Count): number of agents that can answer 00000: at most
%   one of their bits is 0.

able(Rounds, R, Count) :-
    population(Rounds, R, Population),
    aggregate_all(sum(N),
                  ( member(N-Kind, Population),
                    aggregate_all(count, sub_atom(Kind, _, _, _, '1'), Ones),
                    Ones >= 4 ),
                  Count).

claim("with memory cells the second response is faster than the first",
      [ours], at([memory_cells=1], second < first)).
claim("with memory cells the second response is faster than without", [ours],
      at([memory_cells=1], second < at([memory_cells=0], second))).
claim("with memory cells agents serve more of the hosts", [ours],
      at([memory_cells=1], helped > at([memory_cells=0], helped))).

plot(memory, "The antigen of rounds 1 to 5 returns in round 14",
     script('rounds.gp', [medians-panel_rows, dots-panel_dots],
            [size(1000, 760), variables(panels)])).

panel(Runs, panel(Title, Series)) :-
    member(Name-Title,
           [ seconds-"Seconds until a host under attack was served",
             able-"Agents that can answer 00000" ]),
    findall(series(Label, Points),
            ( member(Cells-Label, [ 0-"without memory cells",
                                    1-"with memory cells" ]),
              findall(Ms, ( member(run(Case, _, Ms), Runs),
                            Case.memory_cells =:= Cells ), All),
              curve_points(Name, All, Points) ),
            Series).
