:- agent(murdoch, [ state([ setting/2, peer/2, agenda/2, item/2, wave/2,
                            kept/2, next_id/1, sent/2, hold/4, asked/4,
                            contract/6, over/2, job/6, member/6, bid/4,
                            allocated/1, renewal/2 ]) ]).
:- include(node).

/*  Murdoch (Gerkey and Mataric): tasks are announced, those who can do them
    bid, the fittest get a contract that the auctioneer renews.  As in thesis
    section 7.5 there is no range in which a message is heard: all of them
    are flooded, the bids, too.
*/

publish(Body) :-
    to_robot(Body),
    flood(Body).

tell_robots(_, _, Body) :-
    to_robot(Body),
    flood(Body).

tell_owner(Job, Body) :-
    Job = job(Owner, _),
    (   here(Owner)
    ->  to_owner(Job, Body)
    ;   flood(owner(Job, Body))
    ).

offer_bids(Job, Round, Bids) :-
    here(Here),
    tell_owner(Job, bids(Round, [Here-Bids])).

arrived(owner(Job, Body), _, _) :-
    !,
    Job = job(Owner, _),
    (   here(Owner)
    ->  to_owner(Job, Body)
    ;   true
    ).
arrived(Body, _, _) :-
    to_robot(Body).

onward(Body, Body).

undertake(_, _) :-
    fail.
