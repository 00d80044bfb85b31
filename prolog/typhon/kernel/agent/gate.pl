:- module(typhon_gate,
          [ gate/4,                     % +Host, +Entrant, :Install, -Verdict
            gate_refused/4              % +Host, +From, +Agent, +Reason
          ]).
:- use_module('../base/headroom', [memory_short/1]).
:- use_module('../program',
              [code_check/3, code_guarded/3, code_module/2, code_receive/2]).
:- use_module('../wire', [endpoint_address/1, endpoint_own_proof/1]).
:- use_module('../host',
              [ audit/3, audit/4, event/4, guarding/0, host/3, host_address/2,
                host_closed/1, host_enter/4, host_leave/1, host_load/2,
                peer_permitted/3, place_front/3, quota/3, quota_any/1,
                quota_shared/4 ]).
:- use_module(birth, [birth_proved/4]).
:- use_module(life, [life_tokens/2]).
:- use_module(mailbox, [mail_count/2]).
:- use_module(owner, [owner_entered/3, owner_key/2, owner_of/5]).
:- use_module(signed_payloads, [payloads_admitted/3]).
:- use_module(time_quota, [stay_count/3]).

/** <module> Admission: which agents a host lets in

Every agent that begins on a host, or comes to it, passes gate/4: when it is
created, cloned or restored there, and at the end of a hop, from this process
or from another.  The reasons to refuse an agent are tried in the order of the
clauses below, whatever the path, and a refusal is audited and told as an event
here and nowhere else.

The agent is

    entrant(Agent, Hash, Life, State, Mail)

its id, or the name from which its id will be made; the hash of its program;
its life; its state, as of agent_state/2, or module(Module); the messages that
it brings.  Where it comes from is

  - here: it begins, in this process
  - going: it hops within this process
  - from(Peer, Program, Shown): the process at Peer has sent it with Program,
    as of code_receive/2, or `known`.  Shown is `newborn`, or papers(Papers):
    what proves that Peer may bring it.

*Threading*: any thread.  Of many agents that enter at once each may be one too
many for a quota, but not for the capacity of the host.
*/

:- meta_predicate gate(+, +, 1, -).

%!  gate(+Host, +Entrant, :Install, -Verdict) is det.
%
%   Let an agent in.  Entrant is From-Agent.  If nothing is against it, a place
%   on Host is reserved and call(Install, Verdict) installs the agent.  The
%   place is given back unless Verdict is `ok`.  Other verdicts are
%   refused(Reason), `need_program`, and those of Install.
%
%   Signals wait while the agent is between reserved and installed.  The process
%   has no capacity for more agents while its memory is short.
%
%   @error what Install raises, unless it means that Host refuses the agent

gate(Host, From-Entrant, Install, Verdict) :-
    (   against(From, Entrant, Host, Verdict)
    ->  true
    ;   Entrant = entrant(_, Hash, Life, _, _),
        life_tokens(Life, Tokens),
        sig_atomic(enter(Host, Hash, Tokens, From, Install, Verdict))
    ),
    (   Verdict = refused(Reason)
    ->  arg(1, Entrant, Agent),
        gate_refused(Host, From, Agent, Reason)
    ;   true
    ).

enter(Host, Hash, Tokens, From, Install, Verdict) :-
    host_enter(Host, Hash, Tokens, Entered),
    (   Entered == ok
    ->  (   From \== going,
            host_load(Host, Load),
            memory_short(Load)
        ->  Verdict = refused(capacity)
        ;   catch(call(Install, Verdict), Ball,
                  not_installed(Ball, Host, Verdict))
        ),
        ( Verdict == ok -> true ; host_leave(Host) )
    ;   not_entered(Entered, From, Verdict)
    ).

not_installed(Ball, _, refused(Reason)) :-
    forbidden(Ball, Reason),
    !.
not_installed(Ball, Host, _) :-
    host_leave(Host),
    throw(Ball).

%   The signature may come with the program.

not_entered(refused(unsigned), from(_, known, _), need_program) :-
    !.
not_entered(Refused, _, Refused).

                /*******************************
                *            REASONS           *
                *******************************/

