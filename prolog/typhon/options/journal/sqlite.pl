:- module(typhon_sqlite, []).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(sql, [sql_connect/2, sql_do/2, sql_row/4]).

/** <module> A journal in SQLite: a file of a directory

See typhon_database.  The Base is sqlite(Dir).

*Threading*: one thread at a time.
*/

:- multifile
    typhon_database:database_found/1,
    typhon_database:database_connect/4,
    typhon_database:database_lock/3,
    typhon_database:database_tables/2,
    typhon_database:database_stamp/3,
    typhon_database:database_wrong/3,
    typhon_database:record/2,
    typhon_database:record_put/2,
    typhon_database:record_drop/1,
    typhon_database:error_words/3.

typhon_database:database_found(sqlite(Dir)) :-
    file(Dir, File),
    exists_file(File).

typhon_database:database_connect(sqlite(Dir), Seconds, Connection, Age) :-
    catch(make_directory_path(Dir), error(Formal, _),
          not_written(Dir, Formal)),
    file(Dir, File),
    (   exists_file(File)
    ->  Age = old
    ;   Age = new
    ),
    Timeout is truncate(1000*Seconds),
    format(atom(Driver), 'DRIVER=SQLite3;Timeout=~d;Database=~w',
           [Timeout, File]),
    sql_connect(Driver, Connection).

file(Dir, File) :-
    directory_file_path(Dir, 'journal.db', File).

%   The lock is taken by the first change of the transaction, and kept.

typhon_database:database_lock(sqlite(_), Sync, Connection) :-
    pragma(Connection, locking_mode, exclusive),
    pragma(Connection, journal_mode, wal),
    pragma(Connection, synchronous, Sync),
    sql_do(Connection, 'begin exclusive').

pragma(Connection, Name, Value) :-
    format(atom(Pragma), 'pragma ~w=~w', [Name, Value]),
    sql_do(Connection, Pragma).

typhon_database:database_tables(sqlite(_), Connection) :-
    sql_do(Connection,
           'create table item (kind text, key text, n integer, \c
            length integer, sum integer, value blob, \c
            primary key (kind, key, n)) without rowid'),
    sql_do(Connection,
           'create table part (kind text, key text, n integer, \c
            part integer, value blob, \c
            primary key (kind, key, n, part)) without rowid'),
    sql_do(Connection,
           'create table about (version integer, sample text)').

typhon_database:database_stamp(sqlite(_), _, none).

typhon_database:database_wrong(sqlite(_), Connection, Why) :-
    sql_row(Connection, 'pragma quick_check(1)', row(Said), [atom]),
    !,
    Said \== ok,
    Why = Said.

%   The record is a file that is written completely or not at all.

typhon_database:record(sqlite(Dir), Text) :-
    record_file(Dir, File),
    exists_file(File),
    read_file_to_string(File, Text, [encoding(utf8)]).

typhon_database:record_put(sqlite(Dir), Text) :-
    record_file(Dir, File),
    atom_concat(File, '.new', New),
    catch(( make_directory_path(Dir),
            setup_call_cleanup(open(New, write, Out, [encoding(utf8)]),
                               write(Out, Text),
                               close(Out)),
            rename_file(New, File) ),
          error(Formal, _),
          not_written(Dir, Formal)).

not_written(Dir, Formal) :-
    format(atom(Why), 'it cannot be written: ~p', [Formal]),
    throw(error(permission_error(open, journal, Dir), context(_, Why))).

typhon_database:record_drop(sqlite(Dir)) :-
    record_file(Dir, File),
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

record_file(Dir, File) :-
    directory_file_path(Dir, 'network.pl', File).

typhon_database:error_words(sqlite(_), ['is locked'], locked).
typhon_database:error_words(sqlite(_),
                            [readonly, 'unable to open', 'connect failed'],
                            unwritable).
typhon_database:error_words(sqlite(_), ['is full', 'disk I/O'], full).
typhon_database:error_words(sqlite(_), [driver, 'Driver', 'Data source'],
                            missing(libsqliteodbc)).
