:- module(typhon_channel, []).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/durable', [durable/5]).
:- use_module('../../kernel/base/durable_changes',
              [ crash_point/1, durable_change/1, durable_drop/3,
                durable_drop_below/3, durable_number/1, durable_on/0,
                durable_putting/5, enqueue_changes/0, output_waits/0 ]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_gone/1, endpoint_post/3,
                endpoint_process/1 ]).
:- use_module('../../kernel/host', [alarm_in/3, scheduler_call/1]).
:- use_module('../../kernel/travel', [post_must_fit/1]).

/** <module> The sending end of durable posts

A process that keeps a journal records a post to another process before it sends
it, and keeps the record until the other process reports that it has received
the post durably.  Until then it sends the post again over each new connection.
The frames, and the receiving end, are described in typhon_durable_posts.

The window of a session, see typhon_unacked, is different: it numbers frames
one by one, keeps bytes in a queue, and ends with the process.  Here the items
of the journal are the window: their numbers have gaps, and an item may be
dropped from the middle.  A frame kept as a fact costs three times as much as a
frame in a queue.

*Threading*: any thread posts, and never waits for a connection; one worker at
a time sends to an endpoint.
*/

:- meta_predicate engaging(+, 0).

:- multifile
    typhon_durable_posts:queued/3,
    typhon_endpoint:connection/2,
    typhon_endpoint:received/3,
    typhon_durable:go_on/0,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    out/4,                      % Endpoint, N, Kind, Term: the oldest first
    had/2,                      % Endpoint, N: all up to N were received
    sent/2,                     % Endpoint, N: all up to N were sent; missing
                                % if sending is to start again
    courier/1.                  % Endpoint: a thread sends

