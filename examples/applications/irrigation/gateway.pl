:- agent(gateway, [state([field/2, centre/2, hour/1])]).

/*  Passes readings of a field to the agent at centre(Host, Agent), and its
    orders to the valve, while there is a link.
*/

hour(-1).

main :-
    field(_, Number),
    topic(Number, moisture, Topic),
    subscribe(Topic, [as(latest)]),
    serve(Number).

serve(Number) :-
    (   receive(_-valve(Mm), 1800)
    ->  topic(Number, valve, Topic),
        publish(Topic, _{mm:Mm})
    ;   pass_on(Number)
    ),
    serve(Number).

pass_on(Number) :-
    topic(Number, moisture, Topic),
    hour(Before),
    centre(Host, Agent),
    neighbours(Hosts),
    memberchk(Host, Hosts),
    sense(mqtt-message(Topic, Reading, _)),
    get_dict(hour, Reading, Hour),
    Hour > Before,
    !,
    retractall(hour(_)),
    assertz(hour(Hour)),
    send(Agent, reading(Reading)).
pass_on(_).

topic(Number, Name, Topic) :-
    format(atom(Topic), 'field/~w/~w', [Number, Name]).
