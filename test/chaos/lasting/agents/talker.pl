% Counts aloud to a sink.

:- agent(talker, [state([todo/1, said/1, sink/1])]).

said(0).

main :-
    said(N),
    todo(N),
    !,
    result(said(N)).
main :-
    retract(said(N0)),
    N is N0+1,
    assertz(said(N)),
    sink(Sink),
    self(Me),
    send(Sink, word(Me, N)),
    sleep(0.01),
    main.
