:- module(typhon_postgresql,
          [ postgresql_place/4          % +Url, +Part, -Place, -Server
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(uri),
              [ uri_authority_components/2, uri_components/2, uri_encoded/3,
                uri_query_components/2 ]).
:- use_module(sql,
              [ postgresql_url/1, sql_connect/2, sql_disconnect/1, sql_do/2,
                sql_load/0, sql_row/4 ]).

/** <module> A journal in PostgreSQL: a schema of a database

See typhon_database.  The Base is postgresql(server(Schema, Driver)), given by a
URL as for psql and other programs:

    postgresql://[user[:password]@][host][:port][/database][?schema=name&...]

The default schema is `typhon`.  Further parameters are host (also the directory
of a socket), port, user, password, dbname and sslmode.  For others the
environment applies, such as PGPASSWORD, or the defaults of the server.

*Threading*: one thread at a time.
*/

:- multifile
    typhon_database:database_found/1,
    typhon_database:database_connect/4,
    typhon_database:database_lock/3,
    typhon_database:database_tables/2,
    typhon_database:database_stamp/3,
    typhon_database:database_same/4,
    typhon_database:database_unopened/2,
    typhon_database:database_forgets/4,
    typhon_database:database_record/2,
    typhon_database:database_record_put/2,
    typhon_database:database_record_drop/1,
    typhon_database:error_words/3.

:- setting(silent_seconds, positive_integer, 10,
           "Seconds without data after which the machine of a database server \c
            is taken to be gone").

                /*******************************
                *             URLS             *
                *******************************/

%!  postgresql_place(+Url, +Part, -Place, -Server) is det.
%
%   Place is Url without the password; it names the journal and may be shown.
%   Server holds the parameters of the connection.  Part is appended to the name
%   of the schema.
%
%   @error domain_error(postgresql_url, Url)

postgresql_place(Url0, Part, Place, server(Schema, Driver)) :-
    must_be(text, Url0),
    atom_string(Url, Url0),
    (   postgresql_url(Url),
        catch(parts(Url, Parts0), error(syntax_error(_), _), fail)
    ->  true
    ;   domain_error(postgresql_url, Url)
    ),
    foldl(add_parameter(Url), Parts0, [], Parts),
    option(schema(Schema0), Parts, typhon),
    atom_concat(Schema0, Part, Schema),
    option(dbname(Database), Parts, postgres),
    option(host(Host), Parts, localhost),
    option(port(Port), Parts, '5432'),
    shown_user(Parts, User),
    format(atom(Place), 'postgresql://~w~w:~w/~w?schema=~w',
           [User, Host, Port, Database, Schema]),
    driver([host(Host), port(Port), dbname(Database)|Parts], Driver).

shown_user(Parts, Shown) :-
    (   memberchk(user(User), Parts)
    ->  atom_concat(User, @, Shown)
    ;   Shown = ''
    ).

%   parts(+Url, -Parts): pairs Name=Value, of the query first.

parts(Url, Parts) :-
    uri_components(Url, uri_components(_, Authority, Path, Search, _)),
    findall(Part,
            (   nonvar(Search),
                uri_query_components(Search, Query),
                member(Part, Query)
            ;   uri_authority_components(Authority, Components),
                authority_part(Components, Part)
            ;   atom_concat(/, Name0, Path),
                decoded(dbname=Name0, Part)
            ), Parts).

authority_part(uri_authority(User, Password, Host, Port), Part) :-
    member(Name-Value, [ user-User, password-Password, host-Host, port-Port ]),
    nonvar(Value),
    decoded(Name=Value, Part).

decoded(Name=Encoded0, Name=Value) :-
    atomic_list_concat([Encoded0], Encoded),    % a port is a number
    uri_encoded(path, Value, Encoded),
    Value \== ''.

%   No value may contain a character with a meaning in a connection string.

add_parameter(Url, Name=Value0, Parts, [Part|Parts]) :-
    (   parameter(Name, _),
        atomic_list_concat([Value0], Value),
        \+ ( member(Sign, [;, '{', '}', '\n']),
             sub_atom(Value, _, _, _, Sign) ),
        fits(Name, Value)
    ->  Part =.. [Name, Value]
    ;   domain_error(postgresql_url, Url)
    ).

parameter(host, 'Servername').
parameter(port, 'Port').
parameter(dbname, 'Database').
parameter(user, 'Username').
parameter(password, 'Password').
parameter(sslmode, 'SSLmode').
parameter(schema, none).

fits(schema, Name) :-
    !,
    atom_codes(Name, [First|Codes]),
    \+ between(0'0, 0'9, First),
    forall(member(Code, [First|Codes]), plain(Code)),
    atom_length(Name, Length),
    Length < 48.                        % a part may follow
fits(_, _).

plain(0'_).
plain(Code) :-
    between(0'a, 0'z, Code).
plain(Code) :-
    between(0'0, 0'9, Code).

%   Protocol=7.4-1: savepoints of the driver would double the statements of a
%   transaction.

driver(Parts, Driver) :-
    findall(Text,
            ( parameter(Name, Theirs),
              Theirs \== none,
              Part =.. [Name, Value],
              memberchk(Part, Parts),
              format(atom(Text), ';~w=~w', [Theirs, Value]) ),
            Texts),
    atomic_list_concat([ 'DRIVER={PostgreSQL Unicode};ByteaAsLongVarBinary=1;',
                         'Protocol=7.4-1'
                       | Texts ], Driver).

                /*******************************
                *             OPEN             *
                *******************************/

typhon_database:database_found(postgresql(server(Schema, Driver))) :-
    connected(Driver, Connection, has_table(Schema, about, Connection)).

:- meta_predicate connected(+, -, 0).

connected(Driver, Connection, Goal) :-
    setup_call_cleanup(server_connect(Driver, Connection),
                       once(Goal),
                       sql_disconnect(Connection)).

%   The lock lasts as long as the connection.  If another process has it, wait
%   at least as long as the server may need to notice that a client has died.

typhon_database:database_connect(postgresql(server(Schema, Driver)), Seconds0,
                                 Connection, Age) :-
    server_connect(Driver, Connection),
    catch(begin(Schema, Seconds0, Connection, Age), error(Formal, Context),
          ( sql_disconnect(Connection), throw(error(Formal, Context)) )).

%   A machine that loses its power closes no connection.  By default the kernel
%   waits a quarter of an hour for an acknowledgement, and for ever for data:
%   this process for a server, and the server, with the lock, for this process.
%   Both get shorter limits, as far as they have such settings.

server_connect(Driver, Connection) :-
    findall(Bound,
            ( bound(Name, Value), format(atom(Bound), '~w=~d', [Name, Value]) ),
            Bounds),
    atomic_list_concat(Bounds, ' ', Options),
    format(atom(Bounded), '~w;pqopt={~w}', [Driver, Options]),
    sql_connect(Bounded, Connection).

set_server_limits(Connection) :-
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
    set_server_limits(Connection),
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

%   The end of this process never undoes a commit that the server has answered.
%   A power cut does not undo it if the server writes the commit before it
%   answers, which this transaction demands.

typhon_database:database_lock(postgresql(_), Sync, Connection) :-
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

typhon_database:database_tables(postgresql(_), Connection) :-
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

%   Stamp counts how often the journal was opened.

typhon_database:database_stamp(postgresql(Server), Connection, Stamp) :-
    sql_do(Connection, 'update about set opened=opened+1'),
    stamp(Server, Connection, Stamp).

typhon_database:database_same(postgresql(Server), Sync, Stamp, Connection) :-
    stamp(Server, Connection, Stamp),
    sync(Sync, Connection).

typhon_database:database_unopened(postgresql(Server), Stamp) :-
    Server = server(_, Driver),
    connected(Driver, Connection, stamp(Server, Connection, Stamp)).

stamp(server(Schema, _), Connection, Stamp) :-
    format(atom(Sql), 'select opened from ~w.about', [Schema]),
    sql_row(Connection, Sql, row(Stamp0), [integer]),
    !,
    Stamp = Stamp0.

%   PostgreSQL writes an asynchronous commit within three times this setting;
%   some more is added.

typhon_database:database_forgets(postgresql(_), normal, Connection, Seconds) :-
    sql_row(Connection,
            'select setting::integer from pg_settings \c
             where name=\'wal_writer_delay\'',
            row(Milliseconds), [integer]),
    !,
    Seconds is 2+0.005*Milliseconds.

typhon_database:database_record(postgresql(server(Schema, Driver)), Text) :-
    sql_load,
    connected(Driver, Connection,
              ( has_table(Schema, network, Connection),
                format(atom(Sql), 'select record from ~w.network', [Schema]),
                sql_row(Connection, Sql, row(Text), [string]) )).

typhon_database:database_record_put(postgresql(server(Schema, Driver)),
                                    Text) :-
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

typhon_database:database_record_drop(postgresql(server(Schema, Driver))) :-
    connected(Driver, Connection,
              do(Connection, 'drop table if exists ~w.network', [Schema])).

typhon_database:error_words(postgresql(_), ['lock timeout'], locked).
typhon_database:error_words(postgresql(_), ['No space left', 'disk full'],
                            full).
typhon_database:error_words(postgresql(_),
                            ['Can\'t open lib', 'Data source name'],
                            missing('odbc-postgresql')).
typhon_database:error_words(postgresql(_),
                            [ 'server closed', 'no connection',
                              'terminating connection', 'could not',
                              'onnection refused', 'No such file', 'FATAL',
                              'onnection to server', 'ommunication link',
                              'not connect' ],
                            unreachable).
