:- module(typhon_page_server,
          [ server_start/2,             % +Options, -Link
            server_stop/0
          ]).
:- use_module(library(error),
              [ domain_error/2, must_be/2, permission_error/3,
                syntax_error/1 ]).
:- use_module(library(http/http_wrapper), [http_wrapper/5]).
:- use_module(library(http/websocket), [http_upgrade_to_websocket/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/error_lines', [error_text/2]).
:- use_module('../../kernel/base/monotonic', [deadline/2]).
:- use_module('../../bridges/json', [json_dict/2, json_text/2]).
:- use_module('../../bridges/common',
              [ client_becomes/1, http_before/2, http_head/4,
                http_server_close/1, http_server_open/4, with_bytes/3 ]).
:- use_module(browser_orders, [order_run/2, orders_allowed/2]).
:- use_module(browsers, [browser_serve/2, browsers_start/0, browsers_stop/0]).
:- use_module(editor,
              [ editor_start/0, editor_stop/0, on_console/1,
                without_folder/2 ]).
:- use_module(guard,
              [ guarding_headers/0, page_file/3, request_own/1,
                request_within/2, token_new/1, token_right/2 ]).
:- use_module(overlays,
              [ overlays_shown/1, overlays_start/1, overlays_stop/0 ]).
:- use_module(protocol, [times_stop/0]).
:- use_module(queries,
              [ present_scene/1, query_answer/2, world_shown/0,
                world_start/1, world_stop/0 ]).
:- use_module(runs, [runs_stop/0]).
:- use_module(sources, [sources_metrics/1, sources_start/1, sources_stop/0]).

/** <module> The server of the page

A process has at most one.  Every address begins with the token: `/TOKEN/` is
the page, `/TOKEN/feed` the WebSocket; queries and orders are posted to
`/TOKEN/ask`; other names are those of files.  `/?token=TOKEN` redirects to the
page, and `feed?token=TOKEN` and `metrics?token=TOKEN` are also valid.

It does not use http_dispatch, so that this server and other HTTP servers of the
process do not see each other's handlers.

The head of a request is read into memory before the HTTP library parses it: its
size is bounded, and so is the time from its first byte to its last, see
typhon_http_server.  The body is read after the token has been verified, within
a bounded time, too.

*Threading*: a mutex serialises start and stop.  Each client has a thread, and
one thread accepts connections.
*/

:- use_module(library(http/http_stream), []). % else WebSockets are HTTP/1.0

:- setting(request_bytes, positive_integer, 4 000 000,
           "Bytes of a request to a page, at most").
:- dynamic
    serving/3.                  % Port, Token, ReadOnly

%!  server_start(+Options, -Link) is det.
%!  server_stop is det.
%
%   Start the server with Options of page_start/1, Link being the address of the
%   page; stop it, if it runs.
%
%   @error permission_error(start, page, Port) if there is a page already

server_start(Options, Link) :-
    with_mutex(typhon_page_server, start(Options, Link)).

start(_, _) :-
    serving(Port, _, _),
    !,
    permission_error(start, page, Port).
start(Options, Link) :-
    option(bind(Interface), Options, localhost),
    option(port(Port0), Options, 8080),
    option(read_only(ReadOnly), Options, false),
    token_new(Token),
    ( Port0 == 0 -> true ; Port = Port0 ),
    catch(( start_parts(Options),
            setting(typhon_page_reception:connections, Most),
            http_server_open(typhon_page, Interface:Port, Most,
                             typhon_page_server:client) ),
          Ball,
          ( stop_parts, throw(Ball) )),
    assertz(serving(Port, Token, ReadOnly)),
    format(atom(Link), 'http://~w:~d/?token=~w', [Interface, Port, Token]).

start_parts(Options) :-
    sources_start(Options),
    editor_start,
    option(overlays(Files), Options, []),
    overlays_start(Files),
    world_start(Options),
    browsers_start.

server_stop :-
    with_mutex(typhon_page_server, stop).

stop :-
    (   retract(serving(_, _, _))
    ->  browsers_stop,                  % first: it sends close frames
        http_server_close(typhon_page),
        stop_parts
    ;   true
    ).

stop_parts :-
    runs_stop,
    sources_stop,
    times_stop,
    browsers_stop,
    overlays_stop,
    world_stop,
    editor_stop.

                /*******************************
                *           REQUESTS           *
                *******************************/

:- public serve/2.              % called by the library

serve(In, Request) :-
    memberchk(path(Path), Request),
    atomic_list_concat([''|Parts], /, Path),
    (   \+ request_own(Request)
    ->  refuse(403, 'Not from this page')
    ;   admitted(Parts, Request, Rest, Token)
    ->  route(Rest, Token, In, Request)
    ;   refuse(403, 'The link with the token, which was printed when the \c
                     page was started, leads here; this address does not')
    ).

%   admitted(+Parts, +Request, -Rest, -Token): Request has Token in its path,
%   its query or its authorization; Rest are the parts of the path after it.

admitted([Given|Rest], _, Rest, Token) :-
    Rest = [_|_],
    serving(_, Token, _),
    token_right(Given, Token).
admitted([Name], Request, Rest, Token) :-
    (   option(search(Search), Request),
        memberchk(token=Given, Search)
    ;   option(authorization(Text), Request),
        atom_concat('Bearer ', Given, Text)
    ),
    serving(_, Token, _),
    token_right(Given, Token),
    ( Name == '' -> Rest = [] ; Rest = [Name] ).

route([], Token, _, _) =>
    atomic_list_concat(['', Token, ''], /, Page),
    throw(http_reply(see_other(Page))).
route([feed], _, _, Request) =>
    http_upgrade_to_websocket(feed, [guarded(false)], Request).
route([ask], _, In, Request) =>
    answer(In, Request).
route([metrics], _, _, _) =>
    on_console(sources_metrics(Text)),
    text_reply('text/plain; version=0.0.4', Text).
route(Names, _, _, Request) =>
    (   memberchk(method(Method), Request),
        memberchk(Method, [get, head]),
        page_file(Names, File, Type)
    ->  send_file(File, Type)
    ;   refuse(404, 'There is no file of this name')
    ).

:- public feed/1.               % called by the library

feed(WebSocket) :-
    browser_serve(first_frame, WebSocket).

first_frame(_{snapshot:Scene}) :-
    serving(_, _, ReadOnly),
    orders_allowed(ReadOnly, Orders),
    on_console(present_scene(Seen)),
    overlays_shown(Overlays),
    ( world_shown -> World = true ; World = false ),
    Scene = Seen.put(_{ read_only:ReadOnly, overlays:Overlays,
                        orders:Orders, world:World }).

send_file(File, Type) :-
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

                /*******************************
                *        QUERIES, ORDERS       *
                *******************************/

answer(In, Request) :-
    setting(request_bytes, Most),
    (   \+ memberchk(method(post), Request)
    ->  refuse(405, 'Only POST')
    ;   request_within(Request, Most)
    ->  catch(answer_to(In, Request, Answer), Error,
              error_answer(Error, Answer)),
        json_text(Answer, Text),
        text_reply('application/json', Text)
    ;   refuse(413, 'Too large, or of no known length')
    ).

answer_to(In, Request, _{answer:Answer}) :-
    must_be_json(Request),
    memberchk(content_length(Length), Request),
    with_body(In, Length, Body,
              ( set_stream(Body, encoding(utf8)),
                read_string(Body, _, Text) )),
    json_dict(Text, Message),
    must_be(dict, Message),
    (   get_dict(do, Message, What)
    ->  may_order(What),
        order_run(Message, Answer)
    ;   query_answer(Message, Answer)
    ).

%   A form of another site cannot send this type.

must_be_json(Request) :-
    memberchk(content_type(Type), Request),
    (   sub_atom(Type, 0, _, _, 'application/json')
    ->  true
    ;   domain_error(mimetype, Type)
    ).

%   No order runs without this check.

may_order(What) :-
    (   serving(_, _, false)
    ->  true
    ;   permission_error(What, page, read_only)
    ).

error_answer(Error, _{error:Text}) :-
    error_text(Error, Text0),
    without_folder(Text0, Text).

                /*******************************
                *   CONNECTIONS OF BROWSERS    *
                *******************************/

:- setting(typhon_page_reception:connections, positive_integer, 64,
           "Clients of a page at a time").
:- setting(typhon_page_reception:request_seconds, positive_integer, 20,
           "Seconds for the head of a request, and for its body").
:- setting(typhon_page_reception:head_bytes, positive_integer, 16 384,
           "Bytes of the head of a request, at most").

:- meta_predicate with_body(+, +, -, 0).

:- public client/2.             % called by typhon_http_server

client(none, Out) :-
    !,
    format(Out, 'HTTP/1.1 503 Service Unavailable\r\n\c
                 Content-Length: 0\r\nConnection: close\r\n\r\n', []),
    flush_output(Out).
client(In, Out) :-
    setting(typhon_page_reception:request_seconds, Seconds),
    set_stream(Out, timeout(Seconds)),
    deadline(Seconds, Deadline),
    setting(typhon_page_reception:head_bytes, Most),
    http_head(In, Most, Deadline, Bytes),
    client_becomes(busy),
    handler(In, Handler),
    with_bytes(written(Bytes), Head,
               http_wrapper(Handler, Head, Out, Close, [])),
    switched(Close, In, Out).

%   http_wrapper/5 adds the request, against its meta-predicate declaration.
%   serve/2 prints an answer like the handlers of library(http), and reads the
%   body from In.

handler(In, typhon_page_server:serve(In)).

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
    setting(typhon_page_reception:request_seconds, Seconds),
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
