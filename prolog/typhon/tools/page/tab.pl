:- module(typhon_page_tab,
          [ tab_start/0
          ]).
:- use_module('../../bridges/json', [json_dict/2, json_text/2]).
:- use_module('../../kernel/base/error_lines', [error_text/2]).
:- use_module('../../kernel/base/fifo', [fifo_empty/2]).
:- use_module('../../kernel/host',
              [event_shown/3, events_subscribe/3, host/3, host_time/2]).
:- use_module(browser_orders, [order_run/2, orders_allowed/2]).
:- use_module(editor, [editor_start/0, without_folder/2]).
:- use_module(models, [model_shown/0]).
:- use_module(overlays, [event_rows/2, overlays_shown/1, overlays_start/1]).
:- use_module(queries, [present_scene/1, query_answer/2]).
:- use_module(slices, [slice_run/2]).

/** <module> The page of a tab of a browser, whose hosts are in that tab

The queries, orders and events are those of the server of the page; a worker of
the tab calls them here.  All predicates return at once, but for agents that run
on: the worker is ended then.

*Threading*: one thread, in a process without others.
*/

:- multifile
    tab_order/3,                        % +What, +Message, -Done
    typhon_events:handle_event/4,
    typhon_hosting:begins/1.

:- public                               % called by JavaScript
    tab_first/1,                        % -Json
    tab_ask/2,                          % +Json, -Json
    tab_news/1,                         % -Json
    tab_slice/2.                        % +Seconds, -More

:- dynamic events/1.                    % Queue

kinds([life, faults, hops, messages, facts, said, links, hosts]).

%!  tab_start is det.
%
%   Collect the events of all hosts from now on.

tab_start :-
    editor_start,
    overlays_start([]),
    message_queue_create(Queue),
    assertz(events(Queue)),
    forall(host(Name, _, _), listen(Name)).

listen(Name) :-
    kinds(Kinds),
    events_subscribe(Kinds, Name, page).

typhon_hosting:begins(Name) :-
    events(_),
    listen(Name).

typhon_events:handle_event(page, Host, Agent, What) :-
    events(Queue),
    event_shown(Host, What, Shown),
    host(Host, Address, _),
    host_time(Host, Time),
    thread_send_message(Queue, event(Time, Address, Agent, Shown)).

%   tab_first(-Json:string) is det.
%
%   The first frame of the feed.

tab_first(Json) :-
    present_scene(Scene),
    overlays_shown(Overlays),
    orders_allowed(false, Orders),
    ( model_shown -> Model = true ; Model = false ),
    json_text(_{snapshot:Scene.put(_{ read_only:false, overlays:Overlays,
                                      orders:Orders, world:false,
                                      model:Model })}, Json).

%   tab_ask(+Json:string, -Reply:string) is det.
%
%   Reply is that to a query or an order, or to an order of the hook tab_order/3.

tab_ask(Text, Reply) :-
    catch(( json_dict(Text, Message), answer(Message, Answer) ), Error,
          refused(Error, Answer)),
    json_text(Answer, Reply).

answer(Message, _{answer:Answer}) :-
    get_dict(do, Message, What),
    tab_order(What, Message, Answer),
    !.
answer(Message, _{answer:Answer}) :-
    get_dict(do, Message, _),
    !,
    order_run(Message, Answer).
answer(Message, _{answer:Answer}) :-
    query_answer(Message, Answer).

refused(Error, _{error:Text}) :-
    error_text(Error, Text0),
    without_folder(Text0, Text).

%   tab_news(-Json:string) is det.
%
%   The next frame of the feed, empty if nothing has happened.

tab_news(Json) :-
    events(Queue),
    fifo_empty(Queue, Events),
    (   Events == []
    ->  Json = ""
    ;   event_rows(Events, Rows),
        json_text(_{events:Rows}, Json)
    ).

%   tab_slice(+Seconds, -More:number) is det.
%
%   Let virtual time run at its pace, for about Seconds.  There is more to do
%   after More seconds; -1 if not before the next order.

tab_slice(Seconds, More) :-
    slice_run(Seconds, When),
    ( When = after(More) -> true ; More = -1 ).
