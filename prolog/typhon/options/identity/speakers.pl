:- module(typhon_speakers, []).

/** <module> Processes that may speak for an agent

Where processes have keys, a process may speak for an agent if it has the keys
of its owner, or shows its birth, see typhon_birth, which a process can do that
has or had the agent. And messages to an agent are taken from processes that may
speak for it: they pass on what they have admitted themselves.

The sender may be `user`, or a term of a bridge: that is no id, and as
trustworthy as the process that sends it.

The birth of an agent is shown to its home, and to where it went, and to no
other process: others could speak for it from then on. So what an agent says
away from home goes through its home, unless it goes to one whose way leads
from here.

*Threading*: any thread; no state.
*/

:- use_module(library(apply), [include/3, maplist/3, partition/4]).
:- use_module(library(assoc), [get_assoc/3, ord_list_to_assoc/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(ordsets), [ord_memberchk/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
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
    typhon_senders:ours/1,
    typhon_senders:speaks/3,
    typhon_senders:believes/5,
    typhon_senders:shows/4,
    typhon_senders:by_parts/4.

typhon_keys:begin :-
    senders_check(true).
typhon_keys:end :-
    senders_check(false).

typhon_senders:ours(Id) :-
    agent_owned(Id).

typhon_senders:speaks(Peer, Births, Id) :-
    speaks_for(Peer, Births, Id).

speaks_for(Peer, Births, Id) :-
    endpoint_proof(Peer, Proof),
    once(may_speak(Proof, Births, Id)).

may_speak(Proof, _, _) :-
    endpoint_own_proof(Proof).
may_speak(certificate(Name), _, Id) :-
    atom(Id),
    agent_owned(Id, Name).
may_speak(_, Births, Id) :-
    birth_among(Births, Id, Birth),
    birth_good(Birth).

%   One for each, however many are shown: to look whether one is good takes
%   long.

birth_among(Births, Id, Birth) :-
    is_list(Births),
    member(Birth, Births),
    subsumes_term(birth(Id, _, _, _), Birth),
    !.
birth_among(t(Births), Id, Birth) :-
    get_assoc(Id, Births, Birth).

%   The rest is noted.

typhon_senders:believes(Peer, Id, Births, Mail, Believed) :-
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

                /*******************************
                *             SHOWN            *
                *******************************/

typhon_senders:shows(Endpoint, Ids, There, Births) :-
    findall(Birth, to_show(Endpoint, Ids, There, Birth), Births0),
    Births0 \== [],
    sort(Births0, Births).

to_show(Endpoint, Ids, There, Birth) :-
    (   member(Id, Ids),
        of_others(Id),
        agent_home_endpoint(Id, Endpoint)
    ;   member(Id, There),
        of_others(Id)
    ),
    birth_shown(Id, Birth).

of_others(Id) :-
    atom(Id),
    \+ agent_owned(Id).

typhon_senders:by_parts(Endpoint, Id, Mail, Parts) :-
    of_others(Id),
    \+ birth_shown(Id, _),
    maplist(via(Endpoint), Mail, Pairs),
    keysort(Pairs, Sorted),
    group_pairs_by_key(Sorted, Parts).

via(Endpoint, Mail, Via-Mail) :-
    Mail = mail(Origin, From, _),
    (   of_others(From),
        endpoint_address(Origin),
        agent_home_endpoint(From, Home),
        \+ endpoint_address(Home)
    ->  Via = Home
    ;   Via = Endpoint
    ).
