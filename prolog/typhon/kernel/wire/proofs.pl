:- module(typhon_proofs,
          [ endpoint_proof/2,           % +Peer, -Proof
            endpoint_own_proof/1        % ?Proof
          ]).
:- use_module(secure, [secure_directory/1, secure_own/1, secure_proof/1]).
:- use_module(session, [route/2, session_proof/2]).

/** <module> How a peer has proved itself

*Threading*: any thread.
*/

%!  endpoint_proof(+Peer, -Proof) is det.
%
%   Proof is `cookie`, or certificate(Name): by what the process at the
%   address Peer is known.  In the thread of a connection that is what was
%   proved in it, whatever address the peer claims.  Where there is TLS
%   nobody counts as one who has only the cookie: who is not known is
%   certificate(unknown).

endpoint_proof(_, Proof) :-
    secure_proof(Proof0),
    !,
    Proof = Proof0.
endpoint_proof(_, Proof) :-
    \+ secure_directory(_),
    !,
    Proof = cookie.
endpoint_proof(Peer, Proof) :-
    route(Peer, Session),
    !,
    session_proof(Session, Proof).
endpoint_proof(_, certificate(unknown)).

%!  endpoint_own_proof(?Proof) is semidet.
%
%   Who proves himself so has our keys, or, without TLS, our cookie.

endpoint_own_proof(Proof) :-
    (   secure_own(Own)
    ->  Proof = Own
    ;   Proof = cookie
    ).
