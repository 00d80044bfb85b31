:- module(typhon_traces,
          [ traces_heard/2,             % +Id, +Life
            trace_kind/1                % ?Kind
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../host', [events_hear/3]).
:- use_module(life, [life_traces/2]).

/** <module> The tracers of an agent

The traces of an agent are a part of its life, so they go where it goes: a
list of trace(To, Kinds), To being the address of the process whose people
want to hear of events of Kinds, and of `step` if it is to be held before each
goal.

*Threading*: inside with_agent/2 of the agent.
*/

:- multifile typhon_names:known/2.

%!  trace_kind(?Kind) is nondet.
%
%   What people can ask for.

trace_kind(hops).
trace_kind(messages).
trace_kind(facts).
trace_kind(goals).

typhon_names:known(trace_kind, Kind) :-
    trace_kind(Kind).

%!  traces_heard(+Id, +Life) is det.
%
%   Id is in this process now: its tracers are notified.

traces_heard(Id, Life) :-
    life_traces(Life, Traces),
    (   Traces == []
    ->  true
    ;   forall(trace_in(Traces, To, Kinds),
               events_hear([life, bad_ends|Kinds], Id, trace(To)))
    ).

%   They may come from a stranger.

trace_in(Traces, To, Kinds) :-
    member(Trace, Traces),
    nonvar(Trace),
    Trace = trace(To, Kinds0),
    atom(To),
    is_list(Kinds0),
    findall(Kind, ( trace_kind(Kind), memberchk(Kind, Kinds0) ), Kinds).
