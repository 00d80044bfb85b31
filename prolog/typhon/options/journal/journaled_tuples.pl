:- module(typhon_journaled_tuples, []).
:- use_module('../../kernel/base/durable',
              [ deferred_drop/3, durable/6, durable_number/1, durable_on/0,
                effects_deferred/0 ]).
:- use_module('../../kernel/host',
              [place_host/2, tuple_on/4, tuple_put/4, tuple_restored/4]).
:- use_module(units_of_work, [deferred_call/1, deferred_put/4]).

/** <module> Tuple spaces in the journal

A fact in a tuple space has a number, the key of its item.  Other agents find
the facts that an agent leaves when the agent stops; the facts that it takes are
gone at once.

*Threading*: as typhon_place.
*/

:- multifile
    typhon_place:due/3,
    typhon_place:due_taken/3,
    typhon_place:leaves/3,
    typhon_place:taken/2.

:- dynamic due/5.               % Place, N, Fact, By, Thread: Thread puts it
                                % there when its turn is over

typhon_place:leaves(Place, Fact, By) :-
    place_host(Place, Host),
    durable_number(N),
    noted(By, Fact, Noted),
    deferred_put(tuple, Host, N, Noted),
    (   effects_deferred
    ->  thread_self(Me),
        assertz(due(Place, N, Fact, By, Me)),
        deferred_call(typhon_journaled_tuples:leave_due(Place, N))
    ;   tuple_put(Place, N, Fact, By)
    ).

:- public leave_due/2.

leave_due(Place, N) :-
    with_mutex(typhon_tuples,
               (   retract(due(Place, N, Fact, By, _))
               ->  tuple_put(Place, N, Fact, By)
               ;   true                 % the agent has taken it again
               )).

typhon_place:due(Place, Fact, Whose) :-
    (   Whose == mine
    ->  thread_self(Me)
    ;   true
    ),
    due(Place, _, Fact, _, Me).

typhon_place:due_taken(Place, Fact, By) :-
    thread_self(Me),
    retract(due(Place, N, Fact, By, Me)),
    !,
    typhon_place:taken(Place, N).

typhon_place:taken(Place, N) :-
    (   durable_on
    ->  place_host(Place, Host),
        deferred_drop(tuple, Host, N)
    ;   true
    ).

:- durable(tuple, Host, N, Noted, tuple_item(Host, N, Noted),
           tuple_restore(Host, N, Noted)).

tuple_item(Host, N, Noted) :-
    tuple_on(Host, Fact, N, By),
    integer(N),
    noted(By, Fact, Noted).

tuple_restore(Host, N, Noted) :-
    was_noted(Noted, By, Fact),
    tuple_restored(Host, N, Fact, By).

%   By is `none`, or the term of an option that counts the facts.

was_noted('$by'(By, Fact), By, Fact) :- !.
was_noted(Fact, none, Fact).

noted(none, Fact, Fact) :-
    \+ functor(Fact, '$by', 2),
    !.
noted(By, Fact, '$by'(By, Fact)).
