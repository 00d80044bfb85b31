:- module(typhon_channel, []).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/base/durable',
              [ crash_point/1, durable/5, durable_closed/0, durable_drop/3,
                durable_drop_below/3, durable_number/1, durable_put/4,
                enqueue_changes/0, unit_of_work/1 ]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/wire',
              [ arrival_permitted/4, endpoint_address/1, endpoint_gone/1,
                endpoint_peer/2, endpoint_post/3, endpoint_post_up/3,
                endpoint_process/1 ]).
:- use_module('../../kernel/host', [alarm_in/3, scheduler_call/1]).
:- use_module(units_of_work,
              [changes_add/1, changes_must_fit/1, changes_putting/5]).

/** <module> Durable posts

A process that keeps a journal records a post to another process before it sends
it, and keeps the record until the other process reports that it has received
the post durably.  Until then it sends the post again over each new connection.
It sends

    channel(Process, To, Before, N, Kind, Term)

the post of number N of Process to the endpoint To; Before is the number of the
post before, or first(M) if all up to M are known to have arrived.  The receiver
takes each post once, in order, and notes its arrival together with its effects.
It sends again(To) if a post is missing, and had(To, N) when it has taken one.
It need not keep a journal itself.

The window of a session, see typhon_window, is different: it numbers frames
one by one, keeps bytes in a queue, and ends with the process.  Here the items
of the journal are the window: their numbers have gaps, and an item may be
dropped from the middle.  A frame kept as a fact costs three times as much as a
frame in a queue.

*Threading*: any thread posts, and never waits for a connection; one worker at
a time sends to an endpoint.  Connection threads take posts; a worker
acknowledges them.
*/

:- meta_predicate changing_posts(+, 0).

:- multifile
    typhon_durable:durable_post/3,
    typhon_endpoint:connection/2,
    typhon_endpoint:received/3,
    typhon_durable:go_on/0,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    out/4,                      % Endpoint, N, Kind, Term: the oldest first
    had/2,                      % Endpoint, N: the peer has received all up to N
    sent/2,                     % Endpoint, N: all up to N were sent; missing
                                % if sending is to start again
    courier/1,                  % Endpoint: a worker sends, or will soon
    seen/2,                     % Key, N: last post taken from a channel
    ack_scheduled/1.            % Key: an acknowledgement is scheduled

