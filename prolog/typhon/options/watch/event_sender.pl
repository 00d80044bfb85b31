:- module(typhon_event_sender,
          [ sender_run/1,               % +To
            sender_signal/2,              % +Signals, +Message
            time_at/2,                  % +Clock, -Time
            buffer_open/3,               % +Most, +Signals, -Buffer
            buffer_close/1,              % +Buffer
            buffer_put/3                 % +Buffer, +Host, +Event
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/fifo', [fifo_send/2]).
:- use_module('../../kernel/base/monotonic', [wait_within/2]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_reply/2,
                endpoint_request/4 ]).
:- use_module('../../kernel/host', [time_now/1]).

/** <module> The thread that sends events to a watch

Events gather in a buffer, and adding an event never waits: events that do not
fit are only counted, by host.  The sender sends the gathered events in batches,
each after the previous one has been accepted.  So a slow watch lags, the buffer
overflows if it is too slow, and hosts never wait for it.

The queue Signals of the sender receives `some` when there are events;
end(ReplyTo) to send all remaining events and end; and now(Message), which the
sender also handles while it waits for an answer: `check`, whether the watch
still exists, or answered(Result).  Waking a thread costs as much as everything
else for an event, so a sender that waits gets one `some`, and others get none.

*Threading*: for each watch one thread takes events; any thread adds them.
*/

:- multifile
    deliver_here/3.             % Id, Events, OnAnswer

:- setting(delay, number, 0.05,
           "Seconds for which events gather before they are sent").
:- setting(patience, number, 30,
           "Seconds that a disconnected watching process has to answer").

batch(1000).
many_events(256).               % so many events are sent without delay

%!  sender_run(+To) is det.
%
%   Send the events in Buffer to the watch Id of the process Peer, To being
%   to(Peer, Id, Signals, Buffer).  Returns when the watch has ended, or when
%   all events have been sent after end(ReplyTo).

sender_run(To) :-
    To = to(_, _, Signals, Buffer),
    buffer_awaited(Buffer),
    thread_get_message(Signals, Message),
    handle_message(Message, To, gather(To)).

%!  sender_signal(+Signals, +Message) is det.
%
%   Put Message into the queue Signals of a sender, if it still exists.

sender_signal(Signals, Message) :-
    ignore(fifo_send(Signals, Message)). % the sender may have ended

%!  time_at(+Clock, -Time) is det.

time_at(clock(Epoch, Rate), Time) :-
    time_now(Now),
    Time is (Now-Epoch)*Rate.

gather(To) :-
    To = to(_, _, Signals, _),
    setting(delay, Seconds),
    (   wait_within(Seconds, thread_get_message(Signals, Message))
    ->  handle_message(Message, To, gather(To))
    ;   send_batches(To)
    ).

%   handle_message(+Message, +To, :Next): continue with Next, unless the watch
%   has ended.

handle_message(some, _, Next) :-
    call(Next).
handle_message(now(check), To, Next) :-
    !,
    (   is_there(To)
    ->  call(Next)
    ;   true
    ).
handle_message(now(answered(_)), _, Next) :-
    call(Next).
handle_message(end(ReplyTo), To, _) :-
    send_rest(To),
    (   ReplyTo == none
    ->  true
    ;   endpoint_reply(ReplyTo, ended)
    ).

is_there(to(Peer, Id, _, _)) :-
    setting(patience, Seconds),
    catch(endpoint_call(Peer, watched, alive(Id), answer(Answer), Seconds),
          error(Formal, _), \+ is_gone(Formal)),
    ( nonvar(Formal) -> true ; Answer == yes ).

%   Any other error, such as that of a journal, does not end the watch.

is_gone(unreachable(_)).
is_gone(connection_lost(_)).
is_gone(timeout_error(_, _)).
is_gone(existence_error(_, _)).

send_batches(To) :-
    To = to(_, _, _, Buffer),
    (   send(To)
    ->  (   buffer_size(Buffer, Size),
            many_events(Many),
            Size >= Many
        ->  send_batches(To)
        ;   sender_run(To)
        )
    ;   true                            % the watch has ended
    ).

send_rest(To) :-
    To = to(_, _, _, Buffer),
    (   buffer_size(Buffer, 0)
    ->  true
    ;   send(To)
    ->  send_rest(To)
    ;   true
    ).

%   send(+To) is semidet: send the next batch, and wait until the watch has
%   accepted it; fail if the watch has ended.  A batch that exceeds a frame, or
%   has terms that cannot travel, is halved; a single such event is skipped.

send(To) :-
    To = to(_, _, _, Buffer),
    batch(Most),
    buffer_take(Buffer, Most, Events0, Skipped),
    findall(Event, ( member(Lost, Skipped), skip_event(Lost, Event) ), More),
    append(Events0, More, Events),
    hand_over(Events, To).

hand_over(Events, To) :-
    To = to(Peer, Id, Signals, _),
    catch(( transmit(Peer, Id, Events, Signals),
            Given = true ),
          error(Formal, _),
          Given = Formal),
    handed_over(Given, Events, To).

handed_over(true, _, To) =>
    await(To, answer(more)).
handed_over(resource_error(frame_bytes), Events, To) =>
    hand_over_parts(Events, To).
handed_over(type_error(_, _), Events, To) =>
    hand_over_parts(Events, To).
handed_over(_, _, _) =>                 % the endpoint is closed
    fail.

hand_over_parts([event(Time, Host, _, _)], To) :-
    !,
    hand_over([event(Time, Host, none, skipped(1))], To).
hand_over_parts(Events, To) :-
    length(Events, Length),
    Half is Length//2,
    length(First, Half),
    append(First, Second, Events),
    hand_over(First, To),
    hand_over(Second, To).

%   Within this process events do not cross the wire.

transmit(Peer, Id, Events, Signals) :-
    endpoint_address(Peer),
    !,
    OnAnswer = typhon_event_sender:answered(Signals),
    (   deliver_here(Id, Events, OnAnswer)
    ->  true
    ;   call(OnAnswer, answer(no))
    ).
transmit(Peer, Id, Events, Signals) :-
    endpoint_request(Peer, watched, events(Id, Events),
                     typhon_event_sender:answered(Signals)).

skip_event((Address-Clock)-Count,
           event(Time, Address, none, skipped(Count))) :-
    time_at(Clock, Time).

:- public answered/2.

answered(Signals, Result) :-
    sender_signal(Signals, now(answered(Result))).

await(To, Answer) :-
    To = to(_, _, Signals, _),
    thread_get_message(Signals, now(Message)),
    (   Message = answered(Answer0)
    ->  Answer = Answer0
    ;   is_there(To),
        await(To, Answer)
    ).

                /*******************************
                *            BUFFERS           *
                *******************************/

:- dynamic skipped/3.           % Queue, Host, Count

%!  buffer_open(+Most, +Signals, -Buffer) is det.
%!  buffer_close(+Buffer) is det.
%
%   Buffer holds at most Most events, and reports events to the queue Signals of
%   the sender.  After buffer_close/1 buffer_put/3 raises an error.

buffer_open(Most, Signals, buffer(Queue, Flag, Most, Signals)) :-
    flag(typhon_event_buffer, N, N+1),
    atom_concat(typhon_event_buffer_, N, Flag),
    message_queue_create(Queue).

buffer_close(buffer(Queue, _, _, _)) :-
    message_queue_destroy(Queue),
    retractall(skipped(Queue, _, _)).

%!  buffer_put(+Buffer, +Host, +Event) is det.
%
%   Add Event, of Host, to Buffer, or count it as skipped if Buffer is full.
%
%   @error existence_error(message_queue, Queue) the buffer was closed

buffer_put(buffer(Queue, Flag, Most, Signals), Host, Event) :-
    message_queue_property(Queue, size(Size)),
    (   Size < Most
    ->  thread_send_message(Queue, Event),
        get_flag(Flag, Awaited),
        (   Awaited == 1
        ->  set_flag(Flag, 0),
            thread_send_message(Signals, some)
        ;   true
        )
    ;   with_mutex(typhon_event_buffer, skip(Queue, Host))
    ).

skip(Queue, Host) :-
    (   retract(skipped(Queue, Host, Count0))
    ->  Count is Count0+1
    ;   Count = 1
    ),
    assertz(skipped(Queue, Host, Count)).

%   The sender is about to wait: the next event sends `some`.  An event that was
%   added before the flag was set did not, so the size is checked after it.

buffer_awaited(buffer(Queue, Flag, _, Signals)) :-
    set_flag(Flag, 1),
    message_queue_property(Queue, size(Size)),
    (   Size > 0
    ->  set_flag(Flag, 0),
        thread_send_message(Signals, some)
    ;   true
    ).

buffer_size(buffer(Queue, _, _, _), Size) :-
    message_queue_property(Queue, size(Size0)),
    Size = Size0.

%   buffer_take(+Buffer, +Most, -Events, -Skipped): Events are the first events,
%   at most Most.  Skipped are pairs Host-Count of events that did not fit since
%   the last call.

buffer_take(buffer(Queue, _, _, _), Most, Events, Skipped) :-
    take(Most, Queue, Events),
    (   skipped(Queue, _, _)
    ->  with_mutex(typhon_event_buffer, all_skipped(Queue, Skipped))
    ;   Skipped = []
    ).

take(Most, Queue, Events) :-
    (   Most > 0,
        thread_peek_message(Queue, _)
    ->  thread_get_message(Queue, Event),
        Events = [Event|More],
        Left is Most-1,
        take(Left, Queue, More)
    ;   Events = []
    ).

all_skipped(Queue, Skipped) :-
    findall(Host-Count, skipped(Queue, Host, Count), Skipped),
    forall(member(Host-_, Skipped), retractall(skipped(Queue, Host, _))).
