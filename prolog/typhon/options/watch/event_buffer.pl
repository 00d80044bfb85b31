:- module(typhon_event_buffer,
          [ basin_open/3,               % +Most, +Bell, -Basin
            basin_close/1,              % +Basin
            basin_put/3,                % +Basin, +Host, +Event
            basin_awaited/1,            % +Basin
            basin_size/2,               % +Basin, ?Size
            basin_take/4                % +Basin, +Most, -Events, -Skipped
          ]).
:- use_module(library(lists), [member/2]).

/** <module> Where events gather until they are sent

Adding an event never waits: of events that do not fit, the number is kept
by host.

To wake a thread costs as much as the rest of an event.  So the bell rings
only for a teller that waits, and once.

*Threading*: any thread puts, one takes.
*/

:- dynamic skipped/3.           % Queue, Host, Count

%!  basin_open(+Most, +Bell, -Basin) is det.
%!  basin_close(+Basin) is det.
%
%   Basin holds Most events; the queue Bell hears `some`.

basin_open(Most, Bell, basin(Queue, Flag, Most, Bell)) :-
    flag(typhon_event_buffer, N, N+1),
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
    ;   with_mutex(typhon_event_buffer, skip(Queue, Host))
    ).

skip(Queue, Host) :-
    (   retract(skipped(Queue, Host, Count0))
    ->  Count is Count0+1
    ;   Count = 1
    ),
    assertz(skipped(Queue, Host, Count)).

%!  basin_awaited(+Basin) is det.
%
%   The bell shall ring.  It does at once if there is something.

basin_awaited(basin(Queue, Flag, _, Bell)) :-
    set_flag(Flag, 1),
    message_queue_property(Queue, size(Size)),
    (   Size > 0
    ->  set_flag(Flag, 0),
        thread_send_message(Bell, some)
    ;   true
    ).

%!  basin_size(+Basin, ?Size) is semidet.

basin_size(basin(Queue, _, _, _), Size) :-
    message_queue_property(Queue, size(Size0)),
    Size = Size0.

%!  basin_take(+Basin, +Most, -Events:list, -Skipped:list) is det.
%
%   The first Events, Most at the most.  Skipped are pairs Host-Count of what
%   did not fit since this was last asked.

basin_take(basin(Queue, _, _, _), Most, Events, Skipped) :-
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
