:- module(typhon_whereabouts,
          [ agent_born/2,               % +Id, +Address
            home_knows/4,               % +Id, -Address, -Hops, -Process
            home_agents/1,              % -Ids
            home_agents_at/2,           % +Endpoint, -Ids
            agent_outcome/2,            % +Id, -Outcome
            outcome_wait/3,             % +Id, +Seconds, +Asker
            agent_arrived/4,            % +Id, +Address, +Hops, +Peer
            visitor_arrived/4,          % +Id, +Address, +Hops, +Peer
            agent_departed_to/4,        % +Id, +Address, +Hops, +Peer
            agent_departed/4,           % +Id, +Address, +Hops, +Process
            departure_noted/4,          % +Id, +Address, +Hops, +Peer
            agent_ends/2,               % +Id, +Hops
            ended_agent/1,              % ?Id
            end_noted/4,                % +Id, +Outcome, +Hops, +Results
            agent_ended/4,              % +Id, +Outcome, +Hops, +Results
            agent_faulty/5,             % +Id, +Outcome, +Stamp, +Address,
                                        % +Hops
            agent_resumed/3,            % +Id, +Stamp, +Hops
            agent_resumed_from/3,       % +Id, +Stamp, +Hops
            agent_location/4,           % +Id, -Address, -Hops, -Process
            agent_known_at/2,           % +Id, -Address
            hop_is_new/3,               % +Id, +Hops, -Home
            whereabouts/2               % +Id, -Address
          ]).

/** <module> Whereabouts of agents: at their home, and where they were

The home of an agent is the process in which it was born.  It records where the
agent went and how it ended, and notifies waiting callers.  Older news never
replaces newer news: the number of hops gives the order.  The oldest outcomes
are discarded.  A home that was restarted learns of its agents by their news.

Every process keeps forwarding addresses of the agents that left it, and sends
news to their homes, see news.pl.  The oldest forwarding addresses are
discarded.

A process also records which agents came to it and ended there: a sender in
doubt may ask whether its agent arrived.

An agent is in a process, not at an address: if another process has the address
now, the agent has ended with the process that had it before, or has moved on.

*Threading*: any thread; one mutex for all changes of locations.  A courier
sends news to the home, since that may have to connect.
*/

