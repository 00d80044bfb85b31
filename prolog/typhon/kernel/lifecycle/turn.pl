:- module(typhon_turn,
          [ turn_unit/1,                % :Goal
            turn_settled/0,
            turn_bounded/1,             % +Host
            turn_over_limit/3           % +Host, +Id, +What
          ]).
:- use_module('../base/durable', [unit_of_work/1]).
:- use_module('../base/own_thread', [aborted_quietly/0]).
:- use_module('../base/reports', [report/4]).
:- use_module('../program',
              [ answer_at/3, fault_note/1, machine_ready/1, machine_run/3,
                plain_goals/2 ]).
:- use_module('../host',
              [ context_clear/0, context_set/3, event/4, parts/3,
                security_event/2, turn_later/1, turns_paused/0 ]).
:- use_module('../agent',
              [ agent/5, agent_claim/3, agent_code/2, agent_handles/2,
                agent_here/5, agent_ordered/1, agent_ready/2, agent_rest/3,
                agent_status/3, agent_take/3, mail_take/2,
                with_agent/2 ]).
:- use_module(effect, [effect/5, effect_depart/6]).
:- use_module(ending, [agent_end/2, agent_fails/3]).
:- use_module(orders, [order_obey/3]).

/** <module> Turns: the life of an agent on a host

A worker of the scheduler runs an agent from one effect of the machine to the
next, see typhon_effect.  Orders from outside are obeyed in between.

A turn is turn(Id, Host, Context): the agent, its host, and the context of the
machine.  It starts with goals(Goals), or with resumed(State) where an option
suspended the agent in the middle of its goals.  Its engine is `machine`, or a
closure of an option that runs the agent instead, called with Turn, Start,
Outcome and Goals0.

Options change turns by the hooks below, and by the part `turn` of a host, see
typhon_host_parts, and in no other way.  A hook that no option defines costs
one call that fails.

*Threading*: in the worker that has the agent.  While its status is `running`
an agent belongs to one worker.
*/

:- meta_predicate turn_unit(0).

:- multifile
    engine/3,                   % Id-Host, Start, Engine: it runs Id, which is on
                                % Host, from Start
    limit_passed/1,             % Outcome: of the agent that this thread ran,
                                % and that was interrupted at a limit
    unit/2,                     % Run, Conclude: call(Run, Goal) runs an agent,
                                % call(Conclude, Id, Outcome, Goal, Next) the
                                % rest, as one unit of work
    settle/0,                   % end that unit now
    over/1.                     % Id: its worker no longer runs it

%   turn_run(+Engine, +Unit, +Turn, +Start, -Outcome, -Goals0) is det.
%
%   Run the agent to its next stop, from Goals0.  Unit is unit(Run), where Run
%   is that of unit/2, or `none`.  Outcome is that of machine_run/3, `held` if
%   the agent was suspended in the middle of its goals, over(Resource) if it
%   passed a limit, or ends(Resource) if it ends by the error of a resource,
%   which it may have raised itself.

turn_run(machine, Unit, Turn, goals(Goals), Outcome, Goals) :-
    !,
    (   Unit = unit(Run)
    ->  call(Run, typhon_turn:bounded_run(Turn, Goals, Outcome))
    ;   bounded_run(Turn, Goals, Outcome)
    ).
turn_run(Engine, _, Turn, Start, Outcome, Goals0) :-
    start_plain(Start, Plain),
    call(Engine, Turn, Plain, Outcome, Goals0).

start_plain(goals(Goals0), Start) =>
    Start = goals(Goals),
    plain_goals(Goals0, Goals).
start_plain(Start0, Start) =>
    Start = Start0.

bounded_run(Turn, Goals, Outcome) :-
    Turn = turn(_, Host, Context),
    (   parts(turn, Host, [Run|_])
    ->  machine_ready(Context),
        call(Run, Turn, Goals, Outcome)
    ;   machine_run(Context, Goals, Outcome)
    ).

%!  turn_unit(:Goal) is det.
%
%   Run Goal, in which the agent acts, in the unit of work of this turn.

turn_unit(Goal) :-
    (   unit(Run, _)
    ->  call(Run, Goal)
    ;   call(Goal)
    ).

%!  turn_settled is det.
%
%   End the unit of work now.

turn_settled :-
    ignore(settle).

%   turn_broken(-Outcome) is det.
%
%   Outcome of an agent that was interrupted in the middle of a goal.

turn_broken(Outcome) :-
    (   limit_passed(Passed)
    ->  Outcome = Passed
    ;   Outcome = disposed
    ).

%   turn_overruled(+Host, -Outcome) is semidet.
%
%   The agent passed a limit on Host, and ends with Outcome even if it catches
%   the error.

turn_overruled(Host, Outcome) :-
    parts(turn, Host, _),
    limit_passed(Outcome),
    !.

