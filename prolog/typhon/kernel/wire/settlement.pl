:- module(typhon_settlement,
          [ settled_now/5,              % +Handed, +Key, +Count, -Settled, ?Rest
            settled_late/3,             % +Key, +Count, -Settled
            settled_never/3,            % +Key, +Lost, -Handed
            unsettled/3,                % ?Key, ?Number, -Token
            objection_add/3,            % +Key, +Number, +Answer
            objection_answered/3        % +Key, +Number, +Answer
          ]).

/** <module> What was handed over with a frame, and what became of it

A frame that the peer has received is _settled_ when the peer counts it among
those that it has accepted. If the peer does not accept it, it sends an
objection before it counts the frame. What was handed over is Number-Token: the
number of the frame, and what the caller wants to learn of it by.

*Threading*: for the thread of the connection, and, when that has ended, for the
thread that closes the session; settled_now/5 under the mutex of the session.
Any thread may look at unsettled/3.
*/

:- use_module(library(lists), [append/3, member/2]).
:- use_module(frame, [count_ahead/3]).

:- dynamic
    unsettled/3,                        % Key, Number, Token: received
    objection/3.                        % Key, Number, Answer

%!  unsettled(?Key, ?Number, -Token) is nondet.
%
%   The peer Key has received the frame of that Number, and not settled it.

%!  settled_now(+Handed:list, +Key, +Count, -Settled:list, ?Rest) is det.
%!  settled_late(+Key, +Count, -Settled:list) is det.
%
%   The peer has received Handed, and settled all up to Count, none if that is
%   `none`: Settled are those that are settled by that, settled(Token, Number,
%   Result), Result being `accepted` or an objection. The same of what had been
%   received before.

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
%   The session is over. Of what was received, or is among Lost, which may have
%   been, Handed says what is known, handed(Token, Result): Result is `lost` or
%   an objection.

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
%!  objection_answered(+Key, +Number, +Answer) is semidet.
%
%   The peer does not accept the frame of that Number, but says Answer, if it
%   has said nothing before; it has answered the frame that it had deferred,
%   before it has counted it: this is what it objects.

objection_add(Key, Number, Answer) :-
    (   objection(Key, Number, _)
    ->  true
    ;   assertz(objection(Key, Number, Answer))
    ).

objection_answered(Key, Number, Answer) :-
    retract(objection(Key, Number, deferred)),
    !,
    assertz(objection(Key, Number, Answer)).
