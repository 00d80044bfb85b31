:- module(typhon_whereabouts,
          [ agent_born/2,               % +Id, +Address
            agent_seen/4,               % +Id, +Address, +Hops, +Peer
            agent_left/4,               % +Id, +Address, +Hops, +Peer
            agent_ended/3,              % +Id, +Outcome, +Hops
            agent_reached/3,            % +Id, +Hops, :OnAnswer
            agent_reached_at/4,         % +Id, +Hops, +Endpoint, -Answer
            agent_heard_of/2,           % +Id, -Hops
            whereabouts/2,              % +Id, -Address
            agent_outcome/2,            % +Id, -Outcome
            outcome_wait/3              % +Id, +Seconds, +Asker
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../wire',
              [ endpoint_address/1, endpoint_call/5, endpoint_peer/2,
                endpoint_reply/2, endpoint_request/4 ]).
:- use_module('../host', [address_parts/3, alarm_set/3]).
:- use_module('../agent', [agent/5, agent_home/2]).
:- use_module(news, [news_tell/3]).

/** <module> Where agents went, and how they ended

The home of an agent, the process in which it was born, always knows where
it went and how it ended.  Every process keeps forwarding addresses of the
agents that left it.  Both are ordered by the number of hops: older news
never replace newer ones.  Forwarding addresses and outcomes are bounded;
the oldest are forgotten.

An agent is in a process, not at an address: when another process has the
address now, the agent has died with the one it went to, or has moved on.
A home that was started again knows of its agents what they tell it.

*Threading*: any thread; one mutex per table.  Telling the home is left to
a courier, see typhon_news, since it may have to connect.
*/

:- setting(forwards, positive_integer, 20000,
           "Forwarding addresses kept by a process").
:- meta_predicate agent_reached(+, +, 1).

:- setting(outcomes, positive_integer, 20000,
           "Outcomes of ended agents kept by their home").

:- dynamic
    born/4,                     % Id, Address, Hops, Process: its home is
                                % here, and it has not ended
    forward/4,                  % Id, Address, Hops, Process
    outcome/2,                  % Id, Outcome
    waiter/3.                   % Id, Token, Asker

:- multifile
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

%!  agent_born(+Id, +Address) is det.

agent_born(Id, Address) :-
    assertz(born(Id, Address, 0, here)).

%!  agent_seen(+Id, +Address, +Hops, +Peer) is det.
%
%   Id has arrived at Address, a host of this process, from Peer.

agent_seen(Id, Address, Hops, Peer) :-
    home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  true                            % it is here, and so are we
    ;   retractall(forward(Id, _, _, _)),
        (   Home == Peer                % it knows when it has our answer
        ->  true
        ;   news_tell(Home, Id, located(Id, Address, Hops))
        )
    ).

%!  agent_left(+Id, +Address, +Hops, +Peer) is det.
%
%   Id has left this process for Address, a host at the endpoint Peer.

agent_left(Id, Address, Hops, Peer) :-
    home_endpoint(Id, Home),
    (   endpoint_address(Peer)
    ->  true
    ;   process_at(Peer, Process),
        (   endpoint_address(Home),
            \+ outcome(Id, _)           % else it was given up in doubt
        ->  moved(Id, Address, Hops, Process)
        ;   remember_forward(Id, Address, Hops, Process)
        )
    ).

home_endpoint(Id, Endpoint) :-
    agent_home(Id, Home),
    address_parts(Home, _, Endpoint).

process_at(Endpoint, Process) :-
    (   endpoint_peer(Endpoint, process(Process0))
    ->  Process = Process0
    ;   Process = unknown
    ).

moved(Id, Address, Hops, Process) :-
    with_mutex(typhon_born, moved_(Id, Address, Hops, Process)).

%   The new fact comes before the old one goes: others read meanwhile.  Of
%   whom the home has never heard was born before it was started again.

moved_(Id, Address, Hops, Process) :-
    clause(born(Id, _, Hops0, _), true, Old),
    !,
    (   Hops0 < Hops
    ->  assertz(born(Id, Address, Hops, Process)),
        erase(Old)
    ;   true
    ).
moved_(Id, _, _, _) :-
    outcome(Id, _),
    !.
moved_(Id, Address, Hops, Process) :-
    home_endpoint(Id, Home),
    endpoint_address(Home),
    !,
    assertz(born(Id, Address, Hops, Process)).
moved_(_, _, _, _).

remember_forward(Id, Address, Hops, Process) :-
    with_mutex(typhon_forward,
               (   clause(forward(Id, _, _, _), true, Old)
               ->  assertz(forward(Id, Address, Hops, Process)),
                   erase(Old)
               ;   assertz(forward(Id, Address, Hops, Process))
               )),
    now_and_then(forward(_, _, _, _), forwards).

%   Every 100 times, forget the oldest of what exceeds a setting.

now_and_then(Fact, Setting) :-
    flag(Setting, N, N+1),
    (   N mod 100 =:= 0
    ->  setting(Setting, Max),
        predicate_property(Fact, number_of_clauses(Count)),
        Excess is Count-Max,
        forall(between(1, Excess, _), ignore(retract(Fact)))
    ;   true
    ).

%!  agent_ended(+Id, +Outcome, +Hops) is det.
%
%   Let the home of Id know that it ended after Hops hops.

agent_ended(Id, Outcome, Hops) :-
    home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  ended(Id, Outcome, Hops)
    ;   news_tell(Home, Id, ended(Id, Outcome, Hops))
    ).

ended(Id, Outcome, Hops) :-
    with_mutex(typhon_born, ended_(Id, Outcome, Hops, Askers)),
    forall(member(Asker, Askers), tell_asker(Asker, Outcome)).

