:- module(typhon_fipa_http,
          [ http_url/3,                 % ?Url, ?Address, ?Path
            http_request/4,             % +In, +Out, +MaxBytes, -Request
            http_respond/3,             % +Out, +Code, +KeepAlive
            http_post/4,                % +Out, +Url, +ContentType, +Body
            http_response/3             % +In, -Code, -KeepAlive
          ]).
:- use_module(library(error), [domain_error/2, must_be/2, resource_error/1,
                               syntax_error/1]).
:- use_module(library(http/http_header), [http_parse_header/2]).
:- use_module(library(lists), [append/3]).
:- use_module(library(uri), [uri_components/2, uri_authority_components/2,
                             uri_authority_data/3, uri_data/3]).

/** <module> HTTP, as far as a message transport needs it

Requests and responses on byte streams, each of bounded size: a head of at
most 16 kB, a body of known length.  Servers of the libraries do not bound
the head of a request.

The caller limits the time.

*Threading*: any thread, one for each stream.
*/

max_head(16384).

%   The longest unused rest of an answer that is skipped.

max_skipped(65536).

%!  http_url(+Url:text, -Address, -Path) is det.
%
%   Url is `http://Host:Port/Path`; Address is Host:Port.
%
%   @error domain_error(http_url, Url)

http_url(Url, Host:Port, Path) :-
    (   uri_components(Url, Parts),
        uri_data(scheme, Parts, http),
        uri_data(authority, Parts, Authority),
        atom(Authority),
        uri_authority_components(Authority, Where),
        uri_authority_data(host, Where, Host0),
        atom(Host0),
        Host0 \== '',
        uri_authority_data(port, Where, Port0),
        ( var(Port0) -> Port1 = 80 ; integer(Port0), Port1 = Port0 ),
        uri_data(path, Parts, Path0)
    ->  Host = Host0,
        Port = Port1,
        ( Path0 == '' -> Path = (/) ; Path = Path0 )
    ;   domain_error(http_url, Url)
    ).

                /*******************************
                *           REQUESTS           *
                *******************************/

%!  http_request(+In, +Out, +MaxBytes, -Request) is semidet.
%
%   Read the next request from In, Request being request(Method, Path,
%   ContentType, Body, KeepAlive): an atom, two more, a string of bytes and a
%   boolean.  Fails at the end of In.  A body must have a length; a client
%   that expects `100 Continue` gets it on Out.
%
%   @error syntax_error(http_request), syntax_error(http_length)
%   @error resource_error(http_head), resource_error(http_body)

http_request(In, Out, MaxBytes, request(Method, Path, Type, Body, KeepAlive)) :-
    \+ at_end_of_stream(In),
    max_head(Max),
    line(In, First, Max, Left),
    (   phrase(request_line(MethodCodes, PathCodes, Version), First)
    ->  atom_codes(Method, MethodCodes),
        atom_codes(Path, PathCodes)
    ;   syntax_error(http_request)
    ),
    fields(In, Left, Fields),
    keep_alive(Version, Fields, KeepAlive),
    field(content_type(Type), Fields, ''),
    body(Fields, In, Out, MaxBytes, Body).

request_line(Method, Path, Version) -->
    word(Method), " ", word(Path), " HTTP/1.", [Version].

