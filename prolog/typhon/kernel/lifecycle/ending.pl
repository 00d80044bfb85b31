:- module(typhon_ending,
          [ agent_end/2,                % +Id, +Outcome
            agent_end/3,                % +Id, :Test, +Outcome
            agent_forgotten/2,          % +Id, :Test
            agent_fails/3,              % +Id, +Outcome, +Goals0
            agent_stays/2,              % +Id, +Goals
            faulty_stirs/1,             % +Id
            held_parts/3,               % +Held, -State, -Goals
            agent_join/3,               % +Agents, -Outcome, +Timeout
            agent_result/3              % +Agent, -Term, +Timeout
          ]).

/** <module> How agents end, or are kept when they are faulty; joining

A faulty agent stays on its host with its goals, state and mail, and does not
count in the load.  When an order arrives it becomes `ready`, and counts, until
the order is done.  As its goals begin with its fault, see typhon_fault, it is
faulty again wherever it runs next: after an order, after a move, or from a
restore point.  Only agent_resume/1 removes the fault.

A caller that waits for the outcome asks the home of the agent, see
typhon_whereabouts, which answers when it has the outcome.

*Threading*: any thread.  The thread that removes the record of an agent,
inside with_agent/2, reports its end.
*/

:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [append/2, append/3, last/2, member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../agent',
              [ agent/5, agent_fault/5, agent_home_endpoint/2,
                agent_ordered/1, agent_put/3, agent_ready/2, agent_remove/2,
                agent_status/3, fault_error/2, fault_outcome/2, fault_shown/2,
                fault_stamp/2, is_faulty/3, life_hops/2, result_facts/2,
                with_agent/2 ]).
:- use_module('../base/durable', [unit_of_work/1]).
:- use_module('../base/reports', [report/4]).
:- use_module('../host',
              [ event/4, events_forget/1, host/3, host_again/1, host_leave/1,
                process_ask/6, time_now/1, time_wait/3 ]).
:- use_module('../travel',
              [ agent_ended/4, agent_ends/2, agent_faulty/5, agent_outcome/2,
                clones_ask/3, move_over/2, outcome_wait/3, results_ask/4,
                transfer_given_up/2 ]).
:- use_module('../wire', [endpoint_address/1]).
:- use_module(questions,
              [agent_ask/4, agent_once_named/2, question_answered/2]).

:- setting(typhon_creation:faulty, nonneg, 100,
           "Faulty agents kept for inspection").

:- meta_predicate
    agent_end(+, 1, +),
    agent_forgotten(+, 1).

:- dynamic
    kept/1.                             % Id, the oldest first

:- multifile
    dropped/1,                          % State: the agent ends, and does not go on
    typhon_questions:here/3.

%!  agent_end(+Id, +Outcome) is semidet.
%
%   End Id.

agent_end(Id, Outcome) :-
    agent_end(Id, nonvar, Outcome).

%!  agent_end(+Id, :Test, +Outcome) is semidet.
%
%   End Id if call(Test, Status) succeeds for its status.

agent_end(Id, Test, Outcome) :-
    unit_of_work(( with_agent(Id, ( agent_status(Id, Status, Goals),
                                    call(Test, Status),
                                    remove(Id, Status, Goals, Last)
                                  )),
                   after_removal(Last, Id, Outcome) )).

remove(Id, Status, Goals, last(Host, Hops, Status, Goals, Results, Orders)) :-
    agent(Id, Host, Module, _, Life),
    life_hops(Life, Hops),
    result_facts(Module, Results),
    (   Status = transit(_, _)
    ->  transfer_given_up(Id, Goals)
    ;   dropped_if_held(Goals)
    ),
    retractall(kept(Id)),
    agent_ends(Id, Hops),
    agent_remove(Id, Orders).

after_removal(Last, Id, Outcome) :-
    report_end(Last, Id, Outcome),
    arg(6, Last, Orders),
    answer_none(Id, Orders).

%   Callers that wait for an answer to an order get `none`.

answer_none(Id, Orders) :-
    ignore(move_over(Id, none)),
    forall(member(asked(_, Asker), Orders), question_answered(Asker, none)).

