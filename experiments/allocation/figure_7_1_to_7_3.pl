%   Figures 7.1 to 7.3: allocators that compete for the same robots.

:- include(ground).
:- include(competing).

study('7.1', "Allocators that compete for the same robots").
text("Each allocator requires 10 of 15 robots among 100 hosts, so no two can \c
have them at once.  Constant back-off, in Figure 7.3, is the back-off of the \c
auctions (equation 7.7), used by the agents of the thesis.").

vary(links, [dynamic, static]).
vary(mechanism, [proposed, constant, murdoch, anta]).
vary(allocators, [1, 2, 3, 4, 5]).
skip(Case) :-
    Case.links == static,
    Case.mechanism == constant.

real([links=(dynamic), mechanism=proposed, allocators=2],
     [clock=4, processes=2]).

printed(backoffs, [links=dynamic, mechanism=proposed, allocators=1], 2.6).
printed(interval, [links=dynamic, mechanism=proposed, allocators=1], 5.16).

%   Claims of `competing`, for both figures.

claim(Text, Notes, at([links=Links], Test)) :-
    member(Links-Figure, [(dynamic)-'7.1', static-'7.2']),
    competing(Text0, Notes, Test),
    format(string(Text), "~w, ~w: ~w", [Figure, Links, Text0]).

claim("7.1: ANTA: more than 50,000 communications with five allocators",
      [line(4867)],
      at([links=dynamic, mechanism=anta, allocators=5],
         communications > 50000)).
claim("7.1: a single allocator backs off 2.6 times, within 1", [line(4892)],
      at([links=dynamic, mechanism=proposed, allocators=1],
         near(backoffs, 2.6, 1))).
claim("7.1: a single allocator backs off for 5.16 s, within 1 s", [line(4893)],
      at([links=dynamic, mechanism=proposed, allocators=1],
         near(interval, 5.16, 1))).

claim("7.2: communications of proposed as on the dynamic network, from half \c
to twice", [line(4901)],
      at([links=static, mechanism=proposed],
         between(communications/at([links=dynamic], communications), 1/2, 2))).
claim("7.2: communications of Murdoch as on the dynamic network", [line(4901)],
      at([links=static, mechanism=murdoch],
         between(communications/at([links=dynamic], communications), 1/2, 2))).
claim("7.2: communications of ANTA less than half, five allocators",
      [line(4902)],
      at([links=static, mechanism=anta, allocators=5],
         communications < at([links=dynamic], communications)/2)).
claim("7.2: proposed performs equally well, with five in half to twice the \c
time", [line(4908)],
      at([links=static, mechanism=proposed, allocators=5],
         between(time/at([links=dynamic], time), 1/2, 2))).

claim("7.3: adaptive always has more communications than constant",
      [line(4921)],
      at([links=dynamic, mechanism=proposed],
         communications > at([mechanism=constant], communications))).
claim("7.3: the times follow almost the same trend: both rise, one by less \c
than twice the other", [line(4929)],
      at([links=dynamic, mechanism=proposed, allocators=5],
         ( rise(time, along(allocators)) > 0,
           between(at([mechanism=constant], rise(time, along(allocators)))
                   / rise(time, along(allocators)), 1/2, 2) ))).

plot('7.1', "Allocators on a dynamic network", lines(Options)) :-
    compared([links=dynamic], [proposed, murdoch, anta], Options).
plot('7.2', "Allocators on a static network", lines(Options)) :-
    compared([links=static], [proposed, murdoch, anta], Options).
plot('7.3', "Adaptive and constant back-off",
     lines([x(allocators), y([communications, time]), line(mechanism),
            where([links=dynamic, mechanism=in([proposed, constant])])])).

compared(Where, Mechanisms,
         [ x(allocators), y([communications, time, backoffs, interval]),
           line(mechanism), where([mechanism=in(Mechanisms)|Where]),
           log(communications), rule(communications, 10000),
           rule(communications, 50000) ]).
