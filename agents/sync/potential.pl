% Expects: nothing; pure.
% Gives: theta/5, increase/4, decrease/3, slide/4, rewarded/5, penalised/6.

/*  Potentials, rewards and penalties of a synchronising agent (thesis
    section 5.4.1).

    The thesis leaves three points open.  The penalty bias is added to the
    product, not inside it; the history is averaged over the values it holds,
    not over the length of the window; and it stores magnitudes, so that
    penalties and rewards weigh alike.  Only with this reading do overlaps
    begin at the same delta as in the thesis, and does a potential reach
    exactly zero.
*/

:- use_module(library(lists)).

%!  theta(+History, +Potential, +Maximum, +Bias, -Theta) is det.
%
%   Equation 5.2: the size of a reward (Bias is 0) or a penalty (Bias is
%   delta), from the values in the window and the potential that is left.

theta(History, Potential, Maximum, Bias, Theta) :-
    sum_list(History, Sum),
    length(History, Count),
    Theta is Sum/Count * Potential/Maximum + Bias.

%!  increase(+Potential0, +Theta, +Maximum, -Potential) is det.
%!  decrease(+Potential0, +Theta, -Potential) is det.
%
%   Equation 5.1, for rewards and for penalties: a potential stays within
%   0 and Maximum.

increase(Potential0, Theta, Maximum, Potential) :-
    Potential is min(Maximum, Potential0 + Theta).

decrease(Potential0, Theta, Potential) :-
    Potential is max(0, Potential0 - Theta).

%!  slide(+Window, +History0, +Theta, -History) is det.
%
%   Theta enters the window of the last Window values, oldest first.

slide(Window, History0, Theta, History) :-
    append(History0, [Theta], History1),
    length(History1, Count),
    (   Count > Window
    ->  History1 = [_|History]
    ;   History = History1
    ).

%!  rewarded(+Drive0, +Maximum, +Window, -Theta, -Drive) is det.
%!  penalised(+Drive0, +Maximum, +Window, +Delta, -Theta, -Drive) is det.
%
%   One step of the drive for a task, drive(Potential, History).

rewarded(drive(P0, H0), Maximum, Window, Theta, drive(P, H)) :-
    theta(H0, P0, Maximum, 0, Theta),
    increase(P0, Theta, Maximum, P),
    slide(Window, H0, Theta, H).

penalised(drive(P0, H0), Maximum, Window, Delta, Theta, drive(P, H)) :-
    theta(H0, P0, Maximum, Delta, Theta),
    decrease(P0, Theta, P),
    slide(Window, H0, Theta, H).
