:- module(typhon_teller,
          [ teller_run/1,               % +To
            teller_ring/2,              % +Bell, +Message
            time_at/2,                  % +Clock, -Time
            basin_open/3,               % +Most, +Bell, -Basin
            basin_close/1,              % +Basin
            basin_put/3                 % +Basin, +Host, +Event
          ]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_reply/2,
                endpoint_request/4 ]).
:- use_module('../../kernel/host', [time_now/1]).

/** <module> The thread that sends events to a watch

Events gather in a buffer, to which adding never waits: of events that do not
fit, the number is kept by host.  The teller sends what has gathered in batches,
and the next batch when the last has been accepted.  So a watch lags by as much
as it is slow, the buffer overflows if it is too slow, and hosts never wait.

The teller receives in its queue, the bell, `some` when there are events;
end(ReplyTo) when all that is left is to be sent; and now(Message), which it
handles also while it waits for an answer: `check`, whether the watch is still
there, and the answer.  To wake a thread costs as much as the rest of an event,
so the bell rings only for a teller that waits, and once.

*Threading*: a thread for each watch takes events; any thread adds them.
*/

:- multifile
    taken_here/3.               % Id, Events, OnAnswer

:- setting(typhon_telling:delay, number, 0.05,
           "Events gather for so many seconds before they are sent").
:- setting(typhon_telling:patience, number, 30,
           "A process that watches and is cut off has so long to answer").

batch(1000).
plenty(256).                    % is sent without delay

%!  teller_run(+To) is det.
%
%   To is to(Peer, Id, Bell, Basin): returns when the watch has ended, or
%   all has been sent.

teller_run(To) :-
    idle(To).

%!  teller_ring(+Bell, +Message) is det.

teller_ring(Bell, Message) :-
    catch(thread_send_message(Bell, Message),
          error(existence_error(_, _), _),
          true).                        % it has ended

%!  time_at(+Clock, -Time) is det.
%
%   Time is what a clock(Epoch, Rate) shows now.

time_at(clock(Epoch, Rate), Time) :-
    time_now(Now),
    Time is (Now-Epoch)*Rate.

idle(To) :-
    To = to(_, _, Bell, Basin),
    basin_awaited(Basin),
    thread_get_message(Bell, Message),
    heard(Message, To, gather(To)).

gather(To) :-
    To = to(_, _, Bell, _),
    setting(typhon_telling:delay, Seconds),
    (   thread_get_message(Bell, Message, [timeout(Seconds)])
    ->  heard(Message, To, gather(To))
    ;   pour(To)
    ).

%   heard(+Message, +To, :Next)

heard(some, _, Next) :-
    call(Next).
heard(now(check), To, Next) :-
    !,
    (   is_there(To)
    ->  call(Next)
    ;   true
    ).
heard(now(answered(_)), _, Next) :-
    call(Next).
heard(end(ReplyTo), To, _) :-
    pour_out(To),
    (   ReplyTo == none
    ->  true
    ;   endpoint_reply(ReplyTo, ended)
    ).

is_there(to(Peer, Id, _, _)) :-
    setting(typhon_telling:patience, Seconds),
    catch(endpoint_call(Peer, watched, alive(Id), answer(Answer), Seconds),
          error(_, _), fail),
    Answer == yes.

pour(To) :-
    To = to(_, _, _, Basin),
    (   send(To)
    ->  (   basin_size(Basin, Size),
            plenty(Plenty),
            Size >= Plenty
        ->  pour(To)
        ;   idle(To)
        )
    ;   true                            % the watch has ended
    ).

pour_out(To) :-
    To = to(_, _, _, Basin),
    (   basin_size(Basin, 0)
    ->  true
    ;   send(To)
    ->  pour_out(To)
    ;   true
    ).

%   send(+To) is semidet: the next batch has reached the watch.
%   What is too long for a frame, or cannot travel, is halved, and a single
%   event skipped.

