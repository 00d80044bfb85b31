%   Other readings of equation 5.2: the number of successive penalties that
%   reduce a potential to zero.  Computed; `agents` is the reading of the
%   agents.

:- include('../../agents/sync/potential').
:- use_module(library(lists)).

study(readings, "Readings of equation 5.2: visits until a potential is zero").
text("agents: δ is added to the product, and the history averaged over the \c
values that it holds. over_window: its sum is divided by ω from the start. \c
signed: penalties enter the history as negative numbers. inside: δ is added \c
to the mean, before it is multiplied; inside(Z): and a potential of Z or less \c
counts as zero. scaled: δ enlarges the product, by 1 + δ. On star-bus, \c
δ = 0.2, T2 begins at the 37th second (section 5.6.1): about 90 visits of \c
0.4 s, a few of them with a reward.").

vary(reading, [ agents, over_window, signed, inside, inside(0.5), inside(10),
                scaled ]).
vary(delta, [0.2, 0.3, 0.5, 0.8, 1.0]).
fixed(most, 10000, assumed("more visits count as never")).

view(Log, Visits) :-
    (   falls(drive(100, [15]), Log.case, 0, Visits)
    ->  true
    ;   Visits = never
    ).

falls(drive(Potential, _), _, Visits, Visits) :-
    Potential =:= 0,
    !.
falls(Drive0, Case, Visits0, Visits) :-
    Visits0 < Case.most,
    penalty(Case.reading, Drive0, Case.delta, Drive),
    Visits1 is Visits0 + 1,
    falls(Drive, Case, Visits1, Visits).

penalty(agents, Drive0, Delta, Drive) :-
    !,
    penalised(Drive0, 100, 15, Delta, _, Drive).
penalty(Reading, drive(P0, H0), Delta, drive(P, H)) :-
    sum_list(H0, Sum),
    length(H0, Count),
    size(Reading, Sum, Count, P0/100, Delta, Theta),
    P1 is min(100, max(0, P0 - Theta)),
    ( Reading = inside(Zero), P1 =< Zero -> P = 0 ; P = P1 ),
    ( Reading == signed -> Entry is -Theta ; Entry = Theta ),
    slide(15, H0, Entry, H).

size(over_window, Sum, _, Share, Delta, Theta) :-
    Theta is Sum/15*Share + Delta.
size(signed, Sum, Count, Share, Delta, Theta) :-
    Theta is Sum/Count*Share + Delta.
size(inside, Sum, Count, Share, Delta, Theta) :-
    Theta is (Sum/Count + Delta)*Share.
size(inside(_), Sum, Count, Share, Delta, Theta) :-
    size(inside, Sum, Count, Share, Delta, Theta).
size(scaled, Sum, Count, Share, Delta, Theta) :-
    Theta is Sum/Count*Share*(1 + Delta).

measure(visits, Visits, Visits).

label(visits, "Visits until the potential is zero").

claim("in the reading of the agents, 60 to 100 visits at δ = 0.2",
      [formula, ours],
      at([reading=agents, delta=0.2], between(visits, 60, 100))).
claim("with δ inside the product, or as a factor, a potential is never zero",
      [formula, ours],
      holds(never([inside, scaled]))).
claim("in no other reading 60 to 100 visits at δ = 0.2",
      [formula, ours], holds(no_other)).

never(Readings, Points) :-
    forall(( member(Case-Ms, Points), memberchk(Case.reading, Readings) ),
           \+ number_of(Ms, _)).

no_other(Points) :-
    forall(( member(Case-Ms, Points), Case.delta =:= 0.2,
             number_of(Ms, Visits), Visits >= 60, Visits =< 100 ),
           Case.reading == agents).

number_of(Measures, Visits) :-
    get_dict(visits, Measures, Visits),
    number(Visits).
