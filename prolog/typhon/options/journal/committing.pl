:- module(typhon_committing,
          [ commits_begin/0,
            queue_entry/1,              % +Changes
            queue_send/1,               % +Item
            queue_flush/0,
            queue_must_keep/0,
            commit_queue/0
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2, reverse/2]).
:- use_module(library(rbtrees), [rb_insert_new/4, rb_new/1]).
:- use_module('../../kernel/base/monotonic', [deadline/2]).
:- use_module('../../kernel/base/durable', [crash_point/1, durable_closed/0]).
:- use_module('../../kernel/base/fifo', [fifo_empty/2]).
:- use_module('../../kernel/base/server',
              [server_cast/2, server_start/4, server_stop/1]).
:- use_module(store, [store_commit/1, store_sync/1]).

/** <module> Group commit of queued changes, in order

A queue holds entries of changes and, between them, output that may leave the
process when the entries before it are committed.  The committing thread takes
all of the queue: the changes become one transaction, then the output items are
sent, in their order.  So a thread that only sends does not wait for the disk.

Where a commit waits for the disk to sync, a thread of its own commits; entries
that gather meanwhile are the next transaction.  Otherwise a thread that has
output to send commits itself.  Entries without a waiting thread are committed
after some milliseconds.  After a failed commit the changes and the output are
kept, and the commit is tried again each second.

The close of the queue is one moment: entries from before are in the last
commit, later ones are dropped, each as a whole.

*Threading*: any thread.  One thread at a time commits; it holds a mutex in
which it may take those of sessions, so a thread that holds a mutex of a session
must not commit.
*/

:- multifile
    typhon_durable:commit_error/1,
    typhon_durable:end_commits/0.

:- dynamic
    queue/3,                            % Entries, Committer, Sync
    unsaved/2,                          % Changes and items that wait for them
    committer/1,                        % Server
    reported/1.                         % Error: commits fail with it, or the
                                        % last one has failed

%   Delay before an idle commit, and before a failed commit is tried again.

idle_seconds(0.02).
again_seconds(1).

%!  commits_begin is det.
%
%   The store is open: begin to commit.

commits_begin :-
    on_signal(xfsz, _, typhon_committing:file_too_long),
    store_sync(Sync),
    set_flag(typhon_journal_awake, 0),
    flag(typhon_journal_start, N, N+1),
    retractall(reported(_)),
    server_start(journal, typhon_committing:commits, none, Committer),
    message_queue_create(Entries),
    assertz(queue(Entries, Committer, Sync)),
    assertz(committer(Committer)).

%   If a file exceeds its maximal size (SIGXFSZ), the write raises an error, as
%   on a full disk; the signal must not interrupt the thread.

:- public file_too_long/1.

file_too_long(_).

%   Fails if commits had not begun.

typhon_durable:end_commits :-
    retract(committer(Committer)),
    !,
    server_stop(Committer),
    sig_atomic(with_mutex(typhon_commit, last_commit)).

last_commit :-
    with_mutex(typhon_entries, retract(queue(Entries, _, _))),
    catch(commit_all(Entries), error(Formal, Context),
          ( print_message(error, error(Formal, Context)),
            assertz(reported(error(Formal, Context))) )),
    retractall(unsaved(_, _)),
    message_queue_destroy(Entries).

                /*******************************
                *            ENTRIES           *
                *******************************/

%!  queue_entry(+Changes:list) is det.
%!  queue_send(+Item) is semidet.
%
%   Queue Changes, to be committed together, and Item, to be sent after them.
%   Without a queue the back end has been closed: changes are dropped, output
%   fails.

queue_entry(Changes) :-
    (   queued(Changes)
    ->  true
    ;   get_flag(typhon_journal_start, Start),
        nb_setval(typhon_changes_dropped, Start)
    ).

queue_send(Item) :-
    queued(item(Item)).

%   The mutex decides for each entry whether it precedes the last commit.

queued(Entry) :-
    with_mutex(typhon_entries, put_entry(Entry)),
    wake(idle).

put_entry(Entry) :-
    queue(Entries, _, _),
    !,
    thread_send_message(Entries, Entry).

%!  queue_must_keep is det.
%
%   The journal has or will have all entries of this thread since it was opened.
%
%   @error existence_error(journal, open) if it was closed before one of them;
%          the error of the last commit

queue_must_keep :-
    (   nb_current(typhon_changes_dropped, Start),
        get_flag(typhon_journal_start, Start)
    ->  existence_error(journal, open)
    ;   \+ queue(_, _, _),
        reported(Error)
    ->  throw(Error)
    ;   true
    ).

%   wake(+How): the committer commits after a delay (`idle`), or `now`.

wake(How) :-
    urgency(How, Urgency),
    (   get_flag(typhon_journal_awake, Awake),
        Awake >= Urgency
    ->  true
    ;   sig_atomic(( set_flag(typhon_journal_awake, Urgency),
                     ignore(( queue(_, Committer, _),   % fails after the end
                              server_cast(Committer, How) )) ))
    ).

