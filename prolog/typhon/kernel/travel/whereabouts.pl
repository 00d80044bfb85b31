:- module(typhon_whereabouts,
          [ agent_seen/4,               % +Id, +Address, +Hops, +Peer
            agent_came/4,               % +Id, +Address, +Hops, +Peer
            agent_left/4,               % +Id, +Address, +Hops, +Peer
            agent_went/5,               % +Id, +Address, +Hops, +Peer, +Process
            agent_left_noted/4,         % +Id, +Address, +Hops, +Peer
            agent_ends/2,               % +Id, +Hops
            ended_agent/1,              % ?Id
            agent_ended/4,              % +Id, +Outcome, +Hops, +Results
            agent_faulty/5,             % +Id, +Outcome, +Stamp, +Address,
                                        % +Hops
            agent_resumed/3,            % +Id, +Stamp, +Hops
            agent_resumed_from/3,       % +Id, +Stamp, +Hops
            agent_heard_of/2,           % +Id, -Hops
            agent_last_seen/2,          % +Id, -Hops
            agent_comes_anew/3,         % +Id, +Hops, -Home
            whereabouts/2               % +Id, -Address
          ]).
:- use_module(library(apply), [include/3, maplist/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/durable', [durable/6]).
:- use_module('../base/durable_changes',
              [durable_drop/3, durable_on/0, durable_put/4]).
:- use_module('../wire',
              [ arrival_permitted/4, endpoint_address/1, endpoint_peer/2,
                endpoint_post/3 ]).
:- use_module('../host', [address_parts/3]).
:- use_module('../agent',
              [agent_home_endpoint/2, is_result_fact/1]).
:- use_module(sender_authorization, [peer_may_send_for/3]).
:- use_module(home,
              [ agent_outcome/2, ended_after/2, home_ended/4, home_faulty/6,
                home_knows/4, home_left/4, home_moved/4, home_resumed/3 ]).
:- use_module(news, [news_send/3]).

/** <module> Whereabouts: forwarding addresses of agents

Every process keeps forwarding addresses of the agents that left it, and sends
news to their homes, see typhon_home.  The oldest forwarding addresses are
discarded.

A process also records which agents came to it and ended there: a sender in
doubt may ask whether its agent arrived.

An agent is in a process, not at an address: if another process has the address
now, the agent has ended with the process that had it before, or has moved on.

*Threading*: any thread; one mutex.  A courier sends news to the home, see
typhon_news, since that may have to connect.
*/

:- setting(forwards, positive_integer, 20000,
           "Forwarding addresses kept by a process").
:- setting(endings, positive_integer, 20000,
           "Records of agents that came to a process and ended there").

:- dynamic
    forward/4,                  % Id, Address, Hops, Process
    ended_here/2.               % Id, Hops

:- multifile
    error:has_type/2,
    typhon_bounds:forgotten/1,
    typhon_identity:ids_anew/0,
    typhon_identity:id_anew/1,
    typhon_endpoint:received/3.

                /*******************************
                *             NEWS             *
                *******************************/

%!  agent_seen(+Id, +Address, +Hops, +Peer) is det.
%
%   Record that Id has arrived at Address, a host of this process, from Peer,
%   and report that to its home.  Peer is `here` if Id came from this process.

agent_seen(Id, _, _, _) :-
    home_knows(Id, _, _, _),            % this process is its home
    !.
agent_seen(Id, Address, Hops, Peer) :-
    agent_came(Id, Address, Hops, Peer).

%!  agent_came(+Id, +Address, +Hops, +Peer) is det.
%
%   As agent_seen/4, for agents that were not born in this process.

agent_came(Id, Address, Hops, Peer) :-
    agent_home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  true
    ;   retractall(forward(Id, _, _, _)),
        (   Home == Peer                % the answer to the hop informs it
        ->  true
        ;   news_send(Home, Id, located(Id, Address, Hops))
        )
    ).

typhon_identity:id_anew(Id) :-
    retractall(forward(Id, _, _, _)),
    retractall(ended_here(Id, _)).

%!  agent_left(+Id, +Address, +Hops, +Peer) is det.
%
%   Record that Id has left this process for Address, a host at the endpoint
%   Peer.

agent_left(Id, Address, Hops, Peer) :-
    (   endpoint_address(Peer)
    ->  true
    ;   process_at(Peer, Process),
        agent_went(Id, Address, Hops, Peer, Process)
    ).

%!  agent_went(+Id, +Address, +Hops, +Peer, +Process) is det.
%
%   As agent_left/4; Process is the process at Peer.

agent_went(Id, Address, Hops, _, Process) :-
    home_left(Id, Address, Hops, Process),
    !.
agent_went(Id, Address, Hops, Peer, Process) :-
    agent_home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  left_home(Id, Address, Hops, Process)
    ;   endpoint_address(Peer)
    ->  true
    ;   remember_forward(Id, Address, Hops, Process)
    ).

