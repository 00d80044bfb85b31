:- agent(queue, [state([setting/2])]).
:- include('../lib/parameters').

/*  The queue of a host: travelling agents join it and have their turns one
    after the other, first come, first served.  They find it by the tuple
    queue(Id).

        join             request of an agent that has arrived, or was refused
                         by another host: it joins the tail
        turn(Length)     sent to the head; Length is the number of agents in
                         the queue, from which the cloning pressure follows
        leave            sent by an agent that moves on
        quit             sent by an agent that is about to die; the answer
                         `gone` means that it gets no more turns

    The capacity of the host limits the length of the queue: the host refuses
    an agent if there is no free slot, and the agent stays at its host.

    An agent that ended on its turn without a message would block all others;
    after a time-out the queue continues without it.
*/

default(patience, 60, range(1, 600, 1.0),
        "seconds in which the agent on its turn should act").

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

%   Gives a turn to the new head.

call_head([Head|_], [Head|_]) :-
    !.
call_head(_, [Head|Line]) :-
    !,
    length([Head|Line], Length),
    send(Head, turn(Length)).
call_head(_, []).
