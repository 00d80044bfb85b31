%   Chapter 7: statements of sections 7.6.1 and 7.6.3 on the proposed
%   mechanism compared with the others.
%
%   Gives: competing/3, versus/6.

:- use_module(library(lists), [member/2]).

%   competing(-Text, -Notes, -Test): claims for one to five allocators.

competing("proposed: fewer than 10,000 communications with five allocators",
          [line(4866)],
          at([mechanism=proposed, allocators=5], communications < 10000)).
competing("Murdoch: more than 50,000 communications with five allocators",
          [line(4867)],
          at([mechanism=murdoch, allocators=5], communications > 50000)).
competing(Text, [line(4864)],
          at([mechanism=M], rises(communications, along(allocators)))) :-
    member(M-Title,
           [proposed-"proposed", murdoch-"Murdoch", anta-"ANTA"]),
    format(string(Text), "communications of ~w grow", [Title]).
competing(Text, [line(4868)],
          at([mechanism=proposed, allocators=5],
             rise(communications, along(allocators)) <
             at([mechanism=M], rise(communications, along(allocators))))) :-
    auction(M, Title),
    format(string(Text), "communications of ~w rise more sharply", [Title]).
competing("proposed: back-offs are longer with more allocators",
          [line(4891)],
          at([mechanism=proposed], rises(interval, along(allocators)))).
competing(Text, Notes, Test) :-
    member(said(Measure, What, Order, Line),
           [ said(communications, "fewer communications", <, 4866),
             said(time, "completed sooner", <, 4882),
             said(backoffs, "more back-offs", >, 4887),
             said(interval, "shorter back-offs", <, 4888) ]),
    versus(Measure, What, Order, Text0, Test0),
    with_allocators(Measure, Line, Text0-Test0, Text, Notes, Test).

%   versus(+Measure, +What, +Order, -Text, -Test): compares the proposed
%   mechanism with an auction.

versus(Measure, What, Order, Text, at([mechanism=proposed], Test)) :-
    auction(Auction, Title),
    Test =.. [Order, Measure, at([mechanism=Auction], Measure)],
    format(string(Text), "~w with proposed than with ~w", [What, Title]).

auction(murdoch, "Murdoch").
auction(anta, "ANTA").

%   One claim for one to five allocators, and one for the several that compete.

with_allocators(_, Line, Text0-Test, Text, [line(Line)|Notes], Test) :-
    alone(Notes),
    string_concat(Text0, ", of one to five", Text).
with_allocators(Measure, Line, Text0-Test, Text, [line(Line), ours],
                ( at([allocators=2], Test), at([allocators=3], Test),
                  at([allocators=4], Test), at([allocators=5], Test) )) :-
    member(Measure, [communications, time]),
    string_concat(Text0, ", of two to five", Text).

alone([why("An undisturbed auction takes three floods and the \c
execution; an agent has to meet ten robots, host by host.")]).
