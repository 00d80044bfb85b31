:- module(typhon_durable_posts,
          [ durable_post/3,             % +Endpoint, +Kind, +Term
            post_must_fit/1,            % +Change
            agent_logs/3                % +Host, +Agent, +What
          ]).
:- use_module(library(error),
              [existence_error/2, must_be/2, resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../base/durable', [durable/5]).
:- use_module('../base/durable_changes',
              [ crash_point/1, durable_bytes/2, durable_drop/3,
                durable_number/1, durable_put/4, unit_of_work/1 ]).
:- use_module('../wire', [endpoint_post/3, frame_fits/1]).
:- use_module('../host',
              [alarm_in/3, host_log/3, host_log_event/4, scheduler_call/1]).
:- use_module('../base/deferred',
              [deferred_call/1, effects_deferred/0, deferred_put/4]).

/** <module> Posts that survive the end of their sender or receiver

If changes are durable, a post to another process is kept until that process has
committed it.  A back end does so: it defines the hook queued/3, and sends

    channel(Process, To, Before, N, Kind, Term)

the post of number N of Process to the endpoint To; Before is the number of the
post before, or first(M) if all up to M are known to have arrived.  The receiver
takes each post once, in order, and notes its arrival together with its effects.
It sends again(To) if a post is missing, and had(To, N) when it has taken one.

With a journal, what an agent logs is part of its turn: it is noted with the
turn, and goes to the log server once, whichever process ends.  Other events of
a host go to the log server at once, see typhon_host_log.

*Threading*: any thread posts, and never waits for a connection; connection
threads take incoming posts; a worker acknowledges them.  The worker that runs
the agent logs.
*/

:- multifile
    queued/3,                   % Endpoint, Kind, Term: the post will be sent
    undelivered/4,              % Kind, Term, Endpoint, Formal: the post cannot
                                % be sent
    typhon_endpoint:received/3,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    seen/2,                     % Key, N: last post taken from a channel
    ack_scheduled/1.            % Key: an acknowledgement is scheduled

ack_seconds(0.02).

%   Bytes of a frame besides those of the noted term, at most.

frame_overhead(1000).

%!  durable_post(+Endpoint, +Kind, +Term) is det.
%
%   Post Term to Endpoint exactly once, even if a process ends, together with
%   the changes of this unit of work so far, which ends here.

durable_post(Endpoint, Kind, Term) :-
    (   queued(Endpoint, Kind, Term)
    ->  true
    ;   existence_error(back_end, Endpoint)
    ).

%!  post_must_fit(+Change) is det.
%
%   The term of Change fits in a frame.
%
%   @error resource_error(frame_bytes) if it does not

post_must_fit(Change) :-
    durable_bytes(Change, Count),
    frame_overhead(More),
    Most is Count+More,
    (   frame_fits(Most)
    ->  true
    ;   resource_error(frame_bytes)
    ).

                /*******************************
                *        INCOMING POSTS        *
                *******************************/

typhon_endpoint:received(channel,
                         channel(Process, To, Before, N, Kind, Term), Peer) :-
    must_be(atom, Process),
    must_be(atom, To),
    must_be(integer, N),
    atomic_list_concat([Process, To], ' ', Key),
    with_mutex(typhon_channel_in,
               take_once(Key, Before, N, Kind, Term, Peer, How)),
    answer(How, Key, To, Peer).

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
    catch(ignore(typhon_endpoint:received(Kind, Term, Peer)),
          error(Formal, Context),
          print_error(error, error(Formal, Context))).

answer(gap, _, To, Peer) :-
    endpoint_post(Peer, channel, again(To)).
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
    ->  catch(endpoint_post(Peer, channel, had(To, N)), error(_, _), true)
    ;   true
    ).

typhon_scheduler:fire(Key, had(To, Peer)) :-
    !,
    scheduler_call(typhon_durable_posts:acknowledge(Key, To, Peer)).

:- durable(seen, Key, 0, N, seen(Key, N)).

typhon_runtime:ending(after) :-
    retractall(seen(_, _)),
    retractall(ack_scheduled(_)).

                /*******************************
                *           LOGGING            *
                *******************************/

:- multifile
    typhon_durable_posts:undelivered/4,
    typhon_durable:go_on/0.

:- dynamic said/4.                      % Host, N, Agent, What: before a restart

%!  agent_logs(+Host, +Agent, +What) is det.
%
%   Agent, which is on Host, logs What, a mobile term.  Host has a log server.

agent_logs(Host, Agent, What) :-
    (   effects_deferred
    ->  durable_number(N),
        deferred_put(logged, Host, N, Agent-What),
        deferred_call(typhon_durable_posts:go(Host, N, Agent, What))
    ;   host_log(Host, Agent, What)
    ).

:- public go/4.

go(Host, N, Agent, What) :-
    unit_of_work(( durable_drop(logged, Host, N),
                   post(Host, Agent, What) )).

post(Host, Agent, What) :-
    (   host_log_event(Host, Agent, What, Endpoint-Event)
    ->  catch(durable_post(Endpoint, log, Event),
              error(resource_error(frame_bytes), Context),
              print_message(warning,
                            error(resource_error(frame_bytes), Context)))
    ;   true                            % the log server was removed
    ).

:- durable(logged, Host, N, Agent-What, said(Host, N, Agent, What)).

typhon_durable:go_on :-
    findall(said(Host, N, Agent, What),
            retract(said(Host, N, Agent, What)), All),
    forall(member(said(Host, N, Agent, What), All),
           go(Host, N, Agent, What)).

%   The log server is gone, or cannot take the event: print it here.

typhon_durable_posts:undelivered(log, event(_, Host, Agent, What), _, _) :-
    print_message(informational, typhon(log(Host, Agent, What))).
