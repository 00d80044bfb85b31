% contractor.pl: offers the tasks of its host, and does those awarded to it

:- agent(contractor, []).

on_message(Manager, announce(Task, Kind)) :-
    (   sense(cost(Kind, Cost))
    ->  send(Manager, bid(Task, Cost))
    ;   send(Manager, refuse(Task))
    ).
on_message(Manager, award(Task)) :-
    leave(done(Task)),
    send(Manager, finished(Task)).
on_message(_, reject(_)).
