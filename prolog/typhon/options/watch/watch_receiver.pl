:- module(typhon_watch_receiver,
          [ receiver_open/2,            % +Watch, -Queue
            receiver_close/1,           % +Watch
            receiver_put/2,             % +Watch, +Message
            receiver_run/4              % +Watch, +Queue, :OnEvent, +Asked
          ]).
:- use_module(library(apply), [partition/4]).
:- use_module(library(lists), [delete/3, member/2, min_list/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../../kernel/base/fifo', [fifo_send/2]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1, wait_before/2]).
:- use_module('../../kernel/base/error_text', [error_lines/3, is_abort/1]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_reply/2, endpoint_request/4]).
:- use_module(watch_places,
              [ place_answered/4, place_at/4, place_begin/3, place_cut/3,
                place_due/3, place_started/4, place_stopped/2,
                places_forget/1 ]).

/** <module> The events that a watch receives

The thread of a watch calls OnEvent for each event.  When the connection to a
process that sends events has broken, the thread sends it a new request, see
module `watch_places`.

*Threading*: one thread for each watch.  The hooks of the endpoint put messages
into its queue.  The thread is no `server`, which would continue after an abort:
an aborted watch ends.
*/

:- meta_predicate receiver_run(+, +, 1, +).

:- multifile
    prolog:message//1,
    typhon_endpoint:connection/2,
    typhon_endpoint:requested/4,
    typhon_event_sender:deliver_here/3.

:- setting(typhon_watches:last_seconds, number, 2,
           "Seconds that unwatch/1 waits for earlier events").

:- dynamic watch/2.             % Watch, Queue: while events are wanted

%!  receiver_open(+Watch, -Queue) is det.
%!  receiver_close(+Watch) is det.
%
%   Queue receives the events of Watch from now on, until receiver_close/1,
%   after which the thread that reads it ends.

receiver_open(Watch, Queue) :-
    message_queue_create(Queue),
    assertz(watch(Watch, Queue)).

receiver_close(Watch) :-
    ignore(receiver_put(Watch, over)),
    retractall(watch(Watch, _)).

                /*******************************
                *           THE WIRE           *
                *******************************/

typhon_endpoint:requested(watched, events(Watch, Events), Peer, ReplyTo) :-
    (   is_list(Events),
        receiver_put(Watch, events(Peer, Events, peer(ReplyTo)))
    ->  true
    ;   endpoint_reply(ReplyTo, no)
    ).
typhon_event_sender:deliver_here(Watch, Events, OnAnswer) :-
    endpoint_address(Own),
    !,
    receiver_put(Watch, events(Own, Events, here(OnAnswer))).
typhon_endpoint:requested(watched, alive(Watch), _, ReplyTo) :-
    (   watch(Watch, _)
    ->  endpoint_reply(ReplyTo, yes)
    ;   endpoint_reply(ReplyTo, no)
    ).

typhon_endpoint:connection(Peer, State) :-
    forall(watch(Watch, _),
           ignore(receiver_put(Watch, connection(Peer, State)))).

%!  receiver_put(+Watch, +Message) is semidet.
%
%   Put Message into the queue of Watch.  Fails if Watch has ended.

receiver_put(Watch, Message) :-
    watch(Watch, Queue),
    fifo_send(Queue, Message).

                /*******************************
                *           THE LOOP           *
                *******************************/

%!  receiver_run(+Watch, +Queue, :OnEvent, +Asked) is det.
%
%   Handle the messages of Queue, in the thread of Watch, until
%   receiver_close/1, or the message end(Done): this delivers earlier events
%   first, and then sends `done` to the queue Done.  Asked are terms as in
%   place_begin/3.

receiver_run(Watch, Queue, OnEvent, Asked) :-
    Me = me(Watch, Queue, OnEvent),
    setup_call_cleanup(
        begin(Asked, Me),
        loop(Me),
        ( forget(Watch),
          message_queue_destroy(Queue) )).

%   Processes that are gone are last, since their hosts get the clock of others.

begin(Asked, Me) :-
    partition(has_answered, Asked, There, Gone),
    forall(member(One, There), begin_one(One, Me)),
    forall(member(One, Gone), begin_one(One, Me)).

has_answered(asked(_, _, watching(_, _, _))).

begin_one(Asked, Me) :-
    Me = me(Watch, _, _),
    place_begin(Watch, Asked, Events),
    call_on_all(Events, Me).

forget(Watch) :-
    retractall(watch(Watch, _)),
    places_forget(Watch).

loop(Me) :-
    next(Me, Message),
    (   Message = end(Done)
    ->  end(Me),
        thread_send_message(Done, done)
    ;   handle_message(Message, Me),
        wanted(Me)
    ->  loop(Me)
    ;   unwatch_all(Me)
    ).

next(me(Watch, Queue, _), Message) :-
    findall(Again, place_due(Watch, _, Again), Agains),
    (   Agains == []
    ->  thread_get_message(Queue, Message)
    ;   min_list(Agains, Deadline),
        (   wait_before(Deadline, thread_get_message(Queue, Message0))
        ->  Message = Message0
        ;   Message = due
        )
    ).

wanted(me(Watch, _, _)) :-
    watch(Watch, _).

handle_message(events(Peer, Events, ReplyTo), Me) =>
    request_more(ReplyTo),
    forall(( sends(Peer, Me), member(Event, Events), wanted(Me) ),
           handle_event(Event, Peer, Me)).
handle_message(connection(Peer, down), _), endpoint_address(Peer) =>
    true.                               % this process itself
handle_message(connection(Peer, down), Me) =>
    request_again(Peer, up, Me).
handle_message(connection(Peer, up), Me) =>
    request_again(Peer, down(_, _), Me).
handle_message(due, Me) =>
    Me = me(Watch, _, _),
    monotonic_time(Now),
    forall(( place_due(Watch, Endpoint, Again), Again =< Now ),
           request_watch(Endpoint, Me)).
handle_message(asked(Endpoint, Result), Me) =>
    Me = me(Watch, _, _),
    place_answered(Watch, Endpoint, Result, Events),
    call_on_all(Events, Me).
handle_message(_, _) =>                 % over, ended(_)
    true.

%   sends(+Peer, +Me) is semidet: the process at Peer has watched hosts. Events of
%   a restarted process may come before its answer.

sends(Peer, me(Watch, _, _)) :-
    (   endpoint_address(Peer)
    ;   place_at(Watch, Peer, _, _)
    ;   place_at(Watch, _, _, Peer)
    ),
    !.

request_again(Peer, State, Me) :-
    Me = me(Watch, _, _),
    forall(place_at(Watch, Peer, State, Endpoint),
           request_watch(Endpoint, Me)).

request_watch(Endpoint, me(Watch, Queue, _)) :-
    place_cut(Watch, Endpoint, Wanted),
    endpoint_request(Endpoint, watch, watch(Watch, Wanted),
                     typhon_watch_receiver:put_answer(Queue, asked, Endpoint)).

:- public put_answer/4.

put_answer(Queue, What, Endpoint, Result) :-
    Message =.. [What, Endpoint, Result],
    ignore(fifo_send(Queue, Message)).  % the watch may have ended

request_more(peer(ReplyTo)) :-
    endpoint_reply(ReplyTo, more).
request_more(here(OnAnswer)) :-
    call(OnAnswer, answer(more)).

%   The answer to a request lists the running hosts, of which the event
%   `started` may follow: it is reported once.

handle_event(event(Time, Host, none, started(Clock)), Peer, Me) =>
    Me = me(Watch, _, _),
    (   place_started(Watch, Peer, Host, Clock)
    ->  call_on(event(Time, Host, none, started), Me)
    ;   true
    ).
handle_event(event(Time, Host, none, stopped), _, Me) =>
    Me = me(Watch, _, _),
    place_stopped(Watch, Host),
    call_on(event(Time, Host, none, stopped), Me).
handle_event(Event, _, Me) =>
    call_on(Event, Me).

call_on_all(Events, Me) :-
    forall(( member(Event, Events), wanted(Me) ), call_on(Event, Me)).

call_on(Event, me(Watch, _, OnEvent)) :-
    (   catch(call(OnEvent, Event), Ball, report_raised(Ball, Watch))
    ->  true
    ;   true
    ).

%   An abort ends the thread.

report_raised(Ball, _) :-
    is_abort(Ball),
    !,
    throw(Ball).
report_raised(Ball, Watch) :-
    (   nb_current(typhon_watch_warned, true)
    ->  true
    ;   nb_setval(typhon_watch_warned, true),
        print_message(warning, typhon(watch_raised(Watch, Ball)))
    ).

%   A place sends all its events before it answers `ended`, so all events have
%   been delivered when the last place has answered.

end(Me) :-
    unwatch_all(Me),
    Me = me(Watch, _, _),
    findall(Endpoint, sender_at(Watch, Endpoint), Endpoints),
    await_ends(Endpoints, Me).

sender_at(Watch, Endpoint) :-
    place_at(Watch, _, State, Endpoint),
    State \= down(_, _).

await_ends([], _) :-
    !.
await_ends(Endpoints, Me) :-
    wanted(Me),
    !,
    Me = me(_, Queue, _),
    thread_get_message(Queue, Message),
    (   Message = ended(Endpoint, _)
    ->  delete(Endpoints, Endpoint, Others),
        await_ends(Others, Me)
    ;   Message = events(_, _, _)
    ->  handle_message(Message, Me),
        await_ends(Endpoints, Me)
    ;   await_ends(Endpoints, Me)
    ).
await_ends(_, _).                       % the time is over

unwatch_all(me(Watch, Queue, _)) :-
    forall(sender_at(Watch, Endpoint),
           endpoint_request(Endpoint, watch, unwatch(Watch),
                            typhon_watch_receiver:put_answer(Queue, ended,
                                                             Endpoint))).

prolog:message(typhon(watch_raised(Watch, Ball))) -->
    [ 'The goal of ~w raises an exception; the watch goes on: '-[Watch] ],
    error_lines(Ball).
