% claim.pl: finds a host that no other agent has

:- agent(claim, []).

main :-
    (   leave_new(claimed)
    ->  self(Me),
        leave(owner(Me)),
        here(Host),
        result(Host)
    ;   next_host(conscientious, Next),
        move(Next),
        main
    ).
