:- module(typhon_page_reception,
          [ client_serve/3,             % +Serve, +In, +Out
            json_reply/4,               % +In, +Request, +Most, :Answer
            text_reply/2,               % +Type, +Text
            file_reply/2,               % +File, +Type
            refuse/2                    % +Status, +Why
          ]).
:- use_module(library(error), [domain_error/2, must_be/2, syntax_error/1]).
:- use_module(library(http/http_wrapper), [http_wrapper/5]).
:- use_module(library(lists), [memberchk/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/error_lines', [error_text/2]).
:- use_module('../../kernel/base/error_text', [is_abort/1]).
:- use_module('../../kernel/base/monotonic', [deadline/2]).
:- use_module('../../bridges/json', [json_dict/2, json_text/2]).
:- use_module('../../bridges/common',
              [ client_becomes/1, http_before/2, http_head/4, with_bytes/3 ]).
:- use_module(editor, [without_folder/2]).
:- use_module(guard, [guarding_headers/0, request_within/2]).

/** <module> Requests of browsers and their answers

For the servers of this layer.  They do not use http_dispatch, so that they and
other HTTP servers of the process do not see each other's handlers.

The head of a request is read into memory before the HTTP library parses it: its
size is bounded, and so is the time from its first byte to its last, see
typhon_http_server.  The body is read within a bounded time, too, after the
server has verified the token.

*Threading*: the thread of a client.
*/

:- use_module(library(http/http_stream), []). % else WebSockets are HTTP/1.0

                /*******************************
                *           ANSWERS            *
                *******************************/

%!  file_reply(+File, +Type) is det.
%!  text_reply(+Type, +Text) is det.
%!  refuse(+Status, +Why) is det.
%
%   Print an answer, as handlers of library(http) do: the bytes of File; Text;
%   the text Why with another status than 200.

file_reply(File, Type) :-
    setup_call_cleanup(
        open(File, read, In, [type(binary)]),
        read_string(In, _, Bytes),
        close(In)),
    format('Content-Type: ~w\r\n', [Type]),
    guarding_headers,
    format('\r\n'),
    current_output(Out),
    set_stream(Out, encoding(octet)),
    write(Bytes).

text_reply(Type, Text) :-
    format('Content-Type: ~w; charset=UTF-8\r\n', [Type]),
    guarding_headers,
    format('\r\n~w', [Text]).

refuse(Status, Why) :-
    format('Status: ~d Refused\r\n', [Status]),
    text_reply('text/plain', Why).

%!  json_reply(+In, +Request, +Most, :Answer) is det.
%
%   Print the answer to a posted request in JSON, whose body, on In, has at most
%   Most bytes: {"answer": A}, for call(Answer, Message, A), or {"error": Text}
%   for what it raises, but an abort, which passes.

:- meta_predicate json_reply(+, +, +, 2).

json_reply(In, Request, Most, Goal) :-
    (   \+ memberchk(method(post), Request)
    ->  refuse(405, 'Only POST')
    ;   request_within(Request, Most)
    ->  catch(answer_to(In, Request, Goal, Answer), Error,
              error_answer(Error, Answer)),
        json_text(Answer, Text),
        text_reply('application/json', Text)
    ;   refuse(413, 'Too large, or of no known length')
    ).

answer_to(In, Request, Goal, _{answer:Answer}) :-
    must_be_json(Request),
    memberchk(content_length(Length), Request),
    with_body(In, Length, Body,
              ( set_stream(Body, encoding(utf8)),
                read_string(Body, _, Text) )),
    json_dict(Text, Message),
    must_be(dict, Message),
    call(Goal, Message, Answer).

%   A form of another site cannot send this type.

must_be_json(Request) :-
    memberchk(content_type(Type), Request),
    (   sub_atom(Type, 0, _, _, 'application/json')
    ->  true
    ;   domain_error(mimetype, Type)
    ).

%   An abort ends the thread.

error_answer(Abort, _) :-
    is_abort(Abort),
    !,
    throw(Abort).
error_answer(Error, _{error:Text}) :-
    error_text(Error, Text0),
    without_folder(Text0, Text).

                /*******************************
                *   CONNECTIONS OF BROWSERS    *
                *******************************/

:- setting(connections, positive_integer, 64,
           "Clients of a page at a time").
:- setting(request_seconds, positive_integer, 20,
           "Seconds for the head of a request, and for its body").
:- setting(head_bytes, positive_integer, 16 384,
           "Bytes of the head of a request, at most").

:- meta_predicate with_body(+, +, -, 0).

%!  client_serve(+Serve, +In, +Out) is det.
%
%   Serve a client of typhon_http_server: call(Serve, In, Request), with the
%   qualified name Serve, prints the answer.

client_serve(_, none, Out) :-
    !,
    format(Out, 'HTTP/1.1 503 Service Unavailable\r\n\c
                 Content-Length: 0\r\nConnection: close\r\n\r\n', []),
    flush_output(Out).
client_serve(Serve, In, Out) :-
    setting(request_seconds, Seconds),
    set_stream(Out, timeout(Seconds)),
    deadline(Seconds, Deadline),
    setting(head_bytes, Most),
    http_head(In, Most, Deadline, Bytes),
    client_becomes(busy),
    handler(Serve, In, Handler),
    with_bytes(written(Bytes), Head,
               http_wrapper(Handler, Head, Out, Close, [])),
    switched(Close, In, Out).

%   http_wrapper/5 adds the request, against its meta-predicate declaration.

handler(Module:Name, In, Module:Handler) :-
    Handler =.. [Name,In].

%   After the upgrade the connection is a WebSocket.

switched(switch_protocol(Goal, _), In, Out) =>
    client_becomes(apart),
    set_stream(Out, timeout(infinite)),
    call(Goal, In, Out).
switched(_, _, _) =>
    true.

%   with_body(+In, +Length, -Body, :Goal) is semidet.
%
%   Read a body of Length bytes from In, and run Goal once, in which Body is a
%   stream with these bytes.
%
%   @error timeout_error(read, In)
%   @error syntax_error(http_length) the body is shorter

with_body(In, Length, Body, Goal) :-
    setting(request_seconds, Seconds),
    deadline(Seconds, Deadline),
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
