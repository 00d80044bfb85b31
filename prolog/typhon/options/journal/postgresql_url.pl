:- module(typhon_postgresql_url,
          [ postgresql_url/1,           % +Text
            postgresql_place/4          % +Url, +Part, -Place, -Server
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(uri),
              [ uri_authority_components/2, uri_components/2, uri_encoded/3,
                uri_query_components/2 ]).

/** <module> Where a journal in PostgreSQL is

It is given by a URL, as psql and other programs take it:

    postgresql://[user[:password]@][host][:port][/database][?schema=name&...]

The schema is `typhon` if none is named. Further parameters are host (also the
directory of a socket), port, user, password, dbname and sslmode. What it does
not say the environment does, as PGPASSWORD, or the defaults of the server.

*Threading*: pure.
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
