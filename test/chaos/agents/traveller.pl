% Travels as fast as it can, and takes and leaves tokens on its way.

:- agent(traveller,
         [state([me/1, tick/1, steps/1, hosts/1, heard/1, token/1])]).
:- include(steps).
:- include(mail).

main :-
    (   halted
    ->  true
    ;   journey,
        trade,
        pause,
        main
    ).

% A token is in one hand or on one host. A drop is recorded: if it is undone
% together with all later steps, another agent may already have the token.

trade :-
    random(X),
    (   X < 0.3
    ->  ignore(drop)
    ;   X < 0.6
    ->  ignore(pick_up)
    ;   true
    ).

drop :-
    retract(token(K)),
    !,
    note(drops(K)),
    leave(token(K)).

pick_up :-
    take(token(K)),
    assertz(token(K)).

pause :-
    random(X),
    (   X < 0.5
    ->  true
    ;   Seconds is X/50,
        sleep(Seconds)
    ).
