% Expects: backoffs/1; lib, common; deadline, attendance, sojourn, migration,
%   deallocation.
% Gives: back_off/0.

/*  Backing off before others: thesis section 7.4.1, Contention Resolution.
    The equations of backoff_interval.pl in the life of an allocator;
    backoffs(Count), with this one, is its beta, if that begins with 1.
*/

%!  back_off is det.
%
%   Robots that are executing are kept: no other task can use them yet.

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

%   The host measures it: the mean time of hops to it.

hop_time(Seconds) :-
    here(Host),
    typhon:host_property(Host, hop_time(in, stats(_, _, Seconds, _))),
    !.

%   Dormant, at the robot where it is.

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
