:- module(typhon_database,
          [ database/3,                 % +Where, -Place, -Base
            database_part/3,            % +Where, +P, -Part
            database_found/1,           % +Base
            database_connect/4,         % +Base, +Seconds, -Connection, -Age
            database_lock/3,            % +Base, +Sync, +Connection
            database_tables/2,          % +Base, +Connection
            database_stamp/3,           % +Base, +Connection, -Stamp
            database_same/4,            % +Base, +Sync, +Stamp, +Connection
            database_unopened/2,        % +Base, +Stamp
            database_forgets/4,         % +Base, +Sync, +Connection, -Seconds
            database_wrong/3,           % +Base, +Connection, -Why
            database_record/2,          % +Base, -Text
            database_record_put/2,      % +Base, +Text
            database_record_drop/1,     % +Base
            in_terms_of/3               % +Place, +Base, :Goal
          ]).
:- use_module(library(filesex),
              [chmod/2, directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../kernel/base/private', [private_write/2]).
:- autoload(postgresql, [postgresql_place/4]).
:- use_module(sql, [postgresql_url/1, sql_connect/2, sql_do/2, sql_row/4]).

/** <module> Databases for a journal

The database is SQLite in a directory, with the Base sqlite(Dir), or PostgreSQL
at a URL, see typhon_postgresql; higher layers do not know which.

*Threading*: one thread at a time.
*/

:- meta_predicate in_terms_of(+, +, 0).

:- multifile
    database_found/1,
    database_connect/4,
    database_lock/3,
    database_tables/2,
    database_stamp/3,
    database_same/4,
    database_unopened/2,
    database_forgets/4,
    database_wrong/3,
    database_record/2,
    database_record_put/2,
    database_record_drop/1,
    error_words/3.              % Base, Words, What: a driver error with one of
                                % Words means `locked`, `unwritable`, `full`,
                                % `unwritten`, `unreachable` or
                                % missing(Package)

%!  database(+Where, -Place:atom, -Base) is det.
%
%   Place is the name of the journal in errors, Base its handle for the
%   predicates below.
%
%   @arg Where is a directory, postgresql(Url), or such a Url
%   @error domain_error(postgresql_url, Url)

database(postgresql(Url), Place, postgresql(Server)) :-
    !,
    postgresql_place(Url, '', Place, Server).
database(postgresql(Url, Part), Place, postgresql(Server)) :-
    !,
    postgresql_place(Url, Part, Place, Server).
database(Url, Place, postgresql(Server)) :-
    postgresql_url(Url),
    !,
    postgresql_place(Url, '', Place, Server).
database(Dir0, Dir, sqlite(Dir)) :-
    absolute_file_name(Dir0, Dir).

%!  database_part(+Where, +P, -Part) is det.
%
%   See typhon_journal.

database_part(postgresql(Url), P, postgresql(Url, Part)) :-
    !,
    atom_concat('_process', P, Part).
database_part(Url, P, Part) :-
    postgresql_url(Url),
    !,
    database_part(postgresql(Url), P, Part).
database_part(Dir0, P, Part) :-
    absolute_file_name(Dir0, Dir),
    atom_concat(process, P, Name),
    directory_file_path(Dir, Name, Part).

%!  database_found(+Base) is semidet.

%!  database_connect(+Base, +Seconds, -Connection, -Age) is det.
%
%   Open the journal, or create it: Age is `old` or `new`.  Wait at most Seconds
%   for another process to close it.

%!  database_lock(+Base, +Sync, +Connection) is det.
%
%   Begin a transaction.  From now on no other process can open the journal.

%!  database_tables(+Base, +Connection) is det.

%!  database_stamp(+Base, +Connection, -Stamp) is det.
%!  database_same(+Base, +Sync, +Stamp, +Connection) is semidet.
%!  database_unopened(+Base, +Stamp) is semidet.
%
%   Stamp identifies the last process that opened the journal.  database_same/4
%   checks on a new Connection that no other process has opened it since;
%   database_unopened/2 checks that none had when its lock could not be had.

%!  database_forgets(+Base, +Sync, +Connection, -Seconds) is semidet.
%
%   The server may lose the commits of the last Seconds when it dies while this
%   process survives.

%!  database_wrong(+Base, +Connection, -Why) is semidet.
%
%   The journal is damaged; Why is the report of the database.

%!  database_record(+Base, -Text) is semidet.
%!  database_record_put(+Base, +Text) is det.
%!  database_record_drop(+Base) is det.
%
%   See typhon_journal.

                /*******************************
                *            SQLITE            *
                *******************************/

database_found(sqlite(Dir)) :-
    file(Dir, File),
    exists_file(File).

database_connect(sqlite(Dir), Seconds, Connection, Age) :-
    catch(folder_made(Dir), error(Formal, _), not_written(Dir, Formal)),
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

database_lock(sqlite(_), Sync, Connection) :-
    pragma(Connection, locking_mode, exclusive),
    pragma(Connection, journal_mode, wal),
    pragma(Connection, synchronous, Sync),
    sql_do(Connection, 'begin exclusive').

pragma(Connection, Name, Value) :-
    format(atom(Pragma), 'pragma ~w=~w', [Name, Value]),
    sql_do(Connection, Pragma).

database_tables(sqlite(_), Connection) :-
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

database_stamp(sqlite(_), _, none).

database_wrong(sqlite(_), Connection, Why) :-
    sql_row(Connection, 'pragma quick_check(1)', row(Said), [atom]),
    !,
    Said \== ok,
    Why = Said.

%   The record is a file that is written completely or not at all.

database_record(sqlite(Dir), Text) :-
    record_file(Dir, File),
    exists_file(File),
    read_file_to_string(File, Text, [encoding(utf8)]).

database_record_put(sqlite(Dir), Text) :-
    record_file(Dir, File),
    catch(( folder_made(Dir),
            private_write(File, write_text(Text)) ),
          error(Formal, _),
          not_written(Dir, Formal)).

write_text(Text, File) :-
    setup_call_cleanup(open(File, write, Out, [encoding(utf8)]),
                       write(Out, Text),
                       close(Out)).

folder_made(Dir) :-
    (   exists_directory(Dir)
    ->  true
    ;   make_directory_path(Dir),
        chmod(Dir, 0o700)
    ).

not_written(Dir, Formal) :-
    format(atom(Why), 'it cannot be written: ~p', [Formal]),
    throw(error(permission_error(open, journal, Dir), context(_, Why))).

database_record_drop(sqlite(Dir)) :-
    record_file(Dir, File),
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

record_file(Dir, File) :-
    directory_file_path(Dir, 'network.pl', File).

                /*******************************
                *            ERRORS            *
                *******************************/

%!  in_terms_of(+Place, +Base, :Goal) is semidet.
%
%   Call Goal; turn errors of the driver into errors of the journal at Place.

in_terms_of(Place, Base, Goal) :-
    catch(Goal, error(odbc(State, _, Text), _),
          (   means(Base, State, Text, What)
          ->  throw_meaning(What, Text, Place)
          ;   throw(error(journal_damaged(Place, Text), _))
          )).

means(Base, _, Text, What) :-
    error_words(Base, Words, What),
    member(Word, Words),
    sub_atom(Text, _, _, _, Word),
    !.
means(postgresql(_), State, _, unreachable) :-
    sub_atom(State, 0, _, _, '08').     % the class of connections

error_words(sqlite(_), ['is locked'], locked).
error_words(sqlite(_), [readonly, 'unable to open', 'connect failed'],
            unwritable).
error_words(sqlite(_), ['is full'], full).
error_words(sqlite(_), ['disk I/O'], unwritten).
error_words(sqlite(_), [driver, 'Driver', 'Data source'],
            missing(libsqliteodbc)).

throw_meaning(locked, _, Place) :-
    not_opened(Place, 'another process has it').
throw_meaning(unwritable, _, Place) :-
    not_opened(Place, 'it cannot be written').
throw_meaning(full, _, _) :-
    throw(error(resource_error(journal_space), _)).
throw_meaning(unwritten, Text, Place) :-
    (   write_fails(Place, Why)
    ->  true
    ;   Why = Text
    ),
    (   is_space(Why)
    ->  throw(error(resource_error(journal_space), context(_, Why)))
    ;   throw(error(journal_unwritten(Place, Why), _))
    ).
throw_meaning(missing(Package), Text, _) :-
    throw(error(existence_error(package, Package), context(_, Text))).
throw_meaning(unreachable, Text, Place) :-
    throw(error(journal_unreachable(Place, Text), _)).

%   write_fails(+Dir, -Why) is semidet: the driver does not report the error of
%   the system, but a file beside the journal gets it, too, if the disk takes no
%   writes.

write_fails(Dir, Why) :-
    directory_file_path(Dir, 'journal.try', File),
    catch(setup_call_cleanup(open(File, write, Out),
                             format(Out, '~` t~8192|~n', []),
                             close(Out)),
          error(_, context(_, Why)), true),
    catch(delete_file(File), error(_, _), true),
    atom(Why).

is_space('No space left on device').
is_space('Disk quota exceeded').
is_space('File too large').

not_opened(Place, Why) :-
    throw(error(permission_error(open, journal, Place), context(_, Why))).
