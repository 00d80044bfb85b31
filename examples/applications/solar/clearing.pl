/*  A call market: all orders are cleared together, at one price.

    An order at(Ct, Trader, Kwh) buys Kwh at that price or less; a negative Kwh sells
    at that price or more.  The price is the one at which most is traded, and where
    that is a range, its middle.  Where not all can be served, those with the better
    price go first, and those with an equal price get equal shares of what they want.
*/

%   cleared(+Orders, -Ct, -Traded, -Deals): Deals are pairs Trader-Kwh, and Traded is
%   what changes hands; it fails if that is nothing.

cleared(Orders, Ct, Traded, Deals) :-
    findall(Ct0-(Trader-Kwh), ( member(at(Ct0, Trader, Kwh), Orders), Kwh > 0 ),
            Bids),
    findall(Ct0-(Trader-Kwh), ( member(at(Ct0, Trader, Kwh), Orders), Kwh < 0 ),
            Offers),
    price(Bids, Offers, Ct, Traded),
    sort(1, @>=, Bids, Falling),
    sort(1, @=<, Offers, Rising),
    group_pairs_by_key(Falling, Highest),
    group_pairs_by_key(Rising, Least),
    filled(Highest, Traded, Bought),
    filled(Least, Traded, Sold),
    append(Bought, Sold, Deals).

price(Bids, Offers, Ct, Traded) :-
    findall(Kwh-At,
            ( ( member(At-_, Bids) ; member(At-_, Offers) ),
              volume(At, Bids, Offers, Kwh) ),
            Volumes),
    max_member(Traded-_, Volumes),
    Traded > 0,
    findall(At, ( member(Kwh-At, Volumes), Kwh > Traded - 1.0e-9 ), Prices),
    min_list(Prices, Low),
    max_list(Prices, High),
    Ct is (Low+High)/2.

volume(Ct, Bids, Offers, Kwh) :-
    aggregate_all(sum(K), ( member(At-(_-K), Bids), At >= Ct ), Demand),
    aggregate_all(sum(-K), ( member(At-(_-K), Offers), At =< Ct ), Supply),
    Kwh is min(Demand, Supply).

%   filled(+Orders, +Left, -Deals): Orders are grouped by price, the best first.

filled([], _, []).
filled([_-Orders|Groups], Left0, Deals) :-
    aggregate_all(sum(abs(Kwh)), member(_-Kwh, Orders), Sum),
    Share is min(1, Left0/Sum),
    findall(Trader-Part, ( member(Trader-Kwh, Orders), Part is Share*Kwh ), Some),
    Left is max(0, Left0-Sum),
    append(Some, More, Deals),
    filled(Groups, Left, More).
