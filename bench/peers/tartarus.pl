:- use_module('../common').
:- use_module('../tartarus_ring').

/*  The original Tartarus for bench/peers.pl: the agent of
    tartarus_walker.pl, which moves round a ring of four platforms with its
    clauses. An agent that goes back and forth between two does not return. */

:- initialization(main, main).

main([hops]) :-
    with_ring(4, hops).

hops(Nodes) :-
    round_trip(Nodes, 1, 400, _),       % warm up
    measured(hops_with_program(one), 2000, round_trip(Nodes, 2, 2000, _)),
    told(version('Tartarus')).
