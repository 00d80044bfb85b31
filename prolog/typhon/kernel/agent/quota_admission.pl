:- module(typhon_quota_admission, []).
:- use_module('../host',
              [amended/5, host_address/2, quota/3, quota_any/1, quota_shared/4]).
:- use_module(mailbox, [mail_count/2]).
:- use_module(identity, [agent_origin/5, origin_key/2]).
:- use_module(time_quota, [stay_count/3]).

/** <module> Quotas that keep an agent out

*Threading*: any thread.  Of many agents that enter at once each may be one
too many for a quota.
*/

:- multifile
    typhon_gate:forbidden/2,
    typhon_host_parts:part/4.

typhon_host_parts:part(admit, Host, 40, typhon_quota_admission:forbids) :-
    quota_any(Host).

typhon_gate:forbidden(error(resource_error(program_space), _), quota(state)).

:- public forbids/4.

forbids(From, Entrant, Host, refused(quota(What))) :-
    too_much(What, From, Entrant, Host).

%   too_much(-What, +From, +Entrant, +Host)

too_much(mailbox, From, Entrant, Host) :-
    quota(Host, mailbox, Most),
    brought(From, Entrant, Count),
    Count > Most.
too_much(state, _, entrant(_, _, _, module(Module), _), Host) :-
    quota(Host, state, Most),
    module_property(Module, program_size(Size)),
    Size > Most.
too_much(agents, From, entrant(Agent, Hash, _, State, _), Host) :-
    quota_shared(Host, owner, agents, Most),
    owned(From, Agent, State, Host, Id, Owned),
    agent_origin(Host, Id, Hash, Owned, Owner),
    origin_key(Owner, Key),
    stay_count(Host, Key, Count),
    Count >= Most.

brought(going, entrant(Id, _, _, _, _), Count) :-
    !,
    mail_count(Id, Count).
brought(_, entrant(_, _, _, _, Mail), Count) :-
    length(Mail, Count).

%   owned(+From, +Agent, +State0, +Host, -Id, -State): what tells the owner.
%   Of an agent that begins here the id says no more than this process.

owned(going, Id, State, _, Id, State).
owned(here, _, State, Host, Id, State) :-
    newborn(Host, Id).
owned(from(Peer, _, Shown), Agent, State0, Host, Id, State) :-
    ( Shown == newborn -> newborn(Host, Id) ; Id = Agent ),
    amended(created, Host, Peer, State0, State).

newborn(Host, Id) :-
    host_address(Host, Address),
    atom_concat('newborn@', Address, Id).
