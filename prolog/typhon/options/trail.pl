:- module(typhon_trails,
          [ agent_trail/2               % +Agent, -Trail
          ]).
:- use_module('../kernel/base/on_demand', [on_demand_call/3]).

/** <module> Trails: which hosts have had an agent, and what they did with it

The option trail(Boolean) of hosts that have keys.  This is the interface of
the layer; its modules are loaded in a process that has keys.

*Threading*: any thread that may wait.
*/

%!  agent_trail(+Agent, -Trail) is det.
%
%   Trail is trail(Steps, Verdict): which hosts have had Agent since it first
%   left its process, with the keys of this process. A step is
%   step(N, Name, What): the host with the certificate of that Name has signed
%   that it was handed(To), received(At), or has entered(Result). Verdict is
%   `whole`, or unaccounted(Name): after that host, or in its hands, state or
%   code have changed without a signature; of what came later there are no
%   steps; or since(N), if all is well from the N-th link on, and those before
%   are gone. Without keys on its way an agent has no steps.
%
%   @error existence_error(agent, Agent)
%   @error existence_error(keys, here)

agent_trail(Agent, Trail) :-
    on_demand_call(keys, any, typhon_trail_verified:agent_trail(Agent, Trail)).
