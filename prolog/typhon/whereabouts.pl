:- module(typhon_whereabouts,
          [ agent_born/2,               % +Id, +Address
            agent_seen/4,               % +Id, +Address, +Hops, +Peer
            agent_left/4,               % +Id, +Address, +Hops, +Peer
            agent_ended/3,              % +Id, +Outcome, +Hops
            agent_reached/3,            % +Id, +Hops, :OnAnswer
            whereabouts/3,              % +Id, -Address, -Hops
            agent_outcome/2,            % +Id, -Outcome
            agent_alive/1,              % ?Id
            outcome_wait/3              % +Id, +Seconds, +Asker
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(agent, [agent_home/2, agent/5]).
:- use_module(host, [address_parts/3]).
:- use_module(endpoint,
              [ endpoint_address/1, endpoint_post/3, endpoint_reply/2,
                endpoint_request/4 ]).
:- use_module(scheduler, [alarm_set/3, scheduler_call/1]).

/** <module> Where agents went, and how they ended

The home of an agent, the process in which it was born, always knows where
it went and how it ended.  Every process keeps forwarding addresses of the
agents that left it.  Both are ordered by the number of hops: older news
never replace newer ones.  Forwarding addresses and outcomes are bounded;
the oldest are forgotten.

*Threading*: any thread; one mutex per table.  Telling the home is left to
a worker, since it may have to connect.
*/

:- setting(forwards, positive_integer, 20000,
           "Forwarding addresses kept by a process").
:- meta_predicate agent_reached(+, +, 1).

:- setting(outcomes, positive_integer, 20000,
           "Outcomes of ended agents kept by their home").
:- setting(news_seconds, number, 300,
           "News for a home that cannot be reached are kept so long").

:- dynamic
    born/3,                     % Id, Address, Hops: alive, home is here
    forward/3,                  % Id, Address, Hops
    outcome/2,                  % Id, Outcome
    waiter/3.                   % Id, Token, Asker

:- multifile
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

%!  agent_born(+Id, +Address) is det.

agent_born(Id, Address) :-
    assertz(born(Id, Address, 0)).

%!  agent_seen(+Id, +Address, +Hops, +Peer) is det.
%
%   Id has arrived at Address, a host of this process, from Peer.

agent_seen(Id, Address, Hops, Peer) :-
    home_endpoint(Id, Home),
    (   endpoint_address(Home)
    ->  true                            % it is here, and so are we
    ;   retractall(forward(Id, _, _)),
        (   Home == Peer                % it knows when it has our answer
        ->  true
        ;   tell(Home, located(Id, Address, Hops))
        )
    ).

%!  agent_left(+Id, +Address, +Hops, +Peer) is det.
%
%   Id has left this process for Address, a host at the endpoint Peer.

agent_left(Id, Address, Hops, Peer) :-
    home_endpoint(Id, Home),
    (   endpoint_address(Peer)
    ->  true
    ;   endpoint_address(Home),
        \+ outcome(Id, _)               % else it was given up in doubt
    ->  moved(Id, Address, Hops)
    ;   remember_forward(Id, Address, Hops)
    ).

home_endpoint(Id, Endpoint) :-
    agent_home(Id, Home),
    address_parts(Home, _, Endpoint).

moved(Id, Address, Hops) :-
    with_mutex(typhon_born, moved_(Id, Address, Hops)).

%   The new fact comes before the old one goes: others read meanwhile.

moved_(Id, Address, Hops) :-
    clause(born(Id, _, Hops0), true, Old),
    Hops0 < Hops,
    !,
    assertz(born(Id, Address, Hops)),
    erase(Old).
moved_(_, _, _).

remember_forward(Id, Address, Hops) :-
    findall(Old, clause(forward(Id, _, _), true, Old), Olds),
    assertz(forward(Id, Address, Hops)),
    forall(member(Old, Olds), erase(Old)),
    now_and_then(forward(_, _, _), forwards).

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
    ;   tell(Home, ended(Id, Outcome, Hops))
    ).

tell(Home, News) :-
    scheduler_call(typhon_whereabouts:post_news(Home, News, 1)).

%   A home that cannot be reached now may be so later: messages and those
%   who wait for the end of the agent depend on it.

post_news(Home, News, Seconds) :-
    catch(endpoint_post(Home, whereabouts, News),
          error(unreachable(_), _),
          news_later(Home, News, Seconds)).

news_later(Home, News, Seconds) :-
    setting(news_seconds, Max),
    (   Seconds > Max
    ->  print_message(silent, typhon(home_unreachable(Home, News)))
    ;   get_time(Now),
        Stamp is Now+Seconds,
        Longer is 2*Seconds,
        alarm_set(Stamp, Home, news(News, Longer))
    ).

typhon_scheduler:fire(Home, news(News, Seconds)) :-
    !,
    scheduler_call(typhon_whereabouts:post_news(Home, News, Seconds)).

ended(Id, Outcome, Hops) :-
    with_mutex(typhon_born, ended_(Id, Outcome, Hops, Askers)),
    forall(member(Asker, Askers), tell_asker(Asker, Outcome)).

%   A copy that was given up in doubt says nothing of an agent that is
%   known to have gone on.

ended_(Id, _, Hops, []) :-
    (   outcome(Id, _)
    ;   born(Id, _, Hops0),
        Hops0 > Hops
    ),
    !.
ended_(Id, Outcome, _, Askers) :-
    retractall(born(Id, _, _)),
    assertz(outcome(Id, Outcome)),
    now_and_then(outcome(_, _), outcomes),
    findall(Asker, retract(waiter(Id, _, Asker)), Askers).

typhon_endpoint:received(whereabouts, News, _Peer) :-
    news(News).

news(located(Id, Address, Hops)) :-
    moved(Id, Address, Hops).
news(ended(Id, Outcome, Hops)) :-
    ended(Id, Outcome, Hops).

%!  agent_reached(+Id, +Hops, :OnAnswer) is det.
%
%   Call OnAnswer with answer(Boolean), whether Id has made so many hops as
%   far as its home knows, or with what endpoint_request/4 says if the home
%   does not answer.  A home that was restarted knows nothing.

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

reached(Id, Hops, Reached) :-
    (   (   outcome(Id, _)
        ;   whereabouts(Id, _, Hops0),
            Hops0 >= Hops
        ;   agent(Id, _, _, _, life(_, Hops0, _, _, _, _)),
            Hops0 >= Hops
        )
    ->  Reached = true
    ;   Reached = false
    ).

%!  whereabouts(+Id, -Address, -Hops) is semidet.
%
%   The last that this process knows of an agent that is not in it.

whereabouts(Id, Address, Hops) :-
    forward(Id, Address, Hops),
    !.
whereabouts(Id, Address, Hops) :-
    born(Id, Address, Hops),
    !.

%!  agent_outcome(+Id, -Outcome) is semidet.
%!  agent_alive(?Id) is nondet.
%
%   What the home knows.

agent_outcome(Id, Outcome) :-
    outcome(Id, Outcome).

agent_alive(Id) :-
    born(Id, _, _).

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
    born(Id, _, _),
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
