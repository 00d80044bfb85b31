% Expects: nothing; pure.
% Gives: stimulated/5, remembered/4, normalised/2, dispersion/3.

/*  The action potential of an agent that waits for the turn of its task:
    thesis section 6.3.2, equations 6.6 to 6.10.

    The thesis leaves some points open.  Equation 6.6 multiplies, so a
    potential never becomes zero by itself; below a threshold it counts as
    zero.  The mean and the deviation are taken over the values in the
    history; the deviation of fewer than two values, or of equal ones, is zero.
*/

:- use_module(library(lists)).

%!  stimulated(+Sign, +Psi0, +Sigma, +Threshold, -Psi) is det.
%
%   Equation 6.6: Sign is `positive` or `negative`.

stimulated(positive, Psi0, Sigma, Threshold, Psi) :-
    Psi1 is Psi0 - (1 - exp(-Sigma))*Psi0,
    (   Psi1 < Threshold
    ->  Psi = 0
    ;   Psi = Psi1
    ).
stimulated(negative, Psi0, Sigma, _, Psi) :-
    Psi is Psi0 + (1 - exp(-Sigma))*Psi0.

%!  remembered(+Window, +History0, +Difference, -History) is det.
%
%   Equation 6.7: Difference, the time since the previous task was
%   completed at a host, enters the history of the last Window values,
%   oldest first, if it is larger than the last one.

remembered(_, History, Difference, History) :-
    last(History, Last),
    Difference =< Last,
    !.
remembered(Window, History0, Difference, History) :-
    append(History0, [Difference], History1),
    length(History1, Count),
    Excess is max(0, Count - Window),
    length(Old, Excess),
    append(Old, History, History1).

%!  normalised(+History, -Values) is det.
%
%   Equation 6.8: the first value becomes 0, the last one 1.

normalised([First|Rest], [0|Values]) :-
    last([First|Rest], Last),
    Span is Last - First,
    normalised(Rest, First, Span, Values).

normalised([], _, _, []).
normalised([X|Xs], First, Span, [Y|Ys]) :-
    Y is (X - First)/Span,
    normalised(Xs, First, Span, Ys).

%!  dispersion(+Kappa, +History, -Sigma) is det.
%
%   Equations 6.9 and 6.10: Kappa times the standard deviation of the
%   normalised history.

dispersion(Kappa, History, Sigma) :-
    History = [First|_],
    last(History, Last),
    Last > First,
    !,
    normalised(History, Values),
    deviation(Values, Deviation),
    Sigma is Kappa * Deviation.
dispersion(_, _, 0).

deviation(Values, Deviation) :-
    sum_list(Values, Sum),
    length(Values, Count),
    Mean is Sum/Count,
    squares(Values, Mean, 0, Squares),
    Deviation is sqrt(Squares/Count).

squares([], _, Squares, Squares).
squares([X|Xs], Mean, Squares0, Squares) :-
    Squares1 is Squares0 + (X - Mean)**2,
    squares(Xs, Mean, Squares1, Squares).
