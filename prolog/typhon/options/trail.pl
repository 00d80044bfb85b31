:- module(typhon_trails,
          [ agent_trail/2               % +Agent, -Trail
          ]).
:- use_module('../kernel/base/on_demand', [on_demand_call/3]).

/** <module> Trails: the signed record of the hosts that an agent has visited

The option trail(Boolean) of hosts that have keys.  This is the interface of the
layer; its modules are loaded in a process that has keys.

*Threading*: any thread that may wait.
*/

%!  agent_trail(+Agent, -Trail) is det.
%
%   Trail is trail(Steps, Verdict): the hosts that Agent has visited since it
%   first left its process, verified with the keys of this process.  A step is
%   step(N, Name, What): the host with the certificate of Name has signed What:
%
%     - handed(To): it has handed the agent on to the host To
%     - received(At): it has received the agent at its address At
%     - entered(Result): the agent has entered Result
%
%   Verdict is
%
%     - `whole`: the trail is complete
%     - unaccounted(Name): state or code changed on the host Name, or after it,
%       without a signature; later steps are missing
%     - since(N): the trail is valid from the N-th link on; earlier links were
%       dropped
%
%   An agent that visited no host with keys has no steps.
%
%   @error existence_error(agent, Agent)
%   @error existence_error(keys, here) this process has no keys

agent_trail(Agent, Trail) :-
    on_demand_call(keys, any, typhon_trail_verified:agent_trail(Agent, Trail)).
