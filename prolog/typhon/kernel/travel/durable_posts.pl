:- module(typhon_durable_posts,
          [ durable_post/3,             % +Endpoint, +Kind, +Term
            post_must_fit/1             % +Change
          ]).
:- use_module(library(error), [existence_error/2, must_be/2, resource_error/1]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../base/durable', [durable/5]).
:- use_module('../base/durable_changes',
              [ crash_point/1, durable_bytes/2, durable_put/4,
                unit_of_work/1 ]).
:- use_module('../wire', [endpoint_post/3, frame_fits/1]).
:- use_module('../host', [alarm_in/3, scheduler_call/1]).

/** <module> Posts that survive the processes that send and take them

Where changes are durable a post to another process is kept until that has it
for good.  A back end does so: it defines the hook queued/3, and sends

    channel(Process, To, Before, N, Kind, Term)

the post of number N of Process to the endpoint To; Before is the number of the
one before, or first(M) if all up to M are known to have come.  Any process
takes each once, in order, and notes its arrival together with its effects.  A
process that lacks one sends again(To), one that has one had(To, N).

*Threading*: any thread posts, and never waits for a connection; what comes in
is taken by the threads of connections; a worker says what has come.
*/

:- multifile
    queued/3,                   % Endpoint, Kind, Term: will be sent
    undelivered/4,              % Kind, Term, Endpoint, Formal: never will be
    typhon_endpoint:received/3,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    seen/2,                     % Key, N: of a channel to here
    told/1.                     % Key: that is about to be said

ack_seconds(0.02).

%   A frame has so many bytes beside the term that was noted.

around(1000).

%!  durable_post(+Endpoint, +Kind, +Term) is det.
%!  post_must_fit(+Change) is det.
%
%   Post Term to Endpoint, once, whatever dies, together with the changes of
%   this unit of work so far, which ends; what Change notes can be sent in a
%   frame.
%
%   @error resource_error(frame_bytes) Term is too long for a frame

durable_post(Endpoint, Kind, Term) :-
    (   queued(Endpoint, Kind, Term)
    ->  true
    ;   existence_error(back_end, Endpoint)
    ).

post_must_fit(Change) :-
    durable_bytes(Change, Count),
    around(More),
    Most is Count+More,
    (   frame_fits(Most)
    ->  true
    ;   resource_error(frame_bytes)
    ).

                /*******************************
                *         WHAT COMES IN        *
                *******************************/

typhon_endpoint:received(channel,
                         channel(Process, To, Before, N, Kind, Term), Peer) :-
    must_be(atom, Process),
    must_be(atom, To),
    must_be(integer, N),
    atomic_list_concat([Process, To], ' ', Key),
    with_mutex(typhon_channel_in,
               taken(Key, Before, N, Kind, Term, Peer, How)),
    answer(How, Key, To, Peer).

taken(Key, _, N, _, _, _, known) :-
    seen(Key, Seen),
    N =< Seen,
    !.
taken(Key, Before, N, Kind, Term, Peer, new) :-
    in_order(Before, Key),
    !,
    unit_of_work(( durable_put(seen, Key, 0, N),
                   take(Kind, Term, Peer) )),
    retractall(seen(Key, _)),
    assertz(seen(Key, N)),
    crash_point(after_take).
taken(_, _, _, _, _, _, gap).

%   A process that has lost its state begins where the sender says.

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
    (   told(Key)
    ->  true
    ;   assertz(told(Key)),
        ack_seconds(Seconds),
        alarm_in(Seconds, Key, had(To, Peer))
    ).

say_had(Key, To, Peer) :-
    retractall(told(Key)),
    (   seen(Key, N)
    ->  catch(endpoint_post(Peer, channel, had(To, N)), error(_, _), true)
    ;   true
    ).

typhon_scheduler:fire(Key, had(To, Peer)) :-
    !,
    scheduler_call(typhon_durable_posts:say_had(Key, To, Peer)).

:- durable(seen, Key, 0, N, seen(Key, N)).

typhon_runtime:ending(after) :-
    retractall(seen(_, _)),
    retractall(told(_)).