:- use_module(library(apply), [include/3, maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../agent', [agent_home_endpoint/2, is_result_fact/1]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/durable',
              [ durable/5, durable/6, durable_assertz/1, durable_drop/3,
                durable_drop_all/2, durable_on/0, durable_put/4 ]).
:- use_module('../base/fifo', [fifo_send/2]).
:- use_module('../host', [address_parts/3, alarm_in/3, scheduler_call/1]).
:- use_module('../wire',
              [ arrival_permitted/4, endpoint_address/1, endpoint_gone/1,
                endpoint_peer/2, endpoint_post/3, endpoint_reply/2,
                endpoint_request/4 ]).
:- use_module(news, [news_send/3]).
:- use_module(outcomes, [results_keep/2]).
:- use_module(sender_authorization, [peer_may_send_for/3]).

:- setting(outcomes, positive_integer, 20000,
           "Outcomes of ended agents kept by their home").
:- setting(forwards, positive_integer, 20000,
           "Forwarding addresses kept by a process").
:- setting(endings, positive_integer, 20000,
           "Records of agents that came to a process and ended there").

:- dynamic
    born/4,                     % Id, Address, Hops, Process: its home is
                                % here, and it has not ended
    outcome/3,                  % Id, Outcome, Hops
    faulty/3,                   % Id, Outcome, Age: its callers were notified of
                                % Outcome; `none` if the agent was resumed
                                % since
    waiter/3,                   % Id, Token, Asker
    forward/4,                  % Id, Address, Hops, Process
    ended_here/2.               % Id, Hops

:- multifile
    ended_with/4,               % Id, Outcome, Hops, Results: Id has ended here
    known_at/2,                 % Id, Address: an option knows where Id is
    error:has_type/2,
    typhon_bounds:forgotten/1,
    typhon_identity:ids_anew/0,
    typhon_identity:id_anew/1,
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

typhon_identity:ids_anew :-
    retractall(born(_, _, _, _)),
    retractall(outcome(_, _, _)),
    retractall(faulty(_, _, _)),
    retractall(waiter(_, _, _)),
    retractall(forward(_, _, _, _)),
    retractall(ended_here(_, _)).

typhon_identity:id_anew(Id) :-
    retractall(born(Id, _, _, _)),
    retractall(outcome(Id, _, _)),
    retractall(faulty(Id, _, _)),
    retractall(forward(Id, _, _, _)),
    retractall(ended_here(Id, _)).

typhon_bounds:forgotten(outcome(Id, _, _)) :-
    durable_drop_all(outcome, Id).
typhon_bounds:forgotten(forward(Id, _, _, _)) :-
    durable_drop(agent, Id, 0).

                /*******************************
                *           AT HOME            *
                *******************************/

%!  agent_born(+Id, +Address) is det.
%
%   Record that Id was born on the host Address of this process.

agent_born(Id, Address) :-
    put_born(birth, Id, Address, 0, here).

%   After a restore another process may have the address.

:- durable(born, Id, 0, born(Address, Hops, Process),
           born_item(Id, Address, Hops, Process),
           assertz(born(Id, Address, Hops, Process))).

born_item(Id, Address, Hops, Process) :-
    born(Id, Address, Hops, Process0),
    ( Process0 == here -> Process = here ; Process = unknown ).

:- durable(outcome, Id, _, Outcome-Hops, outcome(Id, Outcome, Hops)).
:- durable(faulty, Id, 0, faulty(Outcome, Age), faulty(Id, Outcome, Age)).
:- durable(flag, Name, N, '', ( Name = outcomes, flag(Name, N, N) ),
           set_flag(Name, N)).

%!  home_knows(+Id, -Address, -Hops, -Process) is semidet.
%
%   Id, which has not ended, was last reported at Address, in Process.

home_knows(Id, Address, Hops, Process) :-
    born(Id, Address0, Hops0, Process0),
    !,
    Address = Address0, Hops = Hops0, Process = Process0.

%!  home_agents(-Ids:list(atom)) is det.
%
%   Agents that were born in this process and have not ended.

home_agents(Ids) :-
    findall(Id, born(Id, _, _, _), Ids0),
    sort(Ids0, Ids).

%!  home_agents_at(+Endpoint, -Ids:list(atom)) is det.
%
%   The agents of home_agents/1 that were last known to be in the process at
%   Endpoint.

home_agents_at(Endpoint, Ids) :-
    findall(Id,
            ( born(Id, Address, _, _),
              address_parts(Address, _, Endpoint) ),
            Ids0),
    sort(Ids0, Ids).

%!  agent_outcome(+Id, -Outcome) is semidet.
%
%   Id, whose home is here, has ended with Outcome.

agent_outcome(Id, Outcome) :-
    outcome(Id, Outcome, _).

%   home_moved(+Id, +Address, +Hops, +Process): record that Id has gone to
%   Address, in Process, by hop number Hops.

home_moved(Id, Address, Hops, Process) :-
    debug(typhon(hop), '~w hop ~D: home records that it is on ~w',
          [Id, Hops, Address]),
    with_mutex(typhon_born, located(Id, Address, Hops, Process, news)).

%   located(+Id, +Address, +Hops, +Process, +By): By is `news`, or `leaving` if
%   Id has left this process; then the caller notes it in the journal.
%
%   A new fact is added before the old one is removed, because other threads
%   read meanwhile.  An agent without a fact was born before its home was
%   restarted, or ended here: the end notice may overtake the arrival notice,
%   and an end after fewer hops is that of a copy that was given up in doubt.

located(Id, Address, Hops, Process, By) :-
    born(Id, _, Hops0, _),
    !,
    (   Hops0 < Hops
    ->  put_born(By, Id, Address, Hops, Process),
        once(retract(born(Id, _, _, _)))
    ;   true
    ).
located(Id, Address, Hops, Process, By) :-
    \+ outcome(Id, _, _),
    agent_home_endpoint(Id, Home),
    endpoint_address(Home),
    !,
    put_born(By, Id, Address, Hops, Process).
located(Id, Address, Hops, Process, leaving) :-
    \+ ( ( forward(Id, _, Known, _) ; outcome(Id, _, Known) ),
         Known >= Hops ),
    !,
    bounded(forward(_, _, _, _), typhon_whereabouts:forwards,
            put_forward(Id, Address, Hops, Process)).
located(_, _, _, _, _).

put_born(By, Id, Address, Hops, Process) :-
    (   By == leaving
    ->  true
    ;   durable_put(born, Id, 0, born(Address, Hops, Process))
    ),
    assertz(born(Id, Address, Hops, Process)).

put_forward(Id, Address, Hops, Process) :-
    assertz(forward(Id, Address, Hops, Process)),
    ignore(( forward(Id, _, Hops0, _),
             Hops0 < Hops,
             retract(forward(Id, _, Hops0, _)) )).

%   home_ended(+Id, +Outcome, +Hops, +Results:list): record that Id has ended
%   after Hops hops, with Results.

home_ended(Id, Outcome, Hops, Results) :-
    debug(typhon(agent), '~w: home records that it ended after ~D hops, ~p',
          [Id, Hops, Outcome]),
    with_mutex(typhon_born, ended(Id, Outcome, Hops, Results, Askers)),
    forall(member(Asker, Askers), send_outcome(Asker, Outcome)).

%   The end of a copy that was given up in doubt is ignored if the agent is
%   known to have gone on.

ended(Id, _, Hops, _, []) :-
    (   outcome(Id, _, _)
    ;   born(Id, _, Hops0, _),
        Hops0 > Hops
    ),
    !.
ended(Id, Outcome0, Hops, Results, Askers) :-
    durable_drop(born, Id, 0),
    durable_drop(agent, Id, 0),
    durable_drop(faulty, Id, 0),
    (   retract(faulty(Id, Told, _))
    ->  last_outcome(Outcome0, Told, Outcome)
    ;   Outcome = Outcome0
    ),
    ( Results == [] -> true ; results_keep(Id, Results) ),
    bounded(outcome(_, _, _), typhon_whereabouts:outcomes,
            durable_assertz(outcome(Id, Outcome, Hops))),
    retractall(born(Id, _, _, _)),
    waiters(Id, Askers).

%   An agent that is disposed of while faulty ends with the outcome of its
%   fault.  Any other outcome means that the agent was resumed; the news of that
%   may come later.

last_outcome(disposed, Told, Told) :-
    Told \== none,
    !.
last_outcome(Outcome, _, Outcome).

%   home_faulty(+Id, +Outcome, +Stamp, +Address, +Hops, +Process): record that
%   Id is faulty with that Outcome, and is kept at Address, in Process, after
%   Hops hops.

home_faulty(Id, Outcome, Stamp, Address, Hops, Process) :-
    debug(typhon(agent), '~w: home records that it is faulty, ~p',
          [Id, Outcome]),
    with_mutex(typhon_born,
               ( located(Id, Address, Hops, Process, news),
                 has_fault(Id, Outcome, Stamp, Hops, Askers) )),
    forall(member(Asker, Askers), send_outcome(Asker, Outcome)).

has_fault(Id, Outcome, Stamp, Hops, Askers) :-
    born(Id, _, Hops0, _),
    Hops0 =< Hops,
    \+ ( faulty(Id, _, Age), Age @>= Hops-Stamp ),
    !,
    put_fault(Id, Outcome, Hops-Stamp),
    waiters(Id, Askers).
has_fault(_, _, _, _, []).

%   home_resumed(+Id, +Stamp, +Hops): record that Id was resumed after the
%   fault of that Stamp. This news may overtake that of the fault: the ages
%   show the order.

home_resumed(Id, Stamp, Hops) :-
    debug(typhon(agent), '~w: home records that it is resumed', [Id]),
    with_mutex(typhon_born, resumed(Id, Hops-Stamp)).

resumed(Id, Age) :-
    (   born(Id, _, _, _),
        \+ ( faulty(Id, _, Age0), Age0 @> Age )
    ->  put_fault(Id, none, Age)
    ;   true
    ).

put_fault(Id, Outcome, Age) :-
    retractall(faulty(Id, _, _)),
    durable_assertz(faulty(Id, Outcome, Age)).

%   Retracts waiters one by one, see typhon_mailbox.

waiters(Id, Askers) :-
    (   retract(waiter(Id, _, Asker))
    ->  Askers = [Asker|More],
        waiters(Id, More)
    ;   Askers = []
    ).

                /*******************************
                *      WAITING FOR THE END     *
                *******************************/

%!  outcome_wait(+Id, +Seconds, +Asker) is det.
%
%   Report to Asker the outcome of Id, whose home is here, when it is known;
%   `timeout` after Seconds, and `unknown` if there is no such agent.
%
%   @arg Asker is queue(Queue, Tag), reply(ReplyTo) or call(Closure), which is
%   called in the thread that reports the end, and must be quick

outcome_wait(Id, Seconds, Asker) :-
    with_mutex(typhon_born, wait_or_answer(Id, Seconds, Asker, Answer)),
    (   Answer == wait
    ->  true
    ;   send_outcome(Asker, Answer)
    ).

wait_or_answer(Id, _, _, Outcome) :-
    (   outcome(Id, Outcome, _)
    ;   faulty(Id, Outcome, _),
        Outcome \== none
    ),
    !.
wait_or_answer(Id, Seconds, Asker, wait) :-
    born(Id, _, _, _),
    !,
    flag(typhon_waiter, Token, Token+1),
    assertz(waiter(Id, Token, Asker)),
    (   number(Seconds)
    ->  alarm_in(Seconds, Id, join(Token))
    ;   true
    ).
wait_or_answer(_, _, _, unknown).

typhon_scheduler:fire(Id, join(Token)) :-
    !,
    (   waiter(Id, Token, _),
        in_doubt(Id, Endpoint)
    ->  alarm_in(1, Id, looked(Token)),
        scheduler_call(typhon_whereabouts:look(Endpoint, Id, Token))
    ;   timed_out(Id, Token)
    ).
typhon_scheduler:fire(Id, looked(Token)) :-
    !,
    timed_out(Id, Token).

timed_out(Id, Token) :-
    (   retract(waiter(Id, Token, Asker))
    ->  at_timeout(Id, Outcome),
        send_outcome(Asker, Outcome)
    ;   true
    ).

%   in_doubt(+Id, -Endpoint) is semidet: the connection to the process of Id has
%   ended, and was not made again, as there is nothing to send.

in_doubt(Id, Endpoint) :-
    born(Id, Host, _, Process),
    Process \== unknown,
    address_parts(Host, _, Endpoint),
    \+ endpoint_gone(Endpoint),
    endpoint_peer(Endpoint, state(down)),
    endpoint_peer(Endpoint, pending(0)),
    !.

look(Endpoint, Id, Token) :-
    endpoint_request(Endpoint, whereabouts, reached(Id, 0),
                     typhon_whereabouts:looked(Id, Token)).

looked(Id, Token, _) :-
    timed_out(Id, Token).

%   Before the timeout the news of a hop from there may be under way.

at_timeout(Id, lost(Host)) :-
    born(Id, Host, _, Process),
    Process \== unknown,                % it may be kept elsewhere
    address_parts(Host, _, Endpoint),
    endpoint_gone(Endpoint),
    !.
at_timeout(_, timeout).

typhon_scheduler:over(Id, Alarm) :-
    ( Alarm = join(Token) ; Alarm = looked(Token) ),
    !,
    \+ waiter(Id, Token, _).

send_outcome(queue(Queue, Tag), Outcome) :-
    ignore(fifo_send(Queue, outcome(Tag, Outcome))).
send_outcome(reply(ReplyTo), Outcome) :-
    endpoint_reply(ReplyTo, Outcome).
send_outcome(call(Closure), Outcome) :-
    call(Closure, Outcome).

typhon_endpoint:requested(join, join(Id, Seconds), _Peer, ReplyTo) :-
    outcome_wait(Id, Seconds, reply(ReplyTo)).

                /*******************************
                *        ON OTHER HOSTS        *
                *******************************/

%!  agent_arrived(+Id, +Address, +Hops, +Peer) is det.
%
%   Record that Id has arrived at Address, a host of this process, from Peer,
%   and report that to its home.  Peer is `here` if Id came from this process.

agent_arrived(Id, _, _, _) :-
    home_knows(Id, _, _, _),            % this process is its home
    !.
agent_arrived(Id, Address, Hops, Peer) :-
    visitor_arrived(Id, Address, Hops, Peer).

%!  visitor_arrived(+Id, +Address, +Hops, +Peer) is det.
%
%   As agent_arrived/4, for agents that were not born in this process.

visitor_arrived(Id, Address, Hops, Peer) :-
    agent_home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  true
    ;   retractall(forward(Id, _, _, _)),
        (   Home == Peer                % the answer to the hop informs it
        ->  true
        ;   news_send(Home, Id, located(Id, Address, Hops))
        )
    ).

