:- module(study_memory,
          [ memory_watch/2,             % +Seconds, +Network
            memory_peaks/1              % -Peaks
          ]).
:- use_module('../../prolog/typhon', [network_at/3]).
:- use_module('../../prolog/typhon/kernel/agent', [agent_here/5, life_may_move/2]).
:- use_module('../../prolog/typhon/kernel/host', [host/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [max_list/2, sum_list/2]).

/** <module> Memory of agents and hosts during a run

Samples, in host time, the bytes of the clauses that each agent of this
process carries besides its program, and of the tuples of each host, as Prolog
counts them.  The sum excludes goals that are still to run, mail and records of
the kernel: their size does not depend on the agent's program.

*Threading*: one run at a time in a process; the thread of alarms writes.
*/

:- dynamic peak/2.              % Name, Value

%!  memory_watch(+Seconds, +Network) is det.
%
%   Samples at intervals of Seconds of host time, beginning now.

memory_watch(Seconds, Network) :-
    retractall(peak(_, _)),
    look(0, Seconds, Network).

:- public look/3.               % called by network_at/3

look(Time, Seconds, Network) :-
    forall(seen(Name, Value), raise(Name, Value)),
    Next is Time + Seconds,
    network_at(Network, Next, study_memory:look(Next, Seconds, Network)).

%!  memory_peaks(-Peaks:list(pair)) is det.
%
%   Peaks are the greatest samples.  For agents that move: `agents`, their
%   number; `agent_bytes`, of all together, and `agent_most`, of one.  Likewise
%   `static`, `static_bytes`, `static_most` for static agents; `host_bytes`
%   and `host_most` for tuples.

memory_peaks(Peaks) :-
    findall(Name-Value, peak(Name, Value), Peaks0),
    sort(Peaks0, Peaks).

raise(Name, Value) :-
    peak(Name, Peak),
    !,
    (   Value > Peak
    ->  retract(peak(Name, Peak)),
        assertz(peak(Name, Value))
    ;   true
    ).
raise(Name, Value) :-
    assertz(peak(Name, Value)).

seen(Name, Value) :-
    agent_sizes(go, Sizes),
    about(Sizes, agents, agent_bytes, agent_most, Name, Value).
seen(Name, Value) :-
    agent_sizes(static, Sizes),
    about(Sizes, static, static_bytes, static_most, Name, Value).
seen(Name, Value) :-
    findall(Bytes, ( host(_, _, Place), tuple_bytes(Place, Bytes) ), Sizes),
    about(Sizes, hosts, host_bytes, host_most, Name, Value).

agent_sizes(May, Sizes) :-
    findall(Bytes, ( agent_here(_, _, Module, _, Life),
                     life_may_move(Life, May),
                     module_property(Module, program_size(Bytes)) ),
            Sizes).

about(Sizes, Name, _, _, Name, Count) :-
    length(Sizes, Count).
about(Sizes, _, Name, _, Name, Sum) :-
    sum_list(Sizes, Sum).
about([Size|Sizes], _, _, Name, Name, Most) :-
    max_list([Size|Sizes], Most).

tuple_bytes(Place, Bytes) :-
    aggregate_all(sum(Size),
                  ( clause(Place:'$tuple'(_), _, Clause),
                    clause_property(Clause, size(Size)) ),
                  Bytes).
