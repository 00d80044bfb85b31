% Expects: backoffs/1; lib, common; deadline, attendance, sojourn, migration,
%   deallocation.
% Gives: back_off/0.

/*  Back-off: thesis section 7.4.1, Contention Resolution.  This file applies
    the equations of backoff_interval.pl to an allocator.  backoffs(Count)
    includes the current back-off; it is beta if the parameter `beta` is 1.
*/

%!  back_off is det.
%
%   Keeps the robots that are executing: no other task can use them yet.

back_off :-
    deallocate([reserved, done]),
    keep(stage(resting)),
    back_off_interval(Interval),
    log(backoff(Interval)),
    now(Now),
    Until is Now + Interval,
    rest(Until),
    restart.

back_off_interval(Interval) :-
    theta(Theta),
    backoffs(Count0),
    Count is Count0 + 1,
    keep(backoffs(Count)),
    parameter(bi_max, Maximum),
    parameter(beta, First),
    Beta is First + Count0,
    chance_turn(Turn),
    interval(Theta, Beta, Maximum, Turn, Interval).

theta(Theta) :-
    parameter(backoff, constant),
    !,
    sojourn(_, _, Rewards, _),
    parameter(bi_min, Minimum),
    bid_time(Rewards, Minimum, Theta).
theta(Theta) :-
    discovered(Found),
    hop_time(HopTime),
    reach_time(Found, HopTime, Theta).

%   The mean hop time to this host, as the host measures it.

hop_time(Seconds) :-
    here(Host),
    typhon:host_property(Host, hop_time(in, stats(_, _, Seconds, _))),
    !.

%   The allocator stays dormant at its robot until the time Until, but handles
%   messages.

rest(Until) :-
    attend,
    now(Now),
    Left0 is Until - Now,
    (   Left0 > 0
    ->  soon(Left0, Left),
        (   receive(From-Message, Left)
        ->  heed(Message, From)
        ;   true
        ),
        rest(Until)
    ;   true
    ).
