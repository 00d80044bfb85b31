:- module(typhon_ending,
          [ agent_end/2,                % +Id, +Outcome
            agent_end/3,                % +Id, :Test, +Outcome
            agent_forgotten/2,          % +Id, :Test
            agent_fails/3,              % +Id, +Outcome, +Goals0
            agent_stays/2,              % +Id, +Goals
            faulty_stirs/1,             % +Id
            held_parts/3                % +Held, -State, -Goals
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/durable', [unit_of_work/1]).
:- use_module('../base/on_demand', [on_demand_call/3]).
:- use_module('../base/reports', [report/4]).
:- use_module('../host',
              [event/4, events_forget/1, host/3, host_again/1, host_uncount/1]).
:- use_module('../agent',
              [ agent/5, agent_ordered/1, agent_put/3, agent_ready/2,
                agent_remove/2, agent_status/3, fault_error/2, fault_outcome/2,
                fault_shown/2, fault_stamp/2, is_faulty/3, life_hops/2,
                result_facts/2, with_agent/2 ]).
:- use_module('../travel',
              [ agent_ended/4, agent_ends/2, agent_faulty/5, end_noted/4,
                move_over/2, transfer_given_up/2 ]).
:- use_module(questions, [question_answered/2]).

/** <module> How agents end, or are kept when they are faulty

A faulty agent stays on its host with its goals, state and mail, and does not
count in the load.  When an order arrives it becomes `ready`, and counts, until
the order is done.  As its goals begin with its fault, see typhon_results, it is
faulty again wherever it runs next: after an order, after a move, or from a
restore point.  Only agent_resume/1 removes the fault.

*Threading*: any thread.  The thread that removes the record of an agent,
inside with_agent/2, reports its end.
*/

:- meta_predicate
    agent_end(+, 1, +),
    agent_forgotten(+, 1).

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
                                    last_outcome(Status, Goals, Outcome,
                                                 Last),
                                    remove(Id, Status, Goals, Last, End)
                                  )),
                   after_removal(End, Id) )).

%   The bad end was reported when the agent became faulty.

last_outcome(faulty(_), Goals, _, Outcome) :-
    !,
    is_faulty(Goals, Fault, _),
    fault_outcome(Fault, Outcome).
last_outcome(_, _, Outcome, Outcome).

%   Each moment the agent is here, or its end is noted.

remove(Id, Status, Goals, Outcome,
       end(Host, Hops, Status, Outcome, Results, Orders)) :-
    agent(Id, Host, Module, _, Life),
    life_hops(Life, Hops),
    result_facts(Module, Results),
    end_noted(Id, Outcome, Hops, Results),
    (   Status = transit(_, _)
    ->  transfer_given_up(Id, Goals)
    ;   dropped_if_held(Goals)
    ),
    retractall(kept(Id)),
    agent_ends(Id, Hops),
    agent_remove(Id, Orders).

after_removal(End, Id) :-
    report_end(End, Id),
    arg(6, End, Orders),
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
    host_uncount(Host),
    answer_none(Id, Orders).

report_end(end(Host, Hops, faulty(_), Outcome, Results, _), Id) :-
    !,
    events_forget(Id),
    event(faults, Host, Id, ended(Outcome)),
    agent_ended(Id, Outcome, Hops, Results).
report_end(end(Host, Hops, Status, Outcome, Results, _), Id) :-
    debug(typhon(agent), '~w: ends on ~w, ~p', [Id, Host, Outcome]),
    warn_if_in_doubt(Status, Id),
    host_uncount(Host),
    event(life, Host, Id, ended(Outcome)),
    events_forget(Id),
    agent_ended(Id, Outcome, Hops, Results).

warn_if_in_doubt(transit(Address, _), Id) :-
    !,
    report(warning, agents_ended_in_doubt, Id,
           typhon(ended_in_doubt(Id, Address))).
warn_if_in_doubt(_, _).

                /*******************************
                *           BAD ENDS           *
                *******************************/

%!  agent_fails(+Id, +Outcome, +Goals0) is det.
%
%   Id ran Goals0 with that Outcome, `failed` or raised(Error): report this,
%   and keep the agent as it was.

agent_fails(Id, Outcome, Goals0) :-
    (   on_demand_call(fault, report,
                       typhon_fault:agent_fault(Id, Outcome, Goals0, Fault,
                                                Left))
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

:- dynamic kept/1.                      % Id, the oldest first

%   The setting keeps its old name, typhon_creation:faulty, which users know.

:- setting(typhon_creation:faulty, nonneg, 100,
           "Faulty agents kept for inspection").

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
        host_uncount(Host)
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

:- multifile dropped/1.         % State: the agent ends, and does not go on

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
