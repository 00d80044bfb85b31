% manager.pl: awards a task to the lowest offer that comes in time

:- agent(manager, [state([contractors/1, task/2])]).

main :-
    task(Task, Kind),
    contractors(Contractors),
    send_all(Contractors, announce(Task, Kind)),
    now(Now),
    Deadline is Now+5,
    collect(Contractors, Task, Deadline, Bids),
    award(Bids, Task).

send_all([], _).
send_all([Agent|Agents], Message) :-
    send(Agent, Message),
    send_all(Agents, Message).

%   collect(+Silent, +Task, +Deadline, -Bids): Silent have not answered yet.

collect([], _, _, []) :-
    !.
collect(Silent, Task, Deadline, Bids) :-
    now(Now),
    Left is max(0, Deadline-Now),
    (   receive(Agent-Answer, Left)
    ->  heard(Answer, Agent, Task, Silent, Rest, Bids, More),
        collect(Rest, Task, Deadline, More)
    ;   Bids = []
    ).

heard(bid(Task, Cost), Agent, Task, Silent, Rest, [Cost-Agent|More], More) :-
    !,
    subtract(Silent, [Agent], Rest).
heard(refuse(Task), Agent, Task, Silent, Rest, Bids, Bids) :-
    !,
    subtract(Silent, [Agent], Rest).
heard(_, _, _, Silent, Silent, Bids, Bids).

award(Bids, Task) :-
    keysort(Bids, Sorted),
    (   Sorted = [Cost-Best|Others]
    ->  pairs_values(Others, Losers),
        send_all(Losers, reject(Task)),
        send(Best, award(Task)),
        receive(Best-finished(Task)),
        result(awarded(Task, Best, Cost))
    ;   result(no_offer(Task))
    ).
