%   Beyond the thesis: allocators that share what they know of robots.

:- include(ground).

study(sharing, "Allocators that share what they know of robots").
text("Section 7.8 expects that agents which share information complete their \c
tasks sooner, and migrate less in vain.  Here they leave at hosts which robots \c
are free or taken, since when; own: an allocator uses only what it has seen \c
itself.").

vary(sharing, [none, own, shared]).
vary(allocators, [1, 3, 5]).
fixed(mechanism, proposed, assumed("auctions have nothing to share")).

claim("shared: completed sooner than without, of three and of five",
      [line(5101)],
      ( at([sharing=shared, allocators=3], time < at([sharing=none], time)),
        at([sharing=shared, allocators=5], time < at([sharing=none], time)) )).
claim("shared: fewer communications than without, of three and of five",
      [line(5103)],
      ( at([sharing=shared, allocators=3],
           communications < at([sharing=none], communications)),
        at([sharing=shared, allocators=5],
           communications < at([sharing=none], communications)) )).
claim("own: fewer than without, of three and of five", [ours],
      ( at([sharing=own, allocators=3],
           communications < at([sharing=none], communications)),
        at([sharing=own, allocators=5],
           communications < at([sharing=none], communications)) )).
claim("shared: fewer than own, of three and of five", [ours],
      ( at([sharing=shared, allocators=3],
           communications < at([sharing=own], communications)),
        at([sharing=shared, allocators=5],
           communications < at([sharing=own], communications)) )).

plot(sharing, "Allocators that share what they know",
     lines([x(allocators), y([communications, time, backoffs]),
            line(sharing)])).
