:- module(typhon_home,
          [ agent_born/2,               % +Id, +Address
            home_moved/4,               % +Id, +Address, +Hops, +Process
            home_left/4,                % +Id, +Address, +Hops, +Process
            home_ended/4,               % +Id, +Outcome, +Hops, +Results
            home_faulty/6,              % +Id, +Outcome, +Stamp, +Address,
                                        % +Hops, +Process
            home_resumed/3,             % +Id, +Stamp, +Hops
            home_knows/4,               % +Id, -Address, -Hops, -Process
            home_agents/1,              % -Ids
            home_agents_at/2,           % +Endpoint, -Ids
            agent_outcome/2,            % +Id, -Outcome
            ended_after/2,              % +Id, -Hops
            outcome_wait/3              % +Id, +Seconds, +Asker
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/4]).
:- use_module('../base/bounds', [bounded/3]).
:- use_module('../base/durable', [durable/5, durable/6, durable_assertz/1]).
:- use_module('../base/durable_changes',
              [durable_drop/3, durable_drop_all/2, durable_put/4]).
:- use_module('../wire',
              [endpoint_address/1, endpoint_gone/1, endpoint_reply/2]).
:- use_module('../host', [address_parts/3, alarm_in/3]).
:- use_module('../agent', [agent_home_endpoint/2]).
:- use_module(outcomes, [results_keep/2]).

/** <module> The home's records of its agents

The home of an agent is the process in which it was born.  It records where the
agent went and how it ended, and notifies waiting callers.  Older news never
replaces newer news: the number of hops gives the order.  The oldest outcomes
are discarded.  A home that was restarted learns of its agents by their news.

*Threading*: any thread; one mutex.
*/

%   Named after typhon_whereabouts because users set it by that name.

:- setting(typhon_whereabouts:outcomes, positive_integer, 20000,
           "Outcomes of ended agents kept by their home").

:- dynamic
    born/4,                     % Id, Address, Hops, Process: its home is
                                % here, and it has not ended
    outcome/3,                  % Id, Outcome, Hops
    faulty/3,                   % Id, Outcome, Age: its callers were notified of
                                % Outcome; `none` if the agent was resumed
                                % since
    waiter/3.                   % Id, Token, Asker

:- multifile
    typhon_bounds:forgotten/1,
    typhon_identity:ids_anew/0,
    typhon_identity:id_anew/1,
    typhon_endpoint:requested/4,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

typhon_identity:ids_anew :-
    retractall(born(_, _, _, _)),
    retractall(outcome(_, _, _)),
    retractall(faulty(_, _, _)),
    retractall(waiter(_, _, _)).

typhon_identity:id_anew(Id) :-
    retractall(born(Id, _, _, _)),
    retractall(outcome(Id, _, _)),
    retractall(faulty(Id, _, _)).

%!  agent_born(+Id, +Address) is det.
%
%   Record that Id was born on the host Address of this process.

agent_born(Id, Address) :-
    put_born(Id, Address, 0, here).

put_born(Id, Address, Hops, Process) :-
    durable_put(born, Id, 0, born(Address, Hops, Process)),
    assertz(born(Id, Address, Hops, Process)).

typhon_bounds:forgotten(outcome(Id, _, _)) :-
    durable_drop_all(outcome, Id).

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

%!  ended_after(+Id, -Hops) is semidet.
%
%   Id, whose home is here, has ended after Hops hops.

ended_after(Id, Hops) :-
    outcome(Id, _, Hops).

%!  home_moved(+Id, +Address, +Hops, +Process) is det.
%
%   Record that Id has gone to Address, in Process, by hop number Hops.

home_moved(Id, Address, Hops, Process) :-
    debug(typhon(hop), '~w hop ~D: home records that it is on ~w',
          [Id, Hops, Address]),
    with_mutex(typhon_born, moved(Id, Address, Hops, Process)).

%!  home_left(+Id, +Address, +Hops, +Process) is semidet.
%
%   As home_moved/4, for an agent that has left this process; the caller notes
%   it in the journal.  Fails if the home does not know the agent, or has newer
%   news.

home_left(Id, Address, Hops, Process) :-
    with_mutex(typhon_born, left(Id, Address, Hops, Process)).

left(Id, Address, Hops, Process) :-
    born(Id, _, Hops0, _),
    !,
    Hops0 < Hops,
    assertz(born(Id, Address, Hops, Process)),
    forget_first(Id).

%   Adds the new fact before it removes the old one, because other threads read
%   meanwhile.  An agent without a fact was born before the home was restarted.

moved(Id, Address, Hops, Process) :-
    born(Id, _, Hops0, _),
    !,
    (   Hops0 < Hops
    ->  put_born(Id, Address, Hops, Process),
        forget_first(Id)
    ;   true
    ).
moved(Id, Address, Hops, Process) :-
    \+ outcome(Id, _, _),
    agent_home_endpoint(Id, Home),
    endpoint_address(Home),
    !,
    put_born(Id, Address, Hops, Process).
moved(_, _, _, _).

forget_first(Id) :-
    retract(born(Id, _, _, _)),
    !.

%!  home_ended(+Id, +Outcome, +Hops, +Results:list) is det.
%
%   Record that Id has ended after Hops hops, with Results.

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
    retractall(born(Id, _, _, _)),
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
    waiters(Id, Askers).

%   An agent that is disposed of while faulty ends with the outcome of its
%   fault.  Any other outcome means that the agent was resumed; the news of that
%   may come later.

last_outcome(disposed, Told, Told) :-
    Told \== none,
    !.
last_outcome(Outcome, _, Outcome).

%!  home_faulty(+Id, +Outcome, +Stamp, +Address, +Hops, +Process) is det.
%
%   Record that Id is faulty with that Outcome, and is kept at Address, in
%   Process, after Hops hops.

home_faulty(Id, Outcome, Stamp, Address, Hops, Process) :-
    debug(typhon(agent), '~w: home records that it is faulty, ~p',
          [Id, Outcome]),
    with_mutex(typhon_born,
               ( moved(Id, Address, Hops, Process),
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

%!  home_resumed(+Id, +Stamp, +Hops) is det.
%
%   Record that Id was resumed after the fault of that Stamp.  This news may
%   overtake that of the fault: the ages show the order.

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
    (   retract(waiter(Id, Token, Asker))
    ->  at_timeout(Id, Outcome),
        send_outcome(Asker, Outcome)
    ;   true
    ).

%   Before the timeout the news of a hop from there may be under way.

at_timeout(Id, lost(Host)) :-
    born(Id, Host, _, _),
    address_parts(Host, _, Endpoint),
    endpoint_gone(Endpoint),
    !.
at_timeout(_, timeout).

typhon_scheduler:over(Id, join(Token)) :-
    \+ waiter(Id, Token, _).

send_outcome(queue(Queue, Tag), Outcome) :-
    catch(thread_send_message(Queue, outcome(Tag, Outcome)),
          error(existence_error(_, _), _), true).
send_outcome(reply(ReplyTo), Outcome) :-
    endpoint_reply(ReplyTo, Outcome).
send_outcome(call(Closure), Outcome) :-
    call(Closure, Outcome).

typhon_endpoint:requested(join, join(Id, Seconds), _Peer, ReplyTo) :-
    outcome_wait(Id, Seconds, reply(ReplyTo)).
