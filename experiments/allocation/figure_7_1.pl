%   Figures 7.1 to 7.3: allocators that want the same robots.

:- include(ground).

study('7.1', "Communications, completion and back-offs by the number of \c
allocators").

vary(links, [dynamic, static]).
vary(mechanism, [proposed, constant, murdoch, anta]).
vary(allocators, [1, 2, 3, 4, 5]).
skip(Case) :-
    Case.links == static,
    Case.mechanism == constant.
fixed(hosts, 100, printed("section 7.6.1")).
fixed(eligible, 15, printed("section 7.6.1")).
fixed(required, 10, printed("section 7.6.1")).
