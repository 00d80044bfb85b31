:- module(typhon_page_browsers,
          [ browsers_start/0,
            browsers_stop/0,
            browsers_send/1,            % +Event
            browsers_there/0,
            browser_serve/2             % :Scene, +WebSocket
          ]).
:- autoload(library(http/websocket), [ws_send/2]).
:- use_module(library(lists), [reverse/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/fifo', [fifo_send/2]).
:- use_module('../../kernel/base/monotonic',
              [deadline/2, monotonic_time/1, poll_within/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../bridges/json', [json_text/2]).
:- use_module('../../kernel/base/own_thread', [in_own_thread/1]).
:- use_module('../../kernel/base/server',
              [server_cast/2, server_start/5, server_stop/1]).
:- use_module(protocol, [skipped_row/2]).
:- use_module(overlays, [event_rows/2]).

/** <module> The connected browsers, and the events that they get

Events go into one queue.  A server takes the events that have gathered there,
converts them into one text, at most twenty times a second, and puts that into
the queues of all browsers.  Events that a browser does not read fast enough are
dropped, and it gets their number.

*Threading*: any thread adds events; the server converts them; each browser has
a thread that sends it the texts, and one that detects when it disconnects.
*/

:- meta_predicate browser_serve(1, +).

:- setting(browsers, positive_integer, 32,
           "Browsers that may be connected to a page at a time").
:- setting(frame_seconds, number, 0.05,
           "Seconds between two texts with events that a page sends").
:- setting(frame_events, positive_integer, 2000,
           "Events in a text that a page sends").
:- setting(heartbeat_seconds, number, 5,
           "Seconds without events after which a page sends a heartbeat").

:- dynamic
    browser/1,                  % Queue
    skipped/2,                  % Queue, Count: dropped events
    sender/1.                   % Server

%   The sizes of the queue of events, and of the queue of texts for one browser.

queue_size(20 000).
frames_waiting(40).

                /*******************************
                *         START, STOP          *
                *******************************/

%!  browsers_start is det.
%!  browsers_stop is det.
%
%   Start the server that sends events; stop it, send a close frame to connected
%   browsers, and wait until they have read it, for at most five seconds.  The
%   HTTP server ends the others.

browsers_start :-
    queue_size(Size),
    server_start(page, typhon_page_browsers:handle, none, [max_size(Size)],
                 Sender),
    assertz(sender(Sender)).

browsers_stop :-
    (   retract(sender(Sender))
    ->  in_own_thread(stop(Sender))
    ;   true
    ).

stop(Sender) :-
    server_stop(Sender),
    retractall(skipped(_, _)),
    forall(browser(Browser), put_message(Browser, bye)),
    ignore(poll_within(5, \+ browser(_))).

                /*******************************
                *            EVENTS            *
                *******************************/

%!  browsers_send(+Event) is det.
%
%   Send Event, see watch/3, to all browsers.  Waits while the queue of events
%   is full.

browsers_send(Event) :-
    (   sender(Sender)
    ->  ignore(server_cast(Sender, Event))
    ;   true
    ).

%!  browsers_there is semidet.

browsers_there :-
    browser(_),
    !.

%   The state is frame(Due, Count, Events), with the newest event first.  Events
%   are sent after the time Due once no more events wait, or as soon as they
%   fill a frame.

:- public handle/3.

handle(begin, _, Next) :-
    begin_frame(0, Next).
handle(event(Time, Host, Agent, What), frame(Due, Count0, Events), Next) :-
    Count is Count0+1,
    setting(frame_events, Most),
    (   Count >= Most
    ->  send_frame([event(Time, Host, Agent, What)|Events], Next)
    ;   Next = until(Due, frame(Due, Count,
                                [event(Time, Host, Agent, What)|Events]))
    ).
handle(timeout, frame(_, _, Events), Next) :-
    send_frame(Events, Next).
handle(stop, frame(_, _, Events), _) :-
    send_frame(Events, _).

send_frame(Events0, Next) :-
    reverse(Events0, Events),
    monotonic_time(Now),
    send_events(Events, Now),
    setting(frame_seconds, Seconds),
    Due is Now+Seconds,
    begin_frame(Due, Next).

begin_frame(Due, until(Beat, frame(Due, 0, []))) :-
    setting(heartbeat_seconds, Pause),
    deadline(Pause, Beat).

send_events(_, _) :-
    \+ browser(_),
    !.
send_events([], Now) :-
    !,
    json_text(_{tick:Now}, Text),
    forall(browser(Browser), queue_text(Browser, Text, 0)).
send_events(Events, _) :-
    event_rows(Events, Rows),
    json_text(_{events:Rows}, Text),
    length(Events, Count),
    forall(browser(Browser), queue_text(Browser, Text, Count)).

%   Only the server puts texts into the queue of a browser, so a text for which
%   there is space now still fits later.

queue_text(Browser, Text, Count) :-
    ( retract(skipped(Browser, Skipped)) -> true ; Skipped = 0 ),
    (   has_room(Browser)
    ->  report_skipped(Skipped, Browser),
        put_message(Browser, frame(Text))
    ;   More is Skipped+Count,
        with_mutex(typhon_page, skip(Browser, More))
    ).

skip(Browser, Count) :-
    (   browser(Browser)
    ->  assertz(skipped(Browser, Count))
    ;   true                            % it has gone meanwhile
    ).

has_room(Browser) :-
    frames_waiting(Most),
    catch(message_queue_property(Browser, size(Size)),
          error(existence_error(_, _), _), fail),
    Size < Most.

report_skipped(0, _) :-
    !.
report_skipped(Skipped, Browser) :-
    skipped_row(Skipped, Row),
    json_text(_{events:[Row]}, Text),
    put_message(Browser, frame(Text)).

put_message(Browser, Message) :-
    ignore(fifo_send(Browser, Message)).

                /*******************************
                *          ONE BROWSER         *
                *******************************/

%!  browser_serve(:Scene, +WebSocket) is det.
%
%   Send a browser all events until it disconnects, or the page stops, and close
%   WebSocket.  The first text is the Dict of call(Scene, Dict), which may
%   already include events that are sent after it.

browser_serve(Scene, WebSocket) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        catch(serve(Queue, Scene, WebSocket), Ball, report_end(Ball)),
        ( remove_browser(Queue),
          catch(close(WebSocket, [force(true)]), error(_, _), true) )).

%   The first clauses handle the ways in which a connection ends normally: the
%   browser has disconnected, or the page has stopped.

report_end(error(io_error(_, _), _)) => true.
report_end(error(socket_error(_, _), _)) => true.
report_end(crew_end) => true.
report_end(Ball) => print_error(warning, Ball).

serve(Queue, Scene, WebSocket) :-
    (   with_mutex(typhon_page, add_browser(Queue))
    ->  call(Scene, Dict),
        json_text(Dict, Text),
        ws_send(WebSocket, text(Text)),
        serve_until_disconnected(Queue, WebSocket)
    ;   json_text(_{error:"Too many browsers look at this page"}, Text),
        ws_send(WebSocket, text(Text))
    ).

add_browser(Queue) :-
    sender(_),
    setting(browsers, Most),
    findall(B, browser(B), Browsers),
    length(Browsers, Count),
    Count < Most,
    assertz(browser(Queue)).

remove_browser(Queue) :-
    with_mutex(typhon_page, ( retractall(browser(Queue)),
                              retractall(skipped(Queue, _)) )),
    message_queue_destroy(Queue).

%   A browser sends nothing but a close frame here.  So any data from it end the
%   connection, unread.

serve_until_disconnected(Queue, WebSocket) :-
    setup_call_cleanup(
        thread_create(wait_for_end(Queue, WebSocket), Listener),
        send_on(Queue, WebSocket),
        end_listener(Listener)),
    catch(ws_send(WebSocket, close(1000, "")), error(_, _), true).

end_listener(Listener) :-
    catch(thread_signal(Listener, throw(typhon_page(bye))),
          error(existence_error(_, _), _), true),
    thread_join(Listener, _).

wait_for_end(Queue, WebSocket) :-
    stream_pair(WebSocket, In, _),
    catch(wait_for_input([In], _, infinite), error(_, _), true),
    catch(thread_send_message(Queue, bye), error(_, _), true).

send_on(Queue, WebSocket) :-
    thread_get_message(Queue, Message),
    (   Message = frame(Text)
    ->  ws_send(WebSocket, text(Text)),
        send_on(Queue, WebSocket)
    ;   true
    ).
