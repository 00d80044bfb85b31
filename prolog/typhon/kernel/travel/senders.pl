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

As far as the kernel knows each process may speak for each agent. Where an
option checks that, a process shows with what its agents say what entitles it
to, and what must not be said by this process goes through another.

*Threading*: any thread.
*/

:- multifile
    ours/1,                     % Id: others take what it says from us
    speaks/3,                   % Peer, Shown, Id
    believes/5,                 % Peer, Id, Shown, Mail, Believed
    shows/4,                    % Endpoint, Ids, There, Shown
    by_parts/4.                 % Endpoint, Id, Mail, Parts

:- dynamic senders_checked/0.   % while there are processes that must not

%!  senders_checked is semidet.
%!  senders_check(+Boolean) is det.
%!  sender_ours(+Id) is semidet.
%
%   There are processes that must not speak for each agent; from now on there
%   are; other processes take from this one what the agent Id says.

senders_check(true) :-
    (   senders_checked
    ->  true
    ;   assertz(senders_checked)
    ).
senders_check(false) :-
    retractall(senders_checked).

sender_ours(Id) :-
    (   senders_checked
    ->  ours(Id)
    ;   true
    ).

%!  speaks_for(+Peer, +Shown, +Id) is semidet.
%
%   The process at the address Peer, which shows Shown, may speak for the agent
%   Id.

speaks_for(Peer, Shown, Id) :-
    (   senders_checked
    ->  speaks(Peer, Shown, Id)
    ;   true
    ).

%!  mail_believed(+Peer, +Id, +Shown, +Mail, -Believed) is det.
%
%   Of Mail, a list of mail(Origin, From, Message) that has come from Peer for
%   the agent Id, Believed is from the sender that it names.

mail_believed(Peer, Id, Shown, Mail, Believed) :-
    (   senders_checked
    ->  believes(Peer, Id, Shown, Mail, Believed)
    ;   Believed = Mail
    ).

%!  shown(+Endpoint, +Ids, +There, +Term, -Sent) is det.
%
%   What is sent to Endpoint instead of Term: shown(Shown, Term), where there
%   is something to show of the agents Ids, if that is their home, or of the
%   agents There; or Term.

shown(Endpoint, Ids, There, Term, Sent) :-
    (   senders_checked,
        shows(Endpoint, Ids, There, Shown)
    ->  Sent = shown(Shown, Term)
    ;   Sent = Term
    ).

%!  mail_parts(+Endpoint, +Id, +Mail, -Parts) is det.
%
%   Parts are Via-Some, Some of Mail, which is for Id at Endpoint, and Via the
%   endpoint to which it goes at first.

mail_parts(Endpoint, Id, Mail, Parts) :-
    (   senders_checked,
        by_parts(Endpoint, Id, Mail, Parts0)
    ->  Parts = Parts0
    ;   Parts = [Endpoint-Mail]
    ).