%   against(+From, +Entrant, +Host, -Verdict): the first reason counts.  It is
%   followed by those of host_enter/4: unsigned, token, capacity.

against(from(_, _, _), _, Host, refused(unknown_host)) :-
    \+ open(Host),
    !.
against(from(Peer, _, _), _, Host, refused(peer)) :-
    \+ peer_permitted(Peer, Host, agents),
    !.
against(from(Peer, _, papers(Papers)), Entrant, _, Verdict) :-
    Entrant = entrant(Id, Hash, _, _, _),
    \+ birth_proved(Papers, Peer, Id, Hash),
    !,
    unproved(Papers, Verdict).
against(From, Entrant, Host, refused(Reason)) :-
    guarding,
    host(Host, _, Place),
    place_front(Place, _, Policy),
    catch(( looked_through(From, Entrant, Policy), fail ), error(Formal, Where),
          forbidden(error(Formal, Where), Reason)),
    !.
against(From, Entrant, Host, refused(quota(What))) :-
    quota_any(Host),
    too_much(What, From, Entrant, Host),
    !.
against(from(_, Program, _), entrant(_, Hash, _, _, _), _, need_program) :-
    \+ has_code(Hash, Program),
    !.
against(_, entrant(_, _, Life, State, _), Host, refused(unsigned)) :-
    \+ payloads_admitted(Host, Life, State).

%   A request may name anything as the host.

open(Host) :-
    atom(Host),
    \+ host_closed(Host).

%   The peer may have what proves it.

unproved(Papers, Verdict) :-
    (   subsumes_term(papers(_, _), Papers)
    ->  Verdict = refused(identity)
    ;   Verdict = need_program
    ).

%   looked_through(+From, +Entrant, +Policy): the program alone.  One that is
%   sent is checked before it is installed, since that loads its libraries.
%   State and goals are checked when the agent is installed.
%
%   @error what forbidden/2 knows

looked_through(_, entrant(_, Hash, _, _, _), Policy) :-
    code_module(Hash, _),
    !,
    code_guarded(Policy, Hash, _).
looked_through(from(_, Program, _), entrant(_, Hash, _, _, _), Policy) :-
    code_check(Policy, Hash, Program).

%   forbidden(+Ball, -Reason): Ball says that a host does not let in what it is
%   not to run, or what is too large.

forbidden(error(permission_error(call, sandboxed, Culprit), _),
          policy(Culprit)).
forbidden(error(resource_error(clause_cells), _), policy(clause_cells)).
forbidden(error(resource_error(program_space), _), quota(state)).

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
    owner_of(Host, Id, Hash, Owned, Owner),
    owner_key(Owner, Key),
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
    owner_entered(Peer, State0, State).

newborn(Host, Id) :-
    host_address(Host, Address),
    atom_concat('newborn@', Address, Id).

%   @error domain_error(program_of_hash(Hash), Program)

has_code(Hash, Program) :-
    (   Program == known
    ->  code_module(Hash, _)
    ;   code_receive(Hash, Program)
    ).

                /*******************************
                *           REFUSALS           *
                *******************************/

%!  gate_refused(+Host, +From, +Agent, +Reason) is det.
%
%   Host has refused Agent: a line in its audit, if it has one, and an event.

gate_refused(Host, From, Agent, Reason) :-
    (   atom(Host),
        host(Host, _, _)
    ->  shown(Reason, Shown),
        noted(From, Host, refused(Agent, Shown)),
        event(hosts, Host, none, refused(Agent, Shown))
    ;   true
    ).

%   A peer can write goals of any size.

shown(policy(Goal), policy(Name/Arity)) :-
    compound(Goal),
    term_size(Goal, Cells),
    Cells > 1000,
    !,
    compound_name_arity(Goal, Name, Arity).
shown(Reason, Reason).

%   A thread that reads from a peer may run an agent of this process, too.

noted(from(Peer, _, _), Host, What) :-
    !,
    audit(Host, Peer, What).
noted(_, Host, What) :-
    endpoint_address(Own),
    endpoint_own_proof(Proof),
    audit(Host, Own, Proof, What).
