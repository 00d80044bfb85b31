:- module(typhon_owner,
          [ agent_owned/1,              % +Id
            agent_owned/2               % +Id, +Owner
          ]).
:- use_module(library(apply), [exclude/3, foldl/4]).
:- use_module(library(lists), [append/3]).
:- use_module('../../kernel/wire', [endpoint_own_proof/1, endpoint_proof/2]).
:- use_module('../../kernel/host', [host_option/2]).
:- use_module('../../kernel/agent', [origin_said/2]).
:- use_module('../keys', [own_keys/1]).
:- use_module(signatures, [program_author/3]).

/** <module> Whose agent it is

What agents of one owner use together can be bounded, see typhon_quotas.  An
owner is what no agent can choose, besides its home, see typhon_identity:

  - author(Name) on a host with authors(Names): the author that signed its
    program
  - certificate(Name): the process that proved this name, not one of ours, when
    it sent it, or the agent of which it is a clone

The second is a fact '$owner'(Owner) among the state of the agent, so it goes
along.  It is put there when an untrusted process brings an agent, whatever it
had before; of a process of ours it is believed.

Where there are keys the id of an agent ends its mark with the name in the
certificate of the process in which it was born, which has to prove that, see
typhon_birth.

*Threading*: any thread; no state.
*/

:- multifile
    typhon_host_parts:part/4,
    typhon_on_demand:joins/2,
    typhon_identity:mark_suffix/1,
    typhon_identity:origin/4.

typhon_on_demand:joins(keys, any).

typhon_identity:origin(Host, Hash, _, author(Author)) :-
    host_option(Host, authors(_)),
    own_keys(Keys),
    program_author(Keys, Hash, Author).
typhon_identity:origin(_, _, State, certificate(Name)) :-
    origin_said(State, Origin),
    subsumes_term(certificate(_), Origin),
    Origin = certificate(Name),
    atom(Name).

typhon_host_parts:part(arrives, _, 20, typhon_owner:arrives) :-
    own_keys(_).
typhon_host_parts:part(created, _, 20, typhon_owner:created) :-
    own_keys(_).

:- public arrives/4, created/4.

arrives(_, hop(_, _, _, _, from(Peer, _)), State0, State) :-
    owner_entered(Peer, State0, State).

created(_, Peer, State0, State) :-
    owner_entered(Peer, State0, State).

%   owner_entered(+Peer, +State0, -State): State0 is that of an agent which the
%   process at Peer sends.

owner_entered(Peer, State0, State) :-
    (   own_keys(_),
        endpoint_proof(Peer, Proof),
        \+ endpoint_own_proof(Proof)
    ->  State0 = state(Empty, Clauses0),
        exclude(of_owner, Clauses0, Clauses),
        State = state(Empty, ['$owner'(Proof)|Clauses])
    ;   State = State0
    ).

of_owner(Clause) :-
    subsumes_term('$owner'(_), Clause).

                /*******************************
                *            IN IDS            *
                *******************************/

%!  agent_owned(+Id) is semidet.
%!  agent_owned(+Id, +Owner) is semidet.
%
%   Id says that it belongs to us; to the process with the certificate of that
%   name.

agent_owned(Id) :-
    endpoint_own_proof(certificate(Own)),
    agent_owned(Id, Own).

agent_owned(Id, Owner) :-
    sub_atom(Id, Before, _, _, '@'),
    !,
    sub_atom(Id, 0, Before, _, Local),
    atomic_list_concat(Parts, '.', Local),
    append(_, [Mark, _], Parts),
    !,
    sub_atom(Mark, _, _, After, -),
    !,
    sub_atom(Mark, _, After, 0, Said),
    spelt(Owner, Said).

typhon_identity:mark_suffix(Part) :-
    own_keys(_),
    endpoint_own_proof(certificate(Name)),
    spelt(Name, Spelt),
    atom_concat(-, Spelt, Part).
%   spelt(+Name, -Spelt): what could be mistaken for another part of an id
%   is written as a number.

spelt(Name, Spelt) :-
    atom_codes(Name, Codes),
    foldl(spelt_code, Codes, Parts, []),
    atomic_list_concat(Parts, Spelt).

spelt_code(Code, [Part|Parts], Parts) :-
    (   Code < 128,
        ( code_type(Code, csym) ; Code =:= 0'- )
    ->  char_code(Part, Code)
    ;   format(atom(Part), '!~16r!', [Code])
    ).
