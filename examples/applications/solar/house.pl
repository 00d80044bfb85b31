:- agent(house, [state([keeper/1, house/1, moment/1, least/1])]).

/*  Requests the energy that a house lacks, and offers its surplus.

    The tuple space of its host has meter(Period, Own, Water): the energy of the
    panel beyond the load in the last period, and the energy that the boiler
    still needs, in kWh; and trader(Agent) and grant(Kwh, Ct), which this agent
    leaves.  It expects the values of the last period in the next one.

    In an auction it answers `bids` with bids(Bids), and waits for grant(Kwh,
    Ct). Load is worth the tariff of the grid; energy for the boiler is worth
    more, the less time is left.  With keeper(Agent) and house(Number) it asks
    the keeper of the battery once in each period, at moment(Share), from 0,
    early, to 1, late, or moment(drawn); and only for needs that are worth at
    least Ct, least(Ct).
*/

tariff(30.0).                   % ct/kWh
heater(0.5).                    % kWh in a period
period(900).                    % seconds

main :-
    self(Me),
    leave(trader(Me)),
    ( keeper(_) -> ask ; true ).

on_message(From, bids) :-
    findall(at(Ct, Kwh), ( bid(Ct, Kwh), Kwh =\= 0 ), Bids),
    send(From, bids(Bids)).
on_message(_, grant(Kwh, Ct)) :-
    granted(Kwh, Ct).

granted(Kwh, Ct) :-
    ( take(grant(_, _)) -> true ; true ),
    leave(grant(Kwh, Ct)).

%   bid(-Ct, -Kwh): buys at price Ct or less; a negative Kwh sells.

bid(0.0, Kwh) :-
    needs(Own, Heat),
    Kwh is min(0, Heat-Own).
bid(Tariff, Lack) :-
    tariff(Tariff),
    needs(Own, _),
    Lack is max(0, -Own).
bid(Ct, Kwh) :-
    needs(Own, Heat),
    Kwh is min(Heat, max(0, Heat-Own)),
    tariff(Tariff),
    urgency(Share),
    Ct is Tariff*Share.

needs(Own, Heat) :-
    sense(meter(_, Own, Water)),
    heater(Power),
    Heat is min(Power, Water).

%   0 at 18:00, 1 when the boiler needs its full power until 18:00.

urgency(Share) :-
    sense(meter(Period, _, Water)),
    heater(Power),
    Left is (71-Period) mod 96 + 1,
    Share is max(0, min(1, 1 - (Left - Water/Power)/96)).

ask :-
    moment(Moment),
    ( Moment == drawn -> random(Share) ; Share = Moment ),
    period(Seconds),
    now(Now),
    Wait is Seconds*(floor(Now/Seconds) + 1.1 + 0.7*Share) - Now,
    sleep(Wait),
    wanted(Kwh),
    keeper(Keeper),
    house(Number),
    send(Keeper, ask(Number, Kwh)),
    ( receive(_-granted(Granted), 60) -> granted(Granted, 0) ; true ),
    ask.

wanted(Sum) :-
    least(Least),
    aggregate_all(sum(Kwh), ( bid(Ct, Kwh), ( Kwh < 0 ; Ct >= Least ) ), Sum).