:- setting(channel_seconds, number, 300,
           "Seconds for which posts are kept for a process that has left, and \c
            is not known to keep a journal").

batch(100).
longest_pause(1).               % seconds between attempts

typhon_durable_posts:queued(Endpoint, Kind, Term) :-
    engaging(Endpoint,
             ( durable_number(N),
               durable_putting(out, Endpoint, N, item(Kind, Term), Change),
               post_must_fit(Change),
               durable_change(Change),
               enqueue_changes,
               assertz(out(Endpoint, N, Kind, Term)) )).

%   engaging(+Endpoint, :Goal): Goal changes the posts for Endpoint; then a
%   courier is started unless there is one.  A thread that is ended in between
%   must not leave a courier/1 fact without a courier: all other threads would
%   rely on it.

engaging(Endpoint, Goal) :-
    sig_atomic(( with_mutex(typhon_channel,
                            ( Goal, engage(Endpoint, Courier) )),
                 set_out(Courier, Endpoint) )).

engage(Endpoint, Courier) :-
    (   ( courier(Endpoint) ; \+ out(Endpoint, _, _, _) )
    ->  Courier = there
    ;   assertz(courier(Endpoint)),
        Courier = wanted
    ).

set_out(there, _).
set_out(wanted, Endpoint) :-
    scheduler_call(typhon_channel:carry(Endpoint, try(0, 0.05))).

%   carry(+Endpoint, +Try): runs in a worker until all is sent.  Try is
%   try(Since, Pause): attempts have failed since then, 0 if the last succeeded;
%   Pause is the delay after this attempt.

carry(Endpoint, Try) :-
    with_mutex(typhon_channel, next(Endpoint, Items)),
    (   Items == []
    ->  true
    ;   catch(send_all(Items, Endpoint), error(Formal, _), true),
        (   var(Formal)
        ->  carry(Endpoint, try(0, 0.05))
        ;   not_sent(Formal, Endpoint, Try)
        )
    ).

next(Endpoint, Items) :-
    (   sent(Endpoint, Sent)
    ->  Before0 = Sent
    ;   had_until(Endpoint, Had),
        Sent = Had,
        Before0 = first(Had)
    ),
    batch(Most),
    findnsols(Most, item(N, Kind, Term),
              ( out(Endpoint, N, Kind, Term), N > Sent ), Found),
    !,
    chained(Found, Before0, Items),
    (   Items == []
    ->  retractall(courier(Endpoint))
    ;   Before0 = first(_)
    ->  assertz(sent(Endpoint, Sent))
    ;   true
    ).

had_until(Endpoint, N) :-
    (   had(Endpoint, N0)
    ->  N = N0
    ;   N = -1
    ).

chained([], _, []).
chained([item(N, Kind, Term)|Found], Before,
        [item(Before, N, Kind, Term)|Items]) :-
    chained(Found, N, Items).

%   Posts that were sent over a connection are lost with it.  If sending was
%   started again meanwhile, this post does not count, and the rest is not sent.

send_all([], _).
send_all([item(Before, N, Kind, Term)|Items], Endpoint) :-
    endpoint_process(Process),
    crash_point(before_post),
    endpoint_post(Endpoint, channel,
                  channel(Process, Endpoint, Before, N, Kind, Term)),
    (   with_mutex(typhon_channel, put_sent(Endpoint, Before, N))
    ->  send_all(Items, Endpoint)
    ;   true
    ).

put_sent(Endpoint, Before, N) :-
    ( Before = first(Last) -> true ; Last = Before ),
    retract(sent(Endpoint, Last)),
    !,
    assertz(sent(Endpoint, N)).

not_sent(existence_error(_, _), Endpoint, _) :-
    all_ends,
    !,
    with_mutex(typhon_channel, retractall(courier(Endpoint))).
not_sent(unreachable(_), Endpoint, try(Since, _)) :-
    endpoint_gone(Endpoint),
    Since > 0,
    get_time(Now),
    setting(channel_seconds, Most),
    Now-Since > Most,
    !,
    print_message(silent, typhon(home_unreachable(Endpoint))),
    give_up(Endpoint).
not_sent(resource_error(frame_bytes), Endpoint, _) :-
    !,
    with_mutex(typhon_channel, next_is_dropped(Endpoint, Dropped)),
    say_undelivered(Dropped, Endpoint, resource_error(frame_bytes)),
    carry(Endpoint, try(0, 0.05)).
not_sent(Formal, Endpoint, try(Since0, Pause)) :-
    debug(typhon(mail), 'nothing can be posted to ~w: ~p', [Endpoint, Formal]),
    with_mutex(typhon_channel, retractall(sent(Endpoint, _))),
    longest_pause(Longest),
    Pause1 is min(Longest, 2*Pause),
    get_time(Now),
    (   Since0 =:= 0
    ->  Since = Now
    ;   Since = Since0
    ),
    alarm_in(Pause, Endpoint, channel(try(Since, Pause1))).

%   A post may exceed the limit now though it did not when it was recorded: the
%   codec may need more space, or the limit may be lower.  It must not block
%   others.

next_is_dropped(Endpoint, [Kind-Term]) :-
    sent(Endpoint, Sent),
    out(Endpoint, N, Kind, Term),
    N > Sent,
    !,
    durable_drop(out, Endpoint, N),
    retractall(out(Endpoint, N, _, _)),
    retractall(sent(Endpoint, _)).
next_is_dropped(_, []).                 % sending starts again

typhon_scheduler:fire(Endpoint, channel(Try)) :-
    !,
    scheduler_call(typhon_channel:carry(Endpoint, Try)).

%   This process sends nothing any more.  If another thing does not exist, such
%   as the queue of a connection that breaks, the next attempt uses another.

all_ends :-
    \+ endpoint_address(_),
    !.
all_ends :-
    output_waits,
    \+ durable_on.

%   A process that is gone, and keeps no journal, will not receive the posts.

give_up(Endpoint) :-
    with_mutex(typhon_channel,
               ( findall(Kind-Term, out(Endpoint, _, Kind, Term), Lost),
                 forget_all(Endpoint),
                 retractall(sent(Endpoint, _)),
                 retractall(had(Endpoint, _)),
                 retractall(courier(Endpoint)) )),
    say_undelivered(Lost, Endpoint, host_unreachable(Endpoint)).

forget_all(Endpoint) :-
    (   out(Endpoint, N, _, _)
    ->  N1 is N+1,
        durable_drop_below(out, Endpoint, N1),
        retractall(out(Endpoint, N, _, _)),
        forget_all(Endpoint)
    ;   true
    ).

say_undelivered(Lost, Endpoint, Formal) :-
    forall(member(Kind-Term, Lost),
           ignore(typhon_durable_posts:undelivered(Kind, Term, Endpoint,
                                                   Formal))).

                /*******************************
                *            ANSWERS           *
                *******************************/

typhon_endpoint:received(channel, again(To), _) :-
    begin_anew(To).
typhon_endpoint:received(channel, had(To, N), _) :-
    must_be(integer, N),
    with_mutex(typhon_channel, has_come(To, N)).

begin_anew(To) :-
    engaging(To, retractall(sent(To, _))).

has_come(To, N) :-
    retractall(had(To, _)),
    assertz(had(To, N)),
    come(To, N),
    N1 is N+1,
    durable_drop_below(out, To, N1).

come(To, N) :-
    (   out(To, N0, _, _),
        !,
        N0 =< N
    ->  retract(out(To, N0, _, _)),
        !,
        come(To, N)
    ;   true
    ).

                /*******************************
                *        BREAKS AND ENDS       *
                *******************************/

%   The previous connection may have broken, or the peer may have died.

typhon_endpoint:connection(Endpoint, up) :-
    (   endpoint_address(Endpoint)
    ->  true
    ;   begin_anew(Endpoint)
    ).

:- durable(out, Endpoint, N, item(Kind, Term), out(Endpoint, N, Kind, Term)).

typhon_durable:go_on :-
    findall(Endpoint, out(Endpoint, _, _, _), All),
    sort(All, Endpoints),
    forall(member(Endpoint, Endpoints), begin_anew(Endpoint)).

typhon_runtime:ending(after) :-
    retractall(out(_, _, _, _)),
    retractall(had(_, _)),
    retractall(sent(_, _)),
    retractall(courier(_)).
