:- agent(murdoch, [state([setting/2])]).
:- include('auctions/participant').

/*  Murdoch (Gerkey and Mataric): an auctioneer announces a task, robots that
    can execute it bid, and the auctioneer awards contracts to the fittest and
    renews them.  As in thesis section 7.5 radio range is not modelled: nodes
    flood all messages, bids included.
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
