:- module(typhon_durable,
          [ durable/5,                  % +Kind, ?Key, ?N, ?Term, :Fact
            durable/6,                  % +Kind, ?Key, ?N, ?Term, :Dump,
                                        % :Restore
            durable_kinds/2,            % +Last, -Kinds
            durable_order/2,            % +Kind, -Order
            durable_assertz/1,          % :Fact
            durable_retractall/1,       % :Fact
            durable_dump/4,             % +Kind, -Key, -N, -Term
            durable_restore/4,          % +Kind, +Key, +N, +Term
            durable_opened/1,           % -Place
            durable_item/5,             % +Kind, +Order, -Key, -N, -Value
            durable_begin/0,
            durable_close/0,
            durable_end/0,
            durable_on/0,
            durable_closed/0,
            durable_restores/0,
            durable_number/1,           % -N
            durable_key/2,              % +Key, +N
            durable_put/4,              % +Kind, +Key, +N, +Term
            durable_drop/3,             % +Kind, +Key, +N
            durable_drop_all/2,         % +Kind, +Key
            durable_drop_below/3,       % +Kind, +Key, +N
            unit_of_work/1,             % :Goal
            after_unit/1,               % +Goal
            enqueue_changes/0,
            effects_deferred/0,
            deferred_drop/3,            % +Kind, +Key, +N
            deferred_act/4,             % +Kind, +Key, +Term, +By
            sync_changes/0,
            sync_after/1,               % :Goal
            commit_changes/0,
            send_after_commit/2,        % +Item, +When
            flush_sends/0,
            commits_must_succeed/0,
            durable_post/3,             % +Endpoint, +Kind, +Term
            crash_point/1               % +Name
          ]).

/** <module> Tables that outlive the process

Data that outlives the process consists of items, item(Kind, Key, N, Term): a
journal records them as they change, a saved network holds all of them.  The
owner of a table declares it once.  A table of facts needs only the item of a
fact:

    :- durable(outcome, Id, _, Outcome-Hops, outcome(Id, Outcome, Hops)).

Where the items are not facts, as in a mailbox, which is a queue, the owner
declares how to list them, and how to restore one:

    :- durable(mail, Id, N, Message, mail_item(Id, N, Message),
               mail_restore(Id, N, Message)).

N is 0, and Term is '', where the table has none.

A module that changes durable data adds the change to the queue before others
can see it.  Changes that belong together are made inside unit_of_work/1: they
become one entry, which is committed as a whole.  Entries are committed in
order, so the store always holds a state that existed.

Output that may follow from a change leaves the process after the commit:
send_after_commit/2. sync_changes/0 waits for the commit.

The actions of an agent between two stops are one unit of work, too: its
messages, and the facts that it leaves and takes, are deferred until it stops.

A process that stops closes the journal at one moment, durable_close/0, and for
all others it ends there, as by a crash: entries that are queued later are
dropped, each as a whole, and no output leaves the process.  In the process
durable_on/0 holds until its threads have stopped, so no unit of work is cut in
two, and no agent or answer leaves as it would without a journal.

The back end, which queues the changes, and has the store, is an option: it
defines the hooks below, and all exports that have no clause here.  Without an
open back end each change costs one call of durable_on/0, and nothing is
deferred.

*Threading*: any thread. The changes of one item are made one after another,
inside the mutex that guards its owner. Dump while nothing changes; restore
before agents run.
*/

:- use_module(library(lists), [append/3, subtract/3]).
:- use_module(index, [part_joins/3]).
:- use_module(on_demand, [on_demand_load/2]).

:- meta_predicate
    durable(+, ?, ?, ?, 0),
    durable(+, ?, ?, ?, 0, 0),
    durable_assertz(0),
    durable_retractall(0),
    sync_after(0),
    unit_of_work(0).

:- dynamic
    item_table/6,                       % Kind, Key, N, Term, Dump, Restore: Dump is
                                        % Module:Fact for a table of facts
    reached/1,
    durable_closed/0,
    durable_on/0.

:- multifile
    restored/0,                         % called when all items are restored
    recover/0,                          % restore the items of the journal
    tidy/0,                             % called before any peer is admitted
    go_on/0,                            % resume all that was restored
    durable_opened/1,
    durable_item/5,
    close_store/0,
    end_commits/0,                      % close the queue, and commit it
    next_number/1,                      % N: see durable_number/1
    durable_key/2,
    change/1,                           % Change: to be committed
    in_unit/1,                          % Goal: call it as one unit of work
    after_unit/1,
    enqueue/0,                          % see enqueue_changes/0
    deferring/0,                        % an agent acts in this thread
    deferred_drop/3,
    deferred_act/4,
    act/3,                              % Kind, Key, Term: what was deferred
    sync/0,                             % see sync_changes/0
    must_keep/0,                        % raise an error if changes were dropped
    commit/0,                           % see commit_changes/0
    send_after_commit/2,
    flush_sends/0,
    commit_error/1,                     % Error: commits fail with it now
    durable_post/3,
    undelivered/4,                      % Kind, Term, Endpoint, Formal: the post of
                                        % durable_post/3 cannot be sent
    committed/1,                        % Items: they may be sent, in this order
    reached/1.                          % Name: of crash_point/1

