:- module(typhon_hop_ids,
          [ hop_id_begin/4,             % +Agent, +Hops, +Endpoint, -Sent
            hop_id_restore/4,           % +Agent, +Hops, +Endpoint, +Sent
            hop_id_end/2,               % +Agent, ?Hops
            hop_id_again/1,             % +Agent
            hop_id_repeated/1,          % +Agent
            hop_id_label/3,             % +Agent, +Endpoint, -Label
            is_hop_id/1,                % @Label
            hop_id_known/1,             % +Label
            hop_id_done/1               % +Label
          ]).
:- use_module('../base/durable', [durable/5]).
:- use_module('../base/durable_changes',
              [ durable_drop_below/3, durable_key/2, durable_on/0,
                durable_put/4 ]).
:- use_module('../wire', [endpoint_process/1]).

/** <module> Ids of hops

A process that keeps a journal may, after a restart, request a hop again when
the agent has long arrived, and has ended or gone on.  So each of its hops to
another process has an id,

    hop_id(Process, N, Least)

and the receiver keeps the ids of the hops that it has accepted.  It discards
those below Least: with the next hop the sender reports that it has no open hop
to the receiver with a number less than Least.

*Threading*: any thread; only one at a time for an agent that is under way.
*/

:- multifile typhon_runtime:ending/1.

:- dynamic
    under_way/4,                % Endpoint, N, Agent, Hops: the oldest first
    last/1,                     % Sent
    again/1,                    % Agent: it was sent before
    done/2.                     % Process, N: was accepted here

%!  hop_id_begin(+Agent, +Hops, +Endpoint, -Sent) is det.
%
%   Record that Agent departs for Endpoint on its hop number Hops, at the time
%   Sent, from which the id is made.

hop_id_begin(Agent, Hops, Endpoint, Sent) :-
    (   durable_on
    ->  with_mutex(typhon_hop_ids,
                   ( stamp(Sent),
                     hop_id_add(Agent, Hops, Endpoint, Sent) ))
    ;   get_time(Sent)
    ).

%   Sent is the present time, and later than any before, so that ids differ.

stamp(Sent) :-
    get_time(Now),
    (   retract(last(Last))
    ->  Sent is max(Now, Last+0.000004)
    ;   Sent = Now
    ),
    assertz(last(Sent)).

hop_id_add(Agent, Hops, Endpoint, Sent) :-
    N is truncate(Sent*1000000),
    assertz(under_way(Endpoint, N, Agent, Hops)).

%!  hop_id_restore(+Agent, +Hops, +Endpoint, +Sent) is det.
%
%   As hop_id_begin/4, for a hop that began before a restart.

hop_id_restore(Agent, Hops, Endpoint, Sent) :-
    hop_id_add(Agent, Hops, Endpoint, Sent),
    hop_id_again(Agent).

%!  hop_id_end(+Agent, ?Hops) is det.
%
%   Record that the hop is over: Agent has arrived, or stays.

hop_id_end(Agent, Hops) :-
    (   retract(under_way(_, _, Agent, Hops))
    ->  retractall(again(Agent))
    ;   true
    ).

%!  hop_id_again(+Agent) is det.
%
%   Record that Agent may have arrived already when it is sent the next time.

hop_id_again(Agent) :-
    retractall(again(Agent)),
    assertz(again(Agent)).

%!  hop_id_repeated(+Agent) is semidet.
%
%   Agent may have arrived by an earlier attempt, see hop_id_again/1.

hop_id_repeated(Agent) :-
    again(Agent),
    !.

%!  hop_id_label(+Agent, +Endpoint, -Label) is det.
%
%   Label is hop_id(Process, N, Least), or `none` if the hop has no id.

hop_id_label(Agent, Endpoint, hop_id(Process, N, Least)) :-
    under_way(Endpoint, N, Agent, _),
    under_way(Endpoint, Least, _, _),
    !,
    endpoint_process(Process).
hop_id_label(_, _, none).

%!  is_hop_id(@Label) is semidet.
%
%   Label is `none` or a hop id; it may come from a peer.

is_hop_id(Label) :-
    Label == none,
    !.
is_hop_id(Label) :-
    subsumes_term(hop_id(_, _, _), Label),
    Label = hop_id(Process, N, Least),
    integer(Least),
    durable_key(Process, N).

%!  hop_id_known(+Label) is semidet.
%
%   Label was already accepted.

hop_id_known(hop_id(Process, N, _)) :-
    done(Process, N),
    !.

%!  hop_id_done(+Label) is det.
%
%   Mark Label accepted.

hop_id_done(none).
hop_id_done(hop_id(Process, N, Least)) :-
    durable_put(done, Process, N, N),
    assertz(done(Process, N)),
    (   N mod 64 =:= 0,
        done(Process, Old),
        Old < Least
    ->  durable_drop_below(done, Process, Least),
        forget_below(Process, Least)
    ;   true
    ).

%   The oldest facts come first, unless the hops arrived in another order.

forget_below(Process, Least) :-
    (   done(Process, Old),
        Old < Least
    ->  retractall(done(Process, Old)),
        forget_below(Process, Least)
    ;   true
    ).

%   The number is in the term because the key of the database has 32 bits.

:- durable(done, Process, _, N, done(Process, N)).

typhon_runtime:ending(after) :-
    retractall(under_way(_, _, _, _)),
    retractall(again(_)),
    retractall(done(_, _)).
