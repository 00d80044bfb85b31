%   Figure 7.1 c and d, of one allocator: which of what is not printed gives
%   the values that are?

:- include(ground).

study(alone, "An allocator that is alone: 2.6 back-offs of 5.16 s").
text("How long a hop takes and how many links there are is not printed.  Who \c
is alone backs off because its mobility resource is used up before it has met \c
ten of the fifteen robots.").

vary(probability, [0.06, 0.03]).
vary(hop_time, [0.05-0.15, 0.02-0.06]).
fixed(mechanism, proposed, printed("section 7.6.1")).
fixed(links, dynamic, printed("section 7.6.1")).
fixed(hosts, 100, printed("section 7.6.1")).
fixed(eligible, 15, printed("section 7.6.1")).
fixed(required, 10, printed("section 7.6.1")).
fixed(allocators, 1, printed("section 7.6.1")).

printed(backoffs, [], 2.6).
printed(interval, [], 5.16).

claim("5.16 s, within 1 s, with hops of 0.02 to 0.06 s and three links",
      [line(4893)],
      at([probability=0.03, hop_time=0.02-0.06], near(interval, 5.16, 1))).
claim("2.6 back-offs, within 1", [line(4892)],
      at([probability=0.03, hop_time=0.02-0.06], near(backoffs, 2.6, 1))).
claim("with fewer links there are more back-offs", [ours],
      falls(backoffs, along(probability))).

plot(alone, "An allocator that is alone",
     lines([ x(hop_time), y([backoffs, interval]), line(probability),
             xlabel("seconds of a hop; lines: probability of a link") ])).
