:- module(typhon_quotas, []).

/** <module> How much agents may use on a host

The option quota(List) of hosts.  Quotas are What(Most), of each agent that
stands on the host:

  - inferences(N), seconds(S): between two stops
  - stack(Bytes), state(Bytes)
  - cells(N): parts of what it sends, logs, leaves or gives as its result
  - clones(N): agents of its program and owner that are here when it clones,
    and clones made of these in a second
  - payloads(N): that it carries when it attaches one
  - tuples(N): facts that it has left in the tuple space
  - mailbox(N): messages that wait for it
  - lifetime(S): by the clock of the host, from when it came here
  - calls(PI, N): of a service of the place, in a second
  - messages(N), log(N), facts(N), hops(N): sent, logged, left and begun in a
    second

and owner(What(Most)) of all agents here that have one owner, see
typhon_birth, together, and host(What(Most)) of all that are here.  There are
also owner(agents(N)), how many may be here, and host(tuples(N)), the facts in
the tuple space.  The largest user ends first: of what the host has together,
the agents of the owner that uses most of it.

A host that admits agents which it does not trust has defaults for what the
option does not say.  A host without quotas has none of the parts below.
This is the interface of the layer.
*/

:- use_module(quotas/quota_hosts, []).
:- use_module(quotas/usage, []).
:- use_module(quotas/quota_agents, []).
