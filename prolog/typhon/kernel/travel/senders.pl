:- module(typhon_senders,
          [ senders_checked/0,
            senders_check/1,            % +Boolean
            sender_ours/1,              % +Id
            speaks_for/3,               % +Peer, +Shown, +Id
            mail_believed/5,            % +Peer, +Id, +Shown, +Mail, -Believed
            shown/5,                    % +Endpoint, +Ids, +There, +Term, -Sent
            mail_parts/4                % +Endpoint, +Id, +Mail, -Parts
          ]).

/** <module> Which process may speak for which agent

In the kernel each process may speak for each agent. If an option checks that, a
process sends with the messages of its agents a proof of its right to do so, and
messages for which it has no right go through another process.

*Threading*: any thread.
*/

:- multifile
    ours/1,                     % Id: other processes accept messages of Id
                                % from this process
    speaks/3,                   % Peer, Shown, Id
    believes/5,                 % Peer, Id, Shown, Mail, Believed
    shows/4,                    % Endpoint, Ids, There, Shown
    by_parts/4.                 % Endpoint, Id, Mail, Parts

:- dynamic senders_checked/0.   % rights of some processes are restricted

%!  senders_checked is semidet.
%
%   There are processes that must not speak for each agent.

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

%!  sender_ours(+Id) is semidet.
%
%   Other processes accept messages of the agent Id from this process.

sender_ours(Id) :-
    (   senders_checked
    ->  ours(Id)
    ;   true
    ).

%!  speaks_for(+Peer, +Shown, +Id) is semidet.
%
%   The process at the address Peer, which has sent Shown, may speak for the
%   agent Id.

speaks_for(Peer, Shown, Id) :-
    (   senders_checked
    ->  speaks(Peer, Shown, Id)
    ;   true
    ).

%!  mail_believed(+Peer, +Id, +Shown, +Mail, -Believed) is det.
%
%   Believed are those of Mail, a list of mail(Origin, From, Message) from Peer
%   for the agent Id, that are from the sender which they name.

mail_believed(Peer, Id, Shown, Mail, Believed) :-
    (   senders_checked
    ->  believes(Peer, Id, Shown, Mail, Believed)
    ;   Believed = Mail
    ).

%!  shown(+Endpoint, +Ids, +There, +Term, -Sent) is det.
%
%   Sent goes to Endpoint in place of Term: shown(Shown, Term) if there is a
%   proof for the agents Ids, if Endpoint is their home, or for the agents
%   There; else Term.

shown(Endpoint, Ids, There, Term, Sent) :-
    (   senders_checked,
        shows(Endpoint, Ids, There, Shown)
    ->  Sent = shown(Shown, Term)
    ;   Sent = Term
    ).

%!  mail_parts(+Endpoint, +Id, +Mail, -Parts) is det.
%
%   Parts are Via-Some: Some of Mail, which is for Id at Endpoint, goes to the
%   endpoint Via first.

mail_parts(Endpoint, Id, Mail, Parts) :-
    (   senders_checked,
        by_parts(Endpoint, Id, Mail, Parts0)
    ->  Parts = Parts0
    ;   Parts = [Endpoint-Mail]
    ).
