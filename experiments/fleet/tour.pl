%   An agent that works on robots, some of which are away at times.

:- agent(tour, [state([way/1, robots/1, base/1, work/1, pause/1, longest/1])]).

main :-
    robots(Robots),
    base(Base),
    log(sent),
    visit(Robots),
    back(Base),
    log(delivered).

visit([]).
visit([Robot|Robots]) :-
    way(Way),
    reached(Way, [Robot|Robots], Rest),
    work(Seconds),
    log(begins),
    sleep(Seconds),
    log(worked),
    visit(Rest).

back(Base) :-
    way(Way),
    reached(Way, [Base], []).

%   reached(+Way, +Hosts, -Rest): the agent is on one of Hosts; Rest are the
%   others.

reached(again, [Host|Rest], Rest) :-
    tried(Host, Error),
    (   Error == none
    ->  true
    ;   pause(Seconds),
        sleep(Seconds),
        reached(again, [Host|Rest], Rest)
    ).
reached(others, Hosts, Rest) :-
    first(Hosts, Reached, Rest0),
    (   Reached == true
    ->  Rest = Rest0
    ;   pause(Seconds),
        sleep(Seconds),
        reached(others, Hosts, Rest)
    ).
reached(wait, [Host|Rest], Rest) :-
    waited(Host).
reached(both, Hosts, Rest) :-
    first(Hosts, Reached, Rest0),
    (   Reached == true
    ->  Rest = Rest0
    ;   Hosts = [Host|Rest],
        waited(Host)
    ).

%   first(+Hosts, -Reached, -Rest): of Hosts the first that can be reached.

first([], false, []).
first([Host|Hosts], Reached, Rest) :-
    tried(Host, Error),
    (   Error == none
    ->  Reached = true,
        Rest = Hosts
    ;   first(Hosts, Reached, Rest0),
        Rest = [Host|Rest0]
    ).

tried(Host, Error) :-
    log(tries),
    catch(( move(Host), Error = none ), error(Error, _), true).

waited(Host) :-
    longest(Seconds),
    log(tries),
    move(Host, [wait(Seconds)]).
