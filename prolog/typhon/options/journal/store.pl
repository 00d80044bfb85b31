:- module(typhon_store,
          [ journal_open/2,             % +Where, +Sync
            journal_open/3,             % +Where, +Sync, +Seconds
            journal_found/1,            % +Where
            journal_place/2,            % +Where, -Place
            store_close/0,
            store_sync/1,               % -Sync
            store_commit/1,             % +Changes
            journal_item/5              % +Kind, +Order, -Key, -N, -Value
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/durable', [crash_point/1]).
:- use_module('../../kernel/base/prolog_faults', [fast_bytes_term/2]).
:- use_module(database,
              [ database/3, database_connect/4, database_forgets/4,
                database_found/1, database_lock/3, database_same/4,
                database_stamp/3, database_tables/2, database_wrong/3,
                in_terms_of/3 ]).
:- use_module(recent,
              [ recent_before/2, recent_begin/1, recent_committed/1,
                recent_doubtful/0, recent_end/0 ]).
:- use_module(sql,
              [ sql_close/0, sql_disconnect/1, sql_do/2, sql_execute/2,
                sql_execute/3, sql_load/0, sql_open/1, sql_part/3, sql_row/4 ]).

/** <module> The store: items in a database

An item is a term identified by a kind, a key and a number.  Changes are

  - put(Kind, Key, N, Bytes): the item becomes Bytes, see item_bytes/2
  - drop(Kind, Key, N): delete the item
  - drop_all(Kind, Key), drop_below(Kind, Key, N): delete all items of this key,
    or those with numbers less than N

The database is SQLite in a directory, or PostgreSQL at a URL; higher layers do
not know which.  A process has one store at a time, and no other process can
open it meanwhile.  An item that is longer than a parameter of the driver can be
is stored in parts.

*Threading*: one thread at a time.
*/

:- multifile
    typhon_durable:durable_opened/1,
    typhon_durable:durable_item/5,
    typhon_durable:close_store/0,
    typhon_options:declared/4.

:- dynamic
    connection/2,                       % Place, Connection
    opened/3,                           % Base, Sync, Stamp
    broken/1,                           % Error: no commit until it is reopened
    long/3.                             % Kind, Key, N: has further parts

format_version(1).

part_bytes(30000).

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%!  journal_open(+Where, +Sync) is det.
%!  journal_open(+Where, +Sync, +Seconds) is det.
%
%   Open the store at Where, see journal_place/2, or make a new one.
%
%   @arg Seconds is how long to wait for another process to close it
%   @arg Sync is `full` if commits must survive a power cut, or `normal` if they
%        must survive the end of the process
%   @error permission_error(open, journal, Place): another process has it, or
%          the directory cannot be written
%   @error journal_damaged(Place, Why), journal_version(Place, Version),
%          journal_unreachable(Place, Why)
%   @error existence_error(package, Name): the package is not installed

journal_open(Where, Sync) :-
    journal_open(Where, Sync, 0.2).

journal_open(Where, Sync, Seconds) :-
    database(Where, Place, Base),
    sql_load,
    in_terms_of(Place, Base, database_connect(Base, Seconds, Connection, Age)),
    catch(in_terms_of(Place, Base,
                      prepare(Age, Place, Base, Sync, Connection)),
          error(Formal, Context),
          ( forget(Connection),
            throw(error(Formal, Context)) )),
    assertz(connection(Place, Connection)).

typhon_options:declared(host_option, journal(X), text, X).
typhon_options:declared(host_option, journal(postgresql(X)), text, X).
typhon_options:declared(host_option, sync(X), oneof([full, normal]), X).

prepare(Age, Place, Base, Sync, Connection) :-
    database_lock(Base, Sync, Connection),
    prepare_tables(Age, Place, Base, Connection),
    database_stamp(Base, Connection, Stamp),
    sql_do(Connection, commit),
    sql_open(Connection),
    assertz(opened(Base, Sync, Stamp)),
    (   database_forgets(Base, Sync, Connection, Seconds)
    ->  recent_begin(Seconds)
    ;   recent_end
    ).

prepare_tables(new, _, Base, Connection) :-
    database_tables(Base, Connection),
    format_version(Version),
    sample(Sample),
    format(atom(About), 'insert into about values (~d, \'~w\')',
           [Version, Sample]),
    sql_do(Connection, About).
prepare_tables(old, Place, Base, Connection) :-
    (   database_wrong(Base, Connection, Why)
    ->  throw(error(journal_damaged(Place, Why), _))
    ;   true
    ),
    must_be_ours(Place, Connection),
    forall(sql_row(Connection, 'select distinct kind, key, n from part',
                   row(Kind, Key, N), [atom, atom, integer]),
           assertz(long(Kind, Key, N))).

must_be_ours(Place, Connection) :-
    format_version(Version),
    sample(Sample),
    (   sql_row(Connection, 'select version, sample from about',
                row(Version0, Sample0), [integer, atom])
    ->  true
    ;   throw(error(journal_damaged(Place, 'it has no version'), _))
    ),
    (   Version0 == Version,
        Sample0 == Sample
    ->  true
    ;   throw(error(journal_version(Place, Version0), _))
    ).

%   A process of another version or word size must not read the items: any
%   difference in their format shows in this sample.

sample(Sample) :-
    Big is 1<<62,
    Huge is 1<<70,
    fast_term_serialized(f(X, X, -1, Big, Huge, 1.5, "text", [a]), Bytes),
    string_codes(Bytes, Codes),
    findall(Text, ( member(Code, Codes), format(atom(Text), '~16r.', [Code]) ),
            Texts),
    atomic_list_concat(Texts, Sample).

%!  journal_place(+Where, -Place:atom) is det.
%!  journal_found(+Where) is semidet.
%
%   See typhon_journal.  journal_found/1 succeeds if the journal exists.

journal_place(Where, Place) :-
    database(Where, Place, _).

journal_found(Where) :-
    database(Where, Place, Base),
    sql_load,
    in_terms_of(Place, Base, database_found(Base)).

%!  store_sync(-Sync) is semidet.
%!  store_close is det.
%
%   Sync is that of the open store; close the store.

typhon_durable:durable_opened(Place) :-
    connection(Place, _).

store_sync(Sync) :-
    opened(_, Sync, _).

store_close :-
    (   connection(_, Connection)
    ->  forget(Connection)
    ;   true
    ).

typhon_durable:close_store :-
    store_close.

forget(Connection) :-
    retractall(connection(_, _)),
    retractall(opened(_, _, _)),
    retractall(broken(_)),
    retractall(long(_, _, _)),
    recent_end,
    sql_close,
    sql_disconnect(Connection).

                /*******************************
                *            CHANGES           *
                *******************************/

%!  store_commit(+Changes:list) is det.
%
%   Apply all Changes, in this order, or none.
%
%   @error resource_error(journal_space): the disk is full
%   @error journal_damaged(Place, Why), journal_unreachable(Place, Why)
%   @error journal_unwritten(Place, Why): of this commit, and then of each until
%          the store is reopened.  After a failed fsync the system may drop what
%          it did not write, and report success for the next.

store_commit(_) :-
    broken(Error),
    !,
    throw(Error).
store_commit(Changes) :-
    catch(commit_new(Changes), error(journal_unreachable(_, _), _),
          ( connect_again, commit_new(Changes) )).

commit_new(Changes) :-
    recent_before(Changes, All),
    commit_all(All),
    recent_committed(Changes).

commit_all(Changes) :-
    connection(Place, _),
    opened(Base, _, _),
    catch(in_terms_of(Place, Base, commit(Changes)),
          error(Formal, Context),
          ( catch(sql_execute(rollback, []), error(_, _), true),
            breaks(error(Formal, Context)),
            throw(error(Formal, Context)) )).

breaks(Error) :-
    (   Error = error(journal_unwritten(_, _), _)
    ->  assertz(broken(Error))
    ;   true
    ).

%   A server that was restarted has lost the lock of this process, and perhaps
%   commits.  Another process may have opened the journal meanwhile.

connect_again :-
    connection(Place, Old),
    opened(Base, Sync, Stamp),
    in_terms_of(Place, Base, database_connect(Base, 0, New, _)),
    catch(in_terms_of(Place, Base, same(Base, Sync, Stamp, Place, New)),
          error(Formal, Context),
          ( sql_disconnect(New), throw(error(Formal, Context)) )),
    sql_close,
    sql_disconnect(Old),
    retractall(connection(_, _)),
    assertz(connection(Place, New)),
    sql_open(New),
    recent_doubtful.

same(Base, Sync, Stamp, Place, Connection) :-
    (   database_same(Base, Sync, Stamp, Connection)
    ->  true
    ;   throw(error(permission_error(open, journal, Place),
                    context(_, 'another process has opened it meanwhile')))
    ).

%   Transactions of the driver are not used: a full disk ends one without its
%   knowledge.

commit(Changes) :-
    sql_execute(begin, []),
    forall(member(Change, Changes), change(Change)),
    crash_point(in_commit),
    sql_execute(commit, []).

change(put(Kind, Key, N, Bytes)) =>
    check_sum(Bytes, Sum),
    string_length(Bytes, Length),
    part_bytes(Most),
    drop_parts(Kind, Key, N),
    (   Length =< Most
    ->  sql_execute(put, [Kind, Key, N, Length, Sum], Bytes)
    ;   assertz(long(Kind, Key, N)),
        sub_string(Bytes, 0, Most, _, First),
        sql_execute(put, [Kind, Key, N, Length, Sum], First),
        Last is (Length-1)//Most,
        forall(between(1, Last, Part), put_part(Kind, Key, N, Part, Bytes))
    ).
change(drop(Kind, Key, N)) =>
    drop_parts(Kind, Key, N),
    sql_execute(drop, [Kind, Key, N]).
change(drop_all(Kind, Key)) =>
    forall(long(Kind, Key, N), drop_parts(Kind, Key, N)),
    sql_execute(drop_all, [Kind, Key]).
change(drop_below(Kind, Key, N)) =>
    forall(( long(Kind, Key, N0), N0 < N ), drop_parts(Kind, Key, N0)),
    sql_execute(drop_below, [Kind, Key, N]).

%   24 bits: term_hash/2 gives 24 or 32 bits in different versions, and the
%   integers of the driver are signed.

check_sum(Bytes, Sum) :-
    term_hash(Bytes, Hash),
    Sum is Hash /\ 0xffffff.

put_part(Kind, Key, N, Part, Bytes) :-
    part_bytes(Most),
    Start is Part*Most,
    string_length(Bytes, Length),
    Count is min(Most, Length-Start),
    sub_string(Bytes, Start, Count, _, Piece),
    sql_execute(put_part, [Kind, Key, N, Part], Piece).

drop_parts(Kind, Key, N) :-
    (   retract(long(Kind, Key, N))
    ->  sql_execute(drop_part, [Kind, Key, N])
    ;   true
    ).

%!  journal_item(+Kind, +Order, -Key, -N, -Value) is nondet.
%
%   Value is an item of Kind.
%
%   @arg Order is `numbers` for ascending numbers, or `any`
%   @error journal_damaged(Place, Kind-Key)

journal_item(Kind, Order, Key, N, Value) :-
    connection(Place, Connection),
    order(Order, By),
    format(atom(Sql), 'select key, n, length, sum, value from item \c
                       where kind=\'~w\'~w', [Kind, By]),
    sql_row(Connection, Sql, row(Key, N, Length, Sum, First),
            [atom, integer, integer, integer, string]),
    whole(Length, Kind-Key-N, First, Bytes),
    (   check_sum(Bytes, Sum)
    ->  fast_bytes_term(Bytes, Value)
    ;   throw(error(journal_damaged(Place, Kind-Key), _))
    ).

typhon_durable:durable_item(Kind, Order, Key, N, Value) :-
    journal_item(Kind, Order, Key, N, Value).

order(any, '').
order(numbers, ' order by n').

whole(Length, _, First, Bytes) :-
    part_bytes(Most),
    Length =< Most,
    !,
    sub_string(First, 0, Length, _, Bytes).
whole(Length, Kind-Key-N, First0, Bytes) :-
    part_bytes(Most),
    sub_string(First0, 0, Most, _, First),
    findall(Piece,
            ( sql_part(parts, [Kind, Key, N], Full),
              string_length(Full, Space),
              Count is min(Most, Space),
              sub_string(Full, 0, Count, _, Piece) ),
            Pieces),
    atomic_list_concat([First|Pieces], Atom),
    atom_string(Atom, All),
    sub_string(All, 0, Length, _, Bytes).
