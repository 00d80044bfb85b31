:- module(typhon_postgresql,
          [ postgresql_url/1,           % +Text
            postgresql_place/4,         % +Url, +Part, -Place, -Server
            postgresql_found/1,         % +Server
            postgresql_connect/4,       % +Server, +Seconds, -Connection, -Age
            postgresql_lock/2,          % +Connection, +Sync
            postgresql_tables/1,        % +Connection
            postgresql_stamp/2,         % +Connection, -Stamp
            postgresql_same/3,          % +Connection, +Sync, +Stamp
            postgresql_record/2,        % +Server, -Text
            postgresql_record_put/2,    % +Server, +Text
            postgresql_record_drop/1,   % +Server
            postgresql_blame/2          % +Text, -What
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(uri),
              [ uri_authority_components/2, uri_components/2, uri_encoded/3,
                uri_query_components/2 ]).
:- use_module(sql,
              [sql_connect/2, sql_disconnect/1, sql_do/2, sql_row/4]).

/** <module> A journal in PostgreSQL: a schema of a database

It is told by a URL, as psql and other programs take it:

    postgresql://[user[:password]@][host][:port][/database][?schema=name&...]

The schema is `typhon` if none is named. Further parameters are host (also the
directory of a socket), port, user, password, dbname and sslmode. What it does
not say the environment does, as PGPASSWORD, or the defaults of the server.

*Threading*: one thread at a time.
*/

%!  postgresql_url(+Text) is semidet.

postgresql_url(Text) :-
    member(Scheme, ['postgresql://', 'postgres://']),
    sub_atom(Text, 0, _, _, Scheme),
    !.

%!  postgresql_place(+Url, +Part, -Place, -Server) is det.
%
%   Place is Url as it may be shown, and names the journal: without password.
%   Server is how it is reached.  Part is added to the name of the schema.
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
    foldl(known(Url), Parts0, [], Parts),
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
            ;   nonvar(Authority),
                uri_authority_components(Authority, Components),
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

%   None has a sign that means something in the string of a driver.

known(Url, Name=Value0, Parts, [Part|Parts]) :-
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

%   Its own savepoints would double the statements of a transaction.

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

%!  postgresql_found(+Server) is semidet.
%!  postgresql_connect(+Server, +Seconds, -Connection, -Age) is det.
%
%   There is a journal; open it, or a new one, Age being `old` or `new`. It is
%   locked as long as the connection lives. Who has it is waited for so many
%   seconds, at least so long as the server may need to see that somebody has
%   died.

postgresql_found(server(Schema, Driver)) :-
    connected(Driver, Connection, has_table(Schema, about, Connection)).

:- meta_predicate connected(+, -, 0).

connected(Driver, Connection, Goal) :-
    setup_call_cleanup(sql_connect(Driver, Connection),
                       once(Goal),
                       sql_disconnect(Connection)).

postgresql_connect(server(Schema, Driver), Seconds0, Connection, Age) :-
    sql_connect(Driver, Connection),
    catch(begin(Schema, Seconds0, Connection, Age), error(Formal, Context),
          ( sql_disconnect(Connection), throw(error(Formal, Context)) )).

begin(Schema, Seconds, Connection, Age) :-
    Wait is max(1000, truncate(1000*Seconds)),
    do(Connection, 'set lock_timeout=~d', [Wait]),
    forall(keepalive(Name, Value),
           do(Connection, 'set ~w=~d', [Name, Value])),
    do(Connection,
       'select pg_advisory_lock(hashtext(\'typhon\'), hashtext(\'~w\'))',
       [Schema]),
    (   has_table(Schema, about, Connection)
    ->  Age = old
    ;   Age = new,
        do(Connection, 'create schema if not exists ~w', [Schema])
    ),
    do(Connection, 'set search_path to ~w', [Schema]).

%   A machine that has lost its power says no goodbye, and has the lock until
%   the server notices.

keepalive(tcp_keepalives_idle, 10).
keepalive(tcp_keepalives_interval, 5).
keepalive(tcp_keepalives_count, 3).

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
%   has then written.

postgresql_lock(Connection, Sync) :-
    sync(Sync, Connection),
    sql_do(Connection, begin).

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

                /*******************************
                *            RECORD            *
                *******************************/

%!  postgresql_record(+Server, -Text) is semidet.
%!  postgresql_record_put(+Server, +Text) is det.
%!  postgresql_record_drop(+Server) is det.
%
%   A text beside the journals, see room `records`.

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

%!  postgresql_blame(+Text, -What) is semidet.
%
%   Which kind of error the driver means by Text: `locked`, `full`,
%   `unreachable` or missing(Package).

postgresql_blame(Text, What) :-
    says(Words, What),
    member(Word, Words),
    sub_atom(Text, _, _, _, Word),
    !.

says(['lock timeout'], locked).
says(['No space left', 'disk full'], full).
says(['Can\'t open lib', 'Data source name'], missing('odbc-postgresql')).
says([ 'server closed', 'no connection', 'terminating connection', 'could not',
       'onnection refused', 'No such file', 'FATAL', 'onnection to server',
       'ommunication link', 'not connect' ], unreachable).
