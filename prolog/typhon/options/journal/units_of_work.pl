:- module(typhon_units_of_work,
          [ changes_begin/0,
            changes_number_after/1,     % +N
            changes_put_at_once/4,      % +Kind, +Key, +N, +Term
            changes_drop_at_once/3,     % +Kind, +Key, +N
            changes_putting/5,          % +Kind, +Key, +N, +Term, -Change
            changes_bytes/2,            % +Change, -Count
            changes_add/1,              % +Change
            changes_must_fit/1,         % +Change
            defer_effects/1,            % :Goal
            deferred_put/4,             % +Kind, +Key, +N, +Term
            deferred_call/1,            % :Goal
            deferred_any/0,
            deferred_commit/0,
            deferred_release/0
          ]).
:- use_module(library(error), [existence_error/2, resource_error/1]).
:- use_module(library(lists), [member/2]).
:- autoload(library(uri), [uri_encoded/3]).
:- use_module('../../kernel/base/durable',
              [ durable/5, durable_begin/0, durable_closed/0, durable_drop/3,
                durable_key/2, durable_on/0, unit_of_work/1 ]).
:- use_module('../../kernel/base/on_demand', [on_demand_load/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/wire', [frame_fits/1]).
:- use_module(committing,
              [ commit_queue/0, commits_begin/0, queue_flush/0,
                queue_entry/1, queue_must_keep/0, queue_send/1 ]).

/** <module> Units of work, and effects that are deferred

This module turns the changes of the kernel, see typhon_durable, into
entries of the queue of typhon_committing.

The changes of unit_of_work/1 are one entry.  The messages that an agent sends,
and the facts that it leaves and takes, are deferred until the agent stops.  Then
all of them are queued together with the agent's new state, inside
unit_of_work/1, and only then released to others.

*Threading*: any thread; each has its own unit of work, and its own deferred
effects.
*/

:- meta_predicate
    defer_effects(0),
    deferred_call(0).

:- multifile
    dropped/1,                          % Changes: their unit of work has failed
    typhon_durable:after_unit/1,
    typhon_durable:go_on/0,
    typhon_durable:change/1,
    typhon_durable:commit/0,
    typhon_durable:deferred_act/4,
    typhon_durable:deferred_drop/3,
    typhon_durable:deferring/0,
    typhon_durable:durable_key/2,
    typhon_durable:enqueue/0,
    typhon_durable:flush_sends/0,
    typhon_durable:in_unit/1,
    typhon_durable:must_keep/0,
    typhon_durable:next_number/1,
    typhon_durable:send_after_commit/2,
    typhon_durable:sync/0.

:- thread_local
    pending/1,                          % Change
    deferred/1,                         % Change
    follows/1,                          % Goal: of after_unit/1
    after/1.                            % Goal

:- dynamic act_again/4.                 % Kind, N, Key, Term: deferred before a
                                        % restart

%!  changes_begin is det.
%
%   The store is open and was read: queue changes from now on.

changes_begin :-
    commits_begin,
    durable_begin,
    get_flag(typhon_durable_number, N),
    number_bound(N).

%   Numbers stay unique after a restart: an item that is written every 10,000
%   numbers holds where they begin.

typhon_durable:next_number(N) :-
    flag(typhon_durable_number, N, N+1),
    (   N mod 10000 =:= 0
    ->  number_bound(N)
    ;   true
    ).

number_bound(N) :-
    Bound is N+20000,
    changes_put_at_once(number, '', 0, Bound).

%!  changes_number_after(+N:integer) is det.
%
%   All later numbers are greater than N.

changes_number_after(N) :-
    flag(typhon_durable_number, N0, max(N0, N+1)).

%   A commit that the database refuses is repeated for ever, and all later ones
%   wait: so keys are checked first.

typhon_durable:durable_key(Key, N) :-
    integer(N),
    N >= -(1<<63),
    N < 1<<63,
    atom(Key),
    atom_length(Key, Length),
    Length =< 500,                      % an index of PostgreSQL takes these
    is_text(Key).

%   No character is 0 or half of a UTF-16 pair.  The first clause is the fast
%   test: the key is unchanged in a URI.

is_text(Key) :-
    uri_encoded(fragment, Key, Encoded),
    Encoded == Key,
    !.
is_text(Key) :-
    atom_codes(Key, Codes),
    \+ ( member(Code, Codes), ( Code =:= 0 ; between(0xd800, 0xdfff, Code) ) ).

                /*******************************
                *            CHANGES           *
                *******************************/

typhon_durable:change(Change) :-
    (   stored_as(Change, Stored)
    ->  changes_add(Stored)
    ;   true
    ).

%   stored_as(+Change, -Stored): as the store takes it.  Fails if there is
%   nothing to delete: no item has an invalid key.

stored_as(put(Kind, Key, N, Term), Stored) :-
    !,
    changes_putting(Kind, Key, N, Term, Stored).
stored_as(drop_all(Kind, Key), drop_all(Kind, Key)) :-
    !,
    durable_key(Key, 0).
stored_as(Drop, Drop) :-
    arg(2, Drop, Key),
    arg(3, Drop, N),
    durable_key(Key, N).

%!  changes_put_at_once(+Kind, +Key, +N, +Term) is det.
%!  changes_drop_at_once(+Kind, +Key, +N) is det.
%
%   As durable_put/4 and durable_drop/3, even if the unit of work fails, and
%   before its other changes.

changes_put_at_once(Kind, Key, N, Term) :-
    (   durable_on
    ->  changes_putting(Kind, Key, N, Term, Change),
        queue_entry([Change])
    ;   true
    ).

changes_drop_at_once(Kind, Key, N) :-
    (   durable_on
    ->  queue_entry([drop(Kind, Key, N)])
    ;   true
    ).

%!  changes_putting(+Kind, +Key, +N, +Term, -Change) is det.
%
%   Change sets the item to Term.
%
%   @error representation_error(journal_key): no item can have this key

changes_putting(Kind, Key, N, Term, put(Kind, Key, N, Bytes)) :-
    (   durable_key(Key, N)
    ->  fast_term_serialized(Term, Bytes)
    ;   throw(error(representation_error(journal_key), _))
    ).

%!  changes_bytes(+Change, -Count) is det.
%
%   The term of the item that Change sets takes Count bytes.

changes_bytes(put(_, _, _, Bytes), Count) :-
    string_length(Bytes, Count).

%   Bytes of a frame besides those of the noted term, at most.

frame_overhead(1000).

%!  changes_must_fit(+Change) is det.
%
%   The term of Change fits in a frame.
%
%   @error resource_error(frame_bytes) if it does not

changes_must_fit(Change) :-
    changes_bytes(Change, Count),
    frame_overhead(More),
    Most is Count+More,
    (   frame_fits(Most)
    ->  true
    ;   resource_error(frame_bytes)
    ).

%!  changes_add(+Change) is det.
%
%   Add Change to the unit of work, or queue it alone.

changes_add(Change) :-
    (   nb_current(typhon_durable_unit, true)
    ->  assertz(pending(Change))
    ;   queue_entry([Change])
    ).

typhon_durable:in_unit(Goal) :-
    (   nb_current(typhon_durable_unit, true)
    ->  once(Goal)
    ;   setup_call_cleanup(nb_setval(typhon_durable_unit, true),
                           ( once(Goal), enqueue ),
                           ( nb_setval(typhon_durable_unit, false),
                             drop_pending )),
        ( follows(_) -> follow ; true )
    ).

follow :-
    findall(Goal, retract(follows(Goal)), Goals),
    forall(member(Goal, Goals), release(Goal)).

typhon_durable:after_unit(Goal) :-
    (   nb_current(typhon_durable_unit, true)
    ->  assertz(follows(Goal))
    ;   call(Goal)
    ).

drop_pending :-
    (   pending(_)
    ->  findall(Change, retract(pending(Change)), Changes),
        forall(dropped(Changes), true)
    ;   true
    ).

typhon_durable:enqueue :-
    enqueue.

enqueue :-
    (   pending(_)
    ->  findall(Change, retract(pending(Change)), Changes),
        queue_entry(Changes)
    ;   true
    ).

                /*******************************
                *            COMMIT            *
                *******************************/

typhon_durable:sync :-
    enqueue,
    commit_queue,
    queue_must_keep.

typhon_durable:must_keep :-
    queue_must_keep.

typhon_durable:commit :-
    enqueue,
    commit_queue.

typhon_durable:send_after_commit(Item, When) :-
    enqueue,
    (   queue_send(Item)
    ->  true
    ;   existence_error(journal, open)
    ),
    (   When == later
    ->  true
    ;   queue_flush
    ).

typhon_durable:flush_sends :-
    queue_flush.

                /*******************************
                *        DEFERRED EFFECTS      *
                *******************************/

%!  defer_effects(:Goal) is det.
%
%   Run Goal, in which an agent acts, and defer its effects to the end of this
%   thread's unit of work.

defer_effects(Goal) :-
    (   durable_on
    ->  setup_call_cleanup(nb_setval(typhon_deferred, true),
                           once(Goal),
                           nb_setval(typhon_deferred, false))
    ;   call(Goal)
    ).

typhon_durable:deferring :-
    nb_current(typhon_deferred, true).

%!  deferred_put(+Kind, +Key, +N, +Term) is det.
%
%   As durable_put/4; inside defer_effects/1 the change is deferred to the end of
%   the unit of work.

deferred_put(Kind, Key, N, Term) :-
    defer(put(Kind, Key, N, Term)).

typhon_durable:deferred_drop(Kind, Key, N) :-
    defer(drop(Kind, Key, N)).

defer(Change) :-
    (   \+ nb_current(typhon_deferred, true)
    ->  typhon_durable:change(Change)
    ;   stored_as(Change, Stored)
    ->  assertz(deferred(Stored))
    ;   true
    ).

%!  deferred_call(:Goal) is det.
%
%   Call Goal after the changes of this unit of work are queued.

deferred_call(Goal) :-
    assertz(after(Goal)).

typhon_durable:deferred_act(Kind, Key, Term, By) :-
    typhon_durable:next_number(N),
    changes_putting(Kind, Key, N, Term, Change),
    (   By == frame
    ->  changes_must_fit(Change)
    ;   true
    ),
    assertz(deferred(Change)),
    deferred_call(act(Kind, N, Key, Term)).

act(_, _, _, _) :-
    durable_closed,                     % the next start does it
    !.
act(Kind, N, Key, Term) :-
    unit_of_work(( durable_drop(Kind, Key, N),
                   ignore(typhon_durable:act(Kind, Key, Term)) )).

:- durable(letter, Id, N, Term, act_again(letter, N, Id, Term)).
:- durable(asked, Host, N, Term, act_again(asked, N, Host, Term)).
:- durable(logged, Host, N, Term, act_again(logged, N, Host, Term)).

typhon_durable:go_on :-
    findall(act(Kind, N, Key, Term), retract(act_again(Kind, N, Key, Term)),
            Acts),
    (   memberchk(act(logged, _, _, _), Acts)
    ->  on_demand_load(host_option, log)
    ;   true
    ),
    forall(member(act(Kind, N, Key, Term), Acts), act(Kind, N, Key, Term)).

%!  deferred_any is semidet.

deferred_any :-
    (   deferred(_)
    ;   after(_)
    ),
    !.

%!  deferred_commit is det.

deferred_commit :-
    forall(retract(deferred(Change)), changes_add(Change)).

%!  deferred_release is det.

deferred_release :-
    (   after(_)
    ->  findall(Goal, after(Goal), Goals),
        retractall(after(_)),
        forall(member(Goal, Goals), release(Goal))
    ;   true
    ).

release(Goal) :-
    catch(ignore(Goal), error(Formal, Context),
          print_error(warning, error(Formal, Context))).