:- setting(channel_seconds, number, 300,
           "Seconds for which posts are kept for a process that has left, and \c
            is not known to keep a journal").

batch(100).
longest_pause(1).               % seconds between attempts
ack_seconds(0.02).
addresses(16).                  % of this process, that a process may use

typhon_durable:durable_post(Endpoint, Kind, Term) :-
    changing_posts(
        Endpoint,
        ( durable_number(N),
          changes_putting(out, Endpoint, N, item(Kind, Term), Change),
          changes_must_fit(Change),
          changes_add(Change),
          enqueue_changes,
          assertz(out(Endpoint, N, Kind, Term)) )).

%   changing_posts(+Endpoint, :Goal): Goal changes the posts for Endpoint.  Then
%   start a courier unless there is one.  Nothing may interrupt the thread in
%   between: a courier/1 fact without a courier stops all posts to Endpoint.

changing_posts(Endpoint, Goal) :-
    sig_atomic(( with_mutex(typhon_channel,
                            ( Goal, claim_courier(Endpoint, Courier) )),
                 set_out(Courier, Endpoint) )).

claim_courier(Endpoint, Courier) :-
    (   ( courier(Endpoint) ; \+ out(Endpoint, _, _, _) )
    ->  Courier = there
    ;   assertz(courier(Endpoint)),
        Courier = wanted
    ).

set_out(there, _).
set_out(wanted, Endpoint) :-
    scheduler_call(typhon_channel:send_posts(Endpoint, try(0, 0.05))).

%   send_posts(+Endpoint, +Try): runs in a worker until all posts are sent.  Try
%   is try(Since, Pause): attempts have failed since the stamp Since, 0 if the
%   last one succeeded; Pause is the delay in seconds after this attempt, should
%   it fail.

send_posts(Endpoint, Try) :-
    with_mutex(typhon_channel, next(Endpoint, Items)),
    (   Items == []
    ->  true
    ;   catch(send_all(Items, Endpoint), error(Formal, _), true),
        (   var(Formal)
        ->  send_posts(Endpoint, try(0, 0.05))
        ;   not_sent(Formal, Endpoint, Try)
        )
    ).

next(Endpoint, Items) :-
    (   sent(Endpoint, Sent)
    ->  Before0 = Sent
    ;   received_until(Endpoint, Had),
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

received_until(Endpoint, N) :-
    (   had(Endpoint, N0)
    ->  N = N0
    ;   N = -1
    ).

chained([], _, []).
chained([item(N, Kind, Term)|Found], Before,
        [item(Before, N, Kind, Term)|Items]) :-
    chained(Found, N, Items).

%   A connection that breaks loses the posts sent over it, and sending starts
%   again. If that has happened meanwhile, this post counts as not sent, and the
%   courier drops the rest of its list.

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
    is_ending,
    !,
    with_mutex(typhon_channel, retractall(courier(Endpoint))).
not_sent(unreachable(_), Endpoint, try(Since, _)) :-
    endpoint_gone(Endpoint),
    Since > 0,
    monotonic_time(Now),
    setting(channel_seconds, Most),
    Now-Since > Most,
    !,
    print_message(silent, typhon(home_unreachable(Endpoint))),
    give_up(Endpoint).
not_sent(resource_error(frame_bytes), Endpoint, _) :-
    !,
    with_mutex(typhon_channel, next_is_dropped(Endpoint, Dropped)),
    report_undelivered(Dropped, Endpoint, resource_error(frame_bytes)),
    send_posts(Endpoint, try(0, 0.05)).
not_sent(Formal, Endpoint, try(Since0, Pause)) :-
    debug(typhon(mail), 'nothing can be posted to ~w: ~p', [Endpoint, Formal]),
    with_mutex(typhon_channel, retractall(sent(Endpoint, _))),
    longest_pause(Longest),
    Pause1 is min(Longest, 2*Pause),
    monotonic_time(Now),
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
    scheduler_call(typhon_channel:send_posts(Endpoint, Try)).

%   This process is ending and can send nothing.  Other existence errors, such
%   as that of the queue of a breaking connection, end with the next connection.

is_ending :-
    \+ endpoint_address(_),
    !.
is_ending :-
    durable_closed.

%   Endpoint is gone and keeps no journal, so it will never receive the posts.

give_up(Endpoint) :-
    with_mutex(typhon_channel,
               ( findall(Kind-Term, out(Endpoint, _, Kind, Term), Lost),
                 forget_all(Endpoint),
                 retractall(sent(Endpoint, _)),
                 retractall(had(Endpoint, _)),
                 retractall(courier(Endpoint)) )),
    report_undelivered(Lost, Endpoint, host_unreachable(Endpoint)).

forget_all(Endpoint) :-
    (   out(Endpoint, N, _, _)
    ->  N1 is N+1,
        durable_drop_below(out, Endpoint, N1),
        retractall(out(Endpoint, N, _, _)),
        forget_all(Endpoint)
    ;   true
    ).

report_undelivered(Lost, Endpoint, Formal) :-
    forall(member(Kind-Term, Lost),
           ignore(typhon_durable:undelivered(Kind, Term, Endpoint,
                                                     Formal))).

                /*******************************
                *            ANSWERS           *
                *******************************/

typhon_endpoint:received(channel, again(To), Peer) :-
    ( leads_to(To, Peer) -> send_again(To) ; true ).
typhon_endpoint:received(channel, had(To, N), Peer) :-
    (   leads_to(To, Peer)
    ->  with_mutex(typhon_channel, posts_received(To, N))
    ;   true
    ).

%   leads_to(+To, +Peer) is semidet: posts to the endpoint To are for the
%   process at Peer, which alone acknowledges them.

leads_to(Peer, Peer) :-
    !.
leads_to(To, Peer) :-
    endpoint_peer(Peer, process(Process)),
    endpoint_peer(To, process(Process)).

send_again(To) :-
    changing_posts(To, retractall(sent(To, _))).

posts_received(To, N) :-
    retractall(had(To, _)),
    assertz(had(To, N)),
    drop_received(To, N),
    N1 is N+1,
    durable_drop_below(out, To, N1).

drop_received(To, N) :-
    (   out(To, N0, _, _),
        !,
        N0 =< N
    ->  retract(out(To, N0, _, _)),
        !,
        drop_received(To, N)
    ;   true
    ).

%   Posts sent over the previous connection may be lost, so sending starts
%   again.

typhon_endpoint:connection(Endpoint, up) :-
    (   endpoint_address(Endpoint)
    ->  true
    ;   send_again(Endpoint)
    ).

typhon_durable:go_on :-
    findall(Endpoint, out(Endpoint, _, _, _), All),
    sort(All, Endpoints),
    forall(member(Endpoint, Endpoints), send_again(Endpoint)).

                /*******************************
                *            RECEIVER          *
                *******************************/

typhon_endpoint:received(channel,
                         channel(Process, To, Before, N, Kind, Term), Peer) :-
    endpoint_peer(Peer, process(Process)),
    atomic_list_concat([Process, To], ' ', Key),
    with_mutex(typhon_channel_in,
               ( may_open(Process, Key),
                 take_once(Key, Before, N, Kind, Term, Peer, How) )),
    !,
    answer(How, Key, To, Peer).
typhon_endpoint:received(channel, channel(Process, _, _, _, _, _), Peer) :-
    debug(typhon(mail), 'post of ~w from ~w is dropped', [Process, Peer]).

%   may_open(+Process, +Key) is semidet: each address at which Process finds this
%   process has a channel, and there are few.

may_open(_, Key) :-
    seen(Key, _),
    !.
may_open(Process, _) :-
    atom_concat(Process, ' ', Begin),
    aggregate_all(count, ( seen(Key, _), sub_atom(Key, 0, _, _, Begin) ),
                  Count),
    addresses(Most),
    Count < Most.

take_once(Key, _, N, _, _, _, known) :-
    seen(Key, Seen),
    N =< Seen,
    !.
take_once(Key, Before, N, Kind, Term, Peer, new) :-
    in_order(Before, Key),
    !,
    unit_of_work(( durable_put(seen, Key, 0, N),
                   take(Kind, Term, Peer) )),
    retractall(seen(Key, _)),
    assertz(seen(Key, N)),
    crash_point(after_take).
take_once(_, _, _, _, _, _, gap).

%   A receiver that has lost its state starts at the number that the sender
%   names.

in_order(first(Before), Key) :-
    (   seen(Key, Seen)
    ->  Seen >= Before
    ;   true
    ).
in_order(Before, Key) :-
    seen(Key, Before).

take(Kind, Term, Peer) :-
    (   arrival_permitted(post, Kind, Term, Peer)
    ->  catch(ignore(typhon_endpoint:received(Kind, Term, Peer)),
              error(Formal, Context),
              print_error(error, error(Formal, Context)))
    ;   true
    ).

%   Without a connection no answer is needed: posts are sent again over the next.

answer(gap, _, To, Peer) :-
    ignore(endpoint_post_up(Peer, channel, again(To))).
answer(_, Key, To, Peer) :-
    (   ack_scheduled(Key)
    ->  true
    ;   assertz(ack_scheduled(Key)),
        ack_seconds(Seconds),
        alarm_in(Seconds, Key, had(To, Peer))
    ).

acknowledge(Key, To, Peer) :-
    retractall(ack_scheduled(Key)),
    (   seen(Key, N)
    ->  ignore(catch(endpoint_post_up(Peer, channel, had(To, N)),
                     error(_, _), fail))
    ;   true
    ).

typhon_scheduler:fire(Key, had(To, Peer)) :-
    !,
    scheduler_call(typhon_channel:acknowledge(Key, To, Peer)).

:- durable(out, Endpoint, N, item(Kind, Term), out(Endpoint, N, Kind, Term)).
:- durable(seen, Key, 0, N, seen(Key, N)).

typhon_runtime:ending(after) :-
    retractall(out(_, _, _, _)),
    retractall(had(_, _)),
    retractall(sent(_, _)),
    retractall(courier(_)),
    retractall(seen(_, _)),
    retractall(ack_scheduled(_)).
