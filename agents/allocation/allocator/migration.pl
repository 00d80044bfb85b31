% Expects: lib, common; trail, held_robots, news, sojourn, rewards.
% Gives: set_out/0, restart/0, migrate/0, pause/0.

/*  Migration of an allocator: thesis section 7.4.1, Agent Migration.
*/

%!  set_out is det.
%!  restart is det.
%
%   Begin a search: without any knowledge (set_out/0), or after a back-off
%   (restart/0).  An allocator that still holds robots keeps its trail, since
%   it may have to return to them.

set_out :-
    endow,
    begin_sojourn,
    here(Host),
    keep(trail([Host])),
    visited(Host).

restart :-
    avoid_none,
    replenish,
    begin_sojourn,
    (   held(_, _, _, _, _)
    ->  true
    ;   here(Host),
        keep(trail([Host]))
    ).

%!  migrate is det.
%
%   The resource decays also where no neighbour is reachable: an isolated
%   allocator must not keep robots from others.

migrate :-
    decay,
    (   next_place(Host)
    ->  catch(move(Host), error(_, _), Arrived = false),
        landed(Arrived)
    ;   pause
    ).

next_place(Host) :-
    promising(Host),
    !.
next_place(Host) :-
    parameter(strategy, Strategy),
    next_host(Strategy, Host).

landed(Arrived) :-
    var(Arrived),
    !,
    count(migration, 1),
    here(Host),
    trail(Trail0),
    findall(Other, held(Other, _, _, _, _), Wanted),
    neighbours(Neighbours),
    stepped(Host, Neighbours, Wanted, Trail0, Trail),
    keep(trail(Trail)),
    note(hop),
    visited(Host).
landed(false) :-
    count(refusal, 1),
    pause.

%!  pause is det.

pause :-
    parameter(pause, Seconds),
    sleep(Seconds).
