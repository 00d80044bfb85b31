:- module(typhon_tuples,
          [ tuple_leave/2,              % +Place, +Fact
            tuple_leave/3,              % +Place, +Fact, +By
            tuple_leave_new/3,          % +Place, +Fact, +By
            tuple_sense/2,              % +Place, ?Fact
            tuple_take/2                % +Place, ?Fact
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module('../base/durable', [durable/6]).
:- use_module('../base/durable_changes',
              [ deferred_call/1, deferred_drop/3, deferred_put/4,
                durable_number/1, durable_on/0, effects_deferred/0 ]).
:- use_module(place, [place_host/2]).

/** <module> Tuple spaces: facts that all agents on a host see

The tuple space of a host is the predicate '$tuple'/1 of its place.

*Threading*: any thread. tuple_take/2 is atomic; tuple_leave_new/3 checks and
adds under a mutex.
*/

:- multifile
    counted/2.                  % By, Change: the number of its facts grows by
                                % Change, 1 or -1

:- public leave_due/2.

:- dynamic due/5.               % Place, N, Fact, By, Thread: Thread puts it
                                % there when its turn is over

%!  tuple_leave(+Place, +Fact) is det.
%!  tuple_leave(+Place, +Fact, +By) is det.
%
%   Put Fact in the tuple space.  By is `none`, or a ground term of an option
%   that counts such facts.
%
%   With a journal a fact has a number, the key of its item.  The number and By
%   are in the body of the clause; the item contains By, too.  Other agents
%   find the facts that an agent leaves when the agent stops; the facts that it
%   takes are gone at once.

tuple_leave(Place, Fact) :-
    tuple_leave(Place, Fact, none).

tuple_leave(Place, Fact, By) :-
    must_be(callable, Fact),
    count(By, 1),
    (   durable_on,
        place_host(Place, _)
    ->  leave_noted(Place, Fact, By)
    ;   with_mutex(typhon_tuples, put_tuple(Place, none, Fact, By))
    ).

%!  tuple_leave_new(+Place, +Fact, +By) is semidet.
%
%   As tuple_leave/3, but fails if there is a fact that unifies.  Of several
%   agents that do so with one fact, one succeeds.

tuple_leave_new(Place, Fact, By) :-
    must_be(callable, Fact),
    with_mutex(typhon_tuples,
               ( \+ Place:'$tuple'(Fact),
                 \+ due(Place, _, Fact, _, _),
                 (   durable_on,
                     place_host(Place, _)
                 ->  leave_noted(Place, Fact, By)
                 ;   put_tuple(Place, none, Fact, By)
                 ),
                 count(By, 1) )).

leave_noted(Place, Fact, By) :-
    durable_number(N),
    place_host(Place, Host),
    noted(By, Fact, Noted),
    deferred_put(tuple, Host, N, Noted),
    (   effects_deferred
    ->  thread_self(Me),
        assertz(due(Place, N, Fact, By, Me)),
        deferred_call(typhon_tuples:leave_due(Place, N))
    ;   put_tuple(Place, N, Fact, By)
    ).

leave_due(Place, N) :-
    with_mutex(typhon_tuples,
               (   retract(due(Place, N, Fact, By, _))
               ->  put_tuple(Place, N, Fact, By)
               ;   true                 % the agent has taken it again
               )).

put_tuple(Place, N, Fact, By) :-
    tuple_body(N, By, Body),
    assertz(Place:('$tuple'(Fact) :- Body)).

%   tuple_body(?N, ?By, ?Body): Body is always true, and holds N and By.

tuple_body(none, none, true) :- !.
tuple_body(N, none, integer(N)) :- !.
tuple_body(N, By, ground(N-By)).

count(none, _) :-
    !.
count(By, Change) :-
    forall(counted(By, Change), true).

%!  tuple_sense(+Place, ?Fact) is nondet.
%
%   Fact is in the tuple space.

tuple_sense(Place, Fact) :-
    Place:'$tuple'(Fact).
tuple_sense(Place, Fact) :-
    effects_deferred,
    thread_self(Me),
    due(Place, _, Fact, _, Me).

%!  tuple_take(+Place, ?Fact) is semidet.
%
%   Remove a fact that unifies.  Of several agents that take one fact, one
%   succeeds.

tuple_take(Place, Fact) :-
    retract(Place:('$tuple'(Fact) :- Body0)),
    !,
    strip_module(Body0, _, Body),
    tuple_body(N, By, Body),
    (   N == none
    ->  true
    ;   place_host(Place, Host),
        deferred_drop(tuple, Host, N)
    ),
    count(By, -1).
tuple_take(Place, Fact) :-
    effects_deferred,
    thread_self(Me),
    retract(due(Place, N, Fact, By, Me)),
    !,
    place_host(Place, Host),
    deferred_drop(tuple, Host, N),
    count(By, -1).

%   The facts in a journal; N is the number of a fact.

:- durable(tuple, Host, N, Noted, tuple_item(Host, N, Noted),
           tuple_restore(Host, N, Noted)).

tuple_item(Host, N, Noted) :-
    tuple_on(Host, Fact, N, By),
    integer(N),
    noted(By, Fact, Noted).

tuple_restore(Host, N, Noted) :-
    was_noted(Noted, By, Fact),
    place_host(Place, Host),
    count(By, 1),
    put_tuple(Place, N, Fact, By).

was_noted('$by'(By, Fact), By, Fact) :- !.
was_noted(Fact, none, Fact).

noted(none, Fact, Fact) :-
    \+ functor(Fact, '$by', 2),
    !.
noted(By, Fact, '$by'(By, Fact)).

%   The facts in a saved network; restoring leaves them again.

:- durable(fact, Host, By, Fact, tuple_on(Host, Fact, _, By),
           fact_restore(Host, By, Fact)).

fact_restore(Host, By, Fact) :-
    place_host(Place, Host),
    tuple_leave(Place, Fact, By).

tuple_on(Host, Fact, N, By) :-
    place_host(Place, Host),
    clause(Place:'$tuple'(Fact), Body0),
    strip_module(Body0, _, Body),
    tuple_body(N, By, Body).
