% Expects: lib.
% Gives: set_deadline/1, check_deadline/0, soon/2; state until/1.

/*  The deadline of a task: the fact until(Time), or until(never).  Beyond the
    thesis.
*/

:- dynamic until/1.

%!  set_deadline(+Seconds) is det.
%
%   Sets the deadline Seconds from now; Seconds may be `never`.

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
%   Seconds is Seconds0, or the time left until the deadline if that is less.

soon(Seconds, Seconds) :-
    until(never),
    !.
soon(Seconds0, Seconds) :-
    until(Until),
    now(Now),
    Seconds is max(0, min(Seconds0, Until - Now)).