%!  agent_departed_to(+Id, +Address, +Hops, +Peer) is det.
%
%   Record that Id has left this process for Address, a host at the endpoint
%   Peer.

agent_departed_to(Id, Address, Hops, Peer) :-
    (   endpoint_address(Peer)
    ->  true
    ;   process_at(Peer, Process),
        agent_departed(Id, Address, Hops, Process)
    ).

%!  agent_departed(+Id, +Address, +Hops, +Process) is det.
%
%   As agent_departed_to/4; Process is the process of Address, another one.

agent_departed(Id, Address, Hops, Process) :-
    with_mutex(typhon_born, located(Id, Address, Hops, Process, leaving)).

process_at(Endpoint, Process) :-
    (   endpoint_peer(Endpoint, process(Process0))
    ->  Process = Process0
    ;   Process = unknown
    ).

%!  departure_noted(+Id, +Address, +Hops, +Peer) is det.
%
%   Note in the journal that Id has left, in place of its record.

departure_noted(Id, Address, Hops, Peer) :-
    (   durable_on,
        \+ endpoint_address(Peer)
    ->  process_at(Peer, Process),
        durable_put(agent, Id, 0, gone(Address, Hops, Process))
    ;   true
    ).

%   After a restore another process may have the address.

:- durable(gone, Id, 0, gone(Address, Hops, Process),
           ( Process = unknown, forward(Id, Address, Hops, _) ),
           assertz(forward(Id, Address, Hops, Process))).

