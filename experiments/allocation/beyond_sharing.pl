%   Beyond the thesis: allocators that share news of robots.

:- include(ground).

study(sharing, "Allocators that share what they know of robots").
text("Section 7.8 expects that agents which share information complete their \c
tasks sooner, with fewer useless migrations.  Here they leave at hosts which \c
robots are free or taken, and since when; own: an allocator uses only its own \c
observations.").

vary(sharing, [none, own, shared]).
vary(allocators, [1, 3, 5]).
vary(hosts, [100, 200]).
skip(Case) :-
    Case.hosts > 100,
    ( Case.allocators =\= 3 ; Case.sharing == own ).
derive(eligible, Case, Count) :- Count is 15*Case.hosts // 100.
derive(required, Case, Count) :- Count is Case.hosts // 10.
derive(probability, Case, P) :- P is 6/Case.hosts.
fixed(mechanism, proposed, assumed("auctions have nothing to share")).

claim("shared: completed sooner than without sharing, 3 and 5 allocators",
      [line(5101)],
      at([hosts=100],
         ( at([sharing=shared, allocators=3], time < at([sharing=none], time)),
           at([sharing=shared, allocators=5], time < at([sharing=none], time))))).
claim("shared: 3 allocators complete sooner with each number of hosts", [ours],
      at([allocators=3, sharing=shared], time < at([sharing=none], time))).
claim("shared: fewer communications than without, 3 and 5 allocators",
      [line(5103)],
      at([hosts=100],
         ( at([sharing=shared, allocators=3],
              communications < at([sharing=none], communications)),
           at([sharing=shared, allocators=5],
              communications < at([sharing=none], communications)) ))).
claim("shared: fewer communications, 3 allocators, each number of hosts",
      [ours],
      at([allocators=3, sharing=shared],
         communications < at([sharing=none], communications))).
claim("own: fewer communications than without, 3 and 5 allocators", [ours],
      at([hosts=100],
         ( at([sharing=own, allocators=3],
              communications < at([sharing=none], communications)),
           at([sharing=own, allocators=5],
              communications < at([sharing=none], communications)) ))).
claim("shared: fewer communications than own, 3 and 5 allocators", [ours],
      at([hosts=100],
         ( at([sharing=shared, allocators=3],
              communications < at([sharing=own], communications)),
           at([sharing=shared, allocators=5],
              communications < at([sharing=own], communications)) ))).

plot(sharing, "Allocators that share what they know",
     lines([ x(allocators), y([communications, time, backoffs]),
             line(sharing), where([hosts=100]) ])).
plot(sharing_hosts, "Three allocators on larger networks",
     lines([ x(hosts), y([communications, time]), line(sharing),
             where([allocators=3]) ])).
