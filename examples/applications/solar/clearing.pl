/*  A call market: all orders are cleared together, at one price.

    An order at(Ct, Trader, Kwh) buys Kwh at that price or less; a negative Kwh
    sells at that price or more.  As much as possible is traded.  If not all
    orders can be filled, those with the better price are first, and orders
    with an equal price get equal shares of their amounts.  The price is the
    middle of the range that all filled orders accept, and all others do not: a
    k-double auction with k = 1/2 (Satterthwaite and Williams, Journal of
    Economic Theory 48, 1989).
*/

%   cleared(+Orders, -Ct, -Traded, -Deals): Deals are pairs Trader-Kwh, and
%   Traded is the amount traded; fails if that is 0.

cleared(Orders, Ct, Traded, Deals) :-
    findall(At-(Trader-Kwh), ( member(at(At, Trader, Kwh), Orders), Kwh > 0 ), Buy),
    findall(At-(Trader-Kwh), ( member(at(At, Trader, Kwh), Orders), Kwh < 0 ), Sell),
    sort(1, @>=, Buy, Falling),
    sort(1, @=<, Sell, Rising),
    levels(Falling, Bids),
    levels(Rising, Offers),
    matched(Bids, Offers, 0, Traded),
    Traded > 0,
    served(Bids, Traded, Bought),
    served(Offers, Traded, Sold),
    middle(Bought, Sold, Ct),
    append(Bought, Sold, Served),
    findall(Trader-Part,
            ( member(level(_, Share, Some), Served),
              member(Trader-Kwh, Some),
              Part is Share*Kwh ),
            Deals).

%   levels(+Orders, -Levels): level(Ct, Sum, Orders) for each price, the best
%   first.

levels(Orders, Levels) :-
    group_pairs_by_key(Orders, Groups),
    findall(level(Ct, Sum, Some),
            ( member(Ct-Some, Groups),
              aggregate_all(sum(abs(Kwh)), member(_-Kwh, Some), Sum) ),
            Levels).

matched([level(Bid, Kwh1, _)|Bids], [level(Offer, Kwh2, _)|Offers], Sum0, Sum) :-
    Bid >= Offer,
    !,
    Sum1 is Sum0 + min(Kwh1, Kwh2),
    Left is Kwh1-Kwh2,
    (   Left > 0
    ->  matched([level(Bid, Left, [])|Bids], Offers, Sum1, Sum)
    ;   More is -Left,
        matched(Bids, [level(Offer, More, [])|Offers], Sum1, Sum)
    ).
matched(_, _, Sum, Sum).

%   served(+Levels, +Traded, -Served): each level with the share of it that is
%   traded.

served([], _, []).
served([level(Ct, Sum, Some)|Levels], Left0, [level(Ct, Share, Some)|Served]) :-
    Share is max(0, min(1, Left0/Sum)),
    Left is Left0-Sum,
    served(Levels, Left, Served).

%   middle(+Bought, +Sold, -Ct): middle of the prices at which no other order
%   would be filled.

middle(Bought, Sold, Ct) :-
    findall(At, ( left(Bought, At) ; traded(Sold, At) ), Low),
    findall(At, ( traded(Bought, At) ; left(Sold, At) ), High),
    max_list(Low, Least),
    min_list(High, Most),
    Ct is (Least+Most)/2.

traded(Levels, Ct) :-
    member(level(Ct, Share, _), Levels),
    Share > 1.0e-9.

left(Levels, Ct) :-
    member(level(Ct, Share, _), Levels),
    Share < 1 - 1.0e-9.
