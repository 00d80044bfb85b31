% Expects: nothing.
% Gives: next/1, remind/2, remind_nothing/0; state due/2.

/*  What a robot waits for: a message, or the time due(Time, What) at which it
    asks its contact whether it is still wanted, or has waited long enough
    for the answer.
*/

:- dynamic due/2.

%!  next(-Event) is det.
%
%   Event is From-Message, or overdue(What).

next(Event) :-
    due(Time, What),
    !,
    now(Now),
    Left is max(0, Time - Now),
    (   receive(From-Message, Left)
    ->  Event = From-Message
    ;   Event = overdue(What)
    ).
next(Event) :-
    receive(Event).

%!  remind(+Seconds, +What) is det.
%
%   Of What, `ask` or `answer`, and of nothing else.

remind(Seconds, What) :-
    remind_nothing,
    (   Seconds == inf
    ->  true
    ;   now(Now),
        Time is Now + Seconds,
        assertz(due(Time, What))
    ).

%!  remind_nothing is det.

remind_nothing :-
    retractall(due(_, _)).
