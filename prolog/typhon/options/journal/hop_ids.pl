:- module(typhon_hop_ids, []).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/wire', [endpoint_process/1]).
:- use_module('../../kernel/agent', [agent_status/3]).
:- use_module('../../kernel/travel',
              [ transfer_again/2, transfer_open/1, transfer_parked/1,
                transfer_traveller/3 ]).

/** <module> Ids of hops

A process that keeps a journal may, after a restart, request a hop again when
the agent has long arrived, and has ended or gone on.  So each of its hops to
another process has an id,

    hop_id(Process, N, Least)

and the receiver keeps the ids of the hops that it has accepted, see
typhon_arrival.  It discards those below Least: with the next hop the sender
reports that it has no open hop to the receiver with a number less than Least.

*Threading*: any thread; only one at a time for an agent that is under way.
*/

:- multifile
    typhon_durable:restored/0,
    typhon_runtime:ending/1,
    typhon_transfer:hop_begins/4,
    typhon_transfer:hop_label/3,
    typhon_transfer:hop_over/2.

:- dynamic
    under_way/4,                % Endpoint, N, Agent, Hops: the oldest first
    last/1.                     % Sent

%   The id is made from the time Sent.

typhon_transfer:hop_begins(Agent, Hops, Endpoint, Sent) :-
    with_mutex(typhon_hop_ids,
               ( stamp(Sent),
                 add(Agent, Hops, Endpoint, Sent) )).

%   Sent is the present time, and later than any before, so that ids differ.

stamp(Sent) :-
    monotonic_time(Now),
    (   retract(last(Last))
    ->  Sent is max(Now, Last+0.000004)
    ;   Sent = Now
    ),
    assertz(last(Sent)).

add(Agent, Hops, Endpoint, Sent) :-
    N is truncate(Sent*1000000),
    assertz(under_way(Endpoint, N, Agent, Hops)).

typhon_transfer:hop_over(Agent, Hops) :-
    retractall(under_way(_, _, Agent, Hops)).

typhon_transfer:hop_label(Agent, Endpoint, hop_id(Process, N, Least)) :-
    under_way(Endpoint, N, Agent, _),
    under_way(Endpoint, Least, _, _),
    !,
    endpoint_process(Process).

%   Restores the oldest hops first, before other agents depart.

typhon_durable:restored :-
    findall(Sent-Transfer,
            ( transfer_open(Transfer),
              arg(1, Transfer, Id),
              agent_status(Id, Status, _),
              arg(2, Status, Sent) ),
            Pairs0),
    keysort(Pairs0, Pairs),
    forall(member(Sent-Transfer, Pairs), restore(Transfer, Sent)).

restore(Transfer, Sent) :-
    transfer_traveller(Transfer, Agent, Hops),
    arg(2, Transfer, dest(_, _, Endpoint)),
    add(Agent, Hops, Endpoint, Sent),
    ( transfer_parked(Transfer) -> true ; transfer_again(Agent, Hops) ).

typhon_runtime:ending(after) :-
    retractall(under_way(_, _, _, _)).
