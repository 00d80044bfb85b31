% roads.pl: the same towns, and the roads between them

road(harbour, mill, 5).
road(harbour, inn, 6).
road(mill, abbey, 5).
road(inn, abbey, 7).
road(inn, ford, 4).
road(ford, castle, 3).
road(abbey, castle, 9).

roads(Network) :-
    findall(A-B, road(A, B, _), Edges),
    network_start(edges(Edges), Network, [clock(virtual), seed(1)]),
    forall(road(A, B, Km), ( lay(A, B, Km), lay(B, A, Km) )).

lay(From, To, Km) :-
    remote(From, leave(road(To, Km))).
