:- module(readings_verdicts,
          [ verdicts/4,                 % +Study, +Outcome, +Verdicts0, -Verdicts
            holds_mostly/1,             % +Verdict
            gained/3,                   % +Before, +After, -Claims
            reachable/3,                % +Tried, -Claim, -Readings
            best_first/2                % +Tried, -Sorted
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3, include/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(pairs), [map_list_to_pairs/3, pairs_values/2]).

/** <module> What a reading makes of the claims

A verdict is verdict(Claim, Held, Of): Claim, Name-Text of a study, held in Held of
the Of seeds for which it is known.  Tried is a list of pairs of a reading and its
verdicts; the first reading is [], which leaves all as it is.

*Threading*: pure.
*/

%!  verdicts(+Name, +Outcome, +Verdicts0, -Verdicts) is det.
%
%   Verdicts has those of Outcome as well, of the study Name.  Claims that are not
%   those of the thesis, or about a formula, are left out: no reading changes them.

verdicts(Name, Outcome, Verdicts0, Verdicts) :-
    findall(verdict(Name-Text, Held, Of),
            ( member(claim(Text, Notes, Held, Of, _, _), Outcome.claims),
              memberchk(line(_), Notes),
              \+ memberchk(ours, Notes),
              \+ memberchk(formula, Notes) ),
            Found),
    append(Verdicts0, Found, Verdicts).

%!  holds_mostly(+Verdict) is semidet.
%
%   It held for half of the seeds at least.

holds_mostly(verdict(_, Held, Of)) :-
    Of > 0,
    2*Held >= Of.

%!  gained(+Before, +After, -Claims:list) is det.
%
%   The Claims that hold mostly in After, and do not in Before.

gained(Before, After, Claims) :-
    findall(Claim,
            ( member(verdict(Claim, Held, Of), After),
              holds_mostly(verdict(Claim, Held, Of)),
              \+ ( member(verdict(Claim, Held0, Of0), Before),
                   holds_mostly(verdict(Claim, Held0, Of0)) ) ),
            Claims).

%!  reachable(+Tried, -Claim, -Readings) is nondet.
%
%   Claim does not hold mostly as all is, and does with each of Readings.

reachable([[]-AsItIs|Others], Claim, Readings) :-
    exclude(holds_mostly, AsItIs, Failed),
    member(verdict(Claim, _, _), Failed),
    findall(Reading,
            ( member(Reading-Verdicts, Others),
              member(verdict(Claim, Held, Of), Verdicts),
              holds_mostly(verdict(Claim, Held, Of)) ),
            Readings).

%!  best_first(+Tried, -Sorted) is det.
%
%   By the number of claims that hold mostly; of as many, by the number of seeds for
%   which they hold; of as many, that which changes fewer parameters.

best_first(Tried, Sorted) :-
    map_list_to_pairs(merit, Tried, Pairs0),
    sort(1, @>=, Pairs0, Pairs),
    pairs_values(Pairs, Sorted).

merit(Reading-Verdicts, merit(Mostly, Held, Simple)) :-
    include(holds_mostly, Verdicts, Holding),
    length(Holding, Mostly),
    aggregate_all(sum(N), member(verdict(_, N, _), Verdicts), Held),
    length(Reading, Changed),
    Simple is -Changed.