%!  durable(+Kind, ?Key, ?N, ?Term, :Fact) is det.
%!  durable(+Kind, ?Key, ?N, ?Term, :Dump, :Restore) is det.
%
%   Directives.  The items of this Kind are the facts Fact; or Dump enumerates
%   them, and Restore restores one.  Several tables may have one Kind: the
%   first one that accepts an item restores it.

durable(Kind, Key, N, Term, Module:Fact) :-
    durable(Kind, Key, N, Term, Module:Fact, Module:assertz(Fact)).

%   A file that is loaded again declares its tables again.

durable(Kind, Key, N, Term, Dump, Restore) :-
    Table = item_table(Kind, Key, N, Term, Dump, Restore),
    copy_term(Table, General),
    (   call(General),
        General =@= Table
    ->  true
    ;   assertz(Table)
    ).

%!  durable_kinds(+Last:list, -Kinds:list) is det.
%
%   The kinds of all declared tables, also of options that are not loaded, in
%   the order in which items are restored.  Those of Last come last, because
%   their items refer to items of the others.

durable_kinds(Last, Kinds) :-
    findall(Kind,
            (   item_table(Kind, _, _, _, _, _)
            ;   part_joins(durable, Kind, _)
            ),
            Kinds0),
    sort(Kinds0, All),
    subtract(All, Last, First),
    append(First, Last, Kinds).

%!  durable_order(+Kind, -Order) is det.
%
%   Order is `numbers` if the items of Kind have numbers, and are restored in
%   ascending order, else `any`.

durable_order(Kind, Order) :-
    (   item_table(Kind, _, _, _, _, _),
        \+ ( item_table(Kind, _, N, _, _, _), N \== 0 )
    ->  Order = any
    ;   Order = numbers
    ).

%!  durable_assertz(:Fact) is det.
%
%   Add Fact to a table of facts, as its newest item.
%
%   @error representation_error(_): no item can have this key

durable_assertz(Module:Fact) :-
    (   durable_on
    ->  once(item_table(Kind, Key, N, Term, Module:Fact, _)),
        ( var(N) -> durable_number(N) ; true ),
        no_term(Term),
        durable_put(Kind, Key, N, Term)
    ;   true
    ),
    assertz(Module:Fact).

%!  durable_retractall(:Fact) is det.
%
%   Remove the facts that match Fact, the key of which is bound.

durable_retractall(Module:Fact) :-
    (   durable_on
    ->  once(item_table(Kind, Key, _, _, Module:Fact, _)),
        durable_drop_all(Kind, Key)
    ;   true
    ),
    retractall(Module:Fact).

%!  durable_dump(+Kind, -Key, -N, -Term) is nondet.

durable_dump(Kind, Key, N, Term) :-
    item_table(Kind, Key, N, Term, Dump, _),
    call(Dump),
    ( var(N) -> N = 0 ; true ),
    no_term(Term).

no_term(Term) :-
    ( var(Term) -> Term = '' ; true ).

%!  durable_restore(+Kind, +Key, +N, +Term) is semidet.
%
%   Restore the item. Fails if no table accepts it.

durable_restore(Kind, Key, N, Term) :-
    on_demand_load(durable, Kind),
    item_table(Kind, Key, N, Term, _, Restore),
    call(Restore),
    !.

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%!  durable_opened(-Place) is semidet.
%
%   A store is open; Place is its name in errors.

%!  durable_item(+Kind, +Order, -Key, -N, -Value) is nondet.
%
%   The items of Kind in the open store.
%
%   @arg Order is `numbers` if lower numbers come first, or `any`

%!  durable_begin is det.
%
%   The store is open and was read, and the back end has begun to commit: queue
%   changes from now on.

durable_begin :-
    assertz(durable_on).

%!  durable_close is det.
%
%   Commit all changes.  From now on changes are dropped, and no output leaves
%   the process.

durable_close :-
    enqueue_changes,
    ( durable_on -> assertz(durable_closed) ; true ),
    ignore(end_commits).

%!  durable_end is det.
%
%   Close the store, so that another process can open it.  Output leaves the
%   process again.

durable_end :-
    retractall(durable_on),
    retractall(durable_closed),
    ignore(close_store).

%!  durable_on is semidet.
%
%   Changes are queued, and output waits for their commit: between
%   durable_begin/0 and durable_end/0.

%!  durable_closed is semidet.
%
%   Between durable_close/0 and durable_end/0.

%!  durable_restores is semidet.
%
%   A store is open, and its items are being restored: no change is queued yet.

durable_restores :-
    \+ durable_on,
    durable_opened(_).

                /*******************************
                *            CHANGES           *
                *******************************/

%!  durable_number(-N:integer) is det.
%
%   N is greater than all numbers before, also of earlier processes; without a
%   back end N is 0.

