% Waits in all possible ways. Orders from outside move it.

:- agent(sleeper, [state([me/1, tick/1, steps/1, hosts/1, heard/1])]).
:- include(steps).
:- include(mail).

main :-
    (   halted
    ->  true
    ;   wait,
        note(awake),
        main
    ).

wait :-
    random(X),
    Seconds is X/4,
    (   X < 0.3
    ->  sleep(Seconds)
    ;   receive(_-m(Sender, K), Seconds)
    ->  heard_from(Sender, K)
    ;   true
    ).
