:- module(test_pages,
          [ with_page/3,                % +Options, -Base, :Goal
            ask/3,                      % +Base, +Message, -Answer
            posted/4,                   % +Address, +Body, +Options, -Status
            got/3,                      % +Address, +Options, -Status
            with_feed/3,                % +Base, -Feed, :Goal
            frame/2,                    % +Feed, -Frame
            feed_event/3,               % +Feed, +Pattern, -Event
            feed_closed/2               % +Feed, -Code
          ]).

/** <module> Clients of the page

*Threading*: any thread.
*/

:- use_module(library(http/http_client), [http_get/3, http_post/4]).
:- use_module(library(http/http_json), []).
:- use_module(library(http/http_open), []).
:- use_module(library(http/websocket),
              [http_open_websocket/3, ws_close/3, ws_receive/3]).
:- use_module(library(lists), [append/3]).
:- use_module(library(time), [call_with_time_limit/2]).
:- use_module('../../prolog/typhon/tools/page', [page_serve/2, page_stop/0]).

:- meta_predicate
    with_page(+, -, 0),
    with_feed(+, -, 0).

%!  with_page(+Options, -Base, :Goal) is semidet.
%
%   Goal is called once while there is a page at Base, which ends in a slash.

with_page(Options, Base, Goal) :-
    setup_call_cleanup(
        page_serve([port(0)|Options], Link),
        ( link_base(Link, Base),
          once(Goal) ),
        page_stop).

link_base(Link, Base) :-
    atomic_list_concat([Site, Token], '?token=', Link),
    atomic_list_concat([Site, Token, /], Base).

%!  ask(+Base, +Message:dict, -Answer:dict) is det.

ask(Base, Message, Answer) :-
    atom_concat(Base, ask, Address),
    http_post(Address, json(Message), Answer,
              [json_object(dict), tag(''), default_tag('')]).

%!  posted(+Address, +Body, +Options, -Status) is det.
%!  got(+Address, +Options, -Status) is det.

posted(Address, Body, Options, Status) :-
    http_post(Address, Body, _, [status_code(Status), to(string)|Options]).

got(Address, Options, Status) :-
    http_get(Address, _, [status_code(Status), redirect(false), to(string)|Options]).

%!  with_feed(+Base, -Feed, :Goal) is semidet.
%!  frame(+Feed, -Frame:dict) is det.
%!  feed_event(+Feed, +Pattern:list, -Event:list) is det.
%
%   Event is the next event that begins like Pattern, after its time; others
%   are skipped.

with_feed(Base, Feed, Goal) :-
    atom_concat(http, Rest, Base),
    atomic_list_concat([ws, Rest, feed], Address),
    setup_call_cleanup(
        open_feed(Address, Feed),
        once(Goal),
        close_feed(Feed)).

%   Events that are not yet skipped.

open_feed(Address, feed(Socket, [])) :-
    http_open_websocket(Address, Socket, []).

close_feed(feed(Socket, _)) :-
    catch(ws_close(Socket, 1000, bye), error(_, _), true).

frame(feed(Socket, _), Frame) :-
    call_with_time_limit(20, ws_receive(Socket, Message, [format(json)])),
    Frame = Message.data.

feed_event(Feed, Pattern, Event) :-
    (   arg(2, Feed, Events),
        append(_, [Event0|Later], Events),
        Event0 = [_|Rest],
        append(Pattern, _, Rest)
    ->  Event = Event0,
        nb_setarg(2, Feed, Later)
    ;   frame(Feed, Frame),
        (   get_dict(events, Frame, More)
        ->  nb_setarg(2, Feed, More)
        ;   nb_setarg(2, Feed, [])
        ),
        feed_event(Feed, Pattern, Event)
    ).

%!  feed_closed(+Feed, -Code) is det.
%
%   Code is that of the close frame with which the server ends Feed, or `none`
%   if it ends without. Frames before that are skipped.

feed_closed(Feed, Code) :-
    Feed = feed(Socket, _),
    call_with_time_limit(20, ws_receive(Socket, Message, [])),
    (   get_dict(opcode, Message, close)
    ->  ( get_dict(code, Message, Code0) -> Code = Code0 ; Code = none )
    ;   feed_closed(Feed, Code)
    ).