%!  agent_forgotten(+Id, :Test) is semidet.
%
%   If call(Test, Status) succeeds for Id, remove its record.  It is no longer
%   here, and has not ended.

agent_forgotten(Id, Test) :-
    with_agent(Id, ( agent_status(Id, Status, _),
                     call(Test, Status),
                     agent(Id, Host, _, _, _),
                     agent_remove(Id, Orders) )),
    events_forget(Id),
    host_leave(Host),
    answer_none(Id, Orders).

%   The bad end was reported when the agent became faulty.

report_end(last(Host, Hops, faulty(_), Goals, Results, _), Id, _) :-
    !,
    events_forget(Id),
    is_faulty(Goals, Fault, _),
    fault_outcome(Fault, Outcome),
    event(faults, Host, Id, ended(Outcome)),
    agent_ended(Id, Outcome, Hops, Results).
report_end(last(Host, Hops, Status, _, Results, _), Id, Outcome) :-
    debug(typhon(agent), '~w: ends on ~w, ~p', [Id, Host, Outcome]),
    warn_if_in_doubt(Status, Id),
    host_leave(Host),
    event(life, Host, Id, ended(Outcome)),
    events_forget(Id),
    agent_ended(Id, Outcome, Hops, Results).

warn_if_in_doubt(transit(Address, _), Id) :-
    !,
    print_message(warning, typhon(ended_in_doubt(Id, Address))).
warn_if_in_doubt(_, _).

                /*******************************
                *           BAD ENDS           *
                *******************************/

%!  agent_fails(+Id, +Outcome, +Goals0) is det.
%
%   Id ran Goals0 with that Outcome, `failed` or raised(Error): report this,
%   and keep the agent as it was.

agent_fails(Id, Outcome, Goals0) :-
    (   agent_fault(Id, Outcome, Goals0, Fault, Left)
    ->  report(Id, Fault),
        is_faulty(Goals, Fault, Left),
        agent_stays(Id, Goals)
    ;   true                            % it has ended meanwhile
    ).

report(Id, Fault) :-
    agent(Id, Host, _, Hash, _),
    !,
    debug(typhon(agent), '~w: is faulty, on ~w', [Id, Host]),
    fault_outcome(Fault, Outcome),
    bad_end(Outcome, Id, Fault, What, Kind, Message),
    event(bad_ends, Host, Id, What),
    fault_shown(Fault, Shown),
    event(faults, Host, Id, fault(Shown)),
    report(Kind, faulty_agents(Hash), Id, typhon(Message)).
report(_, _).

%   bad_end(+Outcome, +Id, +Fault, -What, -Kind, -Message): its event and message.

bad_end(failed, Id, Fault, ended(failed), warning, agent_failed(Id, Fault)).
bad_end(raised(Error), Id, Fault, faulty(Error), error,
        faulty(Id, Error, Fault)).

%!  agent_stays(+Id, +Goals) is det.
%
%   Keep Id, which is faulty: Goals begin with its fault.  If there are too many
%   faulty agents, dispose of the oldest ones.

agent_stays(Id, Goals) :-
    is_faulty(Goals, Fault, _),
    (   with_agent(Id, faulty_keep(Id, Goals, At))
    ->  report_fault(Id, Fault, At),
        bound_faulty
    ;   true                            % it has ended meanwhile
    ).

bound_faulty :-
    (   faulty_oldest(Oldest)
    ->  retractall(kept(Oldest)),
        ignore(agent_end(Oldest, is_kept, disposed)),
        bound_faulty
    ;   true
    ).

is_kept(faulty(_)).

                /*******************************
                *        FAULTY AGENTS         *
                *******************************/

%   The setting keeps its old name, typhon_creation:faulty, which users know.

%   Id, which was running or obeyed an order, is faulty: Goals begin with its
%   fault.  It is not kept if another order has arrived meanwhile.  At is its
%   host and the number of its hops: a moment later it may be elsewhere.

faulty_keep(Id, Goals, at(Host, Hops)) :-
    agent(Id, Host, _, _, Life),
    life_hops(Life, Hops),
    (   agent_ordered(Id)
    ->  agent_ready(Id, Goals)
    ;   is_faulty(Goals, Fault, _),
        fault_error(Fault, Error),
        agent_put(Id, faulty(Error), Goals),
        assertz(kept(Id)),
        host_leave(Host)
    ),
    !.

