% Expects: lib.
% Gives: set_deadline/1, check_deadline/0, soon/2; state until/1.

/*  The time by which a task must be done, until(Time), or until(never).
    Beyond the thesis.
*/

:- dynamic until/1.

%!  set_deadline(+Seconds) is det.
%
%   The deadline is Seconds from now, or `never`.

set_deadline(never) :-
    !,
    keep(until(never)).
set_deadline(Seconds) :-
    now(Now),
    Until is Now + Seconds,
    keep(until(Until)).

%!  check_deadline is det.
%
%   @throws missed

check_deadline :-
    until(never),
    !.
check_deadline :-
    until(Until),
    now(Now),
    (   Now >= Until
    ->  throw(missed)
    ;   true
    ).

%!  soon(+Seconds0, -Seconds) is det.
%
%   Seconds is Seconds0, or less, so that it ends at the deadline.

soon(Seconds, Seconds) :-
    until(never),
    !.
soon(Seconds0, Seconds) :-
    until(Until),
    now(Now),
    Seconds is max(0, min(Seconds0, Until - Now)).
