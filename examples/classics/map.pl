% map.pl: positions of the towns, without the roads

:- payload(map, []).

at(harbour, 0, 0).
at(mill, 2, 4).
at(inn, 5, 1).
at(abbey, 6, 5).
at(ford, 8, 2).
at(castle, 10, 4).