%!  faulty_stirs(+Id) is det.
%
%   Count Id, which is faulty, in the load of its host again.

faulty_stirs(Id) :-
    retractall(kept(Id)),
    agent(Id, Host, _, _, _),
    !,
    host_again(Host).

%   Report the fault to the home of Id.

report_fault(Id, Fault, at(Host, Hops)) :-
    host(Host, Address, _),
    !,
    fault_outcome(Fault, Outcome),
    fault_stamp(Fault, Stamp),
    agent_faulty(Id, Outcome, Stamp, Address, Hops).
report_fault(_, _, _).                  % its host has stopped

%   There are more faulty agents than the setting allows; Id is the oldest.

faulty_oldest(Id) :-
    setting(typhon_creation:faulty, Max),
    predicate_property(kept(_), number_of_clauses(Count)),
    Count > Max,
    kept(Id),
    !.

                /*******************************
                *           ON HOLD            *
                *******************************/

%   The engine of a turn, see typhon_turn, may suspend an agent before any
%   goal.  The agent then has the status `held`, and `resumed` from when it may
%   go on until a worker has it.  In place of its goals there is
%
%       held(State, Goals)
%
%   where the engine needs State to go on, and Goals come next.  A held agent
%   occupies no thread, and is ended as other agents at rest are.  Orders wait
%   for its next effect.

%!  held_parts(+Held, -State, -Goals:list) is semidet.
%
%   Held, the goals of an agent, is a term held(State, Goals).

held_parts(Held, State, Goals) :-
    nonvar(Held),
    Held = held(State, Goals).

%   dropped_if_held(+Goals) is det: an agent with Goals ends.  Release its
%   State if it was held.

dropped_if_held(Goals) :-
    ignore(( held_parts(Goals, State, _), dropped(State) )).

                /*******************************
                *           CALLERS            *
                *******************************/

%!  agent_join(+Agents, -Outcome, +Timeout) is det.
%
%   Wait until an agent has ended, wherever it is, for Timeout seconds (a
%   number or `inf`).  Outcome is `done`, `failed`, raised(Error), `disposed`
%   or `timeout`; lost(Host), after the Timeout, if the process of Host, where
%   the agent was, is known to be gone.
%
%   Agents is an agent, or family(Agent): Agent, its clones, and theirs. Then this
%   waits until the last of them has ended.  Outcome is then a list of pairs
%   Agent-Outcome, each agent before its clones, and these in the order in
%   which they were born in a process.  At the timeout the outcome of agents
%   that have not ended is `timeout`.  Outcomes that the home has discarded are
%   reported as `unknown`.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error host_unreachable(Home), connection_lost(Home): for a family, of
%   any of its members

agent_join(Agents, Outcomes, Timeout) :-
    nonvar(Agents),
    Agents = family(Agent),
    !,
    wait_seconds(Timeout, Seconds),
    agent_once_named(Agent, Id),
    until(Seconds, Until),
    agent_join(Id, Outcome, Seconds),
    clones(Id, Outcome, Clones),
    members(Clones, Until, Others),
    Outcomes = [Id-Outcome|Others].
agent_join(Agent, Outcome, Timeout) :-
    wait_seconds(Timeout, Seconds),
    agent_once_named(Agent, Id),
    outcome_within(Id, Seconds, Outcome0),
    (   Outcome0 == unknown
    ->  existence_error(agent, Agent)
    ;   Outcome = Outcome0
    ).

wait_seconds(Timeout, inf) :-
    (   Timeout == inf
    ;   Timeout == infinite
    ;   float(Timeout),
        Timeout =:= inf
    ),
    !.
wait_seconds(Timeout, Seconds) :-
    must_be(number, Timeout),
    Seconds is max(0, Timeout).

outcome_within(Agent, Seconds, Outcome) :-
    (   agent_home_endpoint(Agent, Endpoint)
    ->  join(Endpoint, Agent, Seconds, Outcome)
    ;   Outcome = unknown
    ).

