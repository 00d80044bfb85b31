%   Figure 7.5: the size of the network, and with it the number of robots.

:- include(ground).

study('7.5', "The size of the network, 1:2:10").
text("Two of ten hosts have eligible robots, and each allocator requires half \c
of these.  Murdoch and ANTA are included because the thesis compares the \c
largest network with theirs of half the size.").

vary(mechanism, [proposed, murdoch, anta]).
vary(hosts, [50, 100, 150, 200]).
skip(Case) :-
    Case.mechanism \== proposed,
    Case.hosts =\= 100.
derive(eligible, Case, N) :- N is Case.hosts // 5.
derive(required, Case, N) :- N is Case.hosts // 10.

claim("communications grow with the size", [line(5023)],
      at([mechanism=proposed], rises(communications, along(hosts)))).
claim("the time grows with the size", [line(5024)],
      at([mechanism=proposed], rises(time, along(hosts)))).
claim("fewer than 20,000 communications on the largest network", [line(5026)],
      at([mechanism=proposed, hosts=200], communications < 20000)).
claim("fewer communications than Murdoch on half the network", [line(5026)],
      at([mechanism=proposed, hosts=200],
         communications < at([mechanism=murdoch, hosts=100], communications))).
claim("fewer communications than ANTA on half the network", [line(5026)],
      at([mechanism=proposed, hosts=200],
         communications < at([mechanism=anta, hosts=100], communications))).
claim("time for each required robot falls slightly, from first to last",
      [line(5032)],
      at([mechanism=proposed], falls(rate, along(hosts), ends))).

plot('7.5', "Size of the network",
     lines([ x(hosts), y([communications, time, rate]), line(mechanism),
             rule(communications, 20000) ])).
