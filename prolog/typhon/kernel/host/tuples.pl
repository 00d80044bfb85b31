:- module(typhon_tuples,
          [ tuple_leave/2,              % +Place, +Fact
            tuple_leave/3,              % +Place, +Fact, +By
            tuple_leave_new/3,          % +Place, +Fact, +By
            tuple_sense/2,              % +Place, ?Fact
            tuple_take/2,               % +Place, ?Fact
            tuple_put/4,                % +Place, +N, +Fact, +By
            tuple_restored/4,           % +Host, +N, +Fact, +By
            tuple_on/4                  % ?Host, ?Fact, -N, -By
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module('../base/durable',
              [durable/6, durable_on/0, effects_deferred/0]).
:- use_module(place, [place_host/2]).

/** <module> Tuple spaces: facts that all agents on a host see

The tuple space of a host is the predicate '$tuple'/1 of its place.  Options may
count facts, and number them: By is `none`, or a ground term of the option that
counts them, N is `none`, or the number.  They are in the body of the clause.
Where changes are durable, the hooks below are called.

*Threading*: any thread. tuple_take/2 is atomic; tuple_leave_new/3 checks and
adds under a mutex.
*/

:- multifile
    counted/2,                  % By, Change: the number of its facts grows by
                                % Change, 1 or -1
    leaves/3,                   % Place, Fact, By: Fact is left, or will be
    due/3,                      % Place, Fact, Whose: Fact will be left by a
                                % thread, which is this one if Whose is `mine`
    due_taken/3,                % Place, Fact, By: it is not left after all
    taken/2.                    % Place, N: the fact of this number

%!  tuple_leave(+Place, +Fact) is det.
%!  tuple_leave(+Place, +Fact, +By) is det.
%
%   Put Fact in the tuple space.

tuple_leave(Place, Fact) :-
    tuple_leave(Place, Fact, none).

tuple_leave(Place, Fact, By) :-
    must_be(callable, Fact),
    count(By, 1),
    (   durable_on,
        leaves(Place, Fact, By)
    ->  true
    ;   with_mutex(typhon_tuples, tuple_put(Place, none, Fact, By))
    ).

%!  tuple_leave_new(+Place, +Fact, +By) is semidet.
%
%   As tuple_leave/3, but fails if there is a fact that unifies.  Of several
%   agents that do so with one fact, one succeeds.

tuple_leave_new(Place, Fact, By) :-
    must_be(callable, Fact),
    with_mutex(typhon_tuples,
               ( \+ Place:'$tuple'(Fact),
                 \+ due(Place, Fact, any),
                 (   durable_on,
                     leaves(Place, Fact, By)
                 ->  true
                 ;   tuple_put(Place, none, Fact, By)
                 ),
                 count(By, 1) )).

%!  tuple_put(+Place, +N, +Fact, +By) is det.
%
%   Put Fact in the tuple space, without its count.

tuple_put(Place, N, Fact, By) :-
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

tuple_sense(Place, Fact) :-
    Place:'$tuple'(Fact).
tuple_sense(Place, Fact) :-
    effects_deferred,
    due(Place, Fact, mine).

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
    ;   taken(Place, N)
    ),
    count(By, -1).
tuple_take(Place, Fact) :-
    effects_deferred,
    due_taken(Place, Fact, By),
    count(By, -1).

%   The facts in a saved network; restoring leaves them again.

:- durable(fact, Host, By, Fact, tuple_on(Host, Fact, _, By),
           fact_restore(Host, By, Fact)).

fact_restore(Host, By, Fact) :-
    place_host(Place, Host),
    tuple_leave(Place, Fact, By).

%!  tuple_restored(+Host, +N, +Fact, +By) is det.
%
%   Put a fact that was numbered N in the tuple space of Host again.

tuple_restored(Host, N, Fact, By) :-
    place_host(Place, Host),
    count(By, 1),
    tuple_put(Place, N, Fact, By).

%!  tuple_on(?Host, ?Fact, -N, -By) is nondet.
%
%   Fact is in the tuple space of Host.

tuple_on(Host, Fact, N, By) :-
    place_host(Place, Host),
    clause(Place:'$tuple'(Fact), Body0),
    strip_module(Body0, _, Body),
    tuple_body(N, By, Body).
