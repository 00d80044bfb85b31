:- module(typhon_settlement,
          [ settled_now/5,              % +Handed, +Key, +Count, -Settled, ?Rest
            settled_late/3,             % +Key, +Count, -Settled
            settled_never/2,            % +Key, -Handed
            unsettled_add/2,            % +Handed, +Key
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
thread that closes the session or gives it another connection. Any thread may
call unsettled/3.
*/

:- use_module(library(lists), [member/2]).
:- use_module(frame, [count_ahead/3]).

:- dynamic
    unsettled/3,                        % Key, Number, Token: received
    objection/3.                        % Key, Number, Answer

%!  unsettled(?Key, ?Number, -Token) is nondet.
%
%   The peer Key has received the frame of that Number, but has not settled it.

%!  unsettled_add(+Handed:list, +Key) is det.
%
%   The peer has received the frames of Handed, and none of them is settled.

unsettled_add(Handed, Key) :-
    forall(member(N-Token, Handed), assertz(unsettled(Key, N, Token))).

%!  settled_now(+Handed:list, +Key, +Count, -Settled:list, ?Rest) is det.
%
%   The peer has received the frames of Handed, and has settled all frames up to
%   Count.  Settled lists the hand-overs that this settles, settled(Token,
%   Number, Result), Result being `accepted` or an objection.

settled_now([], _, _, Settled, Settled).
settled_now([N-Token|Handed], Key, Count, Settled, Rest) :-
    (   count_ahead(N, Count, _)
    ->  result(Key, N, accepted, Result),
        Settled = [settled(Token, N, Result)|More]
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
    findall(settled(Token, N, Result),
            ( unsettled(Key, N, Token),
              count_ahead(N, Count, _),
              retract(unsettled(Key, N, _)),
              result(Key, N, accepted, Result) ),
            Settled).
settled_late(_, _, []).

%!  settled_never(+Key, -Handed:list) is det.
%
%   The session is over. Handed lists the results of hand-overs that were not
%   settled: handed(Token, Result), Result being `lost` or an objection.

settled_never(Key, Handed) :-
    findall(handed(Token, Result),
            ( retract(unsettled(Key, N, Token)),
              result(Key, N, lost, Result) ),
            Handed),
    retractall(objection(Key, _, _)).

result(Key, N, Default, Result) :-
    (   retract(objection(Key, N, Answer))
    ->  Result = Answer
    ;   Result = Default
    ).

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
