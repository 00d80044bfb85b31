:- module(simulation_reading,
          [ reading/1,                  % ?Reading
            reading_full/1,             % -Drive
            reading_step/5,             % +Reading, +What, +Delta, +Drive0,
                                        % -Drive
            reading_revived/3,          % +Drive, +Theta, -Revived
            reading_steps/3             % +Reading, +Delta, -Steps
          ]).
:- include('../../agents/sync/potential').

/** <module> Ways to read equation 5.2

`chosen` is what the travelling agents do: their own file of equations is
included here. The others are what the thesis might also have meant. They
are here to be compared, see doc/fidelity.md:

  - over_window: the sum of the history is divided by the length of the
    window, also while the window is not full
  - inside: delta is added to the mean, before it is multiplied by the
    potential
  - inside(Zero): the same, and a potential of at most Zero counts as zero
  - scaled: delta enlarges the product, by the factor 1 + delta
  - signed: penalties enter the history as negative numbers

*Threading*: pure.
*/

maximum(100).
window(15).
first_theta(15).

%!  reading(?Reading) is semidet.
%
%   Reading is one of those above. Enumerates none of inside(Zero).

reading(chosen).
reading(over_window).
reading(inside).
reading(inside(Zero)) :-
    number(Zero).
reading(scaled).
reading(signed).

%!  reading_full(-Drive) is det.
%
%   Drive, drive(Potential, History), is that of a task at the beginning.

reading_full(drive(Maximum, [Theta])) :-
    maximum(Maximum),
    first_theta(Theta).

%!  reading_step(+Reading, +What, +Delta, +Drive0, -Drive) is det.
%
%   Drive follows Drive0 by What: `reward` or `penalty`.

reading_step(chosen, What, Delta, Drive0, Drive) :-
    !,
    maximum(Maximum),
    window(Window),
    chosen(What, Drive0, Maximum, Window, Delta, Drive).
reading_step(Reading, What, Delta, drive(P0, H0), drive(P, H)) :-
    bias(What, Delta, Bias),
    other_theta(Reading, H0, P0, Bias, Theta),
    changed(What, P0, Theta, P1),
    zero(Reading, P1, P),
    remembered(Reading, What, Theta, Entry),
    window(Window),
    slide(Window, H0, Entry, H).

chosen(reward, Drive0, Maximum, Window, _, Drive) :-
    rewarded(Drive0, Maximum, Window, _, Drive).
chosen(penalty, Drive0, Maximum, Window, Delta, Drive) :-
    penalised(Drive0, Maximum, Window, Delta, _, Drive).

bias(reward, _, 0).
bias(penalty, Delta, Delta).

other_theta(over_window, History, Potential, Bias, Theta) :-
    sum_list(History, Sum),
    window(Window),
    maximum(Maximum),
    Theta is Sum/Window * Potential/Maximum + Bias.
other_theta(inside, History, Potential, Bias, Theta) :-
    mean(History, Mean),
    maximum(Maximum),
    Theta is (Mean + Bias) * Potential/Maximum.
other_theta(inside(_), History, Potential, Bias, Theta) :-
    other_theta(inside, History, Potential, Bias, Theta).
other_theta(scaled, History, Potential, Bias, Theta) :-
    mean(History, Mean),
    maximum(Maximum),
    Theta is Mean * Potential/Maximum * (1 + Bias).
other_theta(signed, History, Potential, Bias, Theta) :-
    maximum(Maximum),
    theta(History, Potential, Maximum, Bias, Theta).

mean(List, Mean) :-
    sum_list(List, Sum),
    length(List, Count),
    Mean is Sum/Count.

%   A negative theta, as of `signed`, can lead below zero on a reward.

changed(reward, P0, Theta, P) :-
    maximum(Maximum),
    increase(P0, Theta, Maximum, P1),
    P is max(0, P1).
changed(penalty, P0, Theta, P) :-
    maximum(Maximum),
    decrease(P0, Theta, P1),
    P is min(Maximum, P1).

zero(inside(Zero), P, 0) :-
    P =< Zero,
    !.
zero(_, P, P).

remembered(signed, penalty, Theta, Entry) :-
    !,
    Entry is -Theta.
remembered(_, _, Theta, Theta).

%!  reading_revived(+Drive, +Theta, -Revived) is det.
%
%   Revived is the Drive of a task that is found missing, by an agent whose
%   last reward or penalty was Theta.

reading_revived(drive(P0, _), Theta, drive(P, [First])) :-
    maximum(Maximum),
    increase(P0, Theta, Maximum, P),
    first_theta(First).

%!  reading_steps(+Reading, +Delta, -Steps) is semidet.
%
%   So many penalties, and no reward, take a full potential to zero. Fails
%   if 10,000 do not.

reading_steps(Reading, Delta, Steps) :-
    reading_full(Drive),
    reading_steps(Drive, Reading, Delta, 0, Steps).

reading_steps(drive(Potential, _), _, _, Steps, Steps) :-
    Potential =:= 0,
    !.
reading_steps(Drive0, Reading, Delta, Steps0, Steps) :-
    Steps0 < 10000,
    reading_step(Reading, penalty, Delta, Drive0, Drive),
    Steps1 is Steps0 + 1,
    reading_steps(Drive, Reading, Delta, Steps1, Steps).
