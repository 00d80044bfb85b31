:- module(typhon_channel_end, []).
:- use_module(library(error), [must_be/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../base/durable_changes',
              [crash_point/1, durable_put/4, unit_of_work/1]).
:- use_module('../wire', [endpoint_post/3]).
:- use_module('../host', [alarm_in/3, scheduler_call/1]).

/** <module> Where posts that survive come in

What other processes send as described in module `channel`: each is taken once, in order,
and its arrival is noted together with its effects.

*Threading*: the threads of connections; a worker says what has come.
*/

:- multifile
    typhon_durable:fact_table/5,
    typhon_endpoint:received/3,
    typhon_runtime:ending/1,
    typhon_scheduler:fire/2.

:- dynamic
    seen/2,                     % Key, N: of a channel to here
    told/1.                     % Key: that is about to be said

ack_seconds(0.02).

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
    scheduler_call(typhon_channel_end:say_had(Key, To, Peer)).

typhon_durable:fact_table(seen, Key, 0, N, typhon_channel_end:seen(Key, N)).

typhon_runtime:ending(after) :-
    retractall(seen(_, _)),
    retractall(told(_)).
