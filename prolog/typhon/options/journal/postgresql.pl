:- module(typhon_postgresql,
          [ postgresql_found/1,         % +Server
            postgresql_connect/4,       % +Server, +Seconds, -Connection, -Age
            postgresql_lock/2,          % +Connection, +Sync
            postgresql_tables/1,        % +Connection
            postgresql_stamp/2,         % +Connection, -Stamp
            postgresql_same/3,          % +Connection, +Sync, +Stamp
            postgresql_forgets/2,       % +Connection, -Seconds
            postgresql_record/2,        % +Server, -Text
            postgresql_record_put/2,    % +Server, +Text
            postgresql_record_drop/1,   % +Server
            postgresql_blame/3          % +State, +Text, -What
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(sql,
              [sql_connect/2, sql_disconnect/1, sql_do/2, sql_row/4]).

/** <module> A journal in PostgreSQL: a schema of a database

A server is given as described in module `postgresql_url`.

*Threading*: one thread at a time.
*/

:- setting(silent_seconds, positive_integer, 10,
           "A server of a journal whose machine says nothing for so long is \c
            taken to be gone").

                /*******************************
                *             OPEN             *
                *******************************/

%!  postgresql_found(+Server) is semidet.
%!  postgresql_connect(+Server, +Seconds, -Connection, -Age) is det.
%
%   There is a journal; open it, or a new one, Age being `old` or `new`. It is
%   locked as long as the connection lives. A process that has it is waited for so many
%   seconds, at least so long as the server may need to see that a client has
%   died.

postgresql_found(server(Schema, Driver)) :-
    connected(Driver, Connection, has_table(Schema, about, Connection)).

:- meta_predicate connected(+, -, 0).

connected(Driver, Connection, Goal) :-
    setup_call_cleanup(server_connect(Driver, Connection),
                       once(Goal),
                       sql_disconnect(Connection)).

postgresql_connect(server(Schema, Driver), Seconds0, Connection, Age) :-
    server_connect(Driver, Connection),
    catch(begin(Schema, Seconds0, Connection, Age), error(Formal, Context),
          ( sql_disconnect(Connection), throw(error(Formal, Context)) )).

%   A machine that has lost its power says no goodbye. For what cannot be
%   delivered the kernel waits a quarter of an hour, for what may come for ever:
%   so do we for a server, and a server for us, with the lock. Both are told
%   how long to wait, as far as they know of such a setting.

server_connect(Driver, Connection) :-
    findall(Bound,
            ( bound(Name, Value), format(atom(Bound), '~w=~d', [Name, Value]) ),
            Bounds),
    atomic_list_concat(Bounds, ' ', Options),
    format(atom(Bounded), '~w;pqopt={~w}', [Driver, Options]),
    sql_connect(Bounded, Connection).

tell_bounds(Connection) :-
    forall(bound(Name, Value),
           do(Connection, 'select set_config(name, \'~d\', false) \c
                           from pg_settings \c
                           where name in (\'~w\', \'tcp_~w\')',
              [Value, Name, Name])).

bound(connect_timeout, Seconds) :-
    setting(silent_seconds, Seconds).
bound(tcp_user_timeout, Milliseconds) :-
    setting(silent_seconds, Seconds),
    Milliseconds is 1000*Seconds.
bound(keepalives_idle, Seconds) :-
    setting(silent_seconds, All),
    Seconds is max(1, All//2).
bound(keepalives_interval, Seconds) :-
    setting(silent_seconds, All),
    Seconds is max(1, All//6).
bound(keepalives_count, 3).

begin(Schema, Seconds, Connection, Age) :-
    Wait is max(1000, truncate(1000*Seconds)),
    do(Connection, 'set lock_timeout=~d', [Wait]),
    tell_bounds(Connection),
    do(Connection,
       'select pg_advisory_lock(hashtext(\'typhon\'), hashtext(\'~w\'))',
       [Schema]),
    (   has_table(Schema, about, Connection)
    ->  Age = old
    ;   Age = new,
        do(Connection, 'create schema if not exists ~w', [Schema])
    ),
    do(Connection, 'set search_path to ~w', [Schema]).

has_table(Schema, Table, Connection) :-
    format(atom(Sql),
           'select count(*) from information_schema.tables \c
            where table_schema=\'~w\' and table_name=\'~w\'',
           [Schema, Table]),
    sql_row(Connection, Sql, row(Count), [integer]),
    !,
    Count > 0.

%!  postgresql_lock(+Connection, +Sync) is det.
%
%   A transaction has begun. What the end of this process may not undo the
%   server has in any case when it has answered; what a power cut may not it
%   has then written, as what this transaction does.

postgresql_lock(Connection, Sync) :-
    sync(Sync, Connection),
    sql_do(Connection, begin),
    sql_do(Connection, 'set local synchronous_commit=on').

sync(Sync, Connection) :-
    (   Sync == full
    ->  Commit = on
    ;   Commit = off
    ),
    do(Connection, 'set synchronous_commit=~w', [Commit]).

do(Connection, Format, Values) :-
    format(atom(Sql), Format, Values),
    sql_do(Connection, Sql).

%!  postgresql_tables(+Connection) is det.

postgresql_tables(Connection) :-
    sql_do(Connection,
           'create table item (kind text, key text, n bigint, \c
            length integer, sum integer, value bytea, \c
            primary key (kind, key, n))'),
    sql_do(Connection,
           'create table part (kind text, key text, n bigint, \c
            part integer, value bytea, \c
            primary key (kind, key, n, part))'),
    sql_do(Connection,
           'create table about (version integer, sample text, \c
            opened bigint default 0)').

%!  postgresql_stamp(+Connection, -Stamp) is det.
%!  postgresql_same(+Connection, +Sync, +Stamp) is semidet.
%
%   The journal has been opened, the Stamp-th time; that was the last time, and
%   this is another connection to it.

postgresql_stamp(Connection, Stamp) :-
    sql_do(Connection, 'update about set opened=opened+1'),
    stamp(Connection, Stamp).

postgresql_same(Connection, Sync, Stamp) :-
    stamp(Connection, Stamp),
    sync(Sync, Connection).

stamp(Connection, Stamp) :-
    sql_row(Connection, 'select opened from about', row(Stamp0), [integer]),
    !,
    Stamp = Stamp0.

%!  postgresql_forgets(+Connection, -Seconds) is det.
%
%   What was committed without waiting is written within that time: three times
%   the setting, as PostgreSQL says, and some more.

postgresql_forgets(Connection, Seconds) :-
    sql_row(Connection,
            'select setting::integer from pg_settings \c
             where name=\'wal_writer_delay\'',
            row(Milliseconds), [integer]),
    !,
    Seconds is 2+0.005*Milliseconds.

                /*******************************
                *            RECORD            *
                *******************************/

%!  postgresql_record(+Server, -Text) is semidet.
%!  postgresql_record_put(+Server, +Text) is det.
%!  postgresql_record_drop(+Server) is det.
%
%   A text beside the journals, see module `records`.

postgresql_record(server(Schema, Driver), Text) :-
    connected(Driver, Connection,
              ( has_table(Schema, network, Connection),
                format(atom(Sql), 'select record from ~w.network', [Schema]),
                sql_row(Connection, Sql, row(Text), [string]) )).

postgresql_record_put(server(Schema, Driver), Text) :-
    split_string(Text, "'", "", Parts),
    atomic_list_concat(Parts, '\'\'', Quoted),
    connected(Driver, Connection,
              ( do(Connection, 'create schema if not exists ~w', [Schema]),
                do(Connection, 'create table if not exists ~w.network \c
                                (one boolean primary key, record text)',
                   [Schema]),
                do(Connection,
                   'insert into ~w.network values (true, \'~w\') \c
                    on conflict (one) do update set record=excluded.record',
                   [Schema, Quoted]) )).

postgresql_record_drop(server(Schema, Driver)) :-
    connected(Driver, Connection,
              do(Connection, 'drop table if exists ~w.network', [Schema])).

                /*******************************
                *            ERRORS            *
                *******************************/

%!  postgresql_blame(+State, +Text, -What) is semidet.
%
%   Which kind of error the driver means by the SQLSTATE State and Text:
%   `locked`, `full`, `unreachable` or missing(Package).

postgresql_blame(_, Text, What) :-
    says(Words, What),
    member(Word, Words),
    sub_atom(Text, _, _, _, Word),
    !.
postgresql_blame(State, _, unreachable) :-
    sub_atom(State, 0, _, _, '08').     % the class of connections

says(['lock timeout'], locked).
says(['No space left', 'disk full'], full).
says(['Can\'t open lib', 'Data source name'], missing('odbc-postgresql')).
says([ 'server closed', 'no connection', 'terminating connection', 'could not',
       'onnection refused', 'No such file', 'FATAL', 'onnection to server',
       'ommunication link', 'not connect' ], unreachable).
