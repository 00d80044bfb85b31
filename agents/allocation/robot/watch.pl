% Expects: nothing.
% Gives: next/1, remind/2, remind_nothing/0; state due/2.

/*  The events of a robot: a message, or the time due(Time, What).  At that
    time the robot asks its contact whether it still needs the robot, or stops
    waiting for the answer.
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
%   Sets the only reminder: What is `ask` or `answer`.

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
