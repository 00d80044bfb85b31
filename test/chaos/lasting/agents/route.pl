% To the next host of a route that ends where it begins, however often it
% takes.

go_on :-
    retract(route([Host|Hosts])),
    append(Hosts, [Host], Route),
    assertz(route(Route)),
    go(Host).

go(Host) :-
    catch(( move(Host), Where = there ), error(_, _), Where = here),
    gone(Where, Host).

gone(there, _).
gone(here, Host) :-
    sleep(0.05),
    go(Host).
