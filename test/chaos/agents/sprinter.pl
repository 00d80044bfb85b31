% Makes a number of journeys without a pause, and ends.

:- agent(sprinter, [state([me/1, tick/1, steps/1, hosts/1, journeys/1])]).
:- include(steps).

main :-
    journeys(N),
    run(N).

run(N) :-
    (   ( N =:= 0 ; halted )
    ->  note(end)
    ;   journey,
        N1 is N-1,
        run(N1)
    ).
