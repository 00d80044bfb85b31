:- module(typhon_ledger,
          [ journal_begin/0,
            journal_close/0,
            journal_end/0,
            journal_on/0,
            journal_guards/0,
            journal_number/1,           % -N
            journal_number_after/1,     % +N
            note_put/4,                 % +Kind, +Key, +N, +Term
            note_drop/3,                % +Kind, +Key, +N
            note_drop_all/2,            % +Kind, +Key
            note_drop_below/3,          % +Kind, +Key, +N
            note_change/1,              % +Change
            note_bytes/2,               % +Term, -Bytes
            journal_step/1,             % :Goal
            journal_seal/0,
            journal_barrier/0,
            journal_commit/0
          ]).
:- use_module(library(lists), [append/2, reverse/2]).
:- use_module(library(rbtrees), [rb_insert_new/4, rb_new/1]).
:- use_module('../base/fifo', [fifo_empty/2]).
:- use_module('../base/output', [output_own/0]).
:- use_module(crash, [crash_point/1]).
:- use_module(store, [store_close/0, store_commit/1]).

/** <module> What is to be committed

Who changes something that is to outlive the process notes it, before others
can see the change.  What belongs together is noted inside journal_step/1, and
sealed: then it is one entry of a queue.  Entries are committed in order, as
many at a time as there are, so what is in the store is always what was so at
some moment.

Who lets something out of the process says journal_barrier/0 before: it
returns when all that was sealed until then is committed.  Of those who wait
there the first commits for all.  What nobody waits for is committed by a
thread within some milliseconds.

*Threading*: any thread.  Changes of one item are noted one after another,
inside the mutex that guards what it is about.
*/

:- meta_predicate journal_step(0).

:- dynamic
    journal_on/0,
    journal_guards/0,
    queue/2,                            % Entries, Wake
    unsaved/1,                          % Changes that could not be committed
    committer/1,                        % Thread
    told/1.                             % Error: nothing can be committed

:- thread_local
    noted/1.                            % Change

%   What nobody waits for waits so long.

idle_seconds(0.005).

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%!  journal_begin is det.
%!  journal_close is det.
%!  journal_end is det.
%!  journal_on is semidet.
%!  journal_guards is semidet.
%
%   The store is open, and what it knows was read: from now on changes are
%   noted; all is committed: from now on nothing leaves the process, see
%   journal_barrier/0, and what happens in it is not known any more; it may
%   again, and the store is closed: until then nobody else can open it, and
%   want the port that this process has; whether changes are noted; whether
%   there is a barrier, from begin to end.

journal_begin :-
    message_queue_create(Entries),
    message_queue_create(Wake),
    assertz(queue(Entries, Wake)),
    set_flag(typhon_journal_awake, 0),
    thread_create(commit_at_leisure(Wake), Thread, [alias(typhon_journal)]),
    assertz(committer(Thread)),
    assertz(journal_guards),
    assertz(journal_on),
    get_flag(typhon_journal_number, N),
    note_number(N).

journal_close :-
    retract(committer(Thread)),
    !,
    journal_seal,
    retractall(journal_on),
    queue(Entries, Wake),
    thread_send_message(Wake, stop),
    thread_join(Thread, _),
    catch(commit, error(Formal, Context),
          print_message(error, error(Formal, Context))),
    retractall(queue(_, _)),
    retractall(unsaved(_)),
    message_queue_destroy(Entries),
    message_queue_destroy(Wake).
journal_close.

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
    note_bytes(Bound, Bytes),
    enqueue([put(number, '', 0, Bytes)]).

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

note_put(Kind, Key, N, Term) :-
    (   journal_on
    ->  note_bytes(Term, Bytes),
        note_change(put(Kind, Key, N, Bytes))
    ;   true
    ).

note_drop(Kind, Key, N) :-
    (   journal_on
    ->  note_change(drop(Kind, Key, N))
    ;   true
    ).

note_drop_all(Kind, Key) :-
    (   journal_on
    ->  note_change(drop_all(Kind, Key))
    ;   true
    ).

