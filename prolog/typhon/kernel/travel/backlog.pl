:- module(typhon_backlog,
          [ backlog/1,                  % +Id
            backlog_add/2,              % +Id, +Letter
            backlog_all/2,              % +Id, -Letters
            retry_later/3,              % +Id, +Letter, +Way
            retries_go_on/0,
            post_tried/0
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/fifo', [fifo_empty/2]).
:- use_module('../base/durable', [durable/6]).
:- use_module('../base/durable_changes',
              [ durable_drop_all/2, durable_number/1, durable_put/4,
                enqueue_changes/0, unit_of_work/1 ]).
:- use_module('../wire', [endpoint_gone/1, endpoint_peer/2]).
:- use_module('../host', [alarm_in/3, scheduler_call/1]).
:- use_module('../agent', [with_agent/2]).
:- use_module(whereabouts, [agent_outcome/2]).
:- use_module(routing,
              [mail_lost/3, one_letter/2, way_in/2, way_out/3, way_send/3]).

/** <module> Letters that wait for another attempt

A letter that cannot be sent now waits here, and later letters for the same
agent wait behind it, in order.  They are tried again as long as the next
process may be alive, and a while longer, since the news that the agent has left
that process may be under way.  While they are tried, a worker holds them; at
most one worker for each agent.

*Threading*: inside with_agent/2 of the agent, except retries_go_on/0 and
post_tried/0.
*/

:- multifile
    typhon_durable:go_on/0,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- setting(messages, positive_integer, 100 000,
           "Messages that wait, in all, for agents that cannot be reached now").

:- dynamic waits/4.             % Id, Queue, Tries, State: idle or tried

                /*******************************
                *            LETTERS           *
                *******************************/

%!  backlog(+Id) is semidet.
%
%   There are letters that wait for Id.

backlog(Id) :-
    waits(Id, _, _, _),
    !.

%!  backlog_add(+Id, +Letter) is det.
%
%   Add Letter to the backlog of Id.  If as many messages wait as the setting
%   `messages` allows, they are lost.

backlog_add(Id, Letter) :-
    (   has_space(Letter)
    ->  durable_number(N),
        durable_put(wait, Id, N, Letter),
        add(Id, Letter)
    ;   Letter = letter(Mail, _),
        mail_lost(resource_error(backlog), Id, Mail)
    ).

has_space(Letter) :-
    setting(messages, Most),
    flag(typhon_backlog, Count, Count),
    messages([Letter], More),
    Count+More =< Most.

%   put(+Queue, +Letter), emptied(+Queue, -Letters:list): the flag has the
%   number of messages in all queues.

put(Queue, Letter) :-
    counted([Letter], 1),
    thread_send_message(Queue, Letter).

emptied(Queue, Letters) :-
    fifo_empty(Queue, Letters),
    counted(Letters, -1).

counted(Letters, Sign) :-
    messages(Letters, Count),
    flag(typhon_backlog, All, All+Sign*Count).

messages(Letters, Count) :-
    aggregate_all(sum(N), ( member(letter(Mail, _), Letters), length(Mail, N) ),
                  Count).

%   A journal has letters one by one; a saved network has all letters of an
%   agent as one item.

:- durable(wait, Id, _, Letter, letter_item(Id, Letter), add(Id, Letter)).
:- durable(backlog, Id, Tries, Letters, backlog_item(Id, Tries, Letters),
           backlog_restore(Id, Tries, Letters)).

letter_item(Id, Letter) :-
    backlog_item(Id, _, Letters),
    member(Letter, Letters).

%   Called while no thread tries letters: the queue is emptied and filled again.

backlog_item(Id, Tries, Letters) :-
    waits(Id, Queue, Tries, _),
    emptied(Queue, Letters),
    maplist(put(Queue), Letters).

backlog_restore(Id, Tries, Letters) :-
    message_queue_create(Queue),
    maplist(put(Queue), Letters),
    assertz(waits(Id, Queue, Tries, idle)).

add(Id, Letter) :-
    (   waits(Id, Queue, _, _)
    ->  true
    ;   message_queue_create(Queue),
        assertz(waits(Id, Queue, 0, idle))
    ),
    put(Queue, Letter).

%   backlog_begin(+Id, -Letters:list, -Tries) is semidet.
%
%   Take out all letters to try them; Tries attempts have failed before.

backlog_begin(Id, Letters, Tries) :-
    retract(waits(Id, Queue, Tries, idle)),
    !,
    emptied(Queue, Letters),
    assertz(waits(Id, Queue, Tries, tried)).

%   backlog_again(+Id, +Letters:list, +Tries) is det.
%
%   Put Letters back, before those that have come meanwhile.

backlog_again(Id, Letters, Tries) :-
    retract(waits(Id, Queue, _, tried)),
    !,
    emptied(Queue, Newer),
    append(Letters, Newer, All),
    durable_drop_all(wait, Id),
    maplist(note_letter(Id), All),
    maplist(put(Queue), All),
    assertz(waits(Id, Queue, Tries, idle)).

note_letter(Id, Letter) :-
    durable_number(N),
    durable_put(wait, Id, N, Letter).

%   backlog_done(+Id) is semidet.
%
%   The letters that were taken out have been sent.  Fails if others wait now.

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
%   A thread is trying letters.

post_tried :-
    waits(_, _, _, tried),
    !.

%   backlog_leaves(+Id) is det.
%
%   Drop from the journal the letters that are being tried, which will be noted
%   elsewhere; those that have come meanwhile stay.

backlog_leaves(Id) :-
    durable_drop_all(wait, Id),
    (   waits(Id, Queue, _, tried)
    ->  emptied(Queue, Newer),
        maplist(note_letter(Id), Newer),
        maplist(put(Queue), Newer)
    ;   true
    ).

%!  backlog_all(+Id, -Letters:list) is det.
%
%   Take the letters for Id, which has arrived.  A thread that is trying letters
%   finds the agent by itself.

backlog_all(Id, Letters) :-
    (   retract(waits(Id, Queue, _, idle))
    ->  emptied(Queue, Letters),
        durable_drop_all(wait, Id),
        message_queue_destroy(Queue)
    ;   Letters = []
    ).

%   The scheduler has stopped, so no thread can try them.

typhon_runtime:ending(after) :-
    retract(waits(_, Queue, _, _)),
    emptied(Queue, _),
    message_queue_destroy(Queue),
    fail.

                /*******************************
                *             TRIES            *
                *******************************/

%   The pause before the next attempt.  A process is presumed gone after
%   most_tries/1 attempts.

pause(Tries, Seconds) :-
    Seconds is min(2.0, 0.05*2**min(Tries, 10)).

most_tries(6).

%   The end of a process that was never connected is not reported.  A letter for
%   it waits as long as news for an unreachable home.

unknown_tries(Tries) :-
    most_tries(Least),
    pause(Least, Pause),
    setting(typhon_news:news_seconds, Seconds),
    Tries is max(Least, ceiling(Seconds/Pause)).

%!  retry_later(+Id, +Letter, +Way) is det.
%
%   Keep Letter, and try it later; Way, see way_out/3, is the reason.  Inside
%   with_agent/2.

retry_later(Id, _, wait(Letter)) :-
    !,
    backlog_add(Id, Letter),
    try_later(Id, 0).
retry_later(Id, _, to(_, Letter)) :-
    !,
    backlog_add(Id, Letter),
    scheduler_call(try(Id)).
retry_later(Id, letter(Mail, _), nowhere) :-
    agent_outcome(Id, _),
    !,
    mail_lost(existence_error(agent, Id), Id, Mail).
retry_later(Id, Letter, nowhere) :-
    backlog_add(Id, Letter),
    try_later(Id, 0).

try_later(Id, Tries) :-
    pause(Tries, Seconds),
    debug(typhon(mail), '~w: a letter waits ~3f seconds', [Id, Seconds]),
    alarm_in(Seconds, Id, mail).

typhon_scheduler:fire(Id, mail) :-
    !,
    scheduler_call(try(Id)).

typhon_scheduler:over(Id, mail) :-
    \+ backlog(Id).

typhon_durable:go_on :-
    retries_go_on.

%!  retries_go_on is det.
%
%   Soon try all letters that wait.

retries_go_on :-
    forall(backlog(Id), try_later(Id, 0)).

%   try(+Id): try the letters for Id; in a worker.

try(Id) :-
    (   with_agent(Id, backlog_begin(Id, Letters, Tries))
    ->  one_letter(Letters, Letter),
        unit_of_work(tried(Id, Letter, Tries))
    ;   true
    ).

%   One with_agent/2 makes one journal entry of two changes: the letter leaves
%   the backlog, and it has a new place.  This entry must precede the entries of
%   other threads about the backlog.

tried(Id, Letter, Tries) :-
    with_agent(Id, ( catch(leave_backlog(Id, Letter, Way), error(Formal, _),
                           Way = failed(Formal)),
                     (   Way = to(_, _)
                     ->  true
                     ;   conclude(Way, Id, Letter, Tries),
                         enqueue_changes
                     ) )),
    send_connecting(Way, Id, Letter, Tries).

leave_backlog(Id, Letter, Way) :-
    backlog_leaves(Id),
    step(Id, Letter, Way).

%   The letter needs a new connection; nothing is noted before it is sent.

send_connecting(to(Endpoint, Letter1), Id, Letter, Tries) :-
    !,
    catch(( way_send(Endpoint, Id, Letter1), Way = done ), error(Formal, _),
          Way = failed(Formal)),
    with_agent(Id, conclude(Way, Id, Letter, Tries)).
send_connecting(_, _, _, _).

step(Id, letter(Mail, _), done) :-
    way_in(Id, Mail),
    !.
step(Id, Letter, Way) :-
    way_out(Id, Letter, Way).

conclude(done, Id, _, _) :-
    (   backlog_done(Id)
    ->  true
    ;   scheduler_call(try(Id))
    ).
conclude(wait(Letter), Id, _, _) :-
    backlog_again(Id, [Letter], 0),
    try_later(Id, 0).
conclude(nowhere, Id, Letter, Tries) :-
    attempt_failed(Id, Letter, Tries, existence_error(agent, Id)).
conclude(failed(Formal), Id, Letter, Tries) :-
    attempt_failed(Id, Letter, Tries, Formal).

attempt_failed(Id, letter(Mail, _), Tries, Formal) :-
    is_hopeless(Formal, Id, Tries),
    !,
    mail_lost(Formal, Id, Mail),
    conclude(done, Id, _, 0).
attempt_failed(Id, Letter, Tries, _) :-
    Tries1 is Tries+1,
    backlog_again(Id, [Letter], Tries1),
    try_later(Id, Tries1).

is_hopeless(existence_error(agent, Id), Id, Tries) :-
    (   agent_outcome(Id, _)
    ->  true
    ;   most_tries(Most),
        Tries >= Most
    ).
is_hopeless(host_unreachable(Endpoint), _, Tries) :-
    endpoint_gone(Endpoint),
    most_tries(Most),
    Tries >= Most.
is_hopeless(host_unreachable(Endpoint), _, Tries) :-
    \+ endpoint_peer(Endpoint, process(_)),
    unknown_tries(Most),
    Tries >= Most.
is_hopeless(resource_error(frame_bytes), _, _).
is_hopeless(existence_error(endpoint, _), _, _).   % this process ends
