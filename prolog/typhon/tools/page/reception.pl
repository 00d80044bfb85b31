:- module(typhon_page_reception,
          [ reception_open/2,           % +Address, :Serve
            reception_close/0,
            with_body/4                 % +In, +Length, -Body, :Goal
          ]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(http/http_wrapper), [http_wrapper/5]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../bridges/common',
              [ client_becomes/1, http_before/2, http_deadline/2,
                http_head/4, http_server_close/1, http_server_open/4,
                with_bytes/3 ]).

/** <module> Connections of browsers

The head of a request is read into memory before the library of HTTP looks at
it: it has a bounded size, and has to be there in time, from its first byte to
its last, see typhon_http_server.  The body, which is read when the token is
known to be right, has to be there in time, too.

*Threading*: an acceptor, and a thread for each client.
*/

:- setting(connections, positive_integer, 64,
           "A page has so many clients at a time").
:- setting(request_seconds, positive_integer, 20,
           "The head of a request takes no longer, and no longer its body").
:- setting(head_bytes, positive_integer, 16 384,
           "The head of a request is no longer").

:- meta_predicate
    reception_open(+, 2),
    with_body(+, +, -, 0).

%!  reception_open(+Address, :Serve) is det.
%!  reception_close is det.
%
%   Serve clients that connect to Address, Interface:Port, by call(Serve, In,
%   Request), which prints an answer as handlers of library(http) do; In has the
%   body.  reception_close/0 ends all clients.
%
%   @error socket_error(Code, Message)

reception_open(Address, Serve) :-
    setting(connections, Most),
    http_server_open(typhon_page, Address, Most,
                     typhon_page_reception:client(Serve)).

reception_close :-
    http_server_close(typhon_page).

:- public client/3.             % called by typhon_http_server

client(_, none, Out) :-
    !,
    format(Out, 'HTTP/1.1 503 Service Unavailable\r\n\c
                 Content-Length: 0\r\nConnection: close\r\n\r\n', []),
    flush_output(Out).
client(Serve, In, Out) :-
    setting(request_seconds, Seconds),
    set_stream(Out, timeout(Seconds)),
    http_deadline(Seconds, Deadline),
    setting(head_bytes, Most),
    http_head(In, Most, Deadline, Bytes),
    client_becomes(busy),
    handler(Serve, In, Handler),
    with_bytes(written(Bytes), Head,
               http_wrapper(Handler, Head, Out, Close, [])),
    switched(Close, In, Out).

%   http_wrapper/5 adds the request, which its declaration does not say.

handler(Serve, In, typhon_page_reception:serve(Serve, In)).

:- public serve/3.

serve(Serve, In, Request) :-
    call(Serve, In, Request).

%   The rest of the connection is a WebSocket.

switched(switch_protocol(Goal, _), In, Out) :-
    !,
    client_becomes(apart),
    set_stream(Out, timeout(infinite)),
    call(Goal, In, Out).
switched(_, _, _).

                /*******************************
                *             BODY             *
                *******************************/

%!  with_body(+In, +Length, -Body, :Goal) is semidet.
%
%   Run Goal once while Body is a stream with the body of that Length, which
%   has been read from In.
%
%   @error timeout_error(read, In), syntax_error(http_length) if it is shorter

with_body(In, Length, Body, Goal) :-
    setting(request_seconds, Seconds),
    http_deadline(Seconds, Deadline),
    with_bytes(copied(In, Length, Deadline), Body, Goal).

copied(In, Left, Deadline, Out) :-
    (   Left > 0
    ->  http_before(Deadline, In),
        (   peek_byte(In, -1)
        ->  syntax_error(http_length)
        ;   true
        ),
        read_pending_codes(In, Bytes, []),
        written(Bytes, Out),
        length(Bytes, Count),
        Left1 is Left-Count,
        copied(In, Left1, Deadline, Out)
    ;   true
    ).

written(Bytes, Out) :-
    format(Out, '~s', [Bytes]).
