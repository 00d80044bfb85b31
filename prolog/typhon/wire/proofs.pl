:- module(typhon_proofs,
          [ endpoint_proof/2            % +Peer, -Proof
          ]).
:- use_module(session, [route/2]).

/** <module> How a peer has proved itself

*Threading*: any thread.
*/

:- multifile
    session_proof/2.            % Session, Proof: where it is not the cookie

%!  endpoint_proof(+Peer, -Proof) is det.
%
%   Proof is `cookie`, or certificate(Name): by what the process at the
%   address Peer is known.

endpoint_proof(Peer, Proof) :-
    route(Peer, Session),
    session_proof(Session, Proof0),
    !,
    Proof = Proof0.
endpoint_proof(_, cookie).
