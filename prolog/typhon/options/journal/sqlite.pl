:- module(typhon_sqlite,
          [ sqlite_found/1,             % +Dir
            sqlite_connect/4,           % +Dir, +Seconds, -Connection, -Age
            sqlite_lock/2,              % +Connection, +Sync
            sqlite_tables/1,            % +Connection
            sqlite_wrong/2,             % +Connection, -Why
            sqlite_record/2,            % +Dir, -Text
            sqlite_record_put/2,        % +Dir, +Text
            sqlite_record_drop/1,       % +Dir
            sqlite_blame/2              % +Text, -What
          ]).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(sql, [sql_connect/2, sql_do/2, sql_row/4]).

/** <module> A journal in SQLite: a file of a directory

*Threading*: one thread at a time.
*/

%!  sqlite_found(+Dir) is semidet.
%!  sqlite_connect(+Dir, +Seconds, -Connection, -Age) is det.
%
%   There is a journal in Dir; open it, or a new one, Age being `old` or `new`.
%   A process that has it is waited for so many seconds.

sqlite_found(Dir) :-
    file(Dir, File),
    exists_file(File).

sqlite_connect(Dir, Seconds, Connection, Age) :-
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

%!  sqlite_lock(+Connection, +Sync) is det.
%
%   A transaction has begun. The lock is taken by the first change, and kept.

sqlite_lock(Connection, Sync) :-
    pragma(Connection, locking_mode, exclusive),
    pragma(Connection, journal_mode, wal),
    pragma(Connection, synchronous, Sync),
    sql_do(Connection, 'begin exclusive').

pragma(Connection, Name, Value) :-
    format(atom(Pragma), 'pragma ~w=~w', [Name, Value]),
    sql_do(Connection, Pragma).

%!  sqlite_tables(+Connection) is det.

sqlite_tables(Connection) :-
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

%!  sqlite_wrong(+Connection, -Why) is semidet.
%
%   The file is damaged.

sqlite_wrong(Connection, Why) :-
    sql_row(Connection, 'pragma quick_check(1)', row(Said), [atom]),
    !,
    Said \== ok,
    Why = Said.

%!  sqlite_record(+Dir, -Text) is semidet.
%!  sqlite_record_put(+Dir, +Text) is det.
%!  sqlite_record_drop(+Dir) is det.
%
%   A text beside the journals, see module `kept`: a file, which is there as a
%   whole or not at all.

sqlite_record(Dir, Text) :-
    record_file(Dir, File),
    exists_file(File),
    read_file_to_string(File, Text, [encoding(utf8)]).

sqlite_record_put(Dir, Text) :-
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

sqlite_record_drop(Dir) :-
    record_file(Dir, File),
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

record_file(Dir, File) :-
    directory_file_path(Dir, 'network.pl', File).

%!  sqlite_blame(+Text, -What) is semidet.
%
%   Which kind of error the driver means by Text: `locked`, `unwritable`, `full`
%   or missing(Package).

sqlite_blame(Text, What) :-
    says(Words, What),
    member(Word, Words),
    sub_atom(Text, _, _, _, Word),
    !.

says(['is locked'], locked).
says([readonly, 'unable to open', 'connect failed'], unwritable).
says(['is full', 'disk I/O'], full).
says([driver, 'Driver', 'Data source'], missing(libsqliteodbc)).
