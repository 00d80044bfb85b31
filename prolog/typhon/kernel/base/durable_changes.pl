:- module(typhon_durable_changes,
          [ durable_open/3,             % +Where, +Sync, +Seconds
            durable_opened/1,           % -Place
            durable_item/5,             % +Kind, +Order, -Key, -N, -Value
            durable_begin/0,
            durable_close/0,
            durable_end/0,
            durable_on/0,
            durable_closed/0,
            output_waits/0,
            durable_number/1,           % -N
            durable_number_after/1,     % +N
            durable_key/1,              % +Key
            durable_key/2,              % +Key, +N
            durable_put/4,              % +Kind, +Key, +N, +Term
            durable_drop/3,             % +Kind, +Key, +N
            durable_drop_all/2,         % +Kind, +Key
            durable_drop_below/3,       % +Kind, +Key, +N
            durable_put_at_once/4,      % +Kind, +Key, +N, +Term
            durable_drop_at_once/3,     % +Kind, +Key, +N
            durable_change/1,           % +Change
            durable_putting/5,          % +Kind, +Key, +N, +Term, -Change
            durable_bytes/2,            % +Change, -Count
            unit_of_work/1,             % :Goal
            enqueue_changes/0,
            sync_changes/0,
            commit_changes/0,
            send_after_commit/2,        % +Item, +When
            flush_sends/0,
            crash_point/1               % +Name
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2]).
:- autoload(library(uri), [uri_encoded/3]).
:- use_module(on_demand, [on_demand_load/2]).

/** <module> Changes that outlive the process

A module that changes durable data adds the change to the queue before others
can see it.  Changes that belong together are made inside unit_of_work/1: they
become one entry, which is committed as a whole.  Entries are committed in
order, so the store always holds a state that existed.

Output that may follow from a change leaves the process after the commit:
send_after_commit/2. sync_changes/0 waits for the commit.

The back end, which has the store and commits, is an option: it defines the
hooks below.  Without an open back end each change costs one call of
durable_on/0.

*Threading*: any thread.  The changes of one item are made one after another,
inside the mutex that guards its owner.
*/

:- multifile
    open_store/3,               % Where, Sync, Seconds: open the store
    durable_opened/1,
    durable_item/5,
    close_store/0,
    begin_commits/0,            % the store is open: begin to commit
    end_commits/0,              % commit the queue, and stop
    queue_entry/1,              % Changes: to be committed together
    queue_send/1,               % Item: to be sent after them
    commit_queue/0,             % commit now, and return when it is done
    flush_sends/0,              % commit soon
    commit_error/1,             % Error: of the last commit
    back_end_error/2,           % Why, Formal: `closed`, `key`
    committed/1,                % Items: they may be sent, in this order
    dropped/1,                  % Changes: their unit of work has failed
    reached/1.                  % Name: of crash_point/1

:- meta_predicate unit_of_work(0).

:- dynamic
    reached/1,
    durable_on/0,
    output_waits/0.

:- thread_local
    pending/1.                          % Change

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%!  durable_open(+Where, +Sync, +Seconds) is det.
%
%   Open the store at Where.
%
%   @arg Sync is `full` if commits survive a power cut, or `normal`
%   @arg Seconds is how long to wait until another process closes it
%   @error existence_error(back_end, Where): none is loaded; and those of the
%          back end

durable_open(Where, Sync, Seconds) :-
    on_demand_load(open_store, any),
    (   open_store(Where, Sync, Seconds)
    ->  true
    ;   existence_error(back_end, Where)
    ).

%!  durable_opened(-Place) is semidet.
%
%   A store is open; Place is its name in errors. The back end defines this.

%!  durable_item(+Kind, +Order, -Key, -N, -Value) is nondet.
%
%   The items of Kind in the open store. The back end defines this.
%
%   @arg Order is `numbers` if lower numbers come first, or `any`

%!  durable_begin is det.
%
%   The store is open and was read: queue changes from now on.

