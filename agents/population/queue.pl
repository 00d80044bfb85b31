:- agent(queue, [state([setting/2])]).
:- include('../lib/parameters').

/*  The queue of a host: travelling agents join it and have their turns one
    after the other, first come, first served.  The tuple queue(Id) tells
    them where to join.

        join             asked by an agent that has arrived, or was refused
                         by another host: it goes to the tail
        turn(Length)     told to the head; Length is the number of agents in
                         the queue, from which the cloning pressure follows
        leave            told by an agent that goes
        quit             told by an agent that is about to die, answered by
                         `gone` when no turn will come any more

    How many may be there at a time is the capacity of the host: an agent
    that finds no free slot is refused at its move and stays where it was.

    An agent that ended on its turn without a message would block all others;
    after a time-out the queue continues without it.
*/

default(patience, 60).

main :-
    self(Me),
    leave(queue(Me)),
    serve([]).

serve(Line0) :-
    next(Line0, Event),
    changed(Event, Line0, Line),
    answer(Event),
    call_head(Line0, Line),
    serve(Line).

next([], Agent-What) :-
    receive(Agent-What).
next([Head|_], Event) :-
    parameter(patience, Seconds),
    (   receive(Agent-What, Seconds)
    ->  Event = Agent-What
    ;   Event = Head-leave
    ).

%   changed(+Event, +Line0, -Line).

changed(Agent-join, Line0, Line) :-
    \+ memberchk(Agent, Line0),
    !,
    append(Line0, [Agent], Line).
changed(Agent-What, Line0, Line) :-
    memberchk(What, [leave, quit]),
    selectchk(Agent, Line0, Line),
    !.
changed(_, Line, Line).

answer(Agent-quit) :-
    !,
    send(Agent, gone).
answer(_).

%   The new head has its turn.

call_head([Head|_], [Head|_]) :-
    !.
call_head(_, [Head|Line]) :-
    !,
    length([Head|Line], Length),
    send(Head, turn(Length)).
call_head(_, []).
