% Expects: task/3; lib, common; held_robots.
% Gives: exchange/0, learn/3, promising/1; its state.

/*  What allocators tell each other of robots: beyond the thesis, which names it
    in section 7.8.

    They meet seldom, so they leave what they know at the hosts that they come
    by, in the tuple robots(News), and take along what is newer there.  An item
    is news(Host, Requirements, Verdict, Time): since Time the robot at Host,
    which meets Requirements, is `free` or `taken`.

    Of neighbours that are known to be free the allocator goes to the one of
    which it heard last; what it found out itself is newer than what sent it
    there, so it does not come back in vain.  The setting `sharing` is `none`
    (of the thesis), `own` (an allocator uses what it has seen itself) or
    `shared`.
*/

:- use_module(library(lists)).
:- dynamic news/4.

%!  exchange is det.
%
%   With the host, if there is something to tell or to learn.

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
%   From now on.

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
%   A neighbour that may be reserved for a team which is not complete.

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
