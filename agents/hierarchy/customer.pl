:- agent(customer, [state([round/1, part/2])]).

/*  Asks leaders for a round of work, and ends when all leaders have served it.
    Facts: round(Round), part(Leader, Hosts).
*/

main :-
    round(Round),
    log(asks(Round)),
    findall(Leader, part(Leader, _), Leaders),
    forall(part(Leader, Hosts), send(Leader, serve(Round, Hosts))),
    wait(Leaders, Round),
    log(served(Round)).

wait([], _).
wait([Leader|Leaders], Round) :-
    receive(Leader-served(Round)),
    wait(Leaders, Round).
