:- module(typhon_birth,
          [ birth_good/1,               % +Birth
            birth_shown/2,              % +Id, -Birth
            agent_owned/1,              % +Id
            agent_owned/2               % +Id, +Owner
          ]).
:- use_module(library(apply), [exclude/3, foldl/4, maplist/2, maplist/3]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(lists), [append/3, sum_list/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../../kernel/base/bounds', [bounded/3]).
:- use_module('../keys', [keys_sign/3, keys_verify/4, own_keys/1]).
:- use_module('../../kernel/base/durable',
              [durable/6, durable_drop/3, durable_put/4]).
:- use_module('../../kernel/wire',
              [ endpoint_address/1, endpoint_own_proof/1, endpoint_peer/2,
                endpoint_proof/2 ]).
:- use_module('../../kernel/agent',
              [agent/5, agent_home_endpoint/2, origin_said/2]).
:- use_module('../../kernel/host', [host_option/2]).
:- use_module(signatures, [program_author/3]).

/** <module> Births: signed proof of the owner of an agent

Where processes have keys, an agent that leaves the process in which it was
created carries a birth that this process has signed,

    birth(Id, Hash, Certificate, Hex)

Id is the id of the agent and names the owner, see typhon_identity; Hash is that
of its program, and Certificate that of the owner.  No other process can make
one, so an id belongs to one owner and one program.  A birth is shown only to
processes to which the agent goes, and to its home, so a process that shows it
has had the agent.

The birth is sent along with the program, once to each process that is not known
to have it.

The resources that agents of one owner use together can be bounded, see
typhon_quotas.  Besides the home, an owner is a property that an agent cannot
choose, see typhon_identity:

  - author(Name) on a host with authors(Names): the author that signed its
    program
  - certificate(Name): the process that proved this name when it sent the
    agent, or the agent of which this is a clone; not a process of the same
    owner

The latter is stored as a fact '$owner'(Owner) in the state of the agent, so it
moves with the agent.  The fact is set when an untrusted process sends an agent,
and replaces an earlier one; processes of the same owner are trusted to send the
right one.

In a process with keys, the mark in the id of a new agent ends with the name in
the certificate of this process, which the birth of the agent proves.

*Threading*: any thread; a mutex serialises writers.
*/

:- multifile
    typhon_bounds:forgotten/1,
    typhon_host_parts:part/4,
    typhon_hop:sent_again/2,
    typhon_identity:ids_anew/0,
    typhon_identity:mark_suffix/1,
    typhon_identity:origin/4,
    typhon_on_demand:joins/2.

:- setting(births, positive_integer, 20000,
           "Agents whose proofs of ownership are kept").

:- dynamic
    known/2,                            % Id, Birth: verified
    has/2.                              % Id, Proof: the process has the birth

typhon_identity:ids_anew :-
    retractall(known(_, _)),
    retractall(has(_, _)).

typhon_host_parts:part(papers, _, 10, typhon_birth:papers) :-
    own_keys(_).
typhon_host_parts:part(new_program, _, 10, typhon_birth:may_change) :-
    own_keys(_).

:- public may_change/3.

%   No host would admit an agent of another owner with another program.

may_change(_, Id, _) :-
    (   agent_owned(Id)
    ->  true
    ;   permission_error(change, agent_program, Id)
    ).

:- public papers/4.

papers(_, program(Id, Hash, Endpoint), Sent, Papers) :-
    proof_of(Endpoint, Proof),
    \+ has_birth(Proof, Id),
    birth(Id, Hash, Birth),
    !,
    note_has(Id, Proof),
    Papers = papers(Birth, Sent).
papers(_, _, Sent, Sent).

proof_of(Endpoint, Proof) :-
    endpoint_peer(Endpoint, proof(Proof)),
    !.
proof_of(_, unknown).

has_birth(Proof, Id) :-
    has(Id, Proof),
    !.
has_birth(Proof, Id) :-
    is_ours(Proof, Id).

%   A process with the same keys can sign all that this process can.

is_ours(Proof, Id) :-
    endpoint_own_proof(Proof),
    agent_owned(Id).

note_has(_, unknown) :-
    !.
note_has(Id, Proof) :-
    with_mutex(typhon_birth,
               ( retractall(has(Id, Proof)),
                 bounded(has(_, _), typhon_birth:births,
                         assertz(has(Id, Proof))) )).

%   The process at Endpoint lacks the birth of Id, although it was recorded to
%   have it.

typhon_hop:sent_again(Endpoint, Id) :-
    proof_of(Endpoint, Proof),
    with_mutex(typhon_birth, retractall(has(Id, Proof))).

birth(Id, Hash, Birth) :-
    known(Id, Birth0),
    Birth0 = birth(_, Hash, _, _),
    !,
    Birth = Birth0.
birth(Id, Hash, birth(Id, Hash, Certificate, Hex)) :-
    agent_owned(Id),
    own_keys(Keys),
    birth_text(Id, Hash, Text),
    keys_sign(Keys, Text, signature(Pem, Hex)),
    atom_string(Certificate, Pem),      % an atom, which many births share
    remember(Id, birth(Id, Hash, Certificate, Hex)).

birth_text(Id, Hash, Text) :-
    atomic_list_concat(['typhon birth', Id, Hash], ' ', Text).

remember(Id, Birth) :-
    durable_put(birth, Id, 0, Birth),
    with_mutex(typhon_birth,
               ( retractall(known(Id, _)),
                 bounded(known(_, _), typhon_birth:births,
                         assertz(known(Id, Birth))) )).

%   Births of agents in this process are kept: other processes need not have
%   them.

typhon_bounds:forgotten(known(Id, Birth)) :-
    (   agent(Id, _, _, _, _)
    ->  assertz(known(Id, Birth))
    ;   durable_drop(birth, Id, 0)
    ).

:- durable(birth, Id, 0, Birth, known(Id, Birth),
           ( retractall(known(Id, _)), assertz(known(Id, Birth)) )).

typhon_host_parts:part(admit, _, 20, typhon_birth:forbids) :-
    own_keys(_).

:- public forbids/4.

forbids(from(Peer, _, papers(Papers)), entrant(Id, Hash, _, _, _), _,
        Verdict) :-
    endpoint_proof(Peer, Proof),
    \+ proved(Papers, Proof, Id, Hash),
    unproved(Papers, Verdict).

%   Without papers, the peer may still have a birth: request it.

unproved(Papers, Verdict) :-
    (   subsumes_term(papers(_, _), Papers)
    ->  Verdict = refused(identity)
    ;   Verdict = need_program
    ).

%   proved(+Papers, +Proof, +Id, +Hash): a process with Proof may send the agent
%   Id with the program Hash: it has shown the birth of Id before, has the same
%   keys as the owner of Id, or shows the birth in Papers, which may be any
%   term.

proved(_, Proof, Id, Hash) :-
    has(Id, Proof),
    known(Id, birth(_, Hash, _, _)).
proved(_, Proof, Id, _) :-
    is_ours(Proof, Id).
proved(Papers, Proof, Id, Hash) :-
    subsumes_term(papers(birth(Id, Hash, _, _), _), Papers),
    arg(1, Papers, Birth),
    birth_good(Birth),
    note_has(Id, Proof).

%!  birth_good(+Birth) is semidet.
%
%   Birth, which may be any term, is a birth of at most the maximal size, and
%   the owner of the agent has signed it.

birth_good(Birth) :-
    ground(Birth),
    Birth = birth(Id, Hash, Certificate, Hex),
    (   known(Id, Birth)
    ->  true
    ;   within_size([Id, Hash, Certificate]),
        own_keys(Keys),
        birth_text(Id, Hash, Text),
        atom_string(Certificate, Pem),
        keys_verify(Keys, Text, signature(Pem, Hex), host(Owner)),
        agent_owned(Id, Owner),
        at_home(Id),
        remember(Id, Birth)
    ).

%   Verified births are kept, also in the journal, and any process with keys can
%   sign arbitrary ones.

within_size(Atoms) :-
    maplist(atom, Atoms),
    maplist(atom_length, Atoms, Lengths),
    sum_list(Lengths, Length),
    Length =< 20 000.

%   An agent of another owner cannot have its home in this process.

at_home(Id) :-
    agent_owned(Id),
    !.
at_home(Id) :-
    agent_home_endpoint(Id, Home),
    \+ endpoint_address(Home).

%!  birth_shown(+Id, -Birth) is semidet.
%
%   Birth proves that this process has, or had, the agent Id of another owner.

birth_shown(Id, Birth) :-
    known(Id, Birth).

                /*******************************
                *            OWNERS            *
                *******************************/

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

typhon_host_parts:part(arrives, _, 20, typhon_birth:arrives) :-
    own_keys(_).
typhon_host_parts:part(created, _, 20, typhon_birth:created) :-
    own_keys(_).

:- public arrives/4, created/4.

arrives(_, hop(_, _, _, _, from(Peer, _)), State0, State) :-
    owner_entered(Peer, State0, State).

created(_, Peer, State0, State) :-
    owner_entered(Peer, State0, State).

%   owner_entered(+Peer, +State0, -State): State0 is the state of an agent that
%   the process at Peer sends.

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

%!  agent_owned(+Id) is semidet.
%!  agent_owned(+Id, +Owner) is semidet.
%
%   According to Id, its owner is this process; or a process whose certificate
%   has the name Owner.

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
    encoded(Owner, Said).

typhon_identity:mark_suffix(Part) :-
    own_keys(_),
    endpoint_own_proof(certificate(Name)),
    encoded(Name, Spelt),
    atom_concat(-, Spelt, Part).

%   encoded(+Name, -Spelt): Spelt is Name with numbers for characters that could
%   be mistaken for another part of an id.

encoded(Name, Spelt) :-
    atom_codes(Name, Codes),
    foldl(encoded_code, Codes, Parts, []),
    atomic_list_concat(Parts, Spelt).

encoded_code(Code, [Part|Parts], Parts) :-
    (   Code < 128,
        ( code_type(Code, csym) ; Code =:= 0'- )
    ->  char_code(Part, Code)
    ;   format(atom(Part), '!~16r!', [Code])
    ).
