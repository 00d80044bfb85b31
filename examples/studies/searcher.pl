% One of several agents that search. See search.pl.

:- agent(searcher, [state([pause/1])]).

main :-
    walk(400).

walk(0).
walk(N) :-
    N > 0,
    log(here),
    pause(Pause),
    sleep(Pause),
    next_host(conscientious, Next),
    move(Next),
    N1 is N-1,
    walk(N1).
