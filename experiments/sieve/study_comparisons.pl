%   Readings of section 3.4.2, which of two antibodies is better, applied to
%   Figures 3.3 to 3.5.

:- include(kinds).
:- use_module(rounds, [count/5]).
:- use_module(library(lists), [member/2, min_list/2]).

study(comparisons, "Which agent is better? Four readings").
text("\"Past performance\" may be the feedback for the present antigen, for \c
antigens similar to it, for all antigens that both agents know, or for all \c
that an agent knows. One claim of each figure is tested.").

vary(reading, [similar, current, common, total]).
vary(figure, ['3.3', '3.4', '3.5']).
fixed(round, 8, tuned("20 hops: half the work of the figures")).
fixed(omega, 100, tuned("the lives of five rounds, as in the figures")).

plan(Case, Plan) :-
    plan_of(Case.figure, Plan).

plan_of('3.3', [['00000', '11111', '10101']-15]).
plan_of('3.4', [['00000', '00001', '00011']-15]).
plan_of('3.5', [ ['00000', '00001', '00011']-5,
                 ['11100', '11101', '11001']-5 ]).

label(complements, "Agents of each complement at the end, at least").
label(not_complements, "Agents of any other kind at the end, at most").
label(generic, "Share of 11110 at the end").
label(new, "Agents with 00010 at the end").
label(not_new, "Agents of any kind but 00010 at the end, at most").

measure(complements, Rounds, Least) :-
    findall(N, ( member(Kind, ['11111', '00000', '01010']),
                 at_end(Kind, Rounds, N) ), Ns),
    min_list(Ns, Least).
measure(not_complements, Rounds, Most) :-
    length(Rounds, Last),
    most_but(['11111', '00000', '01010'], Rounds, Last, Most).
measure(generic, Rounds, Share) :-
    at_end('11110', Rounds, N),
    at_end(_, Rounds, All),
    Share is N/All.
measure(new, Rounds, N) :-
    at_end('00010', Rounds, N).
measure(not_new, Rounds, Most) :-
    length(Rounds, Last),
    most_but(['00010'], Rounds, Last, Most).

at_end(Kind, Rounds, N) :-
    length(Rounds, Last),
    count(population, Kind, Rounds, Last, N).

claim(Text, [ours], at([reading=Reading, figure=Figure], Test)) :-
    vary(reading, Readings),
    member(Figure-Said-Test,
           [ '3.3'-"the complements lead"-(complements > not_complements),
             '3.4'-"11110 is more than half"-(generic > 0.5),
             '3.5'-"00010 leads in the end"-(new > not_new) ]),
    member(Reading, Readings),
    format(string(Text), "Figure ~w, ~w: ~w", [Figure, Reading, Said]).

plot(comparisons, "Agents of the complements, and share of 11110, by reading",
     lines([x(reading), y([complements, generic, new]), line(figure)])).
