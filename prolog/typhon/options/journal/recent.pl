:- module(typhon_recent,
          [ recent_begin/1,             % +Seconds
            recent_end/0,
            recent_doubtful/0,
            recent_before/2,            % +Changes, -All
            recent_committed/1          % +Changes
          ]).
:- use_module(library(lists), [append/2, append/3]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).

/** <module> Recent commits that the server may lose

A server that answers before it has written to its disk loses the last commits
when it dies.  So this process keeps the changes that it has committed in the
last Seconds, and commits them again when the server is back.  A change states
the new value of an item, so applying the last changes twice, in order, has the
same result as applying them once.

*Threading*: one thread at a time, the one that commits.
*/

:- dynamic
    keeps/1,                            % Seconds
    recent/2,                           % Stamp, Changes: the oldest first
    doubtful/0.                         % the server may have lost recent/2

%!  recent_begin(+Seconds:number) is det.
%!  recent_end is det.
%
%   Begin to keep the changes that were committed in the last Seconds; end that.

recent_begin(Seconds) :-
    recent_end,
    assertz(keeps(Seconds)).

recent_end :-
    retractall(keeps(_)),
    retractall(recent(_, _)),
    retractall(doubtful).

%!  recent_doubtful is det.
%
%   The server may have lost the recent commits.

recent_doubtful :-
    (   keeps(_),
        \+ doubtful
    ->  assertz(doubtful)
    ;   true
    ).

%!  recent_before(+Changes:list, -All:list) is det.
%
%   All is what to commit now: the changes that the server may have lost, and
%   then Changes.

recent_before(Changes, All) :-
    (   doubtful
    ->  findall(Recent, recent(_, Recent), Before),
        append(Before, [Changes], Lists),
        append(Lists, All)
    ;   All = Changes
    ).

%!  recent_committed(+Changes:list) is det.
%
%   The changes that recent_before/2 gave for Changes have been committed.

recent_committed(Changes) :-
    keeps(Seconds),
    !,
    monotonic_time(Now),
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
