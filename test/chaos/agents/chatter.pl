% Writes numbered messages to its friends, and travels if it is restless.

:- agent(chatter,
         [state([me/1, tick/1, steps/1, hosts/1, heard/1, restless/1,
                 friends/1, said/2])]).
:- include(steps).
:- include(mail).

main :-
    (   receive(_-friends(Friends), 0.5)
    ->  assertz(friends(Friends)),
        go_on
    ;   halted
    ->  true
    ;   main
    ).

go_on :-
    hear,
    (   halted
    ->  true
    ;   friends(Friends),
        tell_all(Friends),
        wander,
        go_on
    ).

wander :-
    (   restless(true)
    ->  journey,
        sleep(0.02)
    ;   sleep(0.05)
    ).

tell_all([]).
tell_all([Who-Id|Friends]) :-
    tell(Who, Id),
    tell_all(Friends).

% What could not be sent has not been said.

tell(Who, Id) :-
    (   retract(said(Who, K0))
    ->  true
    ;   K0 = 0
    ),
    K is K0+1,
    assertz(said(Who, K)),
    me(Me),
    note(said(Who, K)),
    catch(send(Id, m(Me, K)), error(Why, _), unsaid(Who, K, Why)).

unsaid(Who, K, Why) :-
    note(unsaid(Who, K, Why)),
    retract(said(Who, K)),
    K0 is K-1,
    assertz(said(Who, K0)).
