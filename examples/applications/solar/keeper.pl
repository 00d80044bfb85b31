:- agent(keeper, [state([given/2])]).

/*  Grants energy and free capacity of the battery in the order of requests.
    The tuple space has battery(Period, Level, Capacity, In, Out): In and Out
    are the energies that it can take and give in this period, in kWh.
*/

overlay('granted, kWh', bar, log(granted(House, Kwh)), House-add(abs(Kwh))).

main :-
    receive(From-ask(House, Kwh)),
    sense(battery(Period, _, _, In, Out)),
    ( retract(given(Period, Sum0)) -> true ; Sum0 = 0 ),
    Granted is min(Out-Sum0, max(-In-Sum0, Kwh)),
    Sum is Sum0+Granted,
    retractall(given(_, _)),
    assertz(given(Period, Sum)),
    send(From, granted(Granted)),
    log(granted(House, Granted)),
    main.