:- durable(agent, Id, 0, gone(Address, Hops, Process),
           forward(Id, Address, Hops, Process),
           agent_departed(Id, Address, Hops, Process)).

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

%!  end_noted(+Id, +Outcome, +Hops, +Results:list) is det.
%
%   Options note that Id ends here after Hops hops, and its Results.

end_noted(Id, Outcome, Hops, Results) :-
    forall(ended_with(Id, Outcome, Hops, Results), true).

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
    ->  news(here-here, News)
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
    maplist(news(Peer-Process), Accepted).

news_accepted(Peer, Births, News) :-
    arrival_permitted(news, whereabouts, News, Peer),
    arg(1, News, Id),
    peer_may_send_for(Peer, Births, Id).

%   An agent that is kept elsewhere is located by the process that it left.

news(Peer-Process0, located(Id, Address, Hops)) :-
    address_parts(Address, _, Endpoint),
    ( Endpoint == Peer -> Process = Process0 ; Process = unknown ),
    home_moved(Id, Address, Hops, Process).
news(From, ended(Id, Outcome, Hops)) :-
    news(From, ended(Id, Outcome, Hops, [])).
news(_, ended(Id, Outcome, Hops, Results)) :-
    must_be(list(typhon_payloads), Results),
    home_ended(Id, Outcome, Hops, Results).
