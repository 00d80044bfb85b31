:- module(typhon_ledger,
          [ journal_begin/0,
            journal_close/0,
            journal_end/0,
            journal_on/0,
            journal_guards/0,
            journal_closed/0,
            journal_number/1,           % -N
            journal_number_after/1,     % +N
            note_put/4,                 % +Kind, +Key, +N, +Term
            note_drop/3,                % +Kind, +Key, +N
            note_drop_all/2,            % +Kind, +Key
            note_drop_below/3,          % +Kind, +Key, +N
            note_put_at_once/4,         % +Kind, +Key, +N, +Term
            note_drop_at_once/3,        % +Kind, +Key, +N
            note_change/1,              % +Change
            note_putting/5,             % +Kind, +Key, +N, +Term, -Change
            note_bytes/2,               % +Change, -Count
            journal_step/1,             % :Goal
            journal_seal/0,
            journal_barrier/0,
            journal_commit/0,
            journal_let_out/2,          % +Item, +When
            journal_go/0
          ]).
:- use_module(library(error), [representation_error/1]).
:- use_module(committing,
              [ commit/0, commit_soon/0, committing_begin/0, committing_end/0,
                entry/1, journal_full/1, let_out/1 ]).
:- use_module(item_key, [journal_key/1, journal_key/2]).
:- use_module(store, [store_close/0]).

/** <module> What is to be committed

Who changes something that is to outlive the process notes it, before others
can see the change.  What belongs together is noted inside journal_step/1, and
sealed: then it is one entry, and committed as a whole.  Entries are committed
in order, so what is in the store is always what was so at some moment.

Who lets something out of the process has it go when all is committed that it
may follow from: journal_let_out/2.  Who has to know that something is
committed says journal_barrier/0, and waits.

*Threading*: any thread.  Changes of one item are noted one after another,
inside the mutex that guards what it is about.
*/

:- meta_predicate journal_step(0).

:- dynamic
    journal_on/0,
    journal_guards/0.

:- thread_local
    noted/1.                            % Change

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%!  journal_begin is det.
%!  journal_close is det.
%!  journal_end is det.
%!  journal_on is semidet.
%!  journal_guards is semidet.
%!  journal_closed is semidet.
%
%   The store is open, and what it knows was read: from now on changes are
%   noted; all is committed: from now on nothing leaves the process, see
%   journal_barrier/0, and what happens in it is not known any more; it may
%   again, and the store is closed: until then nobody else can open it, and
%   want the port that this process has; whether changes are noted; whether
%   there is a barrier, from begin to end; it is between close and end.

journal_begin :-
    committing_begin,
    assertz(journal_guards),
    assertz(journal_on),
    get_flag(typhon_journal_number, N),
    note_number(N).

journal_close :-
    journal_seal,
    retractall(journal_on),
    ignore(committing_end).

journal_closed :-
    journal_guards,
    \+ journal_on.

journal_end :-
    retractall(journal_guards),
    store_close.

%!  journal_number(-N:integer) is det.
%!  journal_number_after(+N:integer) is det.
%
%   A number greater than all before, as N will be.  It is 0 where there is no
%   journal.  Of those that are given again after a restart none was given
%   before: they begin where the item says that is noted now and then.

journal_number(N) :-
    (   journal_on
    ->  flag(typhon_journal_number, N, N+1),
        (   N mod 10000 =:= 0
        ->  note_number(N)
        ;   true
        )
    ;   N = 0
    ).

note_number(N) :-
    Bound is N+20000,
    note_put_at_once(number, '', 0, Bound).

journal_number_after(N) :-
    flag(typhon_journal_number, N0, max(N0, N+1)).

                /*******************************
                *             NOTES            *
                *******************************/

%!  note_put(+Kind, +Key, +N, +Term) is det.
%!  note_drop(+Kind, +Key, +N) is det.
%!  note_drop_all(+Kind, +Key) is det.
%!  note_drop_below(+Kind, +Key, +N) is det.
%
%   The item is Term from now on; it is no more; nor are all of this key, or
%   those of it that have numbers less than N.
%
%   @error representation_error(journal_key): there can be no such item

note_put(Kind, Key, N, Term) :-
    (   journal_on
    ->  note_putting(Kind, Key, N, Term, Change),
        note_change(Change)
    ;   true
    ).

