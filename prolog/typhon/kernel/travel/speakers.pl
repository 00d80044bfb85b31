:- module(typhon_speakers,
          [ speaks_for/3,               % +Peer, +Births, +Id
            mail_believed/5             % +Peer, +Id, +Births, +Mail, -Believed
          ]).

/** <module> Processes that may speak for an agent

Where processes have keys, a process may speak for an agent if it has the keys
of its owner, or shows its birth, see typhon_birth, which a process can do that has or
had the agent. And messages to an agent are taken from processes that may
speak for it: they pass on what they have admitted themselves.

The sender may be `user`, or a term of a bridge: that is no id, and as
trustworthy as the process that sends it.

*Threading*: in hooks of the endpoint; no state.
*/

:- use_module(library(apply), [include/3, partition/4]).
:- use_module(library(assoc), [get_assoc/3, ord_list_to_assoc/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(ordsets), [ord_memberchk/2]).
:- use_module('../wire',
              [endpoint_keys/1, endpoint_own_proof/1, endpoint_proof/2]).
:- use_module('../host', [security_event/3]).
:- use_module('../agent',
              [ agent/5, agent_home/2, agent_owned/2, birth_good/1,
                birth_unproved/2 ]).

:- multifile typhon_hop:sent_again/2.

typhon_hop:sent_again(Endpoint, Id) :-
    birth_unproved(Endpoint, Id).

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
    birth_among(Births, Id, Birth),
    birth_good(Birth).

%   One for each, however many are shown: to look whether one is good takes long.

birth_among(Births, Id, Birth) :-
    is_list(Births),
    member(Birth, Births),
    subsumes_term(birth(Id, _, _, _), Birth),
    !.
birth_among(t(Births), Id, Birth) :-
    get_assoc(Id, Births, Birth).

%!  mail_believed(+Peer, +Id, +Births, +Mail, -Believed) is det.
%
%   Of Mail, a list of mail(Origin, From, Message) that has come from Peer for
%   the agent Id, Believed is from whom it says. The rest is noted.

mail_believed(Peer, Id, Births, Mail, Believed) :-
    (   speaks_for(Peer, Births, Id)
    ->  Believed = Mail
    ;   by_id(Births, ById),
        findall(From, member(mail(_, From, _), Mail), Froms0),
        sort(Froms0, Froms),
        include(believed(Peer, t(ById)), Froms, Good),
        partition(is_from(Good), Mail, Believed, Forged),
        forall(member(mail(_, From, _), Forged), noted(Peer, Id, From))
    ).

by_id(Births, ById) :-
    findall(Id-Birth,
            ( is_list(Births),
              member(Birth, Births),
              subsumes_term(birth(_, _, _, _), Birth),
              arg(1, Birth, Id),
              atom(Id) ),
            Pairs0),
    sort(1, @<, Pairs0, Pairs),
    ord_list_to_assoc(Pairs, ById).

is_from(Good, mail(_, From, _)) :-
    ord_memberchk(From, Good).

believed(Peer, Births, From) :-
    (   atom(From),
        agent_home(From, _)
    ->  speaks_for(Peer, Births, From)
    ;   nonvar(From)
    ).

noted(Peer, Id, From) :-
    print_message(warning, typhon(not_from(Peer, Id, From))),
    (   atom(Id),
        agent(Id, Host, _, _, _)
    ->  security_event(Host, Peer, refused(Id, from(From)))
    ;   true
    ).
