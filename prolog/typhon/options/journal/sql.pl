:- module(typhon_sql,
          [ postgresql_url/1,           % +Text
            sql_load/0,
            sql_connect/2,              % +Driver, -Connection
            sql_disconnect/1,           % +Connection
            sql_do/2,                   % +Connection, +Sql
            sql_row/4,                  % +Connection, +Sql, -Row, +Types
            sql_open/1,                 % +Connection
            sql_close/0,
            sql_execute/2,              % +Name, +Values
            sql_execute/3,              % +Name, +Values, +Bytes
            sql_part/3                  % +Name, +Values, -Bytes
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2]).

/** <module> SQL statements through library(odbc)

The driver fixes the length of a parameter when a statement is first executed.
So there is one statement for each of some lengths, and shorter values are
padded.

*Threading*: one thread at a time.
*/

:- dynamic
    connection/1,                       % Connection
    statement/3.                        % Name, Size, Statement

%!  postgresql_url(+Text) is semidet.
%
%   Text is the URL of a PostgreSQL database.

postgresql_url(Text) :-
    member(Scheme, ['postgresql://', 'postgres://']),
    sub_atom(Text, 0, _, _, Scheme),
    !.

%!  sql_load is det.
%
%   Load library(odbc).
%
%   @error existence_error(package, 'swi-prolog-odbc')

sql_load :-
    catch(use_module(library(odbc), []), error(existence_error(_, _), _),
          existence_error(package, 'swi-prolog-odbc')).

%   A meta-call, so that check/0 does not report it where the package is
%   missing.

odbc(Goal) :-
    Called = odbc:Goal,
    call(Called).

%!  sql_connect(+Driver, -Connection) is det.
%!  sql_disconnect(+Connection) is det.
%
%   Connect to a database; close the connection, ignoring errors.
%
%   @arg Driver is what odbc_driver_connect/3 expects
%   @error odbc(State, Native, Text), as all predicates of this module

sql_connect(Driver, Connection) :-
    odbc(odbc_driver_connect(Driver, Connection,
                             [silent(true), encoding(utf8)])).

sql_disconnect(Connection) :-
    catch(odbc(odbc_disconnect(Connection)), error(_, _), true).

%!  sql_do(+Connection, +Sql) is det.
%!  sql_row(+Connection, +Sql, -Row, +Types) is nondet.
%
%   Execute Sql and ignore its result; Row is a row of its result.

sql_do(Connection, Sql) :-
    ignore(odbc(odbc_query(Connection, Sql, _, []))).

sql_row(Connection, Sql, Row, Types) :-
    wide(Wide),
    odbc(odbc_query(Connection, Sql, Row, [types(Types)|Wide])).

                /*******************************
                *          STATEMENTS          *
                *******************************/

%!  sql_open(+Connection) is det.
%!  sql_close is det.
%
%   Prepare the statements for Connection; free all of them.

sql_open(Connection) :-
    assertz(connection(Connection)),
    forall(( sql(Name, Sql, Types), \+ memberchk(bytes, Types) ),
           prepare(Connection, Name, 0, Sql, Types)).

sql_close :-
    forall(retract(statement(_, _, Statement)),
           catch(odbc(odbc_free_statement(Statement)), error(_, _), true)),
    retractall(connection(_)).

prepare(Connection, Name, Size, Sql, Types0) :-
    maplist(parameter_type, Types0, Types),
    options(Name, Options),
    odbc(odbc_prepare(Connection, Sql, Types, Statement, Options)),
    assertz(statement(Name, Size, Statement)).

%   A text type without a length would bind the empty text.

parameter_type(kind, varchar(64)).
parameter_type(key, varchar(2000)).
parameter_type(number, bigint).
parameter_type(bytes, longvarbinary(60000)).

options(parts, [types([string])|Wide]) :-
    wide(Wide),
    !.
options(_, []).

%   Otherwise the driver returns texts longer than a kilobyte damaged.

wide([wide_column_threshold(100)]).

%   Statements that both databases accept.

sql(begin, begin, []).
sql(commit, commit, []).
sql(rollback, rollback, []).
sql(put, 'insert into item values (?, ?, ?, ?, ?, ?) \c
          on conflict (kind, key, n) do update set \c
          length=excluded.length, sum=excluded.sum, value=excluded.value',
    [kind, key, number, number, number, bytes]).
sql(put_part, 'insert into part values (?, ?, ?, ?, ?) \c
               on conflict (kind, key, n, part) do update set \c
               value=excluded.value',
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

%!  sql_execute(+Name, +Values) is det.
%!  sql_execute(+Name, +Values, +Bytes) is det.
%
%   Execute a statement of sql/3; Bytes are the last value.

sql_execute(Name, Values) :-
    statement(Name, 0, Statement),
    !,
    odbc(odbc_execute(Statement, Values)).

sql_execute(Name, Values0, Bytes) :-
    string_length(Bytes, Length),
    padded_size(Length, Size),
    statement_of(Name, Size, Statement),
    filled(Length, Size, Bytes, Full),
    append(Values0, [Full], Values),
    odbc(odbc_execute(Statement, Values)).

statement_of(Name, Size, Statement) :-
    statement(Name, Size, Statement),
    !.
statement_of(Name, Size, Statement) :-
    connection(Connection),
    sql(Name, Sql, Types),
    prepare(Connection, Name, Size, Sql, Types),
    statement(Name, Size, Statement).

padded_size(Length, Size) :-
    (   Length =< 512
    ->  Step = 32
    ;   Length =< 4096
    ->  Step = 256
    ;   Step = 2048
    ),
    Size is (Length+Step-1)//Step*Step.

filled(Length, Size, Bytes, Full) :-
    (   Length =:= Size
    ->  Full = Bytes
    ;   Missing is Size-Length,
        filler(Filler),
        sub_string(Filler, 0, Missing, _, Fill),
        string_concat(Bytes, Fill, Full)
    ).

%!  sql_part(+Name, +Values, -Bytes) is nondet.
%
%   Bytes is a row of a statement that returns bytes.

sql_part(Name, Values, Bytes) :-
    statement(Name, 0, Statement),
    odbc(odbc_execute(Statement, Values, row(Bytes))).

:- dynamic filler/1.

make_filler :-
    length(Codes, 2048),
    maplist(=(0'.), Codes),
    string_codes(Filler, Codes),
    assertz(filler(Filler)).

:- initialization(make_filler, now).

