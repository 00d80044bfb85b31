:- module(typhon_supervision,
          [ agent_monitor/2,            % +Agent, :OnDown
            agent_relations/1           % -Relations
          ]).
:- autoload('supervision/monitors', [monitor_call/2]).
:- autoload('supervision/relations', [relations/2]).
:- use_module('supervision/monitor_words', []).

/** <module> Supervision: the ends of other agents

An agent, or a process, is notified once when another agent ends, wherever both
are.  This is the interface of the layer; the modules that keep monitors are
loaded when a monitor is set, or another process requests one.

*Threading*: any thread that may wait.
*/

:- meta_predicate agent_monitor(+, :).

%!  agent_monitor(+Agent:atom, :OnDown) is det.
%
%   Call call(OnDown, Id, Outcome) once, in a worker, when Agent, whose id is
%   Id, has ended, is faulty or is lost.  Outcome is that of agent_join/3, or
%   `unknown` for an agent that its home does not know, or lost(Host): the
%   process of the agent, or of its home, is gone, and Host is the last known
%   address of the agent.  Does not wait.  Until the call this process keeps its
%   endpoint.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)

agent_monitor(Agent, OnDown) :-
    monitor_call(Agent, OnDown).

%!  agent_relations(-Relations:ordset) is det.
%
%   Relations are the monitors that this process, and the processes that it
%   knows, keep: terms monitors(Agent, Other) and follows(Agent, Other), of ids.
%   Waits up to five seconds for the answers; processes that do not answer are
%   missing.

agent_relations(Relations) :-
    relations(_, Relations).