durable_begin :-
    begin_commits,
    assertz(output_waits),
    assertz(durable_on),
    get_flag(typhon_durable_number, N),
    durable_bound(N).

%!  durable_close is det.
%
%   Commit all changes.  From now on no output leaves the process, see
%   sync_changes/0.

durable_close :-
    enqueue_changes,
    retractall(durable_on),
    ignore(end_commits).

%!  durable_end is det.
%
%   Close the store, so that another process can open it.  Output leaves the
%   process again.

durable_end :-
    retractall(output_waits),
    ignore(close_store).

%!  durable_on is semidet.
%
%   Changes are queued: between durable_begin/0 and durable_close/0.

%!  output_waits is semidet.
%
%   Output waits for the commit: between durable_begin/0 and durable_end/0.

%!  durable_closed is semidet.
%
%   Between durable_close/0 and durable_end/0.

durable_closed :-
    output_waits,
    \+ durable_on.

%!  durable_number(-N:integer) is det.
%!  durable_number_after(+N:integer) is det.
%
%   N is greater than all numbers before; all later numbers are greater than N.
%   Without a back end N is 0.  Numbers stay unique after a restart: an item
%   that is written every 10,000 numbers holds where they begin.

durable_number(N) :-
    (   durable_on
    ->  flag(typhon_durable_number, N, N+1),
        (   N mod 10000 =:= 0
        ->  durable_bound(N)
        ;   true
        )
    ;   N = 0
    ).

durable_bound(N) :-
    Bound is N+20000,
    durable_put_at_once(number, '', 0, Bound).

durable_number_after(N) :-
    flag(typhon_durable_number, N0, max(N0, N+1)).

                /*******************************
                *             KEYS             *
                *******************************/

%!  durable_key(+Key) is semidet.
%!  durable_key(+Key, +N) is semidet.
%
%   Items can have this key, and this number.  Key and N may be any term.  A
%   commit that the database refuses is repeated for ever, and all later ones
%   wait: so keys that other processes choose, such as ids of agents, are
%   checked first.

durable_key(Key) :-
    atom(Key),
    atom_length(Key, Length),
    Length =< 500,                      % an index of PostgreSQL takes these
    is_text(Key).

durable_key(Key, N) :-
    integer(N),
    N >= -(1<<63),
    N < 1<<63,
    durable_key(Key).

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

%!  durable_put(+Kind, +Key, +N, +Term) is det.
%
%   Set the item to Term.
%
%   @error representation_error(_): no item can have this key

durable_put(Kind, Key, N, Term) :-
    (   durable_on
    ->  durable_putting(Kind, Key, N, Term, Change),
        durable_change(Change)
    ;   true
    ).

%!  durable_drop(+Kind, +Key, +N) is det.
%
%   Delete the item.

durable_drop(Kind, Key, N) :-
    drop(Key, N, drop(Kind, Key, N)).

%!  durable_drop_all(+Kind, +Key) is det.
%
%   Delete all items of this key.

durable_drop_all(Kind, Key) :-
    drop(Key, 0, drop_all(Kind, Key)).

%!  durable_drop_below(+Kind, +Key, +N) is det.
%
%   Delete the items of this key with numbers less than N.

durable_drop_below(Kind, Key, N) :-
    drop(Key, N, drop_below(Kind, Key, N)).

%   No item has an invalid key, so there is nothing to delete.

drop(Key, N, Change) :-
    (   durable_on,
        durable_key(Key, N)
    ->  durable_change(Change)
    ;   true
    ).

%!  durable_put_at_once(+Kind, +Key, +N, +Term) is det.
%!  durable_drop_at_once(+Kind, +Key, +N) is det.
%
%   As durable_put/4 and durable_drop/3, even if the unit of work fails, and
%   before its other changes.

durable_put_at_once(Kind, Key, N, Term) :-
    (   durable_on
    ->  durable_putting(Kind, Key, N, Term, Change),
        queue_entry([Change])
    ;   true
    ).

