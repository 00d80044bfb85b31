:- module(typhon_settlement,
          [ settled_now/5,              % +Handed, +Key, +Count, -Settled, ?Rest
            settled_late/3,             % +Key, +Count, -Settled
            settled_never/3,            % +Key, +Lost, -Handed
            unsettled/3,                % ?Key, ?Number, -Token
            objection_add/3,            % +Key, +Number, +Answer
            objection_answered/3        % +Key, +Number, +Answer
          ]).

/** <module> Settlement of frames that hand over a term

A received frame is _settled_ when the peer counts it among those that it has
accepted. If the peer does not accept a frame, it sends an objection before it
counts the frame. A hand-over is Number-Token: the number of the frame, and the
term by which the caller identifies its result.

*Threading*: for the thread of the connection, and, when that has ended, for the
thread that closes the session; settled_now/5 under the mutex of the session.
Any thread may call unsettled/3.
*/

:- use_module(library(lists), [append/3, member/2]).
:- use_module(frame, [count_ahead/3]).

:- dynamic
    unsettled/3,                        % Key, Number, Token: received
    objection/3.                        % Key, Number, Answer

%!  unsettled(?Key, ?Number, -Token) is nondet.
%
%   The peer Key has received the frame of that Number, but has not settled it.

%!  settled_now(+Handed:list, +Key, +Count, -Settled:list, ?Rest) is det.
%
%   The peer has received the frames of Handed, and has settled all frames up to
%   Count, or none if that is `none`.  Settled lists the hand-overs that this
%   settles, settled(Token, Number, Result), Result being `accepted` or an
%   objection.

settled_now([], _, _, Settled, Settled).
settled_now([N-Token|Handed], Key, Count, Settled, Rest) :-
    (   integer(Count),
        count_ahead(N, Count, _)
    ->  settled(N, Token, Key, One),
        Settled = [One|More]
    ;   assertz(unsettled(Key, N, Token)),
        Settled = More
    ),
    settled_now(Handed, Key, Count, More, Rest).

%!  settled_late(+Key, +Count, -Settled:list) is det.
%
%   As settled_now/5, for frames that the peer had received before.

settled_late(Key, Count, Settled) :-
    unsettled(Key, _, _),
    !,
    findall(N-Token,
            ( unsettled(Key, N, Token), count_ahead(N, Count, _) ), Late),
    forall(member(N-_, Late), retractall(unsettled(Key, N, _))),
    settled_now(Late, Key, Count, Settled, []).
settled_late(_, _, []).

settled(N, Token, Key, settled(Token, N, Result)) :-
    (   retract(objection(Key, N, Answer))
    ->  Result = Answer
    ;   Result = accepted
    ).

%!  settled_never(+Key, +Lost:list, -Handed:list) is det.
%
%   The session is over. Handed lists the results of hand-overs that were not
%   settled, or are among Lost, which the peer may have received:
%   handed(Token, Result), Result being `lost` or an objection.

settled_never(Key, Lost, Handed) :-
    findall(N-Token, unsettled(Key, N, Token), Unsettled),
    append(Unsettled, Lost, All),
    findall(handed(Token, Result),
            ( member(N-Token, All), known(Key, N, Result) ),
            Handed),
    retractall(unsettled(Key, _, _)),
    retractall(objection(Key, _, _)).

known(Key, N, Result) :-
    ( objection(Key, N, Answer) -> Result = Answer ; Result = lost ).

%!  objection_add(+Key, +Number, +Answer) is det.
%
%   Record that the peer rejects the frame of that Number with Answer.  Only its
%   first objection counts.

objection_add(Key, Number, Answer) :-
    (   objection(Key, Number, _)
    ->  true
    ;   assertz(objection(Key, Number, Answer))
    ).

%!  objection_answered(+Key, +Number, +Answer) is semidet.
%
%   The peer has answered a frame that it had deferred, before it has counted
%   it: Answer replaces the objection.

objection_answered(Key, Number, Answer) :-
    retract(objection(Key, Number, deferred)),
    !,
    assertz(objection(Key, Number, Answer)).
