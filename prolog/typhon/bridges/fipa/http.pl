:- module(typhon_fipa_http,
          [ http_url/3,                 % ?Url, ?Address, ?Path
            http_request/4,             % +In, +Out, +MaxBytes, -Request
            http_respond/3,             % +Out, +Code, +KeepAlive
            http_post/4,                % +Out, +Url, +ContentType, +Body
            http_response/3,            % +In, -Code, -KeepAlive
            within/2                    % +Seconds, :Goal
          ]).
:- use_module(library(dcg/basics), [string_without//2]).
:- use_module(library(error),
              [domain_error/2, must_be/2, resource_error/1, syntax_error/1]).
:- use_module(library(http/http_header),
              [http_parse_header/2, http_read_request/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(uri), [uri_components/2, uri_authority_components/2,
                             uri_authority_data/3, uri_data/3]).
:- use_module('../../kernel/host', [alarm_in/3]).
:- use_module('../common', [http_head/4, with_bytes/3]).

/** <module> HTTP for the message transport of FIPA

Requests and responses on byte streams, each of bounded size: a head of at most
16 kB, a body of known length.  The HTTP library parses a head after it was read
as a whole.  Clients of library(http/http_open) cannot be used: answers of JADE
have no length, and the connection is kept.

The caller limits the whole time by within/2, since a deadline for each byte
would be the most expensive part of reading a head.  within/2 is like
call_with_time_limit/2, but once library(time) is loaded it may keep SWI-Prolog
9.0.4 from halting, so within/2 uses the alarms of hosts.

*Threading*: any thread, one for each stream; within/2 only while a host runs.
The timer signals the thread.
*/

:- multifile
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- meta_predicate within(+, 0).

:- dynamic busy/2.                      % Key, Thread

max_head(16384).

%   The longest rest of an answer that is skipped.

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
%   Read the next request from In: request(Method, Target, ContentType, Body,
%   KeepAlive), an atom like `post`, two more atoms, a string of bytes and a
%   boolean.  Fails at the end of In.  A body must have a length; a client that
%   expects `100 Continue` gets it on Out.
%
%   @error syntax_error(http_request), syntax_error(http_length)
%   @error resource_error(http_head), resource_error(http_body)

http_request(In, Out, MaxBytes,
             request(Method, Target, Type, Body, KeepAlive)) :-
    max_head(Max),
    http_head(In, Max, none, Head),
    (   catch(with_bytes(written(Head), Text,
                         http_read_request(Text, Fields)),
              error(_, _), fail),
        memberchk(method(Method0), Fields),
        memberchk(request_uri(Target0), Fields),
        memberchk(http_version(1-Minor), Fields)
    ->  Method = Method0,
        Target = Target0
    ;   syntax_error(http_request)
    ),
    keep_alive(Minor, Fields, KeepAlive),
    option(content_type(Type), Fields, ''),
    body(Fields, In, Out, MaxBytes, Body).

written(Bytes, Out) :-
    format(Out, '~s', [Bytes]).

keep_alive(Minor, Fields, KeepAlive) :-
    option(connection(Word0), Fields, none),
    downcase_atom(Word0, Word),
    (   ( Word == close ; Minor == 0, Word \== 'keep-alive' )
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
    ;   send_continue(Fields, Out),
        read_string(In, Length, Body),
        string_length(Body, Length)
    ->  true
    ;   syntax_error(http_length)       % In has ended too early
    ).
body(_, _, _, _, "").

send_continue(Fields, Out) :-
    (   memberchk(expect(_), Fields)
    ->  format(Out, 'HTTP/1.1 100 Continue\r\n\r\n', []),
        flush_output(Out)
    ;   true
    ).

%!  http_respond(+Out, +Code, +KeepAlive:boolean) is det.
%
%   Write a response.  Its body is a line of text, since JADE reads answers by
%   lines and recognises the next answer by its first line.

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
%   Write a request; Body is a string of bytes.

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
%   Read a response.  Fails at the end of In.  Answers of JADE have no length,
%   so the rest of the previous answer is skipped.
%
%   @error resource_error(http_head), syntax_error(http_response)

http_response(In, Code, KeepAlive) :-
    max_head(Max),
    max_skipped(Most),
    Left is Max+Most,
    response(In, Left, Code, KeepAlive).

response(In, Left0, Code, KeepAlive) :-
    http_head(In, Left0, none, Head),
    (   phrase(status(Minor, Code0), Head, Rest),
        Code0 \== 100
    ->  Code = Code0,
        response_fields(Rest, Fields),
        keep_alive(Minor, Fields, KeepAlive),
        skip_body(Fields, In)
    ;   length(Head, Length),
        Left is Left0-Length,
        response(In, Left, Code, KeepAlive)
    ).

status(Minor, Code) -->
    "HTTP/1.",
    !,
    [Version], " ", [A,B,C],
    string_without(`\n`, _), "\n",
    { catch(number_codes(Code, [A,B,C]), error(_, _), fail),
      Minor is Version-0'0 }.
status(Minor, Code) -->
    string_without(`\n`, _), "\n",
    status(Minor, Code).

response_fields(Codes, Fields) :-
    (   catch(http_parse_header(Codes, Fields0), error(_, _), fail)
    ->  Fields = Fields0
    ;   syntax_error(http_response)
    ).

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

%!  within(+Seconds, :Goal) is semidet.
%
%   Call once(Goal), for at most Seconds.
%
%   @throws time_limit_exceeded

within(Seconds, Goal) :-
    flag(typhon_fipa_http, Number, Number+1),
    atom_concat('fipa ', Number, Key),
    thread_self(Me),
    setup_call_cleanup(
        assertz(busy(Key, Me)),
        ( alarm_in(Seconds, Key, fipa_late),
          once(Goal) ),
        retractall(busy(Key, _))).

%   A signal that arrives just before a thread blocks does not wake it, so the
%   signal is repeated.

typhon_scheduler:fire(Key, fipa_late) :-
    !,
    (   busy(Key, Thread)
    ->  catch(thread_signal(Thread, typhon_fipa_http:late(Key)),
              error(_, _), true),
        alarm_in(0.5, Key, fipa_late)
    ;   true
    ).

typhon_scheduler:over(Key, fipa_late) :-
    \+ busy(Key, _).

late(Key) :-
    (   retract(busy(Key, _))
    ->  throw(time_limit_exceeded)
    ;   true
    ).
