% Expects: setting/2; publish/1, tell_robots/3, tell_owner/2, offer_bids/3,
%   arrived/3, onward/2, undertake/2.
% Gives: main/0, and all else that a node needs: it includes the files here.

/*  A node: the static agent of a host that takes part in auctions.  It
    passes on messages (flooding.pl), bids for the robot of its host
    (contractor.pl), and auctions the tasks that are posted at its host
    (auctioneer.pl).  murdoch.pl and anta.pl include this file and define how
    messages travel between auctioneers and robots:

        publish(+Body)                          to all nodes
        tell_robots(+Job, +Hosts, +Body)        to the nodes of Hosts
        tell_owner(+Job, +Body)                 to the auctioneer of Job
        offer_bids(+Job, +Round, +Bids)         the bids of this host
        arrived(+Body, +From, +Now)             handles a message over a link
        onward(+Body, -Onward)                  how a node passes a flood on
        undertake(+What, +Now)                  handles an item of the agenda

    All that a node does between two messages is native Prolog: once it knows
    its peers it stops only at the receive/2 of node_loop/0.

    A Job is job(Host, Number), where Host is the host of the auctioneer.
    Each auction of a task is a Round.
*/

:- include('../../lib/parameters').
:- include('../../lib/tell').
:- include('../common/requirements').
:- include('../common/backoff_interval').
:- include('../common/communications').
:- include(agenda).
:- include(memory).
:- include(flooding).
:- include(contractor).
:- include(jobs).
:- include(awards).
:- include(auctioneer).

default(window, 10, range(0, 100, 0.5), "seconds for bids").
default(answer, 10, range(0, 100, 0.5),
        "seconds for the answers to an award").
default(renew, 20, range(1, 200, 0.5),
        "seconds from one renewal to the next").
default(contract, 60, range(1, 600, 0.5), "seconds until a contract ends").
default(tries, 3, range(0, 20, 1), "rounds without a back-off between them").
default(sending, at_once, ground, "at_once, or one_by_one(Share)").
default(beta, 1, range(0, 5, 0.5), "of the first back-off").
default(bi_min, 10, range(0, 100, 0.5), "seconds, of equation 7.7").
default(bi_max, 500, range(0, 2000, 1.0), "seconds, of equation 7.5").
default(level, 10, range(0, 50, 1), "of a broadcast tree").
default(memory, 1000, range(1, 10000, 1), "floods that a node remembers").
default(jobs, 100, range(1, 1000, 1),
        "jobs of other nodes that it remembers").

%   Messages of other nodes may arrive before the list of peers; they stay in
%   the mailbox until then.

main :-
    first_id,
    assertz(agenda(0, [])),
    receive(_-peers(Peers)),
    know(Peers),
    node_loop.

know(Peers) :-
    retractall(peer(_, _)),
    forall(member(Host-Node, Peers), assertz(peer(Host, Node))).

heard(link(Due, From, Load), _) :-
    !,
    crossed(Due, From, Load).
heard(answer(Ref, Answer), Robot) :-
    !,
    answered(Answer, Ref, Robot).
heard(Message, From) :-
    hear(Message, From),
    !.
heard(_, _).

hear(Message, Robot) :-
    from_robot(Message, Robot).
hear(post(Task), _) :-
    post(Task).
hear(peers(Peers), _) :-
    know(Peers).
hear(account, _) :-
    log_communications.

perform(flooded(From, Id, Body), Now) :-
    !,
    flooded(From, Id, Body, Now).
perform(told(From, Body), Now) :-
    !,
    arrived(Body, From, Now).
perform(What, Now) :-
    (   undertake(What, Now)
    ->  true
    ;   auction_due(What)
    ->  true
    ;   contract_due(What)
    ->  true
    ;   true                            % the message is obsolete
    ).

%   body_kind(+Body, -Kind): Kind is the name under which a message is counted.

body_kind(owner(_, Body), Kind) :-
    !,
    body_kind(Body, Kind).
body_kind(robots(_, _, Body), Kind) :-
    !,
    body_kind(Body, Kind).
body_kind(flooded(Body), Kind) :-
    !,
    body_kind(Body, Kind).
body_kind(report(_, _, _), ack) :-
    !.
body_kind(bids(_, _), bid) :-
    !.
body_kind(Body, Kind) :-
    functor(Body, Kind, _).
