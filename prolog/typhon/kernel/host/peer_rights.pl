:- module(typhon_peer_rights,
          [ peer_may/3,                 % +Peer, +Host, +Right
            security_event/2,           % +Host, +What
            security_event/3            % +Host, +Peer, +What
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_own_proof/1, endpoint_proof/2]).
:- use_module(host_parts, [parts/3]).
:- use_module(hosts, [host/3, host_option/2]).

/** <module> The rights of other processes on a host

The rights are

  - agents: create agents here, and send agents here
  - messages: send messages to agents here
  - orders: dispose of agents, move and change them; link the host
  - remote: run goals here, see remote/2
  - inspect: read agents, events and the properties of the host

A peer has all of these rights, but `remote` only if it proves that it has our
own secret: the cookie, or, where processes have keys, our own certificate.
The parts of a host in the phase `permit` can decide otherwise, and those in
the phase `security` record security events; see typhon_host_parts.

*Threading*: any thread.
*/

:- multifile typhon_handshake:text_only/1.

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
    Right \== remote,
    \+ parts(permit, Host, _),
    !.
permitted(Peer, Host, Right) :-
    endpoint_proof(Peer, Proof),
    proof_may(Proof, Host, Right).

proof_may(Proof, Host, Right) :-
    parts(permit, Host, Closures),
    !,
    forall(member(Closure, Closures), call(Closure, Proof, Right)).
proof_may(Proof, _, remote) :-
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
%   | refused(Id, from(Other)) | Id got no message of Peer's in Other's name |
%   | over(Agent, What)        | Agent passed this limit, and ended          |
%   | cell(Agent, Reason)      | the process that ran Agent was ended, since |
%   |                          | it did what it must not, or ended itself    |
%   | order(Agent, Order)      | Peer gave that order to Agent               |
%   | remote(Goal)             | Peer had Goal run                           |

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
