:- module(typhon_speakers,
          [ speaks_for/3,               % +Peer, +Births, +Id
            mail_believed/5             % +Peer, +Id, +Births, +Mail, -Believed
          ]).

/** <module> Who may say what an agent says

Where processes have keys, a process may speak for an agent if it has the keys
of its owner, or shows its birth, see typhon_birth, which it can do who has or
had the agent. And what somebody has to say to an agent is taken from who may
speak for that one: it passes on what it has let in itself.

Who sends may be `user`, or somebody beyond a bridge: that is no id, and the
word of the process that says so.

*Threading*: in hooks of the endpoint; no state.
*/

:- use_module(library(apply), [partition/4]).
:- use_module(library(lists), [member/2]).
:- use_module('../wire',
              [endpoint_keys/1, endpoint_own_proof/1, endpoint_proof/2]).
:- use_module('../host', [audit/3]).
:- use_module('../agent',
              [agent/5, agent_home/2, agent_owned/2, birth_good/1]).

%!  speaks_for(+Peer, +Births, +Id) is semidet.
%
%   The process at the address Peer, which shows Births, may speak for the
%   agent Id.

speaks_for(Peer, Births, Id) :-
    (   endpoint_keys(_)
    ->  endpoint_proof(Peer, Proof),
        once(may_speak(Proof, Births, Id))
    ;   true
    ).

may_speak(Proof, _, _) :-
    endpoint_own_proof(Proof).
may_speak(certificate(Name), _, Id) :-
    atom(Id),
    agent_owned(Id, Name).
may_speak(_, Births, Id) :-
    is_list(Births),
    member(Birth, Births),
    subsumes_term(birth(Id, _, _, _), Birth),
    birth_good(Birth).

%!  mail_believed(+Peer, +Id, +Births, +Mail, -Believed) is det.
%
%   Of Mail, a list of mail(Origin, From, Message) that has come from Peer for
%   the agent Id, Believed is from whom it says. The rest is noted.

mail_believed(Peer, Id, Births, Mail, Believed) :-
    (   speaks_for(Peer, Births, Id)
    ->  Believed = Mail
    ;   partition(believed(Peer, Births), Mail, Believed, Forged),
        forall(member(mail(_, From, _), Forged), noted(Peer, Id, From))
    ).

believed(Peer, Births, mail(_, From, _)) :-
    (   atom(From),
        agent_home(From, _)
    ->  speaks_for(Peer, Births, From)
    ;   nonvar(From)
    ).

noted(Peer, Id, From) :-
    print_message(warning, typhon(not_from(Peer, Id, From))),
    (   atom(Id),
        agent(Id, Host, _, _, _)
    ->  audit(Host, Peer, refused(Id, from(From)))
    ;   true
    ).
