% Expects: task/3, agreed/3, backoffs/1; lib; messages, held_robots, news,
%   rewards.
% Gives: negotiate/0.

/*  Negotiation with the robot on this host: the agent of the robot returns
    the cost of the task, the payload of the allocator decides whether it
    agrees, and then the allocator reserves the robot.
*/

%!  negotiate is det.

negotiate :-
    here(Host),
    \+ held(Host, _, _, _, _),
    \+ avoided(Host),
    sense(robot(Robot)),
    !,
    open_teams(Open),
    approach(Open, Robot).
negotiate.

%   A robot that is unfit for one team may be fit for another.

approach([], _).
approach([Team-Requirements|Open], Robot) :-
    task(Name, _, Details),
    Need = need(Name, Requirements, Details),
    self(Me),
    hops(Hops),
    backoffs(Backoffs),
    Ref = ref(Me, Backoffs, Hops, Team),
    ask(Robot, Ref, ask(Ref, Need), Answer),
    (   Answer == refused(unfit)
    ->  approach(Open, Robot)
    ;   negotiated(Answer, Robot, Ref, Need)
    ).

negotiated(bid(Cost), Robot, Ref, Need) :-
    Need = need(_, _, Details),
    backoffs(Backoffs),
    agreed(Cost, Details, Backoffs),
    !,
    reserve(Robot, Ref, Need).
negotiated(refused(Reason), _, _, Need) :-
    memberchk(Reason, [reserved, executing]),
    !,
    taken(Need),
    penalty.
negotiated(_, _, _, _).

reserve(Robot, Ref, Need) :-
    self(Me),
    ask(Robot, Ref, reserve(Ref, Me, Need), Answer),
    taken(Need),
    settle(Answer, Robot, Ref).

taken(need(_, Requirements, _)) :-
    here(Host),
    learn(Host, Requirements, taken).

settle(reserved, Robot, Ref) :-
    !,
    reserved(Before),
    here(Host),
    Ref = ref(_, _, _, Team),
    assertz(held(Host, Robot, Ref, Team, reserved)),
    reward(Before).
settle(refused(_), _, _) :-
    !,
    penalty.
settle(silence, Robot, Ref) :-
    ignore(tell(Robot, release(Ref))).