note_drop_below(Kind, Key, N) :-
    (   journal_on
    ->  note_change(drop_below(Kind, Key, N))
    ;   true
    ).

%!  note_bytes(+Term, -Bytes) is det.
%!  note_change(+Change) is det.

note_bytes(Term, Bytes) :-
    fast_term_serialized(Term, Bytes).

note_change(Change) :-
    (   nb_current(typhon_journal_step, true)
    ->  assertz(noted(Change))
    ;   enqueue([Change])
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
        enqueue(Changes)
    ;   true
    ).

enqueue(Changes) :-
    queue(Entries, Wake),
    !,
    thread_send_message(Entries, Changes),
    (   get_flag(typhon_journal_awake, 0)
    ->  set_flag(typhon_journal_awake, 1),
        thread_send_message(Wake, go)
    ;   true
    ).
enqueue(_).                             % it has been closed

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
    ->  journal_commit
    ;   journal_guards
    ->  throw(error(existence_error(journal, open), _))
    ;   true
    ).

%!  journal_commit is det.
%
%   All that was noted before is committed, also what was before the journal
%   was closed; for who lets go what has waited.
%
%   @error resource_error(journal_space)

journal_commit :-
    (   journal_guards
    ->  journal_seal,
        commit
    ;   true
    ).

commit :-
    with_mutex(typhon_commit, commit_all).

commit_all :-
    queue(Entries, _),
    !,
    fifo_empty(Entries, New),
    findall(Old, retract(unsaved(Old)), Olds),
    append([Olds, New], All),
    (   All == []
    ->  true
    ;   append(All, Changes0),
        settled(Changes0, Changes),
        crash_point(before_commit),
        catch(store_commit(Changes), error(Formal, Context),
              ( assertz(unsaved(Changes)),
                throw(error(Formal, Context)) )),
        retractall(told(_)),
        crash_point(after_commit)
    ).
commit_all.

%   settled(+Changes0, -Changes): without those of items that change once more.

settled(Changes0, Changes) :-
    reverse(Changes0, Newest),
    length(Newest, Count),
    (   Count =< 32
    ->  Seen = []                       % quicker for so few
    ;   rb_new(Seen)
    ),
    last_of_each(Newest, Seen, [], Changes).

last_of_each([], _, Changes, Changes).
last_of_each([Change|Older], Seen0, Changes0, Changes) :-
    (   item_of(Change, Item)
    ->  (   first_seen(Seen0, Item, Seen)
        ->  last_of_each(Older, Seen, [Change|Changes0], Changes)
        ;   last_of_each(Older, Seen0, Changes0, Changes)
        )
    ;   last_of_each(Older, Seen0, [Change|Changes0], Changes)
    ).

first_seen(Seen0, Item, Seen) :-
    is_list(Seen0),
    !,
    \+ memberchk(Item, Seen0),
    Seen = [Item|Seen0].
first_seen(Seen0, Item, Seen) :-
    rb_insert_new(Seen0, Item, true, Seen).

item_of(put(Kind, Key, N, _), Kind-Key-N).
item_of(drop(Kind, Key, N), Kind-Key-N).

%   The goal of the thread that sees to what nobody waits for.

commit_at_leisure(Wake) :-
    output_own,
    repeat,
    thread_get_message(Wake, Message),
    (   Message == stop
    ->  !
    ;   idle_seconds(Seconds),
        at_leisure(Wake, Seconds),
        fail
    ).

at_leisure(Wake, Seconds) :-
    (   thread_self(Me),
        thread_get_message(Me, '$typhon_never', [timeout(Seconds)])
    ->  true
    ;   true
    ),
    set_flag(typhon_journal_awake, 0),
    catch(commit, error(Formal, Context),
          not_committed(error(Formal, Context), Wake)).

not_committed(Error, Wake) :-
    (   retract(told(_))
    ->  true
    ;   print_message(error, Error)
    ),
    assertz(told(Error)),
    set_flag(typhon_journal_awake, 1),
    (   thread_self(Me),
        thread_get_message(Me, '$typhon_never', [timeout(1)])
    ->  true
    ;   true
    ),
    thread_send_message(Wake, go).
