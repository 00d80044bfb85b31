% Goes so many hops, with each fourth counts at the host, and tells a sink.

:- agent(hopper, [state([todo/1, route/1, sink/1, made/1])]).
:- include(route).

made(0).

main :-
    made(N),
    todo(N),
    !,
    result(made(N)).
main :-
    go_on,
    retract(made(N0)),
    N is N0+1,
    assertz(made(N)),
    told(N),
    main.

told(N) :-
    N mod 4 =:= 0,
    !,
    count,
    sink(Sink),
    self(Me),
    send(Sink, hop(Me, N)).
told(_).

count :-
    take(visits(V0)),
    !,
    V is V0+1,
    leave(visits(V)).
count :-
    leave(visits(1)).
