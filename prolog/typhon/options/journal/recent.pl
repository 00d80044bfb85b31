:- module(typhon_recent,
          [ recent_begin/1,             % +Seconds
            recent_end/0,
            recent_doubtful/0,
            recent_before/2,            % +Changes, -All
            recent_committed/1          % +Changes
          ]).
:- use_module(library(lists), [append/2, append/3]).

/** <module> Recent commits that the server may lose

A server that answers before it has written loses the last commits when it dies
alone.  So changes that were committed in the last Seconds are kept, and
committed once more when the server is back.  A change states the new value of
an item: to apply the last changes twice, in order, has the same result as to
apply them once.

*Threading*: one thread at a time, the one that commits.
*/

:- dynamic
    keeps/1,                            % Seconds
    recent/2,                           % Stamp, Changes: the oldest first
    doubtful/0.                         % the server may have lost them

%!  recent_begin(+Seconds:number) is det.
%!  recent_end is det.
%
%   Keep changes that were committed in the last Seconds; keep none.

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
%   The server may have lost commits; All is to be committed now: Changes, and
%   before them the changes that may have been lost; All has been committed.

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
