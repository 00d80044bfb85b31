%   Figure 3.3: the complements of the antigens.

:- include(kinds).
:- use_module(rounds, [born/4, count/5, kinds/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists),
              [max_list/2, member/2, memberchk/2, min_list/2]).

study('3.3', "Antigens 00000, 11111, 10101: their complements remain").
text("Three dissimilar antigens attack hosts drawn at random in each of 15 \c
rounds. A host that no agent serves generates a random antibody; antibodies \c
that do better than others at a host clone themselves, the others die.").

plan(_, [['00000', '11111', '10101']-15]).

complements(['11111', '00000', '01010']).

printed(other_most, [], 3).
printed(kinds, [], 14).
printed(last_new, [], 5).

label(least_complement, "Agents of each complement at the end, at least").
label(other_most, "Agents of any other kind at the end, at most").
label(kinds, "Number of kinds").
label(last_new, "Round of the last new kind").
label(clones_of_complements, "Share of the complements among later clones").
label(share, "Share of the complements among later generated ones").

measure(least_complement, Rounds, Least) :-
    complements(Kinds),
    findall(N, ( member(Kind, Kinds),
                 count(population, Kind, Rounds, 15, N) ), Ns),
    min_list(Ns, Least).
measure(other_most, Rounds, Most) :-
    complements(Kinds),
    most_but(Kinds, Rounds, 15, Most).
measure(kinds, Rounds, Count) :-
    kinds(Rounds, Kinds),
    length(Kinds, Count).
measure(last_new, Rounds, Last) :-
    kinds(Rounds, Kinds),
    findall(First,
            ( member(Kind, Kinds),
              aggregate_all(min(R), born(Rounds, R, _, Kind), First) ),
            Firsts),
    max_list(Firsts, Last).
measure(clones_of_complements, Rounds, Share) :-
    later_share(Rounds, clone, Share).
measure(share, Rounds, Share) :-
    later_share(Rounds, _, Share).

%   later_share(+Rounds, ?How, -Share): share of the complements among the
%   antibodies born after round 5.

later_share(Rounds, How, Share) :-
    complements(Complements),
    findall(Kind, ( born(Rounds, R, How, Kind), R > 5 ), All),
    aggregate_all(count, ( member(Kind, All), memberchk(Kind, Complements) ),
                  Part),
    length(All, Total),
    Total > 0,
    Share is Part/Total.

claim("at the end the complements are the three largest populations",
      [line(1482)], least_complement > other_most).
claim("at the end no other kind has more than 3 agents", [line(1490)],
      other_most =< 3).
claim("14 kinds in all", [line(1481), why("16 kinds can answer one of the \c
antigens, and hosts that are left alone draw all of them sooner or later")],
      kinds =:= 14).
claim("new kinds appear until round 5, not later", [line(1514)],
      last_new =< 5).
claim("then the three dominate what is generated", [line(1515)],
      share > 0.5).
claim("nine in ten later clones are complements", [line(1515), ours],
      clones_of_complements >= 0.9).

plot('3.3', "Antigens 00000, 11111, 10101",
     script('rounds.gp', [medians-panel_rows, dots-panel_dots],
            [size(1000, 1000), variables(panels)])).