word([Code|Codes]) -->
    [Code],
    { Code > 0' , Code < 0x7f },
    (   word(Codes)
    ->  []
    ;   { Codes = [] }
    ).

keep_alive(Version, Fields, KeepAlive) :-
    field(connection(Word0), Fields, none),
    downcase_atom(Word0, Word),
    (   ( Word == close ; Version == 0'0, Word \== 'keep-alive' )
    ->  KeepAlive = false
    ;   KeepAlive = true
    ).

body(Fields, _, _, _, _) :-
    memberchk(transfer_encoding(_), Fields),
    !,
    syntax_error(http_length).
body(Fields, In, Out, MaxBytes, Body) :-
    memberchk(content_length(Length), Fields),
    !,
    must_be(nonneg, Length),
    (   Length > MaxBytes
    ->  resource_error(http_body)
    ;   go_on(Fields, Out),
        read_string(In, Length, Body),
        string_length(Body, Length)
    ->  true
    ;   syntax_error(http_length)       % it ended before
    ).
body(_, _, _, _, "").

go_on(Fields, Out) :-
    (   memberchk(expect(_), Fields)
    ->  format(Out, 'HTTP/1.1 100 Continue\r\n\r\n', []),
        flush_output(Out)
    ;   true
    ).

%!  http_respond(+Out, +Code, +KeepAlive:boolean) is det.
%
%   JADE reads answers by lines, and looks for the next one by its first.

http_respond(Out, Code, KeepAlive) :-
    reason(Code, Reason),
    connection(KeepAlive, Connection),
    string_length(Reason, Length0),
    Length is Length0+2,
    format(Out,
           'HTTP/1.1 ~d ~s\r\nContent-Type: text/plain\r\n\c
            Content-Length: ~d\r\nConnection: ~w\r\n\r\n~s\r\n',
           [Code, Reason, Length, Connection, Reason]),
    flush_output(Out).

reason(200, "OK").
reason(400, "Bad Request").
reason(404, "Not Found").
reason(405, "Method Not Allowed").
reason(408, "Request Timeout").
reason(411, "Length Required").
reason(413, "Payload Too Large").
reason(415, "Unsupported Media Type").
reason(500, "Internal Server Error").
reason(503, "Service Unavailable").

connection(true, 'Keep-Alive').
connection(false, close).

                /*******************************
                *           RESPONSES          *
                *******************************/

%!  http_post(+Out, +Url, +ContentType, +Body:string) is det.
%
%   Body is a string of bytes.

http_post(Out, Url, ContentType, Body) :-
    http_url(Url, Host:Port, Path),
    string_length(Body, Length),
    format(Out,
           'POST ~w HTTP/1.1\r\nHost: ~w:~w\r\nCache-Control: no-cache\r\n\c
            Mime-Version: 1.0\r\nContent-Type: ~w\r\n\c
            Content-Length: ~d\r\nConnection: Keep-Alive\r\n\r\n',
           [Path, Host, Port, ContentType, Length]),
    write(Out, Body),
    flush_output(Out).

%!  http_response(+In, -Code, -KeepAlive:boolean) is semidet.
%
%   Fails at the end of In.  JADE's answers have no length: the rest of the
%   last one is skipped.
%
%   @error resource_error(http_head), syntax_error(http_response)

http_response(In, Code, KeepAlive) :-
    max_skipped(Most),
    status_line(In, Most, Version, Code0),
    max_head(Max),
    fields(In, Max, Fields),
    (   Code0 == 100
    ->  http_response(In, Code, KeepAlive)
    ;   Code = Code0,
        keep_alive(Version, Fields, KeepAlive),
        skip_body(Fields, In)
    ).

status_line(In, Left0, Version, Code) :-
    \+ at_end_of_stream(In),
    line(In, Line, Left0, Left),
    (   phrase(status(Version, Code0), Line, _)
    ->  Code = Code0
    ;   status_line(In, Left, Version, Code)
    ).

status(Version, Code) -->
    "HTTP/1.", [Version], " ", [A,B,C],
    { catch(number_codes(Code, [A,B,C]), error(_, _), fail) }.

skip_body(Fields, In) :-
    memberchk(content_length(Length), Fields),
    !,
    max_skipped(Most),
    (   integer(Length),
        Length =< Most
    ->  read_string(In, Length, _)
    ;   syntax_error(http_response)
    ).
skip_body(_, _).

                /*******************************
                *             HEADS            *
                *******************************/

%   line(+In, -Codes, +Left0, -Left): one line, without its end, of which
%   there may be Left0 bytes.

line(In, Codes, Left0, Left) :-
    get_byte(In, Byte),
    line(Byte, In, Codes, Left0, Left).

line(_, _, _, 0, _) :-
    !,
    resource_error(http_head).
line(-1, _, _, _, _) :-
    !,
    syntax_error(http_request).
line(0'\n, _, [], Left0, Left) :-
    !,
    Left is Left0-1.
line(0'\r, In, Codes, Left0, Left) :-
    !,
    Left1 is Left0-1,
    line(In, Codes, Left1, Left).
line(Byte, In, [Byte|Codes], Left0, Left) :-
    Left1 is Left0-1,
    line(In, Codes, Left1, Left).

fields(In, Left, Fields) :-
    head(In, Left, Codes),
    (   catch(http_parse_header(Codes, Fields0), error(_, _), fail)
    ->  Fields = Fields0
    ;   syntax_error(http_request)
    ).

head(In, Left0, Codes) :-
    line(In, Line, Left0, Left),
    (   Line == []
    ->  Codes = `\r\n`
    ;   append(Line, [0'\r,0'\n|More], Codes),
        head(In, Left, More)
    ).

field(Field, Fields, Default) :-
    (   memberchk(Field, Fields)
    ->  true
    ;   arg(1, Field, Default)
    ).
