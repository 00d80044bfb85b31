% Expects: similar/2 of an application, or none; pure.
% Gives: squashed/4, stimulated/3, learnt/4, interaction/5, fate/4, roulette/3.

/*  Interaction of antibodies at a host: thesis section 3.4.3,
    equations 3.1 to 3.5, and the choice by roulette of section 3.4.1.

    A memory is a list Antigen-Xi, each antigen once: the antigens that an
    agent has neutralized, and the feedback for each.

    The thesis does not define exactly which agents are related, and which of
    two is better.  A reading does:

        similar         an agent is compared by the sum of its feedback for
                        antigens similar to that of this attack; agents that
                        know such an antigen are related
        current         the same, for the antigen of this attack alone
        total           the same, for all antigens
        common          agents that know a common antigen are related; they
                        are compared by the sum over all common antigens
*/

:- use_module(library(lists)).
:- use_module(library(pairs)).

                /*******************************
                *      ANTIGENIC FEEDBACK      *
                *******************************/

%!  squashed(+Xi, +Alpha, +Beta, -Squashed) is det.
%
%   Equation 3.2: a feedback between 0 and 1.

squashed(Xi, Alpha, Beta, Squashed) :-
    Squashed is 1/(1 + exp(Alpha - Beta*Xi)).

%!  stimulated(+Gamma0, +Squashed, -Gamma) is det.
%
%   Equation 3.1: adds a feedback to an endurance potential.

stimulated(Gamma0, Squashed, Gamma) :-
    Gamma is Gamma0 + Squashed.

%!  learnt(+Memory0, +Antigen, +Xi, -Memory) is det.
%
%   Memory has Xi, the last feedback, for Antigen.

learnt(Memory0, Antigen, Xi, [Antigen-Xi|Memory]) :-
    (   selectchk(Antigen-_, Memory0, Memory)
    ->  true
    ;   Memory = Memory0
    ).

                /*******************************
                *          INTERACTION         *
                *******************************/

%!  interaction(+Reading, +Antigen, +Constants, +Cells, -Gammas) is det.
%
%   Equations 3.3 to 3.5: cells at a host under attack by Antigen stimulate and
%   suppress each other.  A cell is cell(Id, Gamma, Memory), Constants are
%   kt-ku; Gammas are the potentials afterwards, in the order of Cells.  All
%   effects are computed from the potentials before the interaction.

interaction(Reading, Antigen, Constants, Cells0, Gammas) :-
    relevant(Cells0, Reading, Antigen, Cells),
    gammas(Cells, Reading, Constants, Cells, Gammas).

%   relevant(+Cells0, +Reading, +Antigen, -Cells): Cells have only the part of
%   each memory that counts in this reading, and the size of the whole memory.

relevant([], _, _, []).
relevant([cell(Id, Gamma, Memory0)|Cells0], Reading, Antigen,
         [cell(Id, Gamma, Memory, Count)|Cells]) :-
    length(Memory0, Count),
    findall(Known-Xi,
            ( member(Known-Xi, Memory0), counts(Reading, Known, Antigen) ),
            Memory),
    relevant(Cells0, Reading, Antigen, Cells).

counts(similar, Known, Antigen) :-
    (   Known == Antigen
    ->  true
    ;   similar_antigens(Known, Antigen)
    ).
counts(current, Antigen, Antigen).
counts(common, _, _).
counts(total, _, _).

%   If the application does not define similar/2, different antigens are not
%   similar.

similar_antigens(Known, Antigen) :-
    catch(similar(Known, Antigen),
          error(existence_error(procedure, _), _),
          fail),
    !.

gammas([], _, _, _, []).
gammas([Cell|Cells], Reading, Constants, All, [Gamma|Gammas]) :-
    arg(2, Cell, Gamma0),
    effects(All, Reading, Constants, Cell, All, Gamma0, Gamma),
    gammas(Cells, Reading, Constants, All, Gammas).

effects([], _, _, _, _, Gamma, Gamma).
effects([Other|Others], Reading, Kt-Ku, Cell, All, Gamma0, Gamma) :-
    advantage(Reading, Cell, Other, Advantage),
    (   Advantage > 0
    ->  influence(Reading, Other, All, Influence),
        Gamma1 is Gamma0 + Kt*Influence
    ;   Advantage < 0
    ->  influence(Reading, Other, All, Influence),
        Gamma1 is Gamma0 - Ku*Influence
    ;   Gamma1 = Gamma0
    ),
    effects(Others, Reading, Kt-Ku, Cell, All, Gamma1, Gamma).

%   influence(+Reading, +Cell, +All, -Influence): gamma/N of equations 3.4
%   and 3.5.  N is the number of antigens Cell knows, less those in which it
%   matches a related agent, and at least 1, because it is a divisor.

influence(Reading, Cell, All, Influence) :-
    Cell = cell(_, Gamma, Memory, Count),
    findall(Known,
            ( member(Known-_, Memory),
              member(Other, All),
              matches(Reading, Known, Cell, Other) ),
            Matching0),
    sort(Matching0, Matching),
    length(Matching, Matches),
    Influence is Gamma/max(1, Count - Matches).

matches(Reading, Known, cell(Id, _, _, _), cell(OtherId, _, Theirs, _)) :-
    OtherId \== Id,
    known_to(Reading, Known, Theirs).

known_to(common, Known, Theirs) :-
    !,
    memberchk(Known-_, Theirs).
known_to(_, _, [_|_]).

%!  advantage(+Reading, +Cell, +Other, -Advantage) is det.
%
%   Advantage is positive if Cell is better than Other; 0 if they are not
%   related.

advantage(common, cell(_, _, Mine, _), cell(_, _, Theirs, _), Advantage) :-
    !,
    findall(Difference,
            ( member(Antigen-Xi, Mine),
              memberchk(Antigen-Other, Theirs),
              Difference is Xi - Other ),
            Differences),
    sum_list(Differences, Advantage).
advantage(_, cell(_, _, [M|Mine], _), cell(_, _, [T|Theirs], _),
          Advantage) :-
    !,
    pairs_values([M|Mine], Xis),
    pairs_values([T|Theirs], Others),
    sum_list(Xis, Sum),
    sum_list(Others, OtherSum),
    Advantage is Sum - OtherSum.
advantage(_, _, _, 0).

                /*******************************
                *             FATE             *
                *******************************/

%!  fate(+Gamma, +Minimum, +Maximum, -Fate) is det.
%
%   Fate is `clone`, `die` or `stay`.

fate(Gamma, _, Maximum, clone) :-
    Gamma > Maximum,
    !.
fate(Gamma, Minimum, _, die) :-
    Gamma < Minimum,
    !.
fate(_, _, _, stay).

%!  roulette(+Weighted, +Turn, -Chosen) is semidet.
%
%   Weighted are pairs Weight-Thing, Turn is a random number from 0 to 1.
%   Thing is chosen in proportion to its weight.  Fails if the sum of the
%   weights is 0.

roulette(Weighted, Turn, Chosen) :-
    pairs_keys(Weighted, Weights),
    sum_list(Weights, Sum),
    Sum > 0,
    Position is Turn*Sum,
    fall(Weighted, Position, Chosen).

fall([_-Chosen], _, Chosen) :-
    !.
fall([Weight-Chosen|_], Position, Chosen) :-
    Position < Weight,
    !.
fall([Weight-_|Weighted], Position0, Chosen) :-
    Position is Position0 - Weight,
    fall(Weighted, Position, Chosen).
