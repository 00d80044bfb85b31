:- module(typhon_owner,
          [ owner_of/5,                 % +Host, +Id, +Hash, +State, -Owner
            owner_key/2,                % +Owner, -Key
            owner_entered/3             % +Peer, +State0, -State
          ]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../program', [program_author/3]).
:- use_module('../wire',
              [endpoint_keys/1, endpoint_own_proof/1, endpoint_proof/2]).
:- use_module('../host', [host_option/2]).
:- use_module(identity, [agent_home_endpoint/2]).

/** <module> Whose agent it is

What agents of one owner use together can be bounded, see typhon_quotas.  An
owner is what no agent can choose:

  - author(Name) on a host with authors(Names): the author that signed its program
  - certificate(Name): the process that proved this name, not one of ours, when it
    sent it, or the agent of which it is a clone
  - home(Endpoint) of others: the process in which it was born, or the agent of
    which it is a clone

What cannot be told from the id is a fact '$owner'(Owner) among the state of
the agent, so it goes along.  It is put there when a stranger brings an agent,
whatever it had before, and when an agent is cloned away from home.  An agent
that is guarded cannot touch it; of a process of ours it is believed.

*Threading*: any thread; no state.
*/

:- multifile typhon_host_parts:part/4.

typhon_host_parts:part(arrives, _, 20, typhon_owner:arrives) :-
    endpoint_keys(_).
typhon_host_parts:part(created, _, 20, typhon_owner:created) :-
    endpoint_keys(_).

:- public arrives/4, created/4.

arrives(_, hop(_, _, _, _, from(Peer, _)), State0, State) :-
    owner_entered(Peer, State0, State).

created(_, Peer, State0, State) :-
    owner_entered(Peer, State0, State).

%!  owner_of(+Host, +Id, +Hash, +State, -Owner) is semidet.
%
%   Owner is whose agent Id is on Host, Hash being that of its program, State
%   as of agent_state/2, or module(Module).

owner_of(Host, _, Hash, _, author(Author)) :-
    host_option(Host, authors(_)),
    endpoint_keys(Keys),
    program_author(Keys, Hash, Author),
    !.
owner_of(_, _, _, State, Owner) :-
    said(State, Owner),
    is_owner(Owner),
    !.
owner_of(_, Id, _, _, home(Endpoint)) :-
    agent_home_endpoint(Id, Endpoint).

said(module(Module), Owner) :-
    '$c_current_predicate'(_, Module:'$owner'(_)),
    Module:'$owner'(Owner).
said(state(_, Clauses), Owner) :-
    memberchk('$owner'(Owner), Clauses).

%!  owner_key(+Owner, -Key:atom) is det.
%
%   An atom for tables.

owner_key(Owner, Key) :-
    Owner =.. Parts,
    atomic_list_concat(Parts, ' ', Key).

%!  owner_entered(+Peer, +State0, -State) is det.
%
%   State0 is that of an agent which the process at Peer sends.

owner_entered(Peer, State0, State) :-
    (   endpoint_keys(_),
        endpoint_proof(Peer, Proof),
        \+ endpoint_own_proof(Proof)
    ->  State0 = state(Empty, Clauses0),
        exclude(of_owner, Clauses0, Clauses),
        State = state(Empty, ['$owner'(Proof)|Clauses])
    ;   State = State0
    ).

of_owner(Clause) :-
    subsumes_term('$owner'(_), Clause).

is_owner(Owner) :-
    ground(Owner),
    member(Owner, [certificate(Name), home(Name)]),
    !,
    atom(Name).
