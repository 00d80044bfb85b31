%   Figure 7.4: the density of eligible robots.

:- include(ground).
:- include(competing).

study('7.4', "The density of eligible robots").

vary(mechanism, [proposed, murdoch, anta]).
vary(eligible, [10, 20, 30, 40, 50]).

claim("communications of proposed fall with the density", [line(4976)],
      at([mechanism=proposed], falls(communications, along(eligible)))).
claim("communications of ANTA fall with the density", [line(4976)],
      at([mechanism=anta], falls(communications, along(eligible)))).
claim("communications of Murdoch grow with the density", [line(4977)],
      at([mechanism=murdoch], rises(communications, along(eligible)))).
claim("proposed is completed sooner with more robots", [line(4982)],
      at([mechanism=proposed], falls(time, along(eligible)))).
claim("Murdoch is completed sooner with more robots", [line(4982)],
      at([mechanism=murdoch], falls(time, along(eligible)))).
claim("ANTA is completed sooner with more robots", [line(4982)],
      at([mechanism=anta], falls(time, along(eligible)))).
claim(Text, [line(4979)], Test) :-
    versus(communications, "fewer communications", <, Text, Test).
claim(Text, [line(4983), why("With ten of ten an agent must find every one.")],
      Test) :-
    versus(time, "completed sooner", <, Text, Test).
claim(Text, [line(4983), ours],
      ( at([eligible=20], Test), at([eligible=30], Test),
        at([eligible=40], Test), at([eligible=50], Test) )) :-
    versus(time, "completed sooner", <, Text0, Test),
    string_concat(Text0, ", of 20 and more", Text).
claim("back-offs of proposed fall with the density", [line(5004)],
      at([mechanism=proposed], falls(backoffs, along(eligible)))).
claim("back-offs of proposed get shorter with the density", [line(5004)],
      at([mechanism=proposed], falls(interval, along(eligible)))).
claim("back-offs of Murdoch fall from first to last", [line(5005)],
      at([mechanism=murdoch], falls(backoffs, along(eligible), ends))).
claim("back-offs of ANTA fall from first to last", [line(5005)],
      at([mechanism=anta], falls(backoffs, along(eligible), ends))).
claim("back-off intervals of the auctions follow no pattern", [line(5006)],
      ( \+ at([mechanism=murdoch], falls(interval, along(eligible))),
        \+ at([mechanism=anta], falls(interval, along(eligible))) )).

plot('7.4', "Density of eligible robots",
     lines([ x(eligible), y([communications, time, backoffs, interval]),
             line(mechanism), log(communications), log(time) ])).
