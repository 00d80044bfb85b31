:- module(typhon_hop_ids,
          [ crossing_begin/4,           % +Agent, +Hops, +Endpoint, -Sent
            crossing_restore/4,         % +Agent, +Hops, +Endpoint, +Sent
            crossing_end/2,             % +Agent, ?Hops
            crossing_again/1,           % +Agent
            crossing_repeated/1,        % +Agent
            crossing_label/3,           % +Agent, +Endpoint, -Label
            is_crossing/1,              % @Label
            crossing_known/1,           % +Label
            crossing_done/1             % +Label
          ]).
:- use_module('../base/durable_changes',
              [ durable_drop_below/3, durable_key/2, durable_on/0,
                durable_put/4 ]).
:- use_module('../wire', [endpoint_process/1]).

/** <module> Hops that are known by number

A process that keeps a journal may ask for a hop again after it was started
again, when the agent has arrived long since, and has ended or gone on.  So
each of its hops to another process has a number,

    crossing(Process, N, Least)

and the other keeps those that it has let in until it hears, with the next
hop, that the first has no open one less than Least to it any more.

*Threading*: any thread; of an agent that is under way one at a time.
*/

:- multifile
    typhon_durable:fact_table/5,
    typhon_runtime:ending/1.

:- dynamic
    under_way/4,                    % Endpoint, N, Agent, Hops: under way; the
                                % oldest first
    last/1,                     % Sent
    again/1,                    % Agent: it was sent before
    done/2.                     % Process, N: was let in here

%!  crossing_begin(+Agent, +Hops, +Endpoint, -Sent) is det.
%!  crossing_restore(+Agent, +Hops, +Endpoint, +Sent) is det.
%!  crossing_end(+Agent, ?Hops) is det.
%!  crossing_again(+Agent) is det.
%!  crossing_repeated(+Agent) is semidet.
%
%   Agent sets out for Endpoint, with so many Hops, at Sent, from which the
%   number follows; did so before a restart; has arrived, or stays; it is not
%   known whether it had arrived already when it is sent next; which is so.

crossing_begin(Agent, Hops, Endpoint, Sent) :-
    (   durable_on
    ->  with_mutex(typhon_hop_ids,
                   ( stamp(Sent),
                     crossing_add(Agent, Hops, Endpoint, Sent) ))
    ;   get_time(Sent)
    ).

%   No two are the same.

stamp(Sent) :-
    get_time(Now),
    (   retract(last(Last))
    ->  Sent is max(Now, Last+0.000004)
    ;   Sent = Now
    ),
    assertz(last(Sent)).

crossing_add(Agent, Hops, Endpoint, Sent) :-
    N is truncate(Sent*1000000),
    assertz(under_way(Endpoint, N, Agent, Hops)).

crossing_restore(Agent, Hops, Endpoint, Sent) :-
    crossing_add(Agent, Hops, Endpoint, Sent),
    crossing_again(Agent).

crossing_end(Agent, Hops) :-
    (   retract(under_way(_, _, Agent, Hops))
    ->  retractall(again(Agent))
    ;   true
    ).

crossing_again(Agent) :-
    retractall(again(Agent)),
    assertz(again(Agent)).

crossing_repeated(Agent) :-
    again(Agent),
    !.

%!  crossing_label(+Agent, +Endpoint, -Label) is det.
%
%   Label is crossing(Process, N, Least), or `none`.

crossing_label(Agent, Endpoint, crossing(Process, N, Least)) :-
    under_way(Endpoint, N, Agent, _),
    under_way(Endpoint, Least, _, _),
    !,
    endpoint_process(Process).
crossing_label(_, _, none).

%!  is_crossing(@Label) is semidet.

is_crossing(Label) :-
    Label == none,
    !.
is_crossing(Label) :-
    subsumes_term(crossing(_, _, _), Label),
    Label = crossing(Process, N, Least),
    integer(Least),
    durable_key(Process, N).

%!  crossing_known(+Label) is semidet.
%!  crossing_done(+Label) is det.
%
%   Label was already accepted; mark Label accepted.

crossing_known(crossing(Process, N, _)) :-
    done(Process, N),
    !.

crossing_done(none).
crossing_done(crossing(Process, N, Least)) :-
    durable_put(done, Process, N, N),
    assertz(done(Process, N)),
    (   N mod 64 =:= 0,
        done(Process, Old),
        Old < Least
    ->  durable_drop_below(done, Process, Least),
        forget_below(Process, Least)
    ;   true
    ).

%   The oldest come first, but for those that came in another order.

forget_below(Process, Least) :-
    (   done(Process, Old),
        Old < Least
    ->  retractall(done(Process, Old)),
        forget_below(Process, Least)
    ;   true
    ).

%   The number that comes from the database has 32 bits.

typhon_durable:fact_table(done, Process, _, N,
                          typhon_hop_ids:done(Process, N)).

typhon_runtime:ending(after) :-
    retractall(under_way(_, _, _, _)),
    retractall(again(_)),
    retractall(done(_, _)).
