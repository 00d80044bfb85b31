:- module(typhon_recent,
          [ recent_begin/1,             % +Seconds
            recent_end/0,
            recent_doubtful/0,
            recent_before/2,            % +Changes, -All
            recent_committed/1          % +Changes
          ]).
:- use_module(library(lists), [append/2, append/3]).

/** <module> What was committed last, where that may be lost

A server that answers before it has written forgets the last moments when it
dies, and we live on.  So what was committed in the last Seconds is kept, and
committed once more when the server is there again.  Changes say what items are
from then on: to make the last ones twice, in their order, is to make them once.

*Threading*: one thread at a time, the one that commits.
*/

:- dynamic
    keeps/1,                            % Seconds
    recent/2,                           % Stamp, Changes: the oldest first
    doubtful/0.                         % the server may have lost them

%!  recent_begin(+Seconds:number) is det.
%!  recent_end is det.
%
%   What was committed is kept for so many Seconds; nothing of it is kept.

recent_begin(Seconds) :-
    recent_end,
    assertz(keeps(Seconds)).

recent_end :-
    retractall(keeps(_)),
    retractall(recent(_, _)),
    retractall(doubtful).

%!  recent_doubtful is det.
%!  recent_before(+Changes:list, -All:list) is det.
%!  recent_committed(+Changes:list) is det.
%
%   The server may have lost what it had; All is to be committed, Changes and
%   what may have been lost before them; that is done.

recent_doubtful :-
    (   keeps(_),
        \+ doubtful
    ->  assertz(doubtful)
    ;   true
    ).

recent_before(Changes, All) :-
    (   doubtful
    ->  findall(Recent, recent(_, Recent), Before),
        append(Before, [Changes], Lists),
        append(Lists, All)
    ;   All = Changes
    ).

recent_committed(Changes) :-
    keeps(Seconds),
    !,
    get_time(Now),
    recent_before(Changes, All),
    (   retract(doubtful)
    ->  retractall(recent(_, _))
    ;   Before is Now-Seconds,
        forget(Before)
    ),
    assertz(recent(Now, All)).
recent_committed(_).

forget(Before) :-
    recent(Stamp, _),
    !,
    (   Stamp < Before
    ->  once(retract(recent(Stamp, _))),
        forget(Before)
    ;   true
    ).
forget(_).