news(_-Process, faulty(Id, Outcome, Stamp, Address, Hops)) :-
    address_parts(Address, _, _),
    home_faulty(Id, Outcome, Stamp, Address, Hops, Process).
news(_, resumed(Id, Stamp, Hops)) :-
    home_resumed(Id, Stamp, Hops).

error:has_type(typhon_payloads, Item) :-
    is_result_fact(Item).

                /*******************************
                *           QUESTIONS          *
                *******************************/

%!  agent_location(+Id, -Address, -Hops, -Process) is nondet.
%
%   As far as this process knows, Id, which is not in it, went to Address, in
%   Process, by hop number Hops, and has not ended.

agent_location(Id, Address, Hops, Process) :-
    forward(Id, Address, Hops, Process).
agent_location(Id, Address, Hops, Process) :-
    home_knows(Id, Address, Hops, Process).

%!  agent_known_at(+Id, -Address) is semidet.
%
%   An option knows that Id, wherever its home is, has not ended, and was last at
%   Address.

agent_known_at(Id, Address) :-
    known_at(Id, Address0),
    !,
    Address = Address0.

%!  hop_is_new(+Id, +Hops, -Home) is semidet.
%
%   As far as this process knows, Id, which is not in it, has not made Hops hops
%   before, and has not ended.  Home is `here` if Id was born in this process,
%   else `elsewhere`.  The tables are read in this order because an agent that
%   ends meanwhile is noted in the later ones before it is removed from the
%   first.

hop_is_new(Id, Hops, Home) :-
    \+ ( made_hops(Id, Made), Made >= Hops ),
    \+ outcome(Id, _, _),
    ( born(Id, _, _, _) -> Home = here ; Home = elsewhere ).

made_hops(Id, Hops) :-
    born(Id, _, Hops, _).
made_hops(Id, Hops) :-
    forward(Id, _, Hops, _).
made_hops(Id, Hops) :-
    ended_here(Id, Hops).

%!  whereabouts(+Id, -Address) is semidet.
%
%   Address is the last known host of an agent that is not in this process.
%   Fails if the process to which the agent went is gone.

whereabouts(Id, Address) :-
    agent_location(Id, Address0, _, Process),
    lives(Address0, Process),
    !,
    Address = Address0.

lives(_, Process) :-
    memberchk(Process, [here, unknown]),
    !.
lives(Address, Process) :-
    address_parts(Address, _, Endpoint),
    \+ ( endpoint_peer(Endpoint, process(Now)),
         Now \== Process ).
