% Waits in all the ways there are. Where it is, others decide.

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
    ;   receive(_-m(Who, K), Seconds)
    ->  heard_from(Who, K)
    ;   true
    ).
