:- module(typhon_store,
          [ journal_open/2,             % +Dir, +Sync
            journal_open/3,             % +Dir, +Sync, +Seconds
            journal_opened/1,           % -Dir
            store_close/0,
            store_commit/1,             % +Changes
            journal_item/5              % +Kind, +Order, -Key, -N, -Value
          ]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(crash, [crash_point/1]).

/** <module> The store: items in a database

An item is a term under a kind, a key and a number.  Changes are

  - put(Kind, Key, N, Bytes): the item is Bytes, see item_bytes/2
  - drop(Kind, Key, N): it is no more
  - drop_all(Kind, Key), drop_below(Kind, Key, N): nor are those of this
    key, of numbers less than N

Only this room knows that the database is SQLite, through library(odbc).  A
process has one store at a time, which nobody else can open meanwhile.  What
is longer than a parameter of the driver can be is kept in parts.  A parameter
of the driver has the length that it had when its statement was first
executed: so there is a statement for each of some lengths, and what is shorter
is filled up.

*Threading*: one thread at a time.
*/

:- multifile prolog:error_message//1.

:- dynamic
    connection/2,                       % Dir, Connection
    statement/3,                        % Name, Room, Statement
    long/3.                             % Kind, Key, N: has further parts

format_version(1).

part_bytes(30000).

                /*******************************
                *        OPEN AND CLOSE        *
                *******************************/

%!  journal_open(+Dir, +Sync) is det.
%!  journal_open(+Dir, +Sync, +Seconds) is det.
%
%   Open the store in the directory Dir, a new one if there is none.
%
%   @arg Seconds is how long to wait for another process to give it up
%   @arg Sync is `full` if what is committed is to survive a power cut, or
%        `normal` if the end of the process
%   @error permission_error(open, journal, Dir): another process has it, or
%          the directory cannot be written
%   @error journal_damaged(Dir, Why), journal_version(Dir, Version)
%   @error existence_error(package, Name): the machine lacks it

journal_open(Dir, Sync) :-
    journal_open(Dir, Sync, 0.2).

journal_open(Dir0, Sync, Seconds) :-
    load_odbc,
    absolute_file_name(Dir0, Dir),
    catch(make_directory_path(Dir), error(_, _),
          permission_error(open, journal, Dir)),
    directory_file_path(Dir, 'journal.db', File),
    (   exists_file(File)
    ->  Age = old
    ;   Age = new
    ),
    in_terms_of(Dir, connect(File, Seconds, Connection)),
    catch(( in_terms_of(Dir, prepare_database(Age, Dir, Sync, Connection)),
            assertz(connection(Dir, Connection)),
            in_terms_of(Dir, prepare_statements(Connection))
          ),
          error(Formal, Context),
          ( forget(Connection),
            throw(error(Formal, Context)) )).

load_odbc :-
    catch(use_module(library(odbc), []), error(existence_error(_, _), _),
          existence_error(package, 'swi-prolog-odbc')).

%   Called so that nobody misses it where the package is not installed.

odbc(Goal) :-
    Called = odbc:Goal,
    call(Called).

connect(File, Seconds, Connection) :-
    Timeout is truncate(1000*Seconds),
    format(atom(Driver), 'DRIVER=SQLite3;Timeout=~d;Database=~w',
           [Timeout, File]),
    odbc(odbc_driver_connect(Driver, Connection,
                             [silent(true), encoding(utf8)])).

%   The lock is taken by the first change, and kept.

prepare_database(Age, Dir, Sync, Connection) :-
    pragma(Connection, locking_mode, exclusive),
    pragma(Connection, journal_mode, wal),
    pragma(Connection, synchronous, Sync),
    odbc(odbc_query(Connection, 'begin exclusive')),
    prepare_tables(Age, Dir, Connection),
    odbc(odbc_query(Connection, commit)).

prepare_tables(new, _, Connection) :-
    odbc(odbc_query(Connection,
                    'create table item (kind text, key text, n integer, \c
                     length integer, sum integer, value blob, \c
                     primary key (kind, key, n)) without rowid')),
    odbc(odbc_query(Connection,
                    'create table part (kind text, key text, n integer, \c
                     part integer, value blob, \c
                     primary key (kind, key, n, part)) without rowid')),
    odbc(odbc_query(Connection,
                    'create table about (version integer, sample text)')),
    format_version(Version),
    sample(Sample),
    format(atom(About), 'insert into about values (~d, \'~w\')',
           [Version, Sample]),
    odbc(odbc_query(Connection, About)).
prepare_tables(old, Dir, Connection) :-
    must_be_whole(Dir, Connection),
    format_version(Version),
    sample(Sample),
    (   odbc(odbc_query(Connection, 'select version, sample from about',
                        row(Version0, Sample0), [types([integer, atom])]))
    ->  true
    ;   throw(error(journal_damaged(Dir, 'nothing is said about it'), _))
    ),
    (   Version0 == Version,
        Sample0 == Sample
    ->  true
    ;   throw(error(journal_version(Dir, Version0), _))
    ),
    forall(odbc(odbc_query(Connection,
                           'select distinct kind, key, n from part',
                           row(Kind, Key, N), [types([atom, atom, integer])])),
           assertz(long(Kind, Key, N))).

must_be_whole(Dir, Connection) :-
    odbc(odbc_query(Connection, 'pragma quick_check(1)', row(Said),
                    [types([atom])])),
    !,
    (   Said == ok
    ->  true
    ;   throw(error(journal_damaged(Dir, Said), _))
    ).

pragma(Connection, Name, Value) :-
    format(atom(Pragma), 'pragma ~w=~w', [Name, Value]),
    ignore(odbc(odbc_query(Connection, Pragma, _, []))).

%   Records of another version or word size must not be read: what differs
%   in any of them differs in these.

sample(Sample) :-
    Big is 1<<62,
    Huge is 1<<70,
    fast_term_serialized(f(X, X, -1, Big, Huge, 1.5, "text", [a]), Bytes),
    string_codes(Bytes, Codes),
    findall(Text, ( member(Code, Codes), format(atom(Text), '~16r.', [Code]) ),
            Texts),
    atomic_list_concat(Texts, Sample).

prepare_statements(Connection) :-
    forall(( sql(Name, Sql, Types), \+ memberchk(bytes, Types) ),
           prepare(Connection, Name, 0, Sql, Types)).

prepare(Connection, Name, Room, Sql, Types0) :-
    maplist(parameter_type, Types0, Types),
    options(Name, Options),
    odbc(odbc_prepare(Connection, Sql, Types, Statement, Options)),
    assertz(statement(Name, Room, Statement)).

%   A type of text without a length would bind the empty text.

parameter_type(kind, varchar(64)).
parameter_type(key, varchar(2000)).
parameter_type(number, bigint).
parameter_type(bytes, longvarbinary(60000)).

options(parts, [types([string])|Wide]) :-
    wide(Wide),
    !.
options(_, []).

%   What is longer than a kilobyte would come damaged otherwise.

wide([wide_column_threshold(100)]).

sql(begin, 'begin immediate', []).
sql(commit, commit, []).
sql(rollback, rollback, []).
sql(put, 'insert or replace into item values (?, ?, ?, ?, ?, ?)',
    [kind, key, number, number, number, bytes]).
sql(put_part, 'insert or replace into part values (?, ?, ?, ?, ?)',
    [kind, key, number, number, bytes]).
sql(drop, 'delete from item where kind=? and key=? and n=?',
    [kind, key, number]).
sql(drop_part, 'delete from part where kind=? and key=? and n=?',
    [kind, key, number]).
sql(drop_all, 'delete from item where kind=? and key=?', [kind, key]).
sql(drop_below, 'delete from item where kind=? and key=? and n<?',
    [kind, key, number]).
sql(parts, 'select value from part where kind=? and key=? and n=? \c
            order by part', [kind, key, number]).

%   execute(+Name, +Values), execute(+Name, +Values, +Bytes): bytes come last.

execute(Name, Values) :-
    statement(Name, 0, Statement),
    !,
    odbc(odbc_execute(Statement, Values)).

execute(Name, Values0, Bytes) :-
    string_length(Bytes, Length),
    room(Length, Room),
    statement_of(Name, Room, Statement),
    filled(Length, Room, Bytes, Full),
    append(Values0, [Full], Values),
    odbc(odbc_execute(Statement, Values)).

statement_of(Name, Room, Statement) :-
    statement(Name, Room, Statement),
    !.
statement_of(Name, Room, Statement) :-
    connection(_, Connection),
    sql(Name, Sql, Types),
    prepare(Connection, Name, Room, Sql, Types),
    statement(Name, Room, Statement).

room(Length, Room) :-
    (   Length =< 512
    ->  Step = 32
    ;   Length =< 4096
    ->  Step = 256
    ;   Step = 2048
    ),
    Room is (Length+Step-1)//Step*Step.

filled(Length, Room, Bytes, Full) :-
    (   Length =:= Room
    ->  Full = Bytes
    ;   Missing is Room-Length,
        filler(Filler),
        sub_string(Filler, 0, Missing, _, Fill),
        string_concat(Bytes, Fill, Full)
    ).

:- dynamic filler/1.

make_filler :-
    length(Codes, 2048),
    maplist(=(0'.), Codes),
    string_codes(Filler, Codes),
    assertz(filler(Filler)).

:- initialization(make_filler, now).

%!  journal_opened(-Dir) is semidet.
%!  store_close is det.

journal_opened(Dir) :-
    connection(Dir, _).

store_close :-
    (   connection(_, Connection)
    ->  forget(Connection)
    ;   true
    ).

forget(Connection) :-
    retractall(connection(_, Connection)),
    retractall(long(_, _, _)),
    forall(retract(statement(_, _, Statement)),
           catch(odbc(odbc_free_statement(Statement)), error(_, _), true)),
    odbc(odbc_disconnect(Connection)).

                /*******************************
                *            CHANGES           *
                *******************************/

%!  store_commit(+Changes:list) is det.
%
%   All of Changes, in this order, or none.
%
%   @error resource_error(journal_space): the disk is full
%   @error journal_damaged(Dir, Why)

store_commit(Changes) :-
    connection(Dir, _),
    catch(in_terms_of(Dir, commit(Changes)),
          error(Formal, Context),
          ( catch(execute(rollback, []), error(_, _), true),
            throw(error(Formal, Context)) )).

%   Not the transactions of the driver: a disk that is full ends one without
%   its knowledge.

commit(Changes) :-
    execute(begin, []),
    forall(member(Change, Changes), change(Change)),
    crash_point(in_commit),
    execute(commit, []).

change(put(Kind, Key, N, Bytes)) =>
    check_sum(Bytes, Sum),
    string_length(Bytes, Length),
    part_bytes(Most),
    drop_parts(Kind, Key, N),
    (   Length =< Most
    ->  execute(put, [Kind, Key, N, Length, Sum], Bytes)
    ;   assertz(long(Kind, Key, N)),
        sub_string(Bytes, 0, Most, _, First),
        execute(put, [Kind, Key, N, Length, Sum], First),
        Last is (Length-1)//Most,
        forall(between(1, Last, Part), put_part(Kind, Key, N, Part, Bytes))
    ).
change(drop(Kind, Key, N)) =>
    drop_parts(Kind, Key, N),
    execute(drop, [Kind, Key, N]).
change(drop_all(Kind, Key)) =>
    forall(long(Kind, Key, N), drop_parts(Kind, Key, N)),
    execute(drop_all, [Kind, Key]).
change(drop_below(Kind, Key, N)) =>
    forall(( long(Kind, Key, N0), N0 < N ), drop_parts(Kind, Key, N0)),
    execute(drop_below, [Kind, Key, N]).

%   Of 24 bits: those of Prologs are of 24 or 32, and the driver's integers are
%   signed.

check_sum(Bytes, Sum) :-
    term_hash(Bytes, Hash),
    Sum is Hash /\ 0xffffff.

put_part(Kind, Key, N, Part, Bytes) :-
    part_bytes(Most),
    Start is Part*Most,
    string_length(Bytes, Length),
    Count is min(Most, Length-Start),
    sub_string(Bytes, Start, Count, _, Piece),
    execute(put_part, [Kind, Key, N, Part], Piece).

drop_parts(Kind, Key, N) :-
    (   retract(long(Kind, Key, N))
    ->  execute(drop_part, [Kind, Key, N])
    ;   true
    ).

                /*******************************
                *            ITEMS             *
                *******************************/

%!  journal_item(+Kind, +Order, -Key, -N, -Value) is nondet.
%
%   The items of Kind.
%
%   @arg Order is `numbers` if those of less numbers are to come first, or
%        `any`
%   @error journal_damaged(Dir, Kind-Key)

journal_item(Kind, Order, Key, N, Value) :-
    connection(Dir, Connection),
    order(Order, By),
    wide(Wide),
    format(atom(Sql), 'select key, n, length, sum, value from item \c
                       where kind=\'~w\'~w', [Kind, By]),
    odbc(odbc_query(Connection, Sql, row(Key, N, Length, Sum, First),
                    [types([atom, integer, integer, integer, string])|Wide])),
    whole(Length, Kind-Key-N, First, Bytes),
    (   check_sum(Bytes, Sum)
    ->  fast_term_serialized(Value, Bytes)
    ;   throw(error(journal_damaged(Dir, Kind-Key), _))
    ).

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
    statement(parts, 0, Statement),
    findall(Piece,
            ( odbc(odbc_execute(Statement, [Kind, Key, N], row(Full))),
              string_length(Full, Room),
              Count is min(Most, Room),
              sub_string(Full, 0, Count, _, Piece) ),
            Pieces),
    atomic_list_concat([First|Pieces], Atom),
    atom_string(Atom, All),
    sub_string(All, 0, Length, _, Bytes).

                /*******************************
                *            ERRORS            *
                *******************************/

:- meta_predicate in_terms_of(+, 0).

in_terms_of(Dir, Goal) :-
    catch(Goal, error(odbc(_, _, Text), _), blame(Text, Dir)).

blame(Text, Dir) :-
    says(Text, ['is locked', 'readonly', 'unable to open']),
    !,
    permission_error(open, journal, Dir).
blame(Text, _) :-
    says(Text, ['is full', 'disk I/O']),
    !,
    throw(error(resource_error(journal_space), _)).
blame(Text, _) :-
    says(Text, ['driver', 'Driver', 'Data source']),
    !,
    throw(error(existence_error(package, libsqliteodbc), context(_, Text))).
blame(Text, Dir) :-
    throw(error(journal_damaged(Dir, Text), _)).

says(Text, Parts) :-
    member(Part, Parts),
    sub_atom(Text, _, _, _, Part),
    !.

prolog:error_message(journal_damaged(Dir, Why)) -->
    [ 'The journal ~w is damaged: ~p.'-[Dir, Why], nl,
      'Nothing in it was changed' ].
prolog:error_message(journal_version(Dir, _)) -->
    [ 'The journal ~w was written by another version of Prolog or Typhon.'-[Dir],
      nl, 'Nothing in it was changed' ].
prolog:error_message(permission_error(open, journal, Dir)) -->
    [ 'The journal ~w cannot be opened: another process has it, or it \c
       cannot be written here'-[Dir] ].
prolog:error_message(resource_error(journal_space)) -->
    [ 'There is no room left for the journal' ].