durable_drop_at_once(Kind, Key, N) :-
    (   durable_on
    ->  queue_entry([drop(Kind, Key, N)])
    ;   true
    ).

%!  durable_putting(+Kind, +Key, +N, +Term, -Change) is det.
%
%   Change sets the item to Term.
%
%   @error representation_error(_): no item can have this key

durable_putting(Kind, Key, N, Term, put(Kind, Key, N, Bytes)) :-
    (   durable_key(Key, N)
    ->  fast_term_serialized(Term, Bytes)
    ;   back_end_error(key, Formal),
        throw(error(Formal, _))
    ).

%!  durable_bytes(+Change, -Count) is det.
%
%   The term of the item that Change sets takes Count bytes.

durable_bytes(put(_, _, _, Bytes), Count) :-
    string_length(Bytes, Count).

%!  durable_change(+Change) is det.
%
%   Add Change to the unit of work, or queue it alone.

durable_change(Change) :-
    (   nb_current(typhon_durable_unit, true)
    ->  assertz(pending(Change))
    ;   queue_entry([Change])
    ).

%!  unit_of_work(:Goal) is semidet.
%
%   As once(Goal).  Its changes become one entry, queued when Goal succeeds, or
%   by enqueue_changes/0 before.  If Goal fails or raises an error, changes
%   that are not yet queued are dropped.

unit_of_work(Goal) :-
    (   \+ durable_on
    ->  once(Goal)
    ;   nb_current(typhon_durable_unit, true)
    ->  once(Goal)
    ;   setup_call_cleanup(nb_setval(typhon_durable_unit, true),
                           ( once(Goal), enqueue_changes ),
                           ( nb_setval(typhon_durable_unit, false),
                             drop_changes ))
    ).

drop_changes :-
    (   pending(_)
    ->  findall(Change, retract(pending(Change)), Changes),
        forall(dropped(Changes), true)
    ;   true
    ).

%!  enqueue_changes is det.
%
%   Queue the changes of this thread so far, as one entry.

enqueue_changes :-
    (   pending(_)
    ->  findall(Change, retract(pending(Change)), Changes),
        queue_entry(Changes)
    ;   true
    ).

                /*******************************
                *            COMMIT            *
                *******************************/

%!  sync_changes is det.
%
%   Return when all earlier changes are committed.
%
%   @error resource_error(_): the store is full
%   @error existence_error(_, open): the store was closed

sync_changes :-
    (   durable_on
    ->  enqueue_changes,
        commit_queue
    ;   output_waits
    ->  closed
    ;   true
    ).

closed :-
    back_end_error(closed, Formal),
    throw(error(Formal, _)).

%!  commit_changes is det.
%
%   As sync_changes/0, but no error after durable_close/0.

commit_changes :-
    (   output_waits
    ->  enqueue_changes,
        commit_queue
    ;   true
    ).

%!  send_after_commit(+Item, +When) is det.
%
%   While output waits, see output_waits/0: pass Item to committed/1 when all
%   earlier changes are committed, in the order of these calls.
%
%   @arg When is `now` if a caller waits for it; `anyhow` if a caller waits and
%        the error of the last commit shall not be raised; `later` if the
%        sender soon calls flush_sends/0, or sends another item
%   @error resource_error(_): the store is full, When is `now`, and Item is not
%          sent
%   @error existence_error(_, open): the store was closed

send_after_commit(Item, When) :-
    enqueue_changes,
    may_wait(When),
    (   durable_on,
        queue_send(Item)
    ->  true
    ;   closed
    ),
    (   When == later
    ->  true
    ;   flush_sends
    ).

may_wait(now) :-
    commit_error(Error),
    !,
    throw(Error).
may_wait(_).

%!  flush_sends is det.
%
%   Commit soon, and send the output that waits for it.  The back end defines
%   this.

                /*******************************
                *          CRASH POINTS        *
                *******************************/

%!  crash_point(+Name) is det.
%
%   The process has reached the step Name.  Tests define reached/1 to kill it
%   there.

crash_point(Name) :-
    forall(reached(Name), true).
