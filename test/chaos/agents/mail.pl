% Common part of agents that receive messages: m(Sender, K) is the K-th
% message from Sender to this agent.

hear :-
    (   receive(_-m(Sender, K), 0)
    ->  heard_from(Sender, K),
        hear
    ;   true
    ).

heard_from(Sender, K) :-
    retract(heard(N0)),
    !,
    N is N0+1,
    assertz(heard(N)),
    note(got(Sender, K)).

on_message(_, m(Sender, K)) :-
    heard_from(Sender, K).
on_message(_, _).