%   A copy that was given up in doubt says nothing of an agent that is
%   known to have gone on.

ended_(Id, _, Hops, []) :-
    (   outcome(Id, _)
    ;   born(Id, _, Hops0, _),
        Hops0 > Hops
    ),
    !.
ended_(Id, Outcome, _, Askers) :-
    retractall(born(Id, _, _, _)),
    assertz(outcome(Id, Outcome)),
    now_and_then(outcome(_, _), outcomes),
    waiters(Id, Askers).

%   One by one: see typhon_mailbox.

waiters(Id, Askers) :-
    (   retract(waiter(Id, _, Asker))
    ->  Askers = [Asker|More],
        waiters(Id, More)
    ;   Askers = []
    ).

typhon_endpoint:received(whereabouts, All, Peer) :-
    process_at(Peer, Process),
    maplist(news(Process), All).

news(Process, located(Id, Address, Hops)) :-
    must_be(nonneg, Hops),
    address_parts(Address, _, _),
    moved(Id, Address, Hops, Process).
news(_, ended(Id, Outcome, Hops)) :-
    must_be(nonneg, Hops),
    ended(Id, Outcome, Hops).

%!  agent_reached(+Id, +Hops, :OnAnswer) is det.
%
%   Call OnAnswer with answer(Reached): `true` or `false`, whether Id has made
%   so many hops as far as its home knows, or `unknown`: the home was started
%   after Id was born there; or with what endpoint_request/4 says if the home
%   does not answer.

agent_reached(Id, Hops, OnAnswer) :-
    home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  reached(Id, Hops, Reached),
        call(OnAnswer, answer(Reached))
    ;   endpoint_request(Home, whereabouts, reached(Id, Hops), OnAnswer)
    ).

typhon_endpoint:requested(whereabouts, reached(Id, Hops), _, ReplyTo) :-
    reached(Id, Hops, Reached),
    endpoint_reply(ReplyTo, Reached).

reached(Id, Hops, true) :-
    (   outcome(Id, _)
    ;   hops_of(Id, Hops0),
        Hops0 >= Hops
    ),
    !.
reached(Id, _, false) :-
    hops_of(Id, _),
    !.
reached(_, _, unknown).

hops_of(Id, Hops) :-
    forward(Id, _, Hops, _).
hops_of(Id, Hops) :-
    born(Id, _, Hops, _).
hops_of(Id, Hops) :-
    agent(Id, _, _, _, life(_, Hops, _, _, _, _)).

%!  agent_reached_at(+Id, +Hops, +Endpoint, -Reached) is det.
%
%   Ask the process at Endpoint instead of the home, and wait.
%
%   @error as endpoint_call/5

agent_reached_at(Id, Hops, Endpoint, Reached) :-
    endpoint_call(Endpoint, whereabouts, reached(Id, Hops), answer(Reached),
                  5).

%!  agent_heard_of(+Id, -Hops) is semidet.
%
%   Id, which is not in this process, has made Hops hops at least.

agent_heard_of(Id, Hops) :-
    forward(Id, _, Hops, _),
    !.
agent_heard_of(Id, Hops) :-
    born(Id, _, Hops, _),
    !.

%!  whereabouts(+Id, -Address) is semidet.
%
%   The last that this process knows of an agent that is not in it.  Fails if
%   the process to which it went is no more.

whereabouts(Id, Address) :-
    forward(Id, Address0, _, Process),
    lives(Address0, Process),
    !,
    Address = Address0.
whereabouts(Id, Address) :-
    born(Id, Address0, _, Process),
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

%!  agent_outcome(+Id, -Outcome) is semidet.
%
%   What the home knows.

agent_outcome(Id, Outcome) :-
    outcome(Id, Outcome).

                /*******************************
                *      WAITING FOR THE END     *
                *******************************/

%!  outcome_wait(+Id, +Seconds, +Asker) is det.
%
%   Tell Asker the outcome of Id, whose home is here, when it is known;
%   `timeout` after Seconds and `unknown` if there is no such agent.
%
%   @arg Asker is queue(Queue, Tag) or reply(ReplyTo)

outcome_wait(Id, Seconds, Asker) :-
    with_mutex(typhon_born, wait_or_answer(Id, Seconds, Asker, Answer)),
    (   Answer == wait
    ->  true
    ;   tell_asker(Asker, Answer)
    ).

wait_or_answer(Id, _, _, Outcome) :-
    outcome(Id, Outcome),
    !.
wait_or_answer(Id, Seconds, Asker, wait) :-
    born(Id, _, _, _),
    !,
    flag(typhon_waiter, Token, Token+1),
    assertz(waiter(Id, Token, Asker)),
    (   number(Seconds)
    ->  get_time(Now),
        Stamp is Now+Seconds,
        alarm_set(Stamp, Id, join(Token))
    ;   true
    ).
wait_or_answer(_, _, _, unknown).

typhon_scheduler:fire(Id, join(Token)) :-
    !,
    (   retract(waiter(Id, Token, Asker))
    ->  tell_asker(Asker, timeout)
    ;   true
    ).

typhon_scheduler:over(Id, join(Token)) :-
    \+ waiter(Id, Token, _).

tell_asker(queue(Queue, Tag), Outcome) :-
    catch(thread_send_message(Queue, outcome(Tag, Outcome)),
          error(existence_error(_, _), _), true).
tell_asker(reply(ReplyTo), Outcome) :-
    endpoint_reply(ReplyTo, Outcome).

typhon_endpoint:requested(join, join(Id, Seconds), _Peer, ReplyTo) :-
    outcome_wait(Id, Seconds, reply(ReplyTo)).
