:- agent(auctioneer, [state([home/1, seen/1, order/3, deal/3])]).
:- include(clearing).

/*  Holds an auction of energy in each period: moves from house to house to
    collect bids, clears the market at the battery, its home, and moves round
    again with the grant of each house, and the price.

    It needs no map: from each host it moves to a neighbour that it has not
    visited in this round, else back along its trail.  So a broken link only
    makes the way longer, and only unreachable houses are left out.
*/

overlay('price, ct', label, log(cleared(Price, _, _)), Price).
overlay('traded, kWh', bar, log(cleared(_, Kwh, _)), battery-add(Kwh)).

period(900).                    % seconds
begins(60).                     % seconds from the start of a period
tariff(30.0).                   % ct/kWh
round_trip(0.85).               % share of stored energy that can be used

main :-
    here(Home),
    assertz(home(Home)),
    hold.

hold :-
    period(Seconds),
    begins(After),
    now(Now),
    Wait is Seconds*(floor(Now/Seconds)+1) + After - Now,
    sleep(Wait),
    retractall(order(_, _, _)),
    retractall(deal(_, _, _)),
    round(collect),
    clear,
    round(deliver),
    hold.

clear :-
    findall(at(Ct, House, Kwh), order(Ct, House, Kwh), Orders),
    findall(at(Ct, battery, Kwh), step(Ct, Kwh), Steps),
    append(Orders, Steps, All),
    cleared(All, Ct, Traded, Deals),
    !,
    forall(( member(House-Kwh, Deals), House \== battery ),
           assertz(deal(House, Kwh, Ct))),
    hops(Hops),
    log(cleared(Ct, Traded, Hops)).
clear.

%   The fuller the battery, the lower are its buying and selling prices.

step(Ct, Kwh) :-
    sense(battery(_, Level, Capacity, In, Out)),
    tariff(Tariff),
    round_trip(Share),
    between(1, 5, N),
    (   Kwh is In/5,
        Ct is Tariff*Share*(1 - (Level + (N-0.5)*In/5)/Capacity)
    ;   Kwh is -Out/5,
        Ct is Tariff*(1 - (Level - (N-0.5)*Out/5)/Capacity)
    ).

                /*******************************
                *            ROUNDS            *
                *******************************/

round(deliver) :-
    \+ deal(_, _, _),
    !.
round(Do) :-
    retractall(seen(_)),
    home(Home),
    assertz(seen(Home)),
    walk(Do, []).

%   walk(+Do, +Trail): Trail are the hosts on the way back home.

walk(Do, Trail) :-
    here(Here),
    neighbours(Hosts),
    (   member(Next, Hosts),
        \+ seen(Next)
    ->  assertz(seen(Next)),
        ( moved(Next) -> do(Do), walk(Do, [Here|Trail]) ; walk(Do, Trail) )
    ;   Trail == []
    ->  true
    ;   back(Trail, Hosts, Back, Rest),
        ( moved(Back) -> walk(Do, Rest) ; sleep(60), walk(Do, Trail) )
    ).

moved(Host) :-
    catch(move(Host), error(_, _), fail).

back(_, Hosts, Home, []) :-
    home(Home),
    memberchk(Home, Hosts),
    !.
back([Back|Rest], _, Back, Rest).

do(collect) :-
    (   once(sense(trader(House))),
        send(House, bids),
        receive(House-bids(Bids), 30)
    ->  forall(member(at(Ct, Kwh), Bids), assertz(order(Ct, House, Kwh)))
    ;   true
    ).
do(deliver) :-
    sense(trader(House)),
    deal(House, _, Ct),
    !,
    aggregate_all(sum(Kwh), deal(House, Kwh, _), Sum),
    send(House, grant(Sum, Ct)).
do(deliver).