urgency(idle, 1).
urgency(now, 2).

typhon_durable:commit_error(Error) :-
    reported(Error).

%   What happens after the journal was closed has not happened.

:- multifile user:message_hook/3.
:- dynamic user:message_hook/3.

user:message_hook(Message, _, _) :-
    durable_closed,
    (   Message = typhon(raised(Error))
    ->  true
    ;   Error = Message
    ),
    subsumes_term(error(existence_error(journal, open), _), Error).

                /*******************************
                *            COMMIT            *
                *******************************/

%!  commit_queue is det.
%
%   Commit now, and return when it is done, or when the last commit is over.  If
%   it fails the committer tries again.
%
%   @error resource_error(journal_space)

commit_queue :-
    catch(commit_waiting, error(Formal, Context),
          ( wake(now),
            throw(error(Formal, Context)) )).

commit_waiting :-
    sig_atomic(( with_mutex(typhon_commit, commit_open),
                 commit_if_wanted )).

%!  queue_flush is det.
%
%   Commit soon.

queue_flush :-
    queue(_, _, full),
    !,
    wake(now).
queue_flush :-
    sig_atomic(commit_or_leave).

%   A thread that wants a commit does not wait for the committing thread, which
%   sees the flag and commits again.

commit_or_leave :-
    mutex_trylock(typhon_commit),
    !,
    commit_locked.
commit_or_leave :-
    set_flag(typhon_journal_wanted, 1),
    mutex_trylock(typhon_commit),
    !,                                  % the owner may have missed the flag
    commit_locked.
commit_or_leave.

%   If the commit fails the committer, which may be this thread, commits again at
%   once, and reports an error.

commit_locked :-
    set_flag(typhon_journal_wanted, 0),
    call_cleanup(catch(commit_open, error(_, _), Failed = true),
                 mutex_unlock(typhon_commit)),
    (   Failed == true
    ->  wake(now)
    ;   commit_if_wanted
    ).

commit_if_wanted :-
    (   get_flag(typhon_journal_wanted, 1)
    ->  commit_or_leave
    ;   true
    ).

commit_open :-
    (   queue(Entries, _, _)
    ->  commit_all(Entries)
    ;   true
    ).

commit_all(Entries) :-
    fifo_empty(Entries, New),
    split_entries(New, Changes0, Items0),
    (   retract(unsaved(Changes1, Items1))
    ->  append(Changes1, Changes0, Changes2),
        append(Items1, Items0, Items)
    ;   Changes2 = Changes0,
        Items = Items0
    ),
    save(Changes2, Items),
    (   Items == []
    ->  true
    ;   release(Items)
    ).

release(Items) :-
    catch(ignore(typhon_durable:committed(Items)),
          error(Formal, Context),
          print_message(error, error(Formal, Context))).

split_entries([], [], []).
split_entries([item(Item)|Entries], Changes, [Item|Items]) :-
    !,
    split_entries(Entries, Changes, Items).
split_entries([Entry|Entries], Changes, Items) :-
    append(Entry, Others, Changes),
    split_entries(Entries, Others, Items).

save([], _) :-
    !.
save(Changes0, Items) :-
    last_changes(Changes0, Changes),
    crash_point(before_commit),
    catch(store_commit(Changes), error(Formal, Context),
          ( assertz(unsaved(Changes, Items)),
            throw(error(Formal, Context)) )),
    retractall(reported(_)),
    crash_point(after_commit).

%   last_changes(+Changes0, -Changes): keep only the last change of each item.

last_changes(Changes0, Changes) :-
    reverse(Changes0, Newest),
    length(Newest, Count),
    (   Count =< 32
    ->  Seen = []                       % faster for so few
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

                /*******************************
                *          THE COMMITTER       *
                *******************************/

:- public commits/3.

commits(begin, State, Next) :-
    commit_now(State, Next).
commits(idle, State, until(Stamp, State)) :-
    idle_seconds(Seconds),
    deadline(Seconds, Stamp).
commits(now, State, Next) :-
    commit_now(State, Next).
commits(timeout, State, Next) :-
    commit_now(State, Next).

commit_now(State, Next) :-
    set_flag(typhon_journal_awake, 0),
    catch(( commit_waiting,
            Next = State ),
          error(Formal, Context),
          not_committed(error(Formal, Context), State, Next)).

not_committed(Error, State, until(Stamp, State)) :-
    note_error(Error),
    set_flag(typhon_journal_awake, 2),
    again_seconds(Seconds),
    deadline(Seconds, Stamp).

%   An error is printed once, and each other one that the next tries raise.

note_error(error(Formal, _)) :-
    reported(error(Formal0, _)),
    Formal0 =@= Formal,
    !.
note_error(Error) :-
    print_message(error, Error),
    findall(Old, reported(Old), Others),
    asserta(reported(Error)),
    forall(member(Old, Others), retract(reported(Old))).
