:- module(typhon_fipa_reception,
          [ reception_open/4,           % +Host, +Address, +Limits, -Port
            reception_close/1           % +Host
          ]).
:- use_module(library(option), [option/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../common',
              [ client_becomes/1, http_deadline/2, http_server_close/1,
                http_server_open/4 ]).
:- use_module(http, [http_request/5, http_respond/3, within/2]).

/** <module> Incoming requests

Each client has a thread, as many at a time as there may be connections, see
typhon_http_server.  The time between the first byte and the last of
a request is limited.

*Threading*: an acceptor, and a thread for each client.
*/

:- multifile
    requested/3.                % Host, Request, Code: handle a request

%   Between two requests, at most.

idle_seconds(60).

%   So that a client that sends too much can read the answer.

max_drained(16000000).

%!  reception_open(+Host, +Address, +Limits, -Port) is det.
%
%   Listen at Address, Interface:Port, for Host.  Limits has
%   connections(N), max_bytes(N) and seconds(S).
%
%   @error socket_error(Code, Message)

reception_open(Host, Interface:Port, Limits, Port) :-
    option(connections(Most), Limits),
    http_server_open(fipa(Host), Interface:Port, Most,
                     typhon_fipa_reception:serve(Host, Limits)).

%!  reception_close(+Host) is det.

reception_close(Host) :-
    http_server_close(fipa(Host)).

                /*******************************
                *            CLIENTS           *
                *******************************/

:- public serve/4.              % called by typhon_http_server

serve(_, _, none, Out) :-
    !,
    http_respond(Out, 503, false).
serve(Host, Limits, In, Out) :-
    requests(Host, In, Out, Limits).

requests(Host, In, Out, Limits) :-
    client_becomes(idle),
    idle_seconds(Idle),
    set_stream(In, timeout(Idle)),
    peek_byte(In, Byte),
    Byte \== -1,
    client_becomes(reading),
    option(seconds(Seconds), Limits),
    http_deadline(Seconds, Deadline),
    option(max_bytes(Max), Limits),
    catch(within(Seconds, http_request(In, Out, Deadline, Max, Request)),
          Ball,
          Request = bad(Ball)),
    client_becomes(busy),
    answer(Request, Host, In, Out, KeepAlive),
    KeepAlive == true,
    requests(Host, In, Out, Limits).

answer(bad(Ball), _, In, Out, false) :-
    !,
    (   bad(Ball, Code)
    ->  http_respond(Out, Code, false),
        drained(Code, In)
    ;   throw(Ball)
    ).
answer(Request, Host, _, Out, KeepAlive) :-
    Request = request(_, _, _, _, KeepAlive0),
    (   catch(requested(Host, Request, Code0), error(Formal, Context),
              ( print_error(error, error(Formal, Context)), fail ))
    ->  Code = Code0,
        KeepAlive = KeepAlive0
    ;   Code = 500,
        KeepAlive = false
    ),
    http_respond(Out, Code, KeepAlive).

bad(time_limit_exceeded, 408).
bad(error(Formal, _), Code) :-
    bad_request(Formal, Code).

bad_request(resource_error(http_body), 413) :- !.
bad_request(resource_error(http_head), 413) :- !.
bad_request(syntax_error(http_length), 411) :- !.
bad_request(timeout_error(_, _), 408) :- !.
bad_request(_, 400).

%   A connection that is closed with unread input is reset, and the client
%   loses the answer.

drained(413, In) :-
    !,
    max_drained(Most),
    set_stream(In, timeout(2)),
    catch(catch(within(5, drain(In, Most)),
                time_limit_exceeded, true),
          error(_, _), true).
drained(_, _).

drain(In, Left) :-
    (   Left > 0,
        peek_byte(In, Byte),
        Byte \== -1
    ->  read_pending_codes(In, Codes, []),
        length(Codes, Count),
        Left1 is Left-Count,
        drain(In, Left1)
    ;   true
    ).
