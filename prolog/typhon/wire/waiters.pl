:- module(typhon_waiters,
          [ waiter_add/2,               % +Address, +Queue
            waiters_tell/2,             % ?Address, +Result
            waiter_tell/2               % +Queue, +Result
          ]).

/** <module> Who waits for a connection

A thread that cannot go on without a connection to an address waits at a
queue of its own, and hears `met` or `missed`. Requests wait elsewhere, see
unsent.pl, and hold no thread.

*Threading*: the thread of the keeper owns the table; waiter_tell/2 may be
called from any.
*/

:- use_module(library(lists), [member/2]).

:- dynamic
    waiter/2.                           % Address, Queue

%!  waiter_add(+Address, +Queue) is det.

waiter_add(Address, Queue) :-
    assertz(waiter(Address, Queue)).

%!  waiters_tell(?Address, +Result) is det.
%
%   Tell all who wait for Address.

waiters_tell(Address, Result) :-
    findall(Queue, waiter(Address, Queue), Queues),
    retractall(waiter(Address, _)),
    forall(member(Queue, Queues), waiter_tell(Queue, Result)).

%!  waiter_tell(+Queue, +Result) is det.
%
%   Tell who waits, and may have been interrupted.

waiter_tell(Queue, Result) :-
    catch(thread_send_message(Queue, Result),
          error(existence_error(_, _), _),
          true).
