% Expects: task/3; lib, common; held_robots.
% Gives: exchange/0, learn/3, promising/1; its state.

/*  News of robots that allocators share: beyond the thesis, which names it in
    section 7.8.

    Allocators seldom meet, so they leave their news in the tuple
    robots(News) of the hosts that they visit, and take newer items from
    there.  An item is news(Host, Requirements, Verdict, Time): since Time the
    robot at Host, which meets Requirements, is `free` or `taken`.

    The allocator moves to the neighbour with the newest `free` item.  Its own
    observation there is newer than that item, so the same item does not
    attract it twice.  The setting `sharing` is `none` (of the thesis), `own`
    (an allocator uses only its own observations) or `shared`.
*/

:- use_module(library(lists)).
:- dynamic news/4.

%!  exchange is det.
%
%   Exchanges news with the host, if either has newer items.

exchange :-
    parameter(sharing, shared),
    !,
    (   take(robots(Theirs))
    ->  true
    ;   Theirs = []
    ),
    forall(member(news(Host, Requirements, Verdict, Time), Theirs),
           heard_of(Host, Requirements, Verdict, Time)),
    findall(news(Host, Requirements, Verdict, Time),
            news(Host, Requirements, Verdict, Time),
            News),
    leave(robots(News)).
exchange.

%!  learn(+Host, +Requirements, +Verdict) is det.
%
%   Records Verdict with the current time.

learn(Host, Requirements, Verdict) :-
    (   parameter(sharing, none)
    ->  true
    ;   now(Now),
        heard_of(Host, Requirements, Verdict, Now)
    ).

heard_of(Host, Requirements, _, Time) :-
    news(Host, Requirements, _, Newer),
    Newer >= Time,
    !.
heard_of(Host, Requirements, Verdict, Time) :-
    retractall(news(Host, Requirements, _, _)),
    assertz(news(Host, Requirements, Verdict, Time)).

%!  promising(-Host) is semidet.
%
%   Host is a neighbour whose robot may be reserved for an incomplete team.

promising(Host) :-
    news(_, _, free, _),
    !,
    neighbours(Neighbours),
    open_teams(Open),
    findall(Time-Near,
            ( member(_-Requirements, Open),
              news(Near, Requirements, free, Time),
              memberchk(Near, Neighbours) ),
            Pairs),
    keysort(Pairs, Sorted),
    last(Sorted, _-Host).