%   The end notice may overtake the arrival notice: a forwarding address would
%   then lead back here.  An end after fewer hops is that of a copy that was
%   given up in doubt.

left_home(Id, Address, Hops, Process) :-
    (   ended_after(Id, End)
    ->  (   End >= Hops
        ->  true
        ;   remember_forward(Id, Address, Hops, Process)
        )
    ;   home_moved(Id, Address, Hops, Process)
    ).

process_at(Endpoint, Process) :-
    (   endpoint_peer(Endpoint, process(Process0))
    ->  Process = Process0
    ;   Process = unknown
    ).

%!  agent_left_noted(+Id, +Address, +Hops, +Peer) is det.
%
%   Note in the journal that Id has left, in place of its record.

agent_left_noted(Id, Address, Hops, Peer) :-
    (   durable_on,
        \+ endpoint_address(Peer)
    ->  process_at(Peer, Process),
        durable_put(agent, Id, 0, gone(Address, Hops, Process))
    ;   true
    ).

typhon_identity:ids_anew :-
    retractall(forward(_, _, _, _)),
    retractall(ended_here(_, _)).

typhon_bounds:forgotten(forward(Id, _, _, _)) :-
    durable_drop(agent, Id, 0).

%   After a restore another process may have the address.

:- durable(gone, Id, 0, gone(Address, Hops, Process),
           ( Process = unknown, forward(Id, Address, Hops, _) ),
           assertz(forward(Id, Address, Hops, Process))).

:- durable(agent, Id, 0, gone(Address, Hops, Process),
           forward(Id, Address, Hops, Process),
           forward_restore(Id, Address, Hops, Process)).

forward_restore(Id, Address, Hops, Process) :-
    agent_home_endpoint(Id, Home),
    (   agent_outcome(Id, _)
    ->  true
    ;   home_left(Id, Address, Hops, Process)
    ->  true
    ;   endpoint_address(Home)
    ->  home_moved(Id, Address, Hops, Process)
    ;   assertz(forward(Id, Address, Hops, Process))
    ).

remember_forward(Id, Address, Hops, Process) :-
    bounded(forward(_, _, _, _), typhon_whereabouts:forwards,
            with_mutex(typhon_forward,
                       put_forward(Id, Address, Hops, Process))).

put_forward(Id, Address, Hops, Process) :-
    forward(Id, _, _, _),
    !,
    assertz(forward(Id, Address, Hops, Process)),
    once(retract(forward(Id, _, _, _))).
put_forward(Id, Address, Hops, Process) :-
    assertz(forward(Id, Address, Hops, Process)).

%!  agent_ends(+Id, +Hops) is det.
%
%   Note that Id ends here after Hops hops.  Called before the record of Id is
%   removed, so that a sender that asks always learns that Id has come.

agent_ends(_, 0) :-
    !.                                  % it has no sender
agent_ends(Id, Hops) :-
    bounded(ended_here(_, _), typhon_whereabouts:endings,
            assertz(ended_here(Id, Hops))).

%!  ended_agent(?Id) is nondet.
%
%   Id had come to this process, and has ended here.

ended_agent(Id) :-
    ended_here(Id, _).

%!  agent_ended(+Id, +Outcome, +Hops, +Results:list) is det.
%
%   Report to the home of Id that Id ended after Hops hops, and its Results.

agent_ended(Id, Outcome, Hops, Results) :-
    end_news(Results, Id, Outcome, Hops, News),
    report_to_home(Id, News).

end_news([], Id, Outcome, Hops, ended(Id, Outcome, Hops)) :-
    !.
end_news(Results, Id, Outcome, Hops, ended(Id, Outcome, Hops, Results)).

%!  agent_faulty(+Id, +Outcome, +Stamp, +Address, +Hops) is det.
%
%   Report to the home of Id that Id is faulty with that Outcome, and is kept at
%   Address, a host of this process.

