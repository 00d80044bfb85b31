:- module(typhon_sql_tables, []).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/durable', [crash_point/1]).
:- use_module(database,
              [ database/3, database_connect/4, database_forgets/4,
                database_found/1, database_lock/3, database_part/3,
                database_record/2, database_record_drop/1,
                database_record_put/2, database_same/4, database_stamp/3,
                database_tables/2, database_unopened/2, database_wrong/3,
                in_terms_of/3 ]).
:- use_module(item_format,
              [bytes_sum/2, format_current/2, format_must_be/3]).
:- use_module(recent,
              [ recent_before/2, recent_begin/1, recent_committed/1,
                recent_doubtful/0, recent_end/0 ]).
:- use_module(sql,
              [ sql_close/0, sql_disconnect/1, sql_do/2, sql_execute/2,
                sql_execute/3, sql_load/0, sql_open/1, sql_part/3, sql_row/4 ]).

/** <module> Journals in tables of SQLite or PostgreSQL

A back end of typhon_store, with the Base sql(Database); this module does not
know which database it is, see typhon_database.  An item that is longer than a
parameter of the driver can be is stored in parts.

*Threading*: one thread at a time.
*/

:- multifile
    typhon_store:backend_place/4,
    typhon_store:backend_part/4,
    typhon_store:backend_found/2,
    typhon_store:backend_open/4,
    typhon_store:backend_close/1,
    typhon_store:backend_commit/3,
    typhon_store:backend_item/7,
    typhon_store:backend_record/3,
    typhon_store:backend_record_put/3,
    typhon_store:backend_record_drop/2,
    typhon_options:declared/4.

:- dynamic
    opened/4,                           % Connection, Base, Sync, Stamp
    long/3.                             % Kind, Key, N: has further parts

part_bytes(30000).

typhon_options:declared(host_option, journal(postgresql(X)), text, X).

typhon_store:backend_place(text, Where, Place, sql(Base)) :-
    database(Where, Place, Base).
typhon_store:backend_place(postgresql, Where, Place, sql(Base)) :-
    database(Where, Place, Base).

typhon_store:backend_part(text, Where, P, Part) :-
    database_part(Where, P, Part).
typhon_store:backend_part(postgresql, Where, P, Part) :-
    database_part(Where, P, Part).

typhon_store:backend_record(sql(Base), Place, Text) :-
    in_terms_of(Place, Base, database_record(Base, Text)).
typhon_store:backend_record_put(sql(Base), Place, Text) :-
    in_terms_of(Place, Base, database_record_put(Base, Text)).
typhon_store:backend_record_drop(sql(Base), Place) :-
    in_terms_of(Place, Base, database_record_drop(Base)).

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

typhon_store:backend_found(sql(Base), Place) :-
    sql_load,
    in_terms_of(Place, Base, database_found(Base)).

typhon_store:backend_open(sql(Base), Place, Sync, Seconds) :-
    sql_load,
    in_terms_of(Place, Base, database_connect(Base, Seconds, Connection, Age)),
    catch(in_terms_of(Place, Base,
                      prepare(Age, Place, Base, Sync, Connection)),
          error(Formal, Context),
          ( forget(Connection),
            throw(error(Formal, Context)) )).

prepare(Age, Place, Base, Sync, Connection) :-
    database_lock(Base, Sync, Connection),
    prepare_tables(Age, Place, Base, Connection),
    database_stamp(Base, Connection, Stamp),
    sql_do(Connection, commit),
    sql_open(Connection),
    assertz(opened(Connection, Base, Sync, Stamp)),
    (   database_forgets(Base, Sync, Connection, Seconds)
    ->  recent_begin(Seconds)
    ;   recent_end
    ).

prepare_tables(new, _, Base, Connection) :-
    database_tables(Base, Connection),
    format_current(Version, Sample),
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
    (   sql_row(Connection, 'select version, sample from about',
                row(Version, Sample), [integer, atom])
    ->  format_must_be(Place, Version, Sample)
    ;   throw(error(journal_damaged(Place, 'it has no version'), _))
    ).

typhon_store:backend_close(sql(_)) :-
    forall(opened(Connection, _, _, _), forget(Connection)).

forget(Connection) :-
    retractall(opened(_, _, _, _)),
    retractall(long(_, _, _)),
    recent_end,
    sql_close,
    sql_disconnect(Connection).

                /*******************************
                *            CHANGES           *
                *******************************/

typhon_store:backend_commit(sql(Base), Place, Changes) :-
    catch(commit_new(Base, Place, Changes), error(journal_unreachable(_, _), _),
          ( connect_again(Place), commit_new(Base, Place, Changes) )).

commit_new(Base, Place, Changes) :-
    recent_before(Changes, All),
    commit_all(Base, Place, All),
    recent_committed(Changes).

commit_all(Base, Place, Changes) :-
    catch(in_terms_of(Place, Base, commit(Changes)),
          error(Formal, Context),
          ( catch(sql_execute(rollback, []), error(_, _), true),
            throw(error(Formal, Context)) )).

%   A server that was restarted has lost the lock of this process, and perhaps
%   commits.  Another process may have opened the journal meanwhile.

connect_again(Place) :-
    opened(Old, Base, Sync, Stamp),
    catch(in_terms_of(Place, Base, database_connect(Base, 0, New, _)),
          error(permission_error(open, journal, Place), Context0),
          in_terms_of(Place, Base, locked(Base, Stamp, Place, Context0))),
    catch(in_terms_of(Place, Base, same(Base, Sync, Stamp, Place, New)),
          error(Formal, Context),
          ( sql_disconnect(New), throw(error(Formal, Context)) )),
    sql_close,
    sql_disconnect(Old),
    retractall(opened(_, _, _, _)),
    assertz(opened(New, Base, Sync, Stamp)),
    sql_open(New),
    recent_doubtful.

%   The lock may be that of the former connection, which the server has not yet
%   found broken.

locked(Base, Stamp, Place, Context) :-
    (   database_unopened(Base, Stamp)
    ->  throw(error(journal_unreachable(Place, 'it is locked'), _))
    ;   throw(error(permission_error(open, journal, Place), Context))
    ).

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
    bytes_sum(Bytes, Sum),
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

typhon_store:backend_item(sql(_), Kind, Order, Key, N, Bytes, Sum) :-
    opened(Connection, _, _, _),
    order(Order, By),
    format(atom(Sql), 'select key, n, length, sum, value from item \c
                       where kind=\'~w\'~w', [Kind, By]),
    sql_row(Connection, Sql, row(Key, N, Length, Sum, First),
            [atom, integer, integer, integer, string]),
    whole(Length, Kind-Key-N, First, Bytes).

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
