:- module(typhon_supervision,
          [ agent_monitor/2,            % +Agent, :OnDown
            agent_relations/1           % -Relations
          ]).
:- autoload('supervision/monitors', [monitor_call/2]).
:- autoload('supervision/relations', [relations/2]).
:- use_module('supervision/monitor_words', []).

/** <module> Supervision: the ends of other agents

An agent, or a process, is notified once when another agent ends, wherever both
are.  This is the interface of the layer; what keeps monitors is loaded when
one is set, or another process asks for one.

*Threading*: any thread that may wait.
*/

:- meta_predicate agent_monitor(+, :).

%!  agent_monitor(+Agent, :OnDown) is det.
%
%   Have call(OnDown, Id, Outcome) called once, in a worker, when Agent, whose
%   id is Id, has ended, is faulty or is lost.  Outcome is as of agent_join/3,
%   `unknown` of an agent that its home does not know, or lost(Host), the last
%   address that is known of an agent whose process, or the process of whose
%   home, is gone.  Does not wait.  This process takes part in the network until
%   then.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)

agent_monitor(Agent, OnDown) :-
    monitor_call(Agent, OnDown).

%!  agent_relations(-Relations:ordset) is det.
%
%   What is known of monitors in the processes that are known here: terms
%   monitors(Agent, Other) and follows(Agent, Other), ids.  Waits for answers.

agent_relations(Relations) :-
    relations(_, Relations).
