%   Figure 3.4: one antibody that neutralizes three antigens.

:- include(kinds).
:- use_module(rounds, [born/4, count/5]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [max_list/2, member/2, min_list/2]).

study('3.4', "Antigens 00000, 00001, 00011: a generic antibody").
text("Three similar antigens attack in each of 15 rounds. 11110 answers all \c
of them.").

real([], [clock=2, processes=2]).

plan(_, [['00000', '00001', '00011']-15]).

printed(leads_from, [], 5).

label(leads_from, "Round from which on 11110 leads").
label(share, "Share of 11110 at the end").
label(cloned_least, "Clones of 11110 in a round from 5 on, at least").
label(second, "Agents with 11111 at the end").
label(other_most, "Agents of any other kind at the end, at most").
label(traces, "Agents with 11111 generated in rounds 11 and 12").

measure(leads_from, Rounds, From) :-
    findall(R, ( between(1, 15, R), \+ leads('11110', Rounds, R) ), Not),
    max_list([0|Not], Last),
    From is Last + 1.
measure(share, Rounds, Share) :-
    count(population, '11110', Rounds, 15, N),
    count(population, _, Rounds, 15, All),
    Share is N/All.
measure(cloned_least, Rounds, Least) :-
    findall(N, ( between(5, 15, R), count(clone, '11110', Rounds, R, N) ),
            Ns),
    min_list(Ns, Least).
measure(second, Rounds, N) :-
    count(population, '11111', Rounds, 15, N).
measure(other_most, Rounds, Most) :-
    most_but(['11110', '11111'], Rounds, 15, Most).
measure(traces, Rounds, N) :-
    aggregate_all(count, ( member(R, [11, 12]),
                           born(Rounds, R, _, '11111') ), N).

leads(Kind, Rounds, Round) :-
    count(population, Kind, Rounds, Round, N),
    most_but([Kind], Rounds, Round, Most),
    N > Most.

claim("11110 has the largest population from round 5 on", [line(1530)],
      leads_from =< 5).
claim("11110 is more than half of all at the end", [line(1530), ours],
      share > 0.5).
claim("11110 makes clones in each of rounds 5 to 15", [line(1538)],
      cloned_least > 0).
claim("11111 thrives: it is the second largest at the end", [line(1536)],
      second > other_most).
claim("traces of 11111 are generated in rounds 11 and 12", [line(1539)],
      traces > 0).

plot('3.4', "Antigens 00000, 00001, 00011: a generic antibody",
     script('rounds.gp', [medians-panel_rows, dots-panel_dots],
            [size(1000, 1000), variables(panels)])).
