:- module(typhon_sender_authorization,
          [ senders_checked/0,
            senders_check/1,            % +Boolean
            sender_accepted/1,          % +Id
            peer_may_send_for/3,        % +Peer, +Proof, +Id
            mail_accepted/5,            % +Peer, +Id, +Proof, +Mail, -Accepted
            with_proof/5,               % +Endpoint, +Ids, +There, +Term, -Sent
            mail_routes/4               % +Endpoint, +Id, +Mail, -Parts
          ]).

/** <module> Which process may send messages of which agent

In the kernel each process may send messages of each agent. If an option checks
that, a process sends with the messages of its agents a proof of its right to do
so, and messages for which it has no right go through another process.

*Threading*: any thread.
*/

:- multifile
    peers_accept/1,             % Id: other processes accept messages of Id
                                % from this process
    may_send_for/3,             % Peer, Proof, Id
    accept_mail/5,              % Peer, Id, Proof, Mail, Accepted
    proof_for/4,                % Endpoint, Ids, There, Proof
    split_mail/4.               % Endpoint, Id, Mail, Parts

:- dynamic senders_checked/0.   % rights of some processes are restricted

%!  senders_checked is semidet.
%
%   There are processes that must not send messages of each agent.

%!  senders_check(+Boolean) is det.
%
%   Set or reset senders_checked/0.

senders_check(true) :-
    (   senders_checked
    ->  true
    ;   assertz(senders_checked)
    ).
senders_check(false) :-
    retractall(senders_checked).

%!  sender_accepted(+Id) is semidet.
%
%   Other processes accept messages of the agent Id from this process.

sender_accepted(Id) :-
    (   senders_checked
    ->  peers_accept(Id)
    ;   true
    ).

%!  peer_may_send_for(+Peer, +Proof, +Id) is semidet.
%
%   The process at the address Peer, which has sent Proof, may send messages of
%   the agent Id.

peer_may_send_for(Peer, Proof, Id) :-
    (   senders_checked
    ->  may_send_for(Peer, Proof, Id)
    ;   true
    ).

%!  mail_accepted(+Peer, +Id, +Proof, +Mail, -Accepted) is det.
%
%   Accepted are those of Mail, a list of mail(Origin, From, Message) from Peer
%   for the agent Id, that are from the sender which they name.

mail_accepted(Peer, Id, Proof, Mail, Accepted) :-
    (   senders_checked
    ->  accept_mail(Peer, Id, Proof, Mail, Accepted)
    ;   Accepted = Mail
    ).

%!  with_proof(+Endpoint, +Ids, +There, +Term, -Sent) is det.
%
%   Sent goes to Endpoint in place of Term: shown(Proof, Term) if there is a
%   proof for the agents Ids, if Endpoint is their home, or for the agents
%   There; else Term.

with_proof(Endpoint, Ids, There, Term, Sent) :-
    (   senders_checked,
        proof_for(Endpoint, Ids, There, Proof)
    ->  Sent = shown(Proof, Term)
    ;   Sent = Term
    ).

%!  mail_routes(+Endpoint, +Id, +Mail, -Parts) is det.
%
%   Parts are Via-Some: Some of Mail, which is for Id at Endpoint, goes to the
%   endpoint Via first.

mail_routes(Endpoint, Id, Mail, Parts) :-
    (   senders_checked,
        split_mail(Endpoint, Id, Mail, Parts0)
    ->  Parts = Parts0
    ;   Parts = [Endpoint-Mail]
    ).
