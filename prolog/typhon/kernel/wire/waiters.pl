:- module(typhon_waiters,
          [ waiter_add/2,               % +Address, +Queue
            waiter/1,                   % ?Address
            waiters_tell/2,             % ?Address, +Result
            waiters_missed/2,           % +Address, +Asked
            waiter_tell/2,              % +Queue, +Result
            asking/1,                   % -Number
            asked/1                     % -Number
          ]).

/** <module> Who waits for a connection

A thread that cannot go on without a connection to an address waits at a
queue of its own, and hears `met` or `missed`. Requests wait elsewhere, see
unsent.pl, and hold no thread. All who ask are numbered: an attempt to connect
says nothing to who has asked since it began.

*Threading*: the thread of the keeper owns the table; waiter_tell/2, asking/1
and asked/1 may be called from any.
*/

:- use_module(library(lists), [member/2]).

:- dynamic
    waiter/3.                           % Address, Number, Queue

%!  waiter_add(+Address, +Queue) is det.

waiter_add(Address, Queue) :-
    asking(Number),
    assertz(waiter(Address, Number, Queue)).

%!  waiter(?Address) is semidet.
%
%   Somebody waits for Address.

waiter(Address) :-
    waiter(Address, _, _),
    !.

%!  waiters_tell(?Address, +Result) is det.
%!  waiters_missed(+Address, +Asked) is det.
%
%   Tell all who wait for Address; that it is missed, those with a number below
%   Asked.

waiters_tell(Address, Result) :-
    waiters_tell(Address, inf, Result).

waiters_missed(Address, Asked) :-
    waiters_tell(Address, Asked, missed).

waiters_tell(Address, Before, Result) :-
    findall(Number-Queue,
            ( waiter(Address, Number, Queue), Number < Before ),
            Told),
    forall(member(Number-Queue, Told),
           ( retractall(waiter(_, Number, _)),
             waiter_tell(Queue, Result) )).

%!  waiter_tell(+Queue, +Result) is det.
%
%   Tell who waits, and may have been interrupted.

waiter_tell(Queue, Result) :-
    catch(thread_send_message(Queue, Result),
          error(existence_error(_, _), _),
          true).

%!  asking(-Number) is det.
%!  asked(-Number) is det.
%
%   Who asks now has Number; who has asked before has a lower one.

asking(Number) :-
    flag(typhon_asking, Number, Number+1).

asked(Number) :-
    flag(typhon_asking, Number, Number).
