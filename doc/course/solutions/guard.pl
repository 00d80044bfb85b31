% guard.pl: waits for a worker, and takes over when the worker is silent

:- agent(guard, []).

main :-
    watch(0).

watch(Last) :-
    (   receive(_-Message, 5)
    ->  heard(Message)
    ;   result(took_over(Last))
    ).

heard(beat(N)) :-
    watch(N).
heard(done(What)) :-
    result(done(What)).