agent_faulty(Id, Outcome, Stamp, Address, Hops) :-
    report_to_home(Id, faulty(Id, Outcome, Stamp, Address, Hops)).

%!  agent_resumed(+Id, +Stamp, +Hops) is det.
%
%   Report to the home of Id that Id was resumed after the fault of that Stamp.

agent_resumed(Id, Stamp, Hops) :-
    report_to_home(Id, resumed(Id, Stamp, Hops)).

report_to_home(Id, News) :-
    agent_home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  news(here, News)
    ;   news_send(Home, Id, News)
    ).

%!  agent_resumed_from(+Id, +Stamp, +Hops) is det.
%
%   As agent_resumed/3, for a caller in another process: the home takes later
%   requests of this process after the report.  May wait for a connection.

agent_resumed_from(Id, Stamp, Hops) :-
    agent_home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  home_resumed(Id, Stamp, Hops)
    ;   catch(endpoint_post(Home, whereabouts, [resumed(Id, Stamp, Hops)]),
              error(_, _),
              true)                     % it will get the news later
    ).

typhon_endpoint:received(whereabouts, All, Peer) :-
    is_list(All),
    !,
    receive_news(All, [], Peer).
typhon_endpoint:received(whereabouts, shown(Births, All), Peer) :-
    receive_news(All, Births, Peer).

receive_news(All, Births, Peer) :-
    include(news_accepted(Peer, Births), All, Accepted),
    process_at(Peer, Process),
    maplist(news(Process), Accepted).

news_accepted(Peer, Births, News) :-
    arrival_permitted(news, whereabouts, News, Peer),
    arg(1, News, Id),
    peer_may_send_for(Peer, Births, Id).

news(Process, located(Id, Address, Hops)) :-
    address_parts(Address, _, _),
    home_moved(Id, Address, Hops, Process).
news(Process, ended(Id, Outcome, Hops)) :-
    news(Process, ended(Id, Outcome, Hops, [])).
news(_, ended(Id, Outcome, Hops, Results)) :-
    must_be(list(typhon_payloads), Results),
    home_ended(Id, Outcome, Hops, Results).
news(Process, faulty(Id, Outcome, Stamp, Address, Hops)) :-
    address_parts(Address, _, _),
    home_faulty(Id, Outcome, Stamp, Address, Hops, Process).
news(_, resumed(Id, Stamp, Hops)) :-
    home_resumed(Id, Stamp, Hops).

error:has_type(typhon_payloads, Item) :-
    is_result_fact(Item).

                /*******************************
                *           QUESTIONS          *
                *******************************/

%!  agent_heard_of(+Id, -Hops) is nondet.
%
%   Id, which is not in this process, has made at least Hops hops.

agent_heard_of(Id, Hops) :-
    agent_last_seen(Id, Hops).
agent_heard_of(Id, Hops) :-
    ended_here(Id, Hops).

%!  agent_last_seen(+Id, -Hops) is nondet.
%
%   As agent_heard_of/2, for agents that have not ended here.

agent_last_seen(Id, Hops) :-
    last_seen(Id, _, Hops, _).

%!  agent_comes_anew(+Id, +Hops, -Home) is semidet.
%
%   As far as this process knows, Id, which is not in it, has not made Hops hops
%   before.  Home is `here` if Id was born in this process, else `elsewhere`.

agent_comes_anew(Id, Hops, Home) :-
    home_knows(Id, _, Hops0, _),
    !,
    Hops0 < Hops,
    Home = here.
agent_comes_anew(Id, Hops, elsewhere) :-
    \+ agent_outcome(Id, _),
    \+ ( ( forward(Id, _, Hops0, _) ; ended_here(Id, Hops0) ),
         Hops0 >= Hops ).

%!  whereabouts(+Id, -Address) is semidet.
%
%   Address is the last known host of an agent that is not in this process.
%   Fails if the process to which the agent went is gone.

whereabouts(Id, Address) :-
    last_seen(Id, Address0, _, Process),
    lives(Address0, Process),
    !,
    Address = Address0.

last_seen(Id, Address, Hops, Process) :-
    forward(Id, Address, Hops, Process).
last_seen(Id, Address, Hops, Process) :-
    home_knows(Id, Address, Hops, Process).

lives(_, Process) :-
    memberchk(Process, [here, unknown]),
    !.
lives(Address, Process) :-
    address_parts(Address, _, Endpoint),
    \+ ( endpoint_peer(Endpoint, process(Now)),
         Now \== Process ).