durable_number(N) :-
    (   durable_on
    ->  next_number(N)
    ;   N = 0
    ).

%!  durable_key(+Key, +N) is semidet.
%
%   Items can have this key, and this number.  Key and N may be any term: keys
%   that other processes choose, such as ids of agents, are checked first.

%!  durable_put(+Kind, +Key, +N, +Term) is det.
%
%   Set the item to Term.
%
%   @error representation_error(_): no item can have this key

durable_put(Kind, Key, N, Term) :-
    ( durable_on -> change(put(Kind, Key, N, Term)) ; true ).

%!  durable_drop(+Kind, +Key, +N) is det.
%!  durable_drop_all(+Kind, +Key) is det.
%!  durable_drop_below(+Kind, +Key, +N) is det.
%
%   Delete the item; all items of this key; those with numbers less than N.

durable_drop(Kind, Key, N) :-
    ( durable_on -> change(drop(Kind, Key, N)) ; true ).

durable_drop_all(Kind, Key) :-
    ( durable_on -> change(drop_all(Kind, Key)) ; true ).

durable_drop_below(Kind, Key, N) :-
    ( durable_on -> change(drop_below(Kind, Key, N)) ; true ).

%!  unit_of_work(:Goal) is semidet.
%
%   As once(Goal).  Its changes become one entry, queued when Goal succeeds, or
%   by enqueue_changes/0 before.  If Goal fails or raises an error, changes
%   that are not yet queued are dropped.

unit_of_work(Goal) :-
    ( durable_on -> in_unit(Goal) ; once(Goal) ).

%!  after_unit(+Goal) is det.
%
%   While durable_on/0 holds: call the qualified Goal in this thread when
%   the changes of this unit of work are queued; at once outside of one.

%!  enqueue_changes is det.
%
%   Queue the changes of this thread so far, as one entry.

enqueue_changes :-
    ( durable_on -> enqueue ; true ).

                /*******************************
                *        DEFERRED EFFECTS      *
                *******************************/

%!  effects_deferred is semidet.
%
%   An agent acts in this thread, and its effects are deferred until it stops.

effects_deferred :-
    durable_on,
    deferring.

%!  deferred_drop(+Kind, +Key, +N) is det.
%
%   Where changes are durable: as durable_drop/3; where effects are deferred, so
%   is the change.

%!  deferred_act(+Kind, +Key, +Term, +By) is det.
%
%   Where effects are deferred: call act(Kind, Key, Term) once, when the agent
%   has stopped, even if the process ends before.
%
%   @arg By is `frame` if Term must fit in a frame, else `any`
%   @error resource_error(frame_bytes)

                /*******************************
                *            COMMIT            *
                *******************************/

%!  sync_changes is det.
%
%   Return when all earlier changes of this thread are committed.
%
%   @error resource_error(_) and others: the store takes no commits now.  The
%          changes are committed as soon as it does, if the process lives
%   @error existence_error(_, open): the store was closed, and changes of this
%          thread were dropped

sync_changes :-
    ( durable_on -> sync ; true ).

%!  sync_after(:Goal) is det.
%
%   Call Goal once, then sync_changes/0, which also reports changes of Goal that
%   were dropped when the store has ended meanwhile.

sync_after(Goal) :-
    nb_setval(typhon_changes_dropped, none),
    once(Goal),                         % a store may open or close meanwhile
    (   durable_on
    ->  sync
    ;   nb_getval(typhon_changes_dropped, none)
    ->  true
    ;   must_keep
    ).

%!  commit_changes is det.
%
%   As sync_changes/0, but no error after durable_close/0.

commit_changes :-
    ( durable_on -> commit ; true ).

%!  send_after_commit(+Item, +When) is det.
%
%   While durable_on/0 holds: pass Item to committed/1 when all earlier changes
%   are committed, in the order of these calls.  While commits fail Item waits:
%   no thread of the platform gets an error of the store that it has not asked
%   for, see commits_must_succeed/0.
%
%   @arg When is `now`, or `later` if the sender soon calls flush_sends/0, or
%        sends another item
%   @error existence_error(_, open): the store was closed

%!  commits_must_succeed is det.
%
%   For callers that wait for their output, or would rather keep it until it can
%   leave the process.
%
%   @error the error with which commits fail now

commits_must_succeed :-
    (   durable_on,
        commit_error(Error)
    ->  throw(Error)
    ;   true
    ).

%!  flush_sends is det.
%
%   Commit soon, and send the output that waits for it.

%!  durable_post(+Endpoint, +Kind, +Term) is det.
%
%   Post Term to Endpoint exactly once, even if a process ends, together with
%   the changes of this unit of work so far, which ends here.
%
%   @error resource_error(frame_bytes)

                /*******************************
                *          CRASH POINTS        *
                *******************************/

%!  crash_point(+Name) is det.
%
%   The process has reached the step Name.  Tests define reached/1 to kill it
%   there.

crash_point(Name) :-
    forall(reached(Name), true).
