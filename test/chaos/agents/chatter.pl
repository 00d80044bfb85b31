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
tell_all([Friend-Id|Friends]) :-
    tell(Friend, Id),
    tell_all(Friends).

% A message that could not be sent does not count.

tell(Friend, Id) :-
    (   retract(said(Friend, K0))
    ->  true
    ;   K0 = 0
    ),
    K is K0+1,
    assertz(said(Friend, K)),
    me(Me),
    note(said(Friend, K)),
    catch(send(Id, m(Me, K)), error(Why, _), unsaid(Friend, K, Why)).

unsaid(Friend, K, Why) :-
    note(unsaid(Friend, K, Why)),
    retract(said(Friend, K)),
    K0 is K-1,
    assertz(said(Friend, K0)).
