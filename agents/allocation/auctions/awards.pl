% Expects: nothing; pure.
% Gives: winners/3, becomes/3, later_phase/3.

/*  Which nodes get a contract, and how reports change the phase of a robot.
*/

%!  winners(+Places, +Bids, -Winners) is semidet.
%
%   Winners are the cheapest bidders, chosen team by team.  Bids are
%   Host-Bids, Winners Host-Number.

winners([], _, []).
winners([(Number-_)-Count|Places], Bids0, Winners) :-
    findall(Cost-Host,
            ( member(Host-Bids, Bids0), memberchk(Number-Cost, Bids) ),
            Offers0),
    sort(Offers0, Offers),
    length(Chosen, Count),
    append(Chosen, _, Offers),
    !,
    findall(Host-Number, member(_-Host, Chosen), Team),
    findall(Host-Bids,
            ( member(Host-Bids, Bids0), \+ memberchk(Host-_, Team) ),
            Bids1),
    winners(Places, Bids1, More),
    append(Team, More, Winners).

%!  becomes(+Before, +Phase, -After) is semidet.
%
%   A robot that has executed its part stays `done`, even if it is lost later.

becomes(done, _, done) :-
    !.
becomes(Before, Phase, After) :-
    later_phase(Before, Phase, After).

%!  later_phase(+Before, +Phase, -After) is semidet.
%
%   After is the later of the two phases, since reports arrive in any order.

later_phase(Before, Phase, After) :-
    Order = [awarded, reserved, executing, done],
    nth1(I, Order, Before),
    nth1(J, Order, Phase),
    !,
    Last is max(I, J),
    nth1(Last, Order, After).
