:- module(typhon_settlement,
          [ session_settled/4,          % +Session, +Counts, -Settled, -Waiting
            session_objected/3,         % +Session, +Number, +Answer
            session_pending/2,          % +Session, -Count
            objection_answered/3,       % +Session, +Number, +Answer
            unsettled_add/2,            % +Key, +Handed
            settled_never/4             % +Key, +Sent, +Unsent, -Handed
          ]).

/** <module> Settlement of frames that hand over a term

A received frame is _settled_ when the peer counts it among those that it has
accepted. If the peer does not accept a frame, it sends an objection before it
counts the frame. A hand-over is Number-Token: the number of the frame, and the
term by which the caller identifies its result.

*Threading*: for the thread of the connection, and, when that has ended, for the
thread that closes the session or gives it another connection. Any thread may
call session_pending/2.
*/

:- use_module(library(lists), [member/2]).
:- use_module(frame, [count_ahead/3]).
:- use_module(session, [session_key/2]).
:- use_module(unacked,
              [session_acked/4, session_unacked/2, session_under_way/2]).

:- dynamic
    unsettled/3,                        % Key, Number, Token: received
    objection/3.                        % Key, Number, Answer

%!  session_settled(+Session, +Counts, -Settled:list, -Waiting:integer) is det.
%
%   A frame of the peer has these Counts, see frame.pl. Settled lists the
%   hand-overs that they settle, settled(Token, Number, Result), Result being
%   `accepted` or an objection.  Waiting is 0 if the peer has acknowledged
%   nothing by them, else the number of frames that wait.
%
%   @error domain_error(acknowledged, Count)

session_settled(Session, counts(Received, Count), Settled, Waiting) :-
    session_key(Session, Key),
    (   session_acked(Session, Received, Handed, Waiting)
    ->  settled_now(Handed, Key, Count, Settled, Late)
    ;   Settled = Late,
        Waiting = 0
    ),
    settled_late(Key, Count, Late).

settled_now([], _, _, Settled, Settled).
settled_now([N-Token|Handed], Key, Count, Settled, Rest) :-
    (   count_ahead(N, Count, _)
    ->  result(Key, N, accepted, Result),
        Settled = [settled(Token, N, Result)|More]
    ;   assertz(unsettled(Key, N, Token)),
        Settled = More
    ),
    settled_now(Handed, Key, Count, More, Rest).

%   As settled_now/5, for frames that the peer had received before.

settled_late(Key, Count, Settled) :-
    unsettled(Key, _, _),
    !,
    findall(settled(Token, N, Result),
            ( unsettled(Key, N, Token),
              count_ahead(N, Count, _),
              retract(unsettled(Key, N, _)),
              result(Key, N, accepted, Result) ),
            Settled).
settled_late(_, _, []).

result(Key, N, Default, Result) :-
    (   retract(objection(Key, N, Answer))
    ->  Result = Answer
    ;   Result = Default
    ).

%!  unsettled_add(+Key, +Handed:list) is det.
%
%   The peer has received the frames of Handed, and none of them is settled.

unsettled_add(Key, Handed) :-
    forall(member(N-Token, Handed), assertz(unsettled(Key, N, Token))).

%!  settled_never(+Key, +Sent:list, +Unsent:list, -Handed:list) is det.
%
%   The session is over; Sent and Unsent are those of unacked_close/4. Handed
%   lists the results of all hand-overs that were not settled: handed(Token,
%   Result), Result being `lost`, `unsent`, or an objection.

settled_never(Key, Sent, Unsent, Handed) :-
    findall(N-Token, unsettled(Key, N, Token), Received),
    retractall(unsettled(Key, _, _)),
    findall(handed(Token, Result),
            (   ( member(N-Token, Received) ; member(N-Token, Sent) ),
                result(Key, N, lost, Result)
            ;   member(Token, Unsent),
                Result = unsent
            ),
            Handed),
    retractall(objection(Key, _, _)).

%!  session_pending(+Session, -Count) is det.
%
%   Count frames are not acknowledged, or are hand-overs that are not settled.

session_pending(Session, Count) :-
    session_key(Session, Key),
    session_unacked(Session, Count0),
    ( unsettled(Key, _, _) -> Count is Count0+1 ; Count = Count0 ).

%!  session_objected(+Session, +Number, +Answer) is det.
%
%   Record that the peer rejects the frame of that Number with Answer.  Only its
%   first objection counts, and none to a frame that is not under way.

session_objected(Session, Number, Answer) :-
    session_key(Session, Key),
    (   integer(Number),
        \+ objection(Key, Number, _),
        ( unsettled(Key, Number, _) ; session_under_way(Session, Number) )
    ->  assertz(objection(Key, Number, Answer))
    ;   true
    ).

%!  objection_answered(+Session, +Number, +Answer) is semidet.
%
%   The peer has answered a frame that it had deferred, before it has counted
%   it: Answer replaces the objection.

objection_answered(Session, Number, Answer) :-
    session_key(Session, Key),
    retract(objection(Key, Number, deferred)),
    !,
    assertz(objection(Key, Number, Answer)).
