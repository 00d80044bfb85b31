:- module(typhon_rights,
          [ peer_may/3,                 % +Peer, +Host, +Right
            parent_secret/1,            % +Secret
            security_event/2,           % +Host, +What
            security_event/3            % +Host, +Peer, +What
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_own_proof/1, endpoint_proof/2, right/3]).
:- use_module(host_parts, [parts/3]).
:- use_module(hosts, [host/3, host_option/2]).

/** <module> The rights of other processes

What another process sends is checked against the declarations of
typhon_kinds.  A peer has all its rights, but those that need the secret of this
process only if it proves that it has it: the cookie, or, where processes have
keys, its certificate.
The parts of a host in the phase `permit` can decide otherwise, and those in
the phase `security` record security events; see typhon_host_parts.

*Threading*: any thread.
*/

:- multifile
    agent_scope/2,                      % Agent, Host: Host decides about Agent
    typhon_handshake:text_only/1,
    typhon_kinds:peer_permitted/4.

                /*******************************
                *            SCOPES            *
                *******************************/

%   The scope `all` or agent(Id) may hold no host: then the proof decides.

typhon_kinds:peer_permitted(undeclared(Kind), _, _, Peer) :-
    !,
    forall(host(Host, _, _),
           security_event(Host, Peer, undeclared(Kind))).
typhon_kinds:peer_permitted(parent, _, Term, Peer) :-
    !,
    (   arg(1, Term, Secret),
        secret(Secret)
    ->  true
    ;   refused_everywhere(parent, Peer)
    ).
typhon_kinds:peer_permitted(Right, _, _, _) :-
    right(Right, any, none),
    \+ parts(permit, _, _),
    !.
typhon_kinds:peer_permitted(Right, Scope, Term, Peer) :-
    right(Right, _, Audit),
    scope_hosts(Scope, Hosts),
    (   Hosts == []
    ->  endpoint_proof(Peer, Proof),
        by_default(Proof, Right)
    ;   Scope == some
    ->  member(Host, Hosts),
        permitted(Peer, Host, Right)
    ;   forall(member(Host, Hosts), peer_may(Peer, Host, Right))
    ),
    !,
    (   Audit == none
    ->  true
    ;   used(Right, Scope, Term, What),
        forall(member(Host, Hosts), security_event(Host, Peer, What))
    ).
typhon_kinds:peer_permitted(Right, some, _, Peer) :-
    refused_everywhere(Right, Peer).

refused_everywhere(Right, Peer) :-
    forall(host(Host, _, _), security_event(Host, Peer, refused(Right))),
    fail.

:- dynamic secret/1.                    % Secret of the parent of this process

%!  parent_secret(+Secret) is det.
%
%   The parent of this process, and no other, sends Secret with its orders.

parent_secret(Secret) :-
    assertz(secret(Secret)).

scope_hosts(host(Name), Hosts) :-
    findall(Name, host(Name, _, _), Hosts).
scope_hosts(agent(Id), Hosts) :-
    (   agent_scope(Id, Host)
    ->  Hosts = [Host]
    ;   scope_hosts(all, Hosts)
    ).
scope_hosts(all, Hosts) :-
    findall(Host, host(Host, _, _), Hosts).
scope_hosts(some, Hosts) :-
    scope_hosts(all, Hosts).

%   used(+Right, +Scope, +Term, -What): What is the security event.

used(remote, _, remote(_, Goal), remote(Goal)) :-
    !.
used(Right, Scope, Term, What) :-
    right(Right, _, Audit),
    order(Scope, Term, Of, Order),
    What =.. [Audit,Of,Order].

order(agent(_), question(Id, Order), Id, Order) :-
    !.
order(Scope, Order, Of, Order) :-
    ( compound(Scope) -> arg(1, Scope, Of) ; Of = Scope ).

                /*******************************
                *            RIGHTS            *
                *******************************/

%!  peer_may(+Peer, +Host, +Right) is semidet.
%
%   The process at the address Peer has Right on Host.  A denial is a security
%   event.

peer_may(Peer, Host, Right) :-
    (   permitted(Peer, Host, Right)
    ->  true
    ;   security_event(Host, Peer, refused(Right)),
        fail
    ).

permitted(_, Host, Right) :-
    right(Right, any, _),
    \+ parts(permit, Host, _),
    !.
permitted(Peer, Host, Right) :-
    endpoint_proof(Peer, Proof),
    proof_may(Proof, Host, Right).

proof_may(Proof, Host, Right) :-
    parts(permit, Host, Closures),
    !,
    forall(member(Closure, Closures), call(Closure, Proof, Right)).
proof_may(Proof, _, Right) :-
    by_default(Proof, Right).

by_default(_, Right) :-
    right(Right, any, _),
    !.
by_default(Proof, Right) :-
    right(Right, secret, _),
    endpoint_own_proof(Proof),
    !.

%   A peer that may not run goals here must not be able to end the process by a
%   binary record either.  The codec of a session is chosen when the session
%   begins.

typhon_handshake:text_only(Proof) :-
    (   host(Host, _, _)
    *-> \+ ( proof_may(Proof, Host, remote),
             \+ host_option(Host, remote(false)) )
    ;   \+ endpoint_own_proof(Proof)
    ),
    !.

%!  security_event(+Host, +What) is det.
%!  security_event(+Host, +Peer, +What) is det.
%
%   Report What, which this process, or the process at the address Peer, did, or
%   was refused, on Host.  What is one of
%
%   | refused(Agent, Reason)   | Host did not admit Agent, see typhon_gate    |
%   | refused(Right)           | Peer does not have that Right               |
%   | undeclared(Kind)         | Peer sent a term that is not declared       |
%   | refused(Id, from(Other)) | Id got no message of Peer's in Other's name |
%   | over(Agent, What)        | Agent passed this limit, and ended          |
%   | cell(Agent, Reason)      | the process of Agent was ended for breaking |
%   |                          | a rule, or ended itself                     |
%   | order(Of, Order)         | Peer gave that order to Of, an agent, or on |
%   |                          | a host                                      |
%   | remote(Goal)             | Peer ran Goal here                          |

security_event(Host, What) :-
    endpoint_address(Own),
    endpoint_own_proof(Proof),
    security_event(Host, Own, Proof, What).

security_event(Host, Peer, What) :-
    endpoint_proof(Peer, Proof),
    security_event(Host, Peer, Proof, What).

security_event(Host, Peer, Proof, What) :-
    debug(typhon(security), '~w at ~w: ~p', [Peer, Host, What]),
    (   parts(security, Host, Closures)
    ->  forall(member(Closure, Closures),
               call(Closure, Host, Peer, Proof, What))
    ;   true
    ).
