% Expects: nothing; pure.
% Gives: reach_time/3, bid_time/3, interval/5.

/*  The length of a back-off: thesis sections 7.4.1 and 7.5, equations 7.5 to
    7.7.

    The thesis prints "2 beta Theta" and calls it binary: it is Theta times
    2 to the power of beta, the number of back-offs including this one.
*/

%!  reach_time(+Found, +HopTime, -Theta) is det.
%
%   Equation 7.6: Theta is the time, in seconds, in which a child of an agent
%   that has found Found distinct robots visits them all, with hops of HopTime
%   seconds.

reach_time(Found, HopTime, Theta) :-
    Theta is Found*HopTime.

%!  bid_time(+Bids, +Minimum, -Theta) is det.
%
%   Equation 7.7: constant back-off.  Bids is the number of bids received; it
%   counts as at least 1, so that an auctioneer without bids does not try
%   again at once.

bid_time(Bids, Minimum, Theta) :-
    Theta is max(1, Bids)*Minimum.

%!  interval(+Theta, +Backoffs, +Maximum, +Turn, -Interval) is det.
%
%   Equation 7.5: Interval is in seconds, Turn a random number from 0 to 1.

interval(Theta, Backoffs, Maximum, Turn, Interval) :-
    Range is min(2.0**min(Backoffs, 60) * Theta, Maximum),
    Interval is Theta + Turn*Range.
