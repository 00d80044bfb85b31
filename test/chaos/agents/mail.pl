% What agents have in common that can be written to: m(Who, K) is the K-th
% message from Who to this agent.

hear :-
    (   receive(_-m(Who, K), 0)
    ->  heard_from(Who, K),
        hear
    ;   true
    ).

heard_from(Who, K) :-
    retract(heard(N0)),
    !,
    N is N0+1,
    assertz(heard(N)),
    note(got(Who, K)).

on_message(_, m(Who, K)) :-
    heard_from(Who, K).
on_message(_, _).
