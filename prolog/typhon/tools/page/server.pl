:- module(typhon_page_server,
          [ server_start/2,             % +Options, -Link
            server_stop/0
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(http/websocket), [http_upgrade_to_websocket/3]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../bridges/common',
              [http_server_close/1, http_server_open/4]).
:- use_module(browser_orders, [order_run/2, orders_allowed/2]).
:- use_module(browsers, [browser_serve/2, browsers_start/0, browsers_stop/0]).
:- use_module(editor, [editor_start/0, editor_stop/0, on_console/1]).
:- use_module(guard,
              [page_file/3, request_own/1, token_new/1, token_right/2]).
:- use_module(models, [model_shown/0, models_start/1, models_stop/0]).
:- use_module(overlays,
              [ overlays_shown/1, overlays_start/1, overlays_stop/0 ]).
:- use_module(protocol, [times_stop/0]).
:- use_module(queries,
              [ present_scene/1, query_answer/2, world_shown/0,
                world_start/1, world_stop/0 ]).
:- use_module(reception,
              [client_serve/3, file_reply/2, json_reply/4, refuse/2, text_reply/2]).
:- use_module(runs, [runs_stop/0]).
:- use_module(sources, [sources_metrics/1, sources_start/1, sources_stop/0]).

/** <module> The server of the page

A process has at most one.  Every address begins with the token: `/TOKEN/` is
the page, `/TOKEN/feed` the WebSocket; queries and orders are posted to
`/TOKEN/ask`; other names are those of files.  `/?token=TOKEN` redirects to the
page, and `feed?token=TOKEN` and `metrics?token=TOKEN` are also valid.

*Threading*: a mutex serialises start and stop.  Each client has a thread, and
one thread accepts connections.
*/

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
    models_start(Options),
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
    models_stop,
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
    setting(request_bytes, Most),
    json_reply(In, Request, Most, answer).
route([metrics], _, _, _) =>
    on_console(sources_metrics(Text)),
    text_reply('text/plain; version=0.0.4', Text).
route(Names, _, _, Request) =>
    (   memberchk(method(Method), Request),
        memberchk(Method, [get, head]),
        page_file(Names, File, Type)
    ->  file_reply(File, Type)
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
    ( model_shown -> Model = true ; Model = false ),
    Scene = Seen.put(_{ read_only:ReadOnly, overlays:Overlays,
                        orders:Orders, world:World, model:Model }).

                /*******************************
                *        QUERIES, ORDERS       *
                *******************************/

answer(Message, Answer) :-
    (   get_dict(do, Message, What)
    ->  may_order(What),
        order_run(Message, Answer)
    ;   query_answer(Message, Answer)
    ).

%   No order runs without this check.

may_order(What) :-
    (   serving(_, _, false)
    ->  true
    ;   permission_error(What, page, read_only)
    ).

:- public client/2.             % called by typhon_http_server

client(In, Out) :-
    client_serve(typhon_page_server:serve, In, Out).
