:- module(typhon_trails,
          [ agent_trail/2               % +Agent, -Trail
          ]).
:- use_module('../kernel/base/on_demand', [on_demand_call/3]).

/** <module> Trails: which hosts have had an agent

The option trail(Boolean) of hosts that have keys.  This is the interface of
the layer; its modules are loaded in a process that has keys.

*Threading*: any thread that may wait.
*/

%!  agent_trail(+Agent, -Trail) is det.
%
%   Trail is trail(Steps, Verdict): the hosts that have had Agent since it first
%   left its process, verified with the keys of this process.  A step is
%   step(N, Name, What): the host whose certificate has that Name signed that
%   the agent was handed(To), received(At), or has entered(Result).  Verdict is
%   `whole`; or unaccounted(Name): state or code changed on or after that host
%   without a signature, and later steps are missing; or since(N): all is well
%   from the N-th link on, and earlier links are gone.  An agent that met no
%   keys on its way has no steps.
%
%   @error existence_error(agent, Agent)
%   @error existence_error(keys, here)

agent_trail(Agent, Trail) :-
    on_demand_call(keys, any, typhon_trail_verified:agent_trail(Agent, Trail)).
