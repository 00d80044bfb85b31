:- module(typhon_sender_rights, []).

/** <module> Which processes may send messages in the name of an agent

Where processes have keys, a process may send messages from an agent if it has
the keys of the owner of the agent, or shows the birth of the agent, see
typhon_birth.  Only a process that has or had the agent can show its birth.
Messages to an agent are also accepted from processes that may send in the name
of that agent: these forward messages that they have checked themselves.

The sender may also be `user`, or a term of a bridge: such a sender has no
birth, and is trusted as much as the process that sends the message.

The birth of an agent is shown to its home, and to the processes to which it
went, and to no other process, which could send in its name from then on.  So
messages of an agent away from home go through its home, unless the recipient
has the owner of this process, or has been in this process.

*Threading*: any thread; no state.
*/

:- use_module(library(apply), [include/3, maplist/3, partition/4]).
:- use_module(library(assoc), [get_assoc/3, ord_list_to_assoc/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(ordsets), [ord_memberchk/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module('../../kernel/base/reports', [report/4]).
:- use_module('../../kernel/wire',
              [endpoint_address/1, endpoint_own_proof/1, endpoint_proof/2]).
:- use_module('../../kernel/host', [security_event/3]).
:- use_module('../../kernel/agent',
              [agent/5, agent_home/2, agent_home_endpoint/2]).
:- use_module('../../kernel/travel', [senders_check/1]).
:- use_module(birth,
              [agent_owned/1, agent_owned/2, birth_good/1, birth_shown/2]).

:- multifile
    typhon_keys:begin/0,
    typhon_keys:end/0,
    typhon_sender_authorization:accept_mail/5,
    typhon_sender_authorization:may_send_for/3,
    typhon_sender_authorization:peers_accept/1,
    typhon_sender_authorization:proof_for/4,
    typhon_sender_authorization:split_mail/4.

typhon_keys:begin :-
    senders_check(true).
typhon_keys:end :-
    senders_check(false).

typhon_sender_authorization:peers_accept(Id) :-
    agent_owned(Id).

typhon_sender_authorization:may_send_for(Peer, Births, Id) :-
    may_send_for(Peer, Births, Id).

may_send_for(Peer, Births, Id) :-
    endpoint_proof(Peer, Proof),
    once(has_right(Proof, Births, Id)).

has_right(Proof, _, _) :-
    endpoint_own_proof(Proof).
has_right(certificate(Name), _, Id) :-
    atom(Id),
    agent_owned(Id, Name).
has_right(_, Births, Id) :-
    birth_among(Births, Id, Birth),
    birth_good(Birth).

%   Only one birth of each id is verified, since verification takes long, and a
%   peer may show many.

birth_among(Births, Id, Birth) :-
    is_list(Births),
    member(Birth, Births),
    subsumes_term(birth(Id, _, _, _), Birth),
    !.
birth_among(t(Births), Id, Birth) :-
    get_assoc(Id, Births, Birth).

%   Messages that are not accepted are reported as security events.

typhon_sender_authorization:accept_mail(Peer, Id, Births, Mail, Accepted) :-
    (   may_send_for(Peer, Births, Id)
    ->  Accepted = Mail
    ;   by_id(Births, ById),
        findall(From, member(mail(_, From, _), Mail), Froms0),
        sort(Froms0, Froms),
        include(sender_accepted(Peer, t(ById)), Froms, Good),
        partition(is_from(Good), Mail, Accepted, Forged),
        forall(member(mail(_, From, _), Forged), report_forged(Peer, Id, From))
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

sender_accepted(Peer, Births, From) :-
    (   atom(From),
        agent_home(From, _)
    ->  may_send_for(Peer, Births, From)
    ;   nonvar(From)
    ).

report_forged(Peer, Id, From) :-
    report(warning, forged_senders, Peer, typhon(not_from(Peer, Id, From))),
    (   atom(Id),
        agent(Id, Host, _, _, _)
    ->  security_event(Host, Peer, refused(Id, from(From)))
    ;   true
    ).

                /*******************************
                *             BIRTHS           *
                *******************************/

typhon_sender_authorization:proof_for(Endpoint, Ids, There, Births) :-
    findall(Birth, birth_to_show(Endpoint, Ids, There, Birth), Births0),
    Births0 \== [],
    sort(Births0, Births).

birth_to_show(Endpoint, Ids, There, Birth) :-
    (   member(Id, Ids),
        of_other_owner(Id),
        agent_home_endpoint(Id, Endpoint)
    ;   member(Id, There),
        of_other_owner(Id)
    ),
    birth_shown(Id, Birth).

of_other_owner(Id) :-
    atom(Id),
    \+ agent_owned(Id).

typhon_sender_authorization:split_mail(Endpoint, Id, Mail, Parts) :-
    of_other_owner(Id),
    \+ birth_shown(Id, _),
    maplist(via(Endpoint), Mail, Pairs),
    keysort(Pairs, Sorted),
    group_pairs_by_key(Sorted, Parts).

via(Endpoint, Mail, Via-Mail) :-
    Mail = mail(Origin, From, _),
    (   of_other_owner(From),
        endpoint_address(Origin),
        agent_home_endpoint(From, Home),
        \+ endpoint_address(Home)
    ->  Via = Home
    ;   Via = Endpoint
    ).