%!  turn_bounded(+Host) is semidet.
%
%   Turns on Host have limits.

turn_bounded(Host) :-
    parts(turn, Host, _),
    !.

%   turn_over(+Id) is det.
%
%   The worker leaves the agent, which rests, goes on elsewhere or has ended.

turn_over(Id) :-
    ( over(Id) -> true ; true ).

                /*******************************
                *       AGENTS ON A HOST       *
                *******************************/

:- multifile
    typhon_scheduler:run/1,
    typhon_scheduler:run_on/4.

typhon_scheduler:run(Id) :-
    (   with_agent(Id, take(Id, Task))
    ->  begin(Task, Id)
    ;   turn_over(Id)                   % has ended
    ).

%   An agent that has just arrived by the short path is running already.

typhon_scheduler:run_on(Id, Host, Context, Goals) :-
    (   turns_paused
    ->  ignore(with_agent(Id, agent_ready(Id, Goals)))
    ;   begin(run_on(Host, Context, Goals), Id)
    ).

begin(Task, Id) :-
    (   catch(completed(Task, Id), Ball, broken_off(Ball, Id))
    ->  context_clear
    ;   context_clear,
        fail
    ).

take(Id, later) :-
    turn_later(Id),
    !.
take(Id, Task) :-
    agent_take(Id, Goals, Order),
    !,
    (   Order == none
    ->  Task = run(goals(Goals))
    ;   Task = order(Order, Goals)
    ).
take(Id, leave(Dest, Hole, Goals, Since)) :-
    agent_claim(Id, leaving(Dest, _), hop(Hole-Goals, Since)),
    !.
take(Id, run(resumed(Held))) :-
    agent_claim(Id, resumed, Held).

completed(Task, Id) :-
    perform(Task, Id),
    !.
completed(Task, Id) :-
    task_goals(Task, Goals),
    not_completed(Id, Goals).

task_goals(Task, Goals) :-
    (   Task = run(goals(Goals))
    ;   Task = run_on(_, _, Goals)
    ;   Task = order(_, Goals)
    ),
    Goals = [_|_],
    !.
task_goals(leave(Dest, move(Dest), Goals, _), [move(Dest)|Goals]) :-
    !.
task_goals(leave(Dest, wait(Hole, _), Goals, Since), All) :-
    !,
    task_goals(leave(Dest, Hole, Goals, Since), All).
task_goals(_, [true]).

%   not_completed(+Id, +Goals) is semidet.
%
%   A step of Id from Goals failed, in the kernel or in an option.  An agent
%   left `running` would delay host_stop/1 for ever.  Fails if it rests, goes
%   on elsewhere or has ended: then there is nothing to repair.

not_completed(Id, Goals) :-
    agent_status(Id, Status, _),
    memberchk(Status, [running, obeying]),
    !,
    fault_note(none),
    concluded(Id, failed,
              agent_fails(Id, raised(error(step_not_completed, _)), Goals)),
    turn_over(Id).
not_completed(_, _) :-
    turn_settled,
    fail.

%   concluded(+Id, +Outcome, :Goal): what Id has done, and Goal, which ends its
%   turn, are one unit of work.

concluded(Id, Outcome, Goal) :-
    (   unit(_, Whole)
    ->  call(Whole, Id, Outcome, typhon_turn:Goal, stop)
    ;   unit_of_work(Goal)
    ).

perform(later, _).
perform(order(Order, Goals), Id) :-
    unit_of_work(order_obey(Order, Id, Goals)).
perform(leave(Dest, Hole, Goals, Since), Id) :-
    unit_of_work(effect_depart(Id, Dest, Hole, Goals, Since, Next)),
    go_on(Next, _, turn(Id, none, none)).
perform(run(Start), Id) :-
    agent(Id, Host, Module, _, _),
    agent_code(Module, Program),
    run_from(Start, Id, Host, context(Program, Module)).
perform(run_on(Host, Context, Goals), Id) :-
    (   agent_here(Id, Host, _, _, _)
    ->  run_from(goals(Goals), Id, Host, Context)
    ;   turn_over(Id)                   % has ended
    ).

run_from(Start, Id, Host, Context) :-
    Context = context(_, Module),
    context_set(Host, Id, Module),
    (   engine(Id-Host, Start, Engine0)
    ->  Engine = Engine0
    ;   Engine = machine
    ),
    turns(Start, Engine, turn(Id, Host, Context)).

turns(Start, Engine, Turn) :-
    (   unit(Run, Whole)
    ->  turn_run(Engine, unit(Run), Turn, Start, Outcome, Goals0),
        arg(1, Turn, Id),
        call(Whole, Id, Outcome,
             typhon_turn:conclude(Outcome, Goals0, Turn, Next), Next)
    ;   turn_run(Engine, none, Turn, Start, Outcome, Goals0),
        conclude(Outcome, Goals0, Turn, Next)
    ),
    go_on(Next, Engine, Turn).