send(To) :-
    To = to(_, _, _, Basin),
    batch(Most),
    basin_take(Basin, Most, Events0, Skipped),
    findall(Event, ( member(Lost, Skipped), skip_event(Lost, Event) ), More),
    append(Events0, More, Events),
    hand_over(Events, To).

hand_over(Events, To) :-
    To = to(Peer, Id, Bell, _),
    catch(( give(Peer, Id, Events, Bell),
            Given = true ),
          error(Formal, _),
          Given = Formal),
    handed_over(Given, Events, To).

handed_over(true, _, To) =>
    await(To, answer(more)).
handed_over(resource_error(_), Events, To) =>
    hand_over_parts(Events, To).
handed_over(type_error(_, _), Events, To) =>
    hand_over_parts(Events, To).
handed_over(_, _, _) =>                 % there is no endpoint any more
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

%   Within this process nothing has to be sent.

give(Peer, Id, Events, Bell) :-
    endpoint_address(Peer),
    !,
    OnAnswer = typhon_teller:answered(Bell),
    (   taken_here(Id, Events, OnAnswer)
    ->  true
    ;   call(OnAnswer, answer(no))
    ).
give(Peer, Id, Events, Bell) :-
    endpoint_request(Peer, watched, events(Id, Events),
                     typhon_teller:answered(Bell)).

skip_event((Address-Clock)-Count,
           event(Time, Address, none, skipped(Count))) :-
    time_at(Clock, Time).

:- public answered/2.

answered(Bell, Result) :-
    teller_ring(Bell, now(answered(Result))).

await(To, Answer) :-
    To = to(_, _, Bell, _),
    thread_get_message(Bell, now(Message)),
    (   Message = answered(Answer0)
    ->  Answer = Answer0
    ;   is_there(To),
        await(To, Answer)
    ).

                /*******************************
                *       EVENTS THAT WAIT       *
                *******************************/

:- dynamic skipped/3.           % Queue, Host, Count

%!  basin_open(+Most, +Bell, -Basin) is det.
%!  basin_close(+Basin) is det.
%
%   Basin holds Most events; the queue Bell hears `some`.

basin_open(Most, Bell, basin(Queue, Flag, Most, Bell)) :-
    flag(typhon_basin, N, N+1),
    atom_concat(typhon_basin_, N, Flag),
    message_queue_create(Queue).

basin_close(basin(Queue, _, _, _)) :-
    message_queue_destroy(Queue),
    retractall(skipped(Queue, _, _)).

%!  basin_put(+Basin, +Host, +Event) is det.
%
%   @error existence_error(message_queue, Queue) if it has been closed

basin_put(basin(Queue, Flag, Most, Bell), Host, Event) :-
    message_queue_property(Queue, size(Size)),
    (   Size < Most
    ->  thread_send_message(Queue, Event),
        get_flag(Flag, Awaited),
        (   Awaited == 1
        ->  set_flag(Flag, 0),
            thread_send_message(Bell, some)
        ;   true
        )
    ;   with_mutex(typhon_basin, skip(Queue, Host))
    ).

skip(Queue, Host) :-
    (   retract(skipped(Queue, Host, Count0))
    ->  Count is Count0+1
    ;   Count = 1
    ),
    assertz(skipped(Queue, Host, Count)).

%   The bell rings for the next event, at once if there is one.

basin_awaited(basin(Queue, Flag, _, Bell)) :-
    set_flag(Flag, 1),
    message_queue_property(Queue, size(Size)),
    (   Size > 0
    ->  set_flag(Flag, 0),
        thread_send_message(Bell, some)
    ;   true
    ).

basin_size(basin(Queue, _, _, _), Size) :-
    message_queue_property(Queue, size(Size0)),
    Size = Size0.

%   basin_take(+Basin, +Most, -Events, -Skipped): the first events, Most at the
%   most.  Skipped are pairs Host-Count of what
%   did not fit since the last call.

basin_take(basin(Queue, _, _, _), Most, Events, Skipped) :-
    take(Most, Queue, Events),
    (   skipped(Queue, _, _)
    ->  with_mutex(typhon_basin, all_skipped(Queue, Skipped))
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
