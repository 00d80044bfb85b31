:- module(typhon_durable_posts, []).
:- use_module(library(error), [must_be/2]).
:- use_module('../../kernel/base/durable', [durable/5]).
:- use_module('../../kernel/base/durable_changes',
              [crash_point/1, durable_put/4, unit_of_work/1]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../../kernel/wire', [endpoint_post/3]).
:- use_module('../../kernel/host', [alarm_in/3, scheduler_call/1]).

/** <module> The receiving end of durable posts

If changes are durable, a post to another process is kept until that process has
committed it, see typhon_channel, which sends

    channel(Process, To, Before, N, Kind, Term)

the post of number N of Process to the endpoint To; Before is the number of the
post before, or first(M) if all up to M are known to have arrived.  The receiver
takes each post once, in order, and notes its arrival together with its effects.
It sends again(To) if a post is missing, and had(To, N) when it has taken one.
It need not keep a journal itself.

*Threading*: connection threads take posts; a worker acknowledges them.
*/

:- multifile
    typhon_endpoint:received/3,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    seen/2,                     % Key, N: last post taken from a channel
    ack_scheduled/1.            % Key: an acknowledgement is scheduled

ack_seconds(0.02).

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