note_drop(Kind, Key, N) :-
    (   journal_on,
        journal_key(Key, N)
    ->  note_change(drop(Kind, Key, N))
    ;   true
    ).

note_drop_all(Kind, Key) :-
    (   journal_on,
        journal_key(Key)
    ->  note_change(drop_all(Kind, Key))
    ;   true
    ).

note_drop_below(Kind, Key, N) :-
    (   journal_on,
        journal_key(Key, N)
    ->  note_change(drop_below(Kind, Key, N))
    ;   true
    ).

%!  note_put_at_once(+Kind, +Key, +N, +Term) is det.
%!  note_drop_at_once(+Kind, +Key, +N) is det.
%
%   As note_put/4 and note_drop/3, whatever becomes of the step in which this is
%   noted, and before what was noted in it.

note_put_at_once(Kind, Key, N, Term) :-
    (   journal_on
    ->  note_putting(Kind, Key, N, Term, Change),
        entry([Change])
    ;   true
    ).

note_drop_at_once(Kind, Key, N) :-
    (   journal_on
    ->  entry([drop(Kind, Key, N)])
    ;   true
    ).

%!  note_putting(+Kind, +Key, +N, +Term, -Change) is det.
%!  note_bytes(+Change, -Count) is det.
%!  note_change(+Change) is det.
%
%   Change puts this item, which has so many bytes; it is noted.
%
%   @error representation_error(journal_key)

note_putting(Kind, Key, N, Term, put(Kind, Key, N, Bytes)) :-
    (   journal_key(Key, N)
    ->  fast_term_serialized(Term, Bytes)
    ;   representation_error(journal_key)
    ).

note_bytes(put(_, _, _, Bytes), Count) :-
    string_length(Bytes, Count).

note_change(Change) :-
    (   nb_current(typhon_journal_step, true)
    ->  assertz(noted(Change))
    ;   entry([Change])
    ).

%!  journal_step(:Goal) is semidet.
%
%   As once(Goal).  What it notes belongs together, and is sealed when it has
%   succeeded at the latest; what was not sealed by one that fails or raises
%   an error is as if it had not been noted.

journal_step(Goal) :-
    (   \+ journal_on
    ->  once(Goal)
    ;   nb_current(typhon_journal_step, true)
    ->  once(Goal)
    ;   setup_call_cleanup(nb_setval(typhon_journal_step, true),
                           ( once(Goal), journal_seal ),
                           ( nb_setval(typhon_journal_step, false),
                             retractall(noted(_)) ))
    ).

%!  journal_seal is det.
%
%   What this thread has noted so far is one entry.

journal_seal :-
    (   noted(_)
    ->  findall(Change, retract(noted(Change)), Changes),
        entry(Changes)
    ;   true
    ).

                /*******************************
                *            COMMIT            *
                *******************************/

%!  journal_barrier is det.
%
%   Return when all that was noted before is committed.
%
%   @error resource_error(journal_space)
%   @error existence_error(journal, open): it was closed

journal_barrier :-
    (   journal_on
    ->  journal_seal,
        commit
    ;   journal_guards
    ->  closed
    ;   true
    ).

closed :-
    throw(error(existence_error(journal, open), _)).

%!  journal_commit is det.
%
%   As journal_barrier/0, also of what was before the journal was closed.

journal_commit :-
    (   journal_guards
    ->  journal_seal,
        commit
    ;   true
    ).

%!  journal_let_out(+Item, +When) is det.
%
%   Where journal_guards/0: give Item to letting_out/1 when all that was noted
%   before is committed, in the order of these calls.
%
%   @arg When is `now` if somebody waits for it, `anyhow` if so and he would not
%        hear of an error, `later` if who lets it out says journal_go/0 before
%        long, or lets out something else
%   @error resource_error(journal_space): nothing can be committed; Item will
%          not be let out, When being `now`
%   @error existence_error(journal, open): it was closed

journal_let_out(Item, When) :-
    journal_seal,
    may_wait(When),
    (   journal_on,
        let_out(Item)
    ->  true
    ;   closed
    ),
    (   When == later
    ->  true
    ;   commit_soon
    ).

may_wait(now) :-
    journal_full(Error),
    !,
    throw(Error).
may_wait(_).

%!  journal_go is det.
%
%   What is to be let out goes soon.

journal_go :-
    commit_soon.
