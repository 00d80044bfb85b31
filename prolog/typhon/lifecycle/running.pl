:- module(typhon_running, []).
:- use_module('../base/output', [output_rest/0]).
:- use_module('../journal',
              [ journal_on/0, journal_seal/0, journal_step/1, unit_commit/0,
                unit_has_effects/0, unit_release/0, unit_run/1 ]).
:- use_module('../program', [answer_at/3, probe_next/2, probe_start/3]).
:- use_module('../host',
              [ context_clear/0, context_set/3, event/4, quota_any/1,
                still_keeps/1 ]).
:- use_module('../agent',
              [ agent/5, agent_code/2, agent_departs/3, agent_handles/2,
                agent_ordered/1, agent_put_down/3, agent_ready/2, agent_rest/3,
                agent_take/3, agent_unorder/2,
                mail_take/2, with_agent/2 ]).
:- use_module(effect, [effect/5, effect_depart/6]).
:- use_module(ending, [agent_end/2, agent_fails/3]).
:- use_module(metering, [metered_ball/1, metered_run/4]).
:- use_module(on_hold, [held_resumes/2]).
:- use_module(orders, [order_obey/3, order_take/2]).
:- use_module(stepping, [is_probed/3, probe_rests/1, probed_goal/6]).
:- use_module(traced, [traced_held/1]).

/** <module> The life of an agent on a host

A worker of the scheduler runs an agent from one effect of the machine to
the next, see typhon_effect.  Orders from outside are obeyed in between.

*Threading*: run/1 in workers.  While its status is `running` an agent
belongs to one worker.
*/

:- multifile typhon_scheduler:run/1.

typhon_scheduler:run(Id) :-
    (   with_agent(Id, take(Id, Task))
    ->  (   catch(perform(Task, Id), Ball, broken_off(Ball, Id))
        ->  left
        ;   left,
            fail
        )
    ;   probe_rests(Id)                 % has ended
    ).

take(Id, later) :-
    still_keeps(Id),
    !.
take(Id, Task) :-
    agent_take(Id, Goals, Order),
    !,
    (   Order == none
    ->  Task = run(Goals)
    ;   Task = order(Order, Goals)
    ).
take(Id, leave(Dest, Hole, Goals, Since)) :-
    agent_departs(Id, Dest, hop(Hole-Goals, Since)),
    !.
take(Id, resume(Probe)) :-
    held_resumes(Id, Probe).

perform(later, _).
perform(order(Order, Goals), Id) :-
    journal_step(order_obey(Order, Id, Goals)).
perform(leave(Dest, Hole, Goals, Since), Id) :-
    journal_step(effect_depart(Id, Dest, Hole, Goals, Since, Next)),
    go_on(Next, Id).
perform(run(Goals), Id) :-
    agent(Id, Host, Module, Hash, Life),
    agent_code(Module, Program),
    context_set(Host, Id, Module),
    Context = context(Program, Module),
    (   is_probed(Host, Life, Hash)
    ->  probed(Goals, Id, Host, Context, Next)
    ;   live(Goals, Id, Host, Context, Next)
    ),
    go_on(Next, Id).
perform(resume(Probe), Id) :-
    agent(Id, Host, Module, _, _),
    agent_code(Module, Program),
    context_set(Host, Id, Module),
    probed_on(Probe, Id, Host, context(Program, Module), Next),
    go_on(Next, Id).

go_on(stop, _).
go_on(elsewhere(Goals), Id) :-
    perform(run(Goals), Id).

%   A worker that is interrupted leaves an agent in the middle of a goal:
%   it cannot go on.  Not in a cleanup handler: while an exception is pending
%   9.0.4 catches no other.

broken_off(Ball, Id) :-
    sig_atomic(( left,
                 ( metered_ball(Outcome) -> true ; Outcome = disposed ),
                 over_quota(Id, Outcome),
                 unit_commit,
                 ignore(agent_end(Id, Outcome)),
                 unit_release )),
    throw(Ball).

over_quota(Id, raised(error(resource_error(What), _))) :-
    !,
    print_message(warning, typhon(over_quota(Id, What))).
over_quota(_, _).

left :-
    output_rest,
    context_clear.

live(Goals0, Id, Host, Context, Next) :-
    (   journal_on
    ->  unit_run(metered_run(Id-Host, Context, Goals0, Outcome)),
        concluded(Outcome, Goals0, Id, Host, Context, Next0)
    ;   metered_run(Id-Host, Context, Goals0, Outcome),
        conclude(Outcome, Goals0, Id, Host, Context, Next0)
    ),
    (   Next0 = go(Goals)
    ->  live(Goals, Id, Host, Context, Next)
    ;   Next = Next0
    ).

