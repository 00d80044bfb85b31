%   Chapter 7: readings that decide which mechanism completes tasks first.

:- include(ground).
:- include(competing).

study(contention, "Readings of chapter 7: which mechanism is completed soonest").
text("Completion times include the available bandwidth (section 7.6.1).  Sending \c
at once, messages do not wait for each other; one by one, a node has one channel, \c
and a message takes a share of the time that an agent takes.  Of equation 7.5 beta may begin \c
with 1, as in CSMA/CD, or with 0, as no back-off has been experienced before the \c
first.").

vary(sending, [at_once, one_by_one(0.2), one_by_one(0.5), one_by_one(1)]).
vary(beta, [0, 1]).
vary(mechanism, [proposed, murdoch, anta]).
vary(allocators, [1, 2, 3, 5]).

%   Allocators send hardly any messages, so the parameter `sending` does not
%   change their runs.

skip(Case) :-
    Case.mechanism == proposed,
    Case.sending \== at_once.

claim(Text, [line(4882)],
      at([sending=Sending, beta=Beta, mechanism=M],
         time > at([sending=at_once, mechanism=proposed], time))) :-
    setting(Sending, Beta, Setting),
    auction(M, Title),
    format(string(Text), "~w: ~w takes longer than proposed, of one to five",
           [Setting, Title]).
claim(Text, [line(4882)],
      ( at([sending=Sending, beta=Beta, mechanism=M, allocators=2], Test),
        at([sending=Sending, beta=Beta, mechanism=M, allocators=3], Test),
        at([sending=Sending, beta=Beta, mechanism=M, allocators=5], Test) )) :-
    setting(Sending, Beta, Setting),
    auction(M, Title),
    Test = (time > at([sending=at_once, mechanism=proposed], time)),
    format(string(Text), "~w: ~w takes longer than proposed, of two to five",
           [Setting, Title]).
claim(Text, [line(4893)],
      at([sending=at_once, beta=Beta, mechanism=proposed, allocators=1],
         near(interval, 5.16, 1))) :-
    member(Beta, [0, 1]),
    format(string(Text), "beta from ~w: an allocator alone backs off for 5.16 s, \c
within 1 s", [Beta]).

setting(Sending, Beta, Text) :-
    member(Sending, [at_once, one_by_one(0.2), one_by_one(0.5), one_by_one(1)]),
    member(Beta, [0, 1]),
    format(string(Text), "~w, beta from ~w", [Sending, Beta]).

plot(contention, "Completion, by bandwidth and by mechanism",
     lines([x(allocators), y([time]), line(mechanism), log(time),
            where([sending=one_by_one(0.5), beta=1])])).