go_on(stop, _, turn(Id, _, _)) :-
    turn_over(Id).
go_on(go(Goals), Engine, Turn) :-
    turns(goals(Goals), Engine, Turn).
go_on(elsewhere(Host, Module, Goals), _, turn(Id, _, Context0)) :-
    (   Context0 = context(_, Module)
    ->  Context = Context0
    ;   agent_code(Module, Program),
        Context = context(Program, Module)
    ),
    run_from(goals(Goals), Id, Host, Context).

%   An agent whose worker is interrupted is in the middle of a goal, and cannot
%   go on.  This is not done in a cleanup handler: while an exception is
%   pending 9.0.4 catches no other.

broken_off(Ball, Id) :-
    sig_atomic(( context_clear,
                 report_aborted(Id),
                 turn_broken(Outcome),
                 over_limit(Id, Outcome),
                 concluded(Id, Outcome, ignore(agent_end(Id, Outcome))) )),
    throw(Ball).

%   The platform interrupts agents by abort_quietly/0; halt/1 aborts threads.

report_aborted(Id) :-
    (   ( aborted_quietly ; current_prolog_flag(exit_status, _) )
    ->  true
    ;   report(warning, agents_aborted, Id, typhon(aborted(Id)))
    ).

over_limit(Id, raised(error(resource_error(What), _))) :-
    agent(Id, Host, _, _, _),
    !,
    turn_over_limit(Host, Id, What).
over_limit(_, _).

%!  turn_over_limit(+Host, +Id, +What) is det.
%
%   Report that an agent of Host ends, as it has passed the limit What.

turn_over_limit(Host, Id, What) :-
    security_event(Host, over(Id, What)),
    report(warning, agents_over_limit, Id, typhon(over_limit(Id, What))).

%   conclude(+Outcome, +Goals0, +Turn, -Next): carry out Outcome of the run
%   from Goals0.  Next is as in effect/5.

conclude(done, _, Turn, Next) :-
    finish(Turn, Next).
conclude(failed, Goals0, turn(Id, _, _), stop) :-
    agent_fails(Id, failed, Goals0).
conclude(held, _, _, stop).
conclude(lost(Why), _, turn(Id, _, _), stop) :-
    ignore(agent_end(Id, lost(Why))).
conclude(over(What), _, turn(Id, _, _), stop) :-
    ends_over(Id, raised(error(resource_error(What), _))).
conclude(ends(What), _, turn(Id, _, _), stop) :-
    report(warning, agents_exhausted, Id, typhon(exhausted(Id, What))),
    ignore(agent_end(Id, raised(error(resource_error(What), _)))).
conclude(raised(Error), Goals0, turn(Id, _, _), stop) :-
    agent_fails(Id, raised(Error), Goals0).
conclude(effect(Control, Hole, Goals), _, turn(Id, Host, _), Next) :-
    (   agent_ordered(Id),
        term_attvars(Goals, [])         % else effect/5 raises an error
    ->  Hole = Control,
        with_agent(Id, agent_ready(Id, Goals)),
        Next = stop
    ;   catch(effect(Control, Hole, Goals, Id-Host, Next),
              error(Formal, Where),
              raised_at(Control, error(Formal, Where), Hole-Goals, Id-Host,
                        Next))
    ).

%   An agent that passed a limit ends, even if it catches the error.

raised_at(_, _, _, Id-Host, stop) :-
    turn_overruled(Host, Outcome),
    !,
    ends_over(Id, Outcome).
raised_at(Control, Error, Hole-Goals, _, go(Goals)) :-
    answer_at(Control, throw(Error), Hole).

ends_over(Id, Outcome) :-
    over_limit(Id, Outcome),
    ignore(agent_end(Id, Outcome)).

%   No goals are left: take the next message, stay resident, or end.  An agent
%   does not end because on_message/2 fails.

finish(turn(Id, _, context(Program, Module)), Next) :-
    agent_handles(Program, Module),
    !,
    with_agent(Id, next_message(Id, Next)),
    received(Next, Id).
finish(turn(Id, _, _), stop) :-
    ignore(agent_end(Id, done)).

%   An order is taken before a message.

next_message(Id, Next) :-
    (   \+ agent_ordered(Id),
        mail_take(Id, From-Message)
    ->  Next = go([( on_message(From, Message)
                   ->  true
                   ;   message_failed(From, Message)
                   )])
    ;   agent_rest(Id, resident, []),
        Next = stop
    ).

received(stop, _).
received(go([(on_message(From, Message) -> _ ; _)]), Id) :-
    agent(Id, Host, _, _, _),
    !,
    event(messages, Host, Id, received(From, Message)).
received(go(_), _).
