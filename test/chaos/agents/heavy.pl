% Travels with thousands of facts, and counts them on each host.

:- agent(heavy,
         [state([me/1, tick/1, steps/1, hosts/1, heard/1, load/1,
                 ballast/2])]).
:- include(steps).
:- include(mail).

main :-
    load(Count),
    forall(between(1, Count, I),
           ( format(string(Text), "what number ~d says", [I]),
             assertz(ballast(I, Text)) )),
    travel.

travel :-
    count,
    (   halted
    ->  true
    ;   journey,
        sleep(0.1),
        travel
    ).

count :-
    load(Count),
    aggregate_all(count-sum(I), ballast(I, _), Sums),
    Sum is Count*(Count+1)//2,
    (   Sums == Count-Sum
    ->  true
    ;   note(wrong(ballast(Sums)))
    ).