join(Endpoint, Agent, Seconds, Outcome) :-
    home_here(Agent, Endpoint),
    !,
    setup_call_cleanup(
        message_queue_create(Queue),    % deleted even after an interrupt
        ( outcome_wait(Agent, Seconds, queue(Queue, join)),
          outcome_received(Queue, Outcome)
        ),
        message_queue_destroy(Queue)).
join(Endpoint, Agent, Seconds, Outcome) :-
    (   Seconds == inf
    ->  Limit = 1.0e9
    ;   Limit is Seconds+10
    ),
    process_ask(Endpoint, Endpoint, join, join(Agent, Seconds), Outcome,
                Limit).

%   A plain wait in the thread of virtual time would stop the time.

outcome_received(Queue, Outcome) :-
    time_wait(Queue, outcome(join, Outcome0), inf),
    !,
    Outcome = Outcome0.
outcome_received(_, timeout).

                /*******************************
                *            FAMILIES          *
                *******************************/

%   members(+Agents, +Until, -Outcomes): Outcomes are those of Agents and of
%   their clones.

members([], _, []).
members([Agent|Agents], Until, [Agent-Outcome|Outcomes]) :-
    seconds_left(Until, Seconds),
    outcome_within(Agent, Seconds, Outcome),
    clones(Agent, Outcome, Clones),
    append(Clones, Agents, Others),
    members(Others, Until, Outcomes).

until(inf, inf) :-
    !.
until(Seconds, Until) :-
    time_now(Now),
    Until is Now+Seconds.

seconds_left(inf, inf) :-
    !.
seconds_left(Until, Seconds) :-
    time_now(Now),
    Seconds is max(0, Until-Now).

clones(Agent, Outcome, Clones) :-
    results_of(Agent, Outcome, cloned, Items),
    findall(Some,
            ( member(cloned(Endpoint), Items),
              clones_ask(Endpoint, Agent, Some) ),
            Lists),
    append(Lists, Clones).

                /*******************************
                *            RESULTS           *
                *******************************/

%!  agent_result(+Agent, -Term, +Timeout) is semidet.
%
%   Wait at most Timeout seconds, a number or `inf`, until Agent has ended,
%   wherever and however.  Term is the last term that it gave with result/1.
%   Fails after a timeout.  Its home keeps the results of the last 20,000
%   agents (the setting typhon_outcomes:results).
%
%   @error existence_error(result, Agent) if it has given none
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error host_unreachable(Home), connection_lost(Home)

agent_result(Agent, Term, Timeout) :-
    wait_seconds(Timeout, Seconds),
    agent_once_named(Agent, Id),
    agent_join(Id, Outcome, Seconds),
    \+ memberchk(Outcome, [timeout, lost(_)]),
    results_of(Id, Outcome, result, Results),
    (   last(Results, result(Result))
    ->  Term = Result
    ;   existence_error(result, Agent)
    ).

%   home_here(+Agent, +Home): the home of Agent is this process, or was when
%   this process had another endpoint.

home_here(_, Home) :-
    endpoint_address(Home),
    !.
home_here(Agent, _) :-
    agent_outcome(Agent, _).

%   results_of(+Agent, +Outcome, +Kind, -Items): the results of Agent.  If the
%   agent has not ended, or is kept because it is faulty, it answers, else its
%   home.

results_of(Agent, Outcome, Kind, Items) :-
    may_still_exist(Outcome),
    catch(agent_ask(Agent, results(Kind), 2, answer(Items0)), error(_, _),
          fail),
    !,
    Items = Items0.
results_of(Agent, _, Kind, Items) :-
    agent_home_endpoint(Agent, Home),
    (   home_here(Agent, Home)
    ->  results_ask(here, Agent, Kind, Items)
    ;   results_ask(Home, Agent, Kind, Items)
    ).

may_still_exist(timeout).
may_still_exist(failed).
may_still_exist(raised(_)).

typhon_questions:here(results(Kind), Agent, Asker) :-
    agent(Agent, _, Module, _, _),
    !,
    result_facts(Module, Items0),
    functor(Item, Kind, 1),
    findall(Item, member(Item, Items0), Items),
    question_answered(Asker, answer(Items)).
