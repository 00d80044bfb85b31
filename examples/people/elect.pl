% elect.pl: whoever gives the highest number becomes speaker; one on each host

:- agent(elect, [state([question/1])]).

main :-
    question(Question),
    ask(number(Question), Number),
    here(Home),
    leave(rank(Number-Home)),           % of equal numbers the host decides
    run(Number-Home),
    announce(Home),
    result(Home).

run(Mine) :-
    next(Next),
    move(Next),
    rank(Rank),
    (   Rank @> Mine
    ->  dispose
    ;   Rank @< Mine
    ->  run(Mine)
    ;   true                            % its own host again
    ).

announce(Speaker) :-
    show(speaker(Speaker)),
    next(Next),
    (   Next == Speaker
    ->  true
    ;   move(Next),
        announce(Speaker)
    ).

rank(Rank) :-
    sense(rank(Rank)),
    !.
rank(Rank) :-                           % the person here has yet to answer
    sleep(0.5),
    rank(Rank).

next(Host) :- sense(next(Host)), !.
