% warden.pl: monitors agents, and lists the outcome of each

:- agent(warden, [state([wards/1])]).

main :-
    wards(Agents),
    forall(member(Agent, Agents), monitor(Agent)),
    await(Agents, Ends),
    result(ends(Ends)).

await([], []).
await([_|More], [Agent-Outcome|Ends]) :-
    receive(system-down(Agent, Outcome)),
    await(More, Ends).
