:- agent(anta, [state([setting/2, tree/3, way/3, gathered/4])]).
:- include('auctions/participant').

/*  ANTA (Lee, Zaheer, Kim): the trade message spreads as a tree, down to a
    level; bids go up the tree, nodes merge them and pass on only the lowest
    ones; awards go down the tree (thesis section 7.5).  Each round has a tree
    of its own.  If the next neighbour on the way of a message has ended or is
    unknown, the node floods the message instead.

    A node reports to its parent once, when its children must have reported:
    nodes of the last level first.  So the time for bids is divided by twice
    the number of levels, half for the way down, half for the way up.

    State: tree(Job, Round, Parent), Parent is `none` at the root;
    way(Job, Host, Child), Child is the neighbour on the way to Host;
    gathered(Job, Round, Host, Bids), not yet reported.
*/

                /*******************************
                *            TRADES            *
                *******************************/

publish(announce(Job, Round, Offer)) :-
    now(Now),
    planted(Job, Round, none),
    to_robot(announce(Job, Round, Offer)),
    flood(announce(Job, Round, Offer, Now, 1)).

%   Trade messages are floods that count levels; other floods reach all nodes.

onward(announce(Job, Round, Offer, Begin, Level0), Onward) :-
    !,
    parameter(level, Levels),
    Level0 < Levels,
    Level is Level0 + 1,
    Onward = announce(Job, Round, Offer, Begin, Level).
onward(Body, Body).

planted(Job, Round, Parent) :-
    retractall(gathered(Job, _, _, _)),
    parameter(jobs, Most),
    (   tree(Job, _, _)
    ->  retractall(tree(Job, _, _)),
        assertz(tree(Job, Round, Parent))
    ;   forget_ways(Most),
        make_room(tree(_, _, _), Most),
        assertz(tree(Job, Round, Parent))
    ).

%   Called before the oldest tree is removed.

forget_ways(Most) :-
    (   kept(tree, Most),
        tree(Job, _, _)
    ->  retractall(way(Job, _, _))
    ;   true
    ).

                /*******************************
                *             BIDS             *
                *******************************/

%   Level is the level of this node; neighbours of the root have level 1.

traded(Job, Round, Offer, Begin, Level, From) :-
    planted(Job, Round, From),
    Offer = offer(_, _, Places, _, Close),
    parameter(level, Levels),
    Report is Begin + (Close - Begin)*(2*Levels - Level)/(2*Levels),
    at(Report, gather(Job, Round, Places)),
    to_robot(announce(Job, Round, Offer)).

offer_bids(Job, Round, Bids) :-
    here(Here),
    take_bids(Job, Round, [Here-Bids]).

%   take_bids(+Job, +Round, +List): keeps the bids for the report, or hands
%   them to the auctioneer.  Bids that arrive after the report are passed up
%   at once.

take_bids(Job, Round, List) :-
    Job = job(Owner, _),
    (   here(Owner)
    ->  to_owner(Job, bids(Round, List))
    ;   tree(Job, Round, _),
        \+ reported(Job, Round)
    ->  forall(member(Host-Bids, List),
               assertz(gathered(Job, Round, Host, Bids)))
    ;   pass_up(Job, bids(Round, List))
    ).

reported(Job, Round) :-
    gathered(Job, Round, none, _).

gather(Job, Round, Places) :-
    tree(Job, Round, _),
    findall(Host-Bids, retract(gathered(Job, Round, Host, Bids)), All),
    assertz(gathered(Job, Round, none, [])),
    lowest(Places, All, List),
    (   List == []
    ->  true
    ;   pass_up(Job, bids(Round, List))
    ).

%   lowest(+Places, +All, -List): the bids that can still win.  A robot that
%   is best for two teams can join only one, so for each team as many bids are
%   kept as robots are needed in all teams together.

lowest(Places, All, List) :-
    findall(Count, member(_-Count, Places), Counts),
    sum_list(Counts, Needed),
    findall(Host,
            ( member((Number-_)-_, Places),
              best(Number, Needed, All, Host) ),
            Hosts),
    findall(Host-Bids,
            ( member(Host-Bids, All), memberchk(Host, Hosts) ),
            List).

best(Number, Count, All, Host) :-
    findall(Cost-H, ( member(H-Bids, All), memberchk(Number-Cost, Bids) ),
            Offers0),
    sort(Offers0, Offers),
    nth1(I, Offers, _-Host),
    I =< Count.

                /*******************************
                *       UP AND DOWN THE TREE   *
                *******************************/

tell_owner(Job, Body) :-
    Job = job(Owner, _),
    (   here(Owner)
    ->  to_owner(Job, Body)
    ;   pass_up(Job, Body)
    ).

pass_up(Job, Body) :-
    (   tree(Job, _, Parent),
        Parent \== none,
        now(Now),
        cross(Parent, owner(Job, Body), Now)
    ->  true
    ;   flood(flooded(owner(Job, Body)))
    ).

%   Where the ways of a message for several hosts part, each child gets the
%   message for the hosts on its way.

tell_robots(Job, Hosts, Body) :-
    here(Here),
    (   memberchk(Here, Hosts)
    ->  to_robot(Body)
    ;   true
    ),
    findall(Child-Host,
            ( member(Host, Hosts), Host \== Here,
              (   way(Job, Host, Child)
              ->  true
              ;   Child = none
              ) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    group_pairs_by_key(Pairs, Groups),
    pass_down(Groups, Job, Body, Left),
    (   Left == []
    ->  true
    ;   flood(flooded(robots(Job, Left, Body)))
    ).

pass_down([], _, _, []).
pass_down([Child-Hosts|Groups], Job, Body, Left) :-
    now(Now),
    (   Child \== none,
        cross(Child, robots(Job, Hosts, Body), Now)
    ->  Left = Left1
    ;   append(Hosts, Left1, Left)
    ),
    pass_down(Groups, Job, Body, Left1).

%   arrived(+Body, +From, +Now): From is the neighbour that sent Body.

arrived(announce(Job, Round, Offer, Begin, Level), From, _) :-
    !,
    traded(Job, Round, Offer, Begin, Level, From).
arrived(flooded(Body), _, _) :-
    !,
    everywhere(Body).
arrived(owner(Job, bids(Round, List)), From, _) :-
    !,
    forall(member(Host-_, List),
           ( retractall(way(Job, Host, _)), assertz(way(Job, Host, From)) )),
    take_bids(Job, Round, List).
arrived(owner(Job, Body), _, _) :-
    !,
    tell_owner(Job, Body).
arrived(robots(Job, Hosts, Body), _, _) :-
    tell_robots(Job, Hosts, Body).

%   A message that was flooded because of a broken tree concerns only its
%   receivers.

everywhere(owner(Job, Body)) :-
    Job = job(Owner, _),
    here(Owner),
    !,
    (   Body = bids(_, List)
    ->  forall(member(Host-_, List), retractall(way(Job, Host, _)))
    ;   true
    ),
    to_owner(Job, Body).
everywhere(robots(_, Hosts, Body)) :-
    here(Here),
    memberchk(Here, Hosts),
    !,
    to_robot(Body).
everywhere(_).

undertake(gather(Job, Round, Places), _) :-
    gather(Job, Round, Places).