%   probed(+Goals, ...): as live/5, seen by somebody goal by goal.

probed(Goals, Id, Host, Context, Next) :-
    probe_start(Context, Goals, Probe),
    probed_on(Probe, Id, Host, Context, Next).

probed_on(Probe, Id, Host, Context, Next) :-
    unit_run(probe_next(Probe, Step)),
    probed_to(Step, Probe, Id, Host, Context, Next).

probed_to(goal(Goal, Goals), Probe, Id, Host, Context, Next) :-
    probed_goal(Id, Host, Probe, Goal, Goals, Next0),
    (   Next0 == on
    ->  probed_on(Probe, Id, Host, Context, Next)
    ;   unit_commit,
        unit_release,
        traced_held(Id),
        held_obeys(Id),
        Next = stop
    ).
probed_to(outcome(Outcome, Goals0), _, Id, Host, Context, Next) :-
    concluded(Outcome, Goals0, Id, Host, Context, Next0),
    (   Next0 = go(Goals)
    ->  probed(Goals, Id, Host, Context, Next)
    ;   Next = Next0,
        probe_rests(Id)
    ).

%   Orders that came while it ran, and need no effect.

held_obeys(Id) :-
    at_once(Order),
    with_agent(Id, agent_unorder(Id, Order)),
    !,
    order_take(Id, Order),
    held_obeys(Id).
held_obeys(_).

at_once(dispose).
at_once(evacuate(_)).

%   concluded(+Outcome, +Goals0, ...): as conclude/6.  If there is a journal
%   what the agent has done in this turn is noted together with what it is to
%   do next, and then released: first of all, as somebody else may run it as
%   soon as it rests, and what it says then must not come before.

concluded(Outcome, Goals0, Id, Host, Context, Next) :-
    (   journal_on
    ->  journal_step(( turn_ends(Outcome, Id),
                       conclude(Outcome, Goals0, Id, Host, Context, Next),
                       noted(Next, Id) )),
        unit_release
    ;   conclude(Outcome, Goals0, Id, Host, Context, Next)
    ).

turn_ends(effect(Control, Hole, Goals), Id) :-
    !,
    \+ \+ ( Hole = Control,
            before_it_rests(Id, Goals) ).
turn_ends(done, Id) :-
    !,
    before_it_rests(Id, []).
turn_ends(_, _) :-
    unit_commit.

before_it_rests(Id, Goals) :-
    (   unit_has_effects
    ->  unit_commit,
        agent_put_down(Id, ready, Goals),
        journal_seal,
        unit_release
    ;   true
    ).

noted(stop, _).
noted(go(Goals), Id) :-
    agent_put_down(Id, ready, Goals).
noted(elsewhere(Goals), Id) :-
    agent_put_down(Id, ready, Goals).

%   conclude(+Outcome, +Goals0, +Id, +Host, +Context, -Next): Goals0 were run,
%   Next as of effect/5.

conclude(done, _, Id, _, Context, Next) :-
    finish(Id, Context, Next).
conclude(failed, Goals0, Id, _, _, stop) :-
    agent_fails(Id, failed, Goals0).
conclude(over(What), _, Id, _, _, stop) :-
    Outcome = raised(error(resource_error(What), _)),
    over_quota(Id, Outcome),
    ignore(agent_end(Id, Outcome)).
conclude(raised(Error), Goals0, Id, _, _, stop) :-
    agent_fails(Id, raised(Error), Goals0).
conclude(effect(Control, Hole, Goals), _, Id, Host, _, Next) :-
    (   agent_ordered(Id),
        term_attvars(Goals, [])         % else see effect/5
    ->  Hole = Control,
        with_agent(Id, agent_ready(Id, Goals)),
        Next = stop
    ;   catch(effect(Control, Hole, Goals, Id-Host, Next),
              error(Formal, Where),
              raised_at(Control, error(Formal, Where), Hole-Goals, Id-Host,
                        Next))
    ).

%   Who has passed a quota ends, whatever it would catch.

raised_at(_, _, _, Id-Host, stop) :-
    quota_any(Host),
    metered_ball(Outcome),
    !,
    over_quota(Id, Outcome),
    ignore(agent_end(Id, Outcome)).
raised_at(Control, Error, Hole-Goals, _, go(Goals)) :-
    answer_at(Control, throw(Error), Hole).

%   No goals are left: take the next message, or stay resident, or end.  That
%   on_message/2 does not want a message, or fails, is no reason to end.

finish(Id, context(Program, Module), Next) :-
    agent_handles(Program, Module),
    !,
    with_agent(Id, next_message(Id, Next)),
    received(Next, Id).
finish(Id, _, stop) :-
    ignore(agent_end(Id, done)).

%   An order comes first.

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
