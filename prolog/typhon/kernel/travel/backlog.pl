:- module(typhon_backlog,
          [ backlog/1,                  % +Id
            backlog_add/2,              % +Id, +Letter
            backlog_begin/3,            % +Id, -Letters, -Tries
            backlog_again/3,            % +Id, +Letters, +Tries
            backlog_done/1,             % +Id
            backlog_all/2,              % +Id, -Letters
            backlog_leaves/1,           % +Id
            post_tried/0
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../base/fifo', [fifo_empty/2]).
:- use_module('../base/durable', [durable/6]).
:- use_module('../base/durable_changes',
              [durable_drop_all/2, durable_number/1, durable_put/4]).

/** <module> Mail that waits for a way to its agent

Letters that cannot be passed on for the moment wait here, in order, and
what comes later for the same agent waits behind them.  While they are being
tried they are with whoever tries; there is one at a time.

*Threading*: inside with_agent/2 of the agent.
*/

:- multifile
    typhon_runtime:ending/1.

:- dynamic waits/4.             % Id, Queue, Tries, State: idle or tried

%!  backlog(+Id) is semidet.
%
%   Letters for Id wait.

backlog(Id) :-
    waits(Id, _, _, _),
    !.

%!  backlog_add(+Id, +Letter) is det.

backlog_add(Id, Letter) :-
    durable_number(N),
    durable_put(wait, Id, N, Letter),
    add(Id, Letter).

%   A journal has them one by one; a saved network has those of an agent
%   together.

:- durable(wait, Id, _, Letter, letter_item(Id, Letter), add(Id, Letter)).
:- durable(backlog, Id, Tries, Letters, backlog_item(Id, Tries, Letters),
           backlog_restore(Id, Tries, Letters)).

letter_item(Id, Letter) :-
    backlog_item(Id, _, Letters),
    member(Letter, Letters).

%   No thread tries them now.

backlog_item(Id, Tries, Letters) :-
    waits(Id, Queue, Tries, _),
    fifo_empty(Queue, Letters),
    maplist(thread_send_message(Queue), Letters).

backlog_restore(Id, Tries, Letters) :-
    message_queue_create(Queue),
    maplist(thread_send_message(Queue), Letters),
    assertz(waits(Id, Queue, Tries, idle)).

add(Id, Letter) :-
    (   waits(Id, Queue, _, _)
    ->  true
    ;   message_queue_create(Queue),
        assertz(waits(Id, Queue, 0, idle))
    ),
    thread_send_message(Queue, Letter).

%!  backlog_begin(+Id, -Letters:list, -Tries) is semidet.
%!  backlog_again(+Id, +Letters:list, +Tries) is det.
%!  backlog_done(+Id) is semidet.
%
%   All letters are taken out to be tried, which was done in vain Tries times
%   before; they are put back, in front of what came meanwhile; or they have
%   found their way.  The last fails if other letters wait now.

backlog_begin(Id, Letters, Tries) :-
    retract(waits(Id, Queue, Tries, idle)),
    !,
    fifo_empty(Queue, Letters),
    assertz(waits(Id, Queue, Tries, tried)).

backlog_again(Id, Letters, Tries) :-
    retract(waits(Id, Queue, _, tried)),
    !,
    fifo_empty(Queue, Newer),
    append(Letters, Newer, All),
    durable_drop_all(wait, Id),
    maplist(note_letter(Id), All),
    maplist(thread_send_message(Queue), All),
    assertz(waits(Id, Queue, Tries, idle)).

note_letter(Id, Letter) :-
    durable_number(N),
    durable_put(wait, Id, N, Letter).

backlog_done(Id) :-
    retract(waits(Id, Queue, _, tried)),
    !,
    (   thread_peek_message(Queue, _)
    ->  assertz(waits(Id, Queue, 0, idle)),
        fail
    ;   message_queue_destroy(Queue)
    ).

%!  post_tried is semidet.
%
%   A thread has messages in hand.

post_tried :-
    waits(_, _, _, tried),
    !.

%!  backlog_leaves(+Id) is det.
%
%   The letters that are being tried are about to leave, to be noted elsewhere;
%   what has come meanwhile stays.

backlog_leaves(Id) :-
    durable_drop_all(wait, Id),
    (   waits(Id, Queue, _, tried)
    ->  fifo_empty(Queue, Newer),
        maplist(note_letter(Id), Newer),
        maplist(thread_send_message(Queue), Newer)
    ;   true
    ).

%!  backlog_all(+Id, -Letters:list) is det.
%
%   The letters for Id, which has arrived.  Those that are being tried just
%   now find it by themselves.

backlog_all(Id, Letters) :-
    (   retract(waits(Id, Queue, _, idle))
    ->  fifo_empty(Queue, Letters),
        durable_drop_all(wait, Id),
        message_queue_destroy(Queue)
    ;   Letters = []
    ).

%   No thread is left to try them.

typhon_runtime:ending(after) :-
    retract(waits(_, Queue, _, _)),
    message_queue_destroy(Queue),
    fail.
