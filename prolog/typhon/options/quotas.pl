:- module(typhon_quotas, []).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../kernel/host', [host_option/2]).
:- use_module(quotas/quota_agents, [quota_agents_again/1]).
:- use_module(quotas/quota_enforcer, [enforcer_adapt/0]).
:- use_module(quotas/quota_table, [quota/3, quotas_drop/1, quotas_put/3]).
:- use_module(quotas/usage, [usage_forget/1]).

/** <module> Quotas: limits of the resources that agents use on a host

The option quota(List) of hosts.  Quotas are What(Most), for each agent on the
host:

  - inferences(N), seconds(S): inferences and run time between two stops
  - stack(Bytes), state(Bytes): size of its stack and of its state
  - cells(N): size of a term that it sends, logs, leaves or returns as its
    result
  - clones(N): agents of its program and owner on the host when it clones,
    and clones that these make in a second
  - payloads(N): payloads that it carries
  - tuples(N): facts that it has left in the tuple space
  - mailbox(N): messages that wait for it
  - lifetime(S): seconds since its arrival, by the clock of the host
  - calls(PI, N): calls of a service of the place, in a second
  - messages(N), log(N), facts(N), hops(N): messages that it sends, entries that
    it logs, facts that it leaves and hops that it begins, in a second

and owner(What(Most)) for all agents on the host that have the same owner, see
typhon_birth, together, and host(What(Most)) for all agents on the host.
Further quotas are owner(agents(N)), the number of agents on the host, and
host(tuples(N)), the facts in the tuple space.  If a quota of an owner or of the
host is exceeded, the agents that use most end first, among those of the owner
that uses most.

A host that admits untrusted agents has default quotas where the option names
none.  Quotas cost nothing on a host without quotas: it has none of the parts
that the modules define.  This is the interface of the layer.

*Threading*: under the mutex of host_start/2.
*/

:- multifile
    typhon_host_parts:begins/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:changes/2,
    typhon_host_parts:compiled/1,
    typhon_host_parts:ends/1,
    typhon_host_parts:limit/3,
    typhon_on_demand:joins/2,
    typhon_options:declared/4.

:- dynamic changed/1.           % Host: its agents need the new quotas

typhon_options:declared(host_option, quota(List), list, List).

%   Hosts that admit untrusted agents have quotas also without the option.

typhon_on_demand:joins(untrusted, any).

typhon_host_parts:limit(Host, What, Most) :-
    quota(Host, What, Most).

%   default(?Quota): of hosts that admit untrusted agents.

default(seconds(5)).
default(stack(67 108 864)).
default(state(16 777 216)).
default(cells(200 000)).
default(clones(100)).
default(payloads(100)).
default(tuples(10 000)).
default(mailbox(10 000)).
default(messages(10 000)).
default(facts(10 000)).
default(hops(10 000)).
default(log(1000)).
default(host(tuples(100 000))).

typhon_host_parts:begins(Host, _, Options) :-
    put(Host, Options).

typhon_host_parts:changeable(quota(_)).

typhon_host_parts:changes(Option, Host) :-
    functor(Option, Name, Arity),
    functor(Same, Name, Arity),
    findall(Other, ( host_option(Host, Other), Other \= Same ), Others),
    put(Host, [Option|Others]).

put(Host, Options) :-
    ( memberchk(quota(Given), Options) -> true ; Given = [] ),
    (   member(Option, Options),
        typhon_host_parts:untrusted(Option)
    ->  findall(Quota, default(Quota), Defaults)
    ;   Defaults = []
    ),
    append(Given, Defaults, Quotas),
    quotas_put(Host, Quotas, Changed),
    (   Changed == true
    ->  assertz(changed(Host)),
        enforcer_adapt
    ;   true
    ).

typhon_host_parts:compiled(Host) :-
    retract(changed(Host)),
    !,
    quota_agents_again(Host).

typhon_host_parts:ends(Host) :-
    quotas_drop(Host),
    enforcer_adapt,
    usage_forget(Host).
