:- module(typhon_stepping,
          [ agent_step/1                % +Agent
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../../kernel/host', [event/4, event_subscribed/1, host/3]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_order/2, agent_put/3, agent_status/3,
                agent_unorder/2, with_agent/2 ]).
:- use_module('../../language/faults', [printable_fallback/2]).
:- use_module('../../kernel/lifecycle',
              [ agent_answer/3, agent_join/3, held_parts/3, order_give/3,
                order_take/2, question_answered/2, turn_bounded/1,
                turn_settled/0, turn_unit/1 ]).
:- use_module('../../tools/administration', [agent_property/2]).
:- use_module('../../kernel/program',
              [ control_use/2, fault_note/1, fault_noted/1, machine_run/3,
                plain_goals/2 ]).
:- use_module(spying, [spied/3, spied_program/1]).
:- use_module(tracing,
              [ goal_shown/3, held_on/2, traced_goals/1, traced_held/1,
                traced_step/1, traced_stepwise/1 ]).

/** <module> Stepping: agents that are held before each goal

An agent that is stepped, or whose goals are traced, runs in a probe: an engine
in which the machine stops before each goal that it looks up.  Between two goals
the engine keeps all choice points and occupies no thread.  A stepped agent is
held before each goal, see typhon_ending, in the state probe(Probe, Seen); Seen
is true if a caller has received its position.

The machine looks goals up in the table '$mobile'/6 of the program's module.  A
probe passes this module instead, whose table yields the goal and then looks it
up in the table of the program.  A goal that Prolog runs to its end is one step.

*Threading*: any thread sends requests; the worker that runs the agent runs its
probe.
*/

:- multifile
    typhon_ending:dropped/1,
    typhon_questions:here/3,
    typhon_turn:engine/3,
    typhon_turn:over/1.

:- dynamic asker/2.             % Id, Asker: waits until Id is held or stops

                /*******************************
                *           REQUESTS           *
                *******************************/

%!  agent_step(+Agent) is det.
%
%   See the interface of the layer, typhon_trace.

agent_step(Agent) :-
    agent_answer(Agent, step, Answer),
    position(Answer, Agent, What),
    print_message(help, typhon(stepped(Agent, What))).

position(not_held, Agent, What) :-
    !,
    order_give(Agent, watched(step), _),
    agent_answer(Agent, step, Answer),
    position(Answer, Agent, What).
position(again, Agent, What) :-
    !,
    agent_answer(Agent, step, Answer),
    position(Answer, Agent, What).
position(bounded, Agent, _) :-
    !,
    permission_error(step, agent, Agent).
position(gone, Agent, What) :-
    !,
    (   agent_property(Agent, host(_))
    ->  position(again, Agent, What)
    ;   agent_join(Agent, Outcome, 5)
    ->  What = ended(Outcome)
    ;   existence_error(agent, Agent)
    ).
position(What, _, What).

typhon_questions:here(step, Agent, Asker) :-
    with_agent(Agent, step(Agent, Asker, Answer)),
    (   Answer == later
    ->  true
    ;   question_answered(Asker, answer(Answer))
    ).

step(Id, Asker, Answer) :-
    agent(Id, Host, _, _, Life),
    once(agent_status(Id, Status, Goals)),
    (   turn_bounded(Host)
    ->  Answer = bounded
    ;   \+ traced_stepwise(Life)
    ->  Answer = not_held
    ;   step(Status, Goals, Id-Host, Asker, Answer)
    ).

step(held, Held, Id-Host, Asker, Answer) =>
    held_parts(Held, probe(Probe, Seen), Goals),
    (   Seen == true
    ->  assertz(asker(Id, Asker)),
        held_on(Id, Held),
        Answer = later
    ;   put_held(Id, Probe, true, Goals),
        next_goal(Id, Host, Goals, Answer)
    ).
step(Status, _, Id-_, Asker, Answer), runs(Status) =>
    assertz(asker(Id, Asker)),
    Answer = later.
step(Status, _, Id-_, Asker, Answer), under_way(Status) =>
    agent_order(Id, asked(question(step), Asker)),
    Answer = later.
step(Status, _, _, _, Answer) =>
    rests(Status, Answer).

runs(ready).
runs(running).
runs(resumed).
runs(obeying).
runs(arriving).

%   In these states the request follows the agent.

under_way(leaving(_, _)).
under_way(transit(_, _)).
under_way(cloning(_, _)).

next_goal(Id, Host, [Goal|_], held(Address, Shown)) :-
    host(Host, Address, _),
    goal_shown(Id, Goal, Shown).

                /*******************************
                *             RUN              *
                *******************************/

typhon_turn:engine(_, resumed(Held), typhon_stepping:probe) :-
    held_parts(Held, probe(_, _), _).
typhon_turn:engine(Id-Host, goals(_), typhon_stepping:probe) :-
    agent(Id, _, _, Hash, Life),
    ( traced_goals(Life) ; spied_program(Hash) ),
    !,
    \+ turn_bounded(Host).             % no limit could end a probe in time

typhon_ending:dropped(probe(Probe, _)) :-
    probe_stop(Probe).

:- public probe/4.

probe(Turn, goals(Goals), Outcome, Goals0) :-
    Turn = turn(_, _, Context),
    probe_start(Context, Goals, Probe),
    probed(Probe, Turn, Outcome, Goals0).
probe(Turn, resumed(Held), Outcome, Goals0) :-
    held_parts(Held, probe(Probe, _), _),
    probed(Probe, Turn, Outcome, Goals0).

probed(Probe, Turn, Outcome, Goals0) :-
    turn_unit(probe_next(Probe, Step)),
    probed_to(Step, Probe, Turn, Outcome, Goals0).

probed_to(outcome(Outcome, Goals0), _, _, Outcome, Goals0).
probed_to(goal(Goal, Goals), Probe, Turn, Outcome, Goals0) :-
    Turn = turn(Id, Host, _),
    probed_goal(Id, Host, Probe, Goal, Goals, Next),
    (   Next == on
    ->  probed(Probe, Turn, Outcome, Goals0)
    ;   turn_settled,
        traced_held(Id),
        held_obeys(Id),
        Outcome = held
    ).

%   Carry out orders that arrived while Id ran and that need no effect of Id.

held_obeys(Id) :-
    at_once(Order),
    with_agent(Id, agent_unorder(Id, Order)),
    !,
    order_take(Id, Order),
    held_obeys(Id).
held_obeys(_).

at_once(dispose).
at_once(evacuate(_)).

%   probed_goal(+Id, +Host, +Probe, +Goal, +Goals, -Next): Probe stops before
%   Goal; Next is `on`, or `stop` if Id is held there.

probed_goal(Id, Host, Probe, Goal, Goals, Next) :-
    (   event_subscribed(goals)
    ->  printable_fallback(Goal, Portable),
        event(goals, Host, Id, goal(Portable))
    ;   true
    ),
    spied_goal(Id, Host, Goal),
    (   agent(Id, _, _, _, Life),
        traced_stepwise(Life)
    ->  maplist(printable_fallback, [Goal|Goals], Shown),
        with_agent(Id, hold(Id, Host, Probe, Shown, Askers, Answer)),
        answer(Askers, Answer),
        Next = stop
    ;   Next = on
    ).

spied_goal(Id, Host, Goal) :-
    agent(Id, _, _, Hash, _),
    spied(Hash, Goal, Action),
    !,
    printable_fallback(Goal, Portable0),
    goal_shown(Id, Portable0, Portable),
    host(Host, Address, _),
    (   Action == hold
    ->  traced_step(Id),
        print_message(help, typhon(spied(Id, Address, Portable)))
    ;   print_message(help, typhon(traced(Id, Address, goal(Portable))))
    ).
spied_goal(_, _, _).

hold(Id, Host, Probe, Goals, Askers, Answer) :-
    askers(Id, Askers),
    (   Askers == []
    ->  Seen = false
    ;   Seen = true
    ),
    put_held(Id, Probe, Seen, Goals),
    next_goal(Id, Host, Goals, Answer).

put_held(Id, Probe, Seen, Goals) :-
    agent_put(Id, held, held(probe(Probe, Seen), Goals)).

askers(Id, Askers) :-
    (   retract(asker(Id, Asker))
    ->  Askers = [Asker|More],
        askers(Id, More)
    ;   Askers = []
    ).

answer(Askers, Answer) :-
    forall(member(Asker, Askers), question_answered(Asker, answer(Answer))).

%   Id has stopped without reaching a goal: answer the callers that wait for its
%   next goal.

typhon_turn:over(Id) :-
    asker(Id, _),
    !,
    with_agent(Id, stopped(Id, Askers, Answer)),
    answer(Askers, Answer).

stopped(Id, Askers, Answer) :-
    (   agent_status(Id, Status, _)
    ->  (   runs(Status)                % Id may still reach a goal
        ->  Askers = []
        ;   askers(Id, Askers),
            rests(Status, Answer)
        )
    ;   askers(Id, Askers),
        Answer = gone
    ).

rests(Status, again) :-
    under_way(Status),
    !.
rests(Status, rests(State)) :-
    functor(Status, State, _).

                /*******************************
                *         GOAL BY GOAL         *
                *******************************/

%   probe_start(+Context, +Goals, -Probe), probe_next(+Probe, -Step),
%   probe_stop(+Probe)
%
%   Probe runs Goals as machine_run/3 does.  A Step is goal(Goal, Goals), the
%   next goal and the goals after it that the machine has already unfolded; or,
%   at the end, outcome(Outcome, Goals0), with the goals at which the turn
%   began.  The probe ends with its outcome, or when it is stopped.  Its fault
%   is noted in the thread that has received the outcome.

probe_start(context(Program, Agent), Goals, Probe) :-
    (   nb_current(typhon_turns, Context)
    ->  true
    ;   Context = none
    ),
    engine_create(Step, run(Context, Program, Agent, Goals, Step), Probe).

%   An engine has its own global variables, so these variables are set again.

run(Context, Program, Agent, Goals, outcome(Outcome, Goals)-Note) :-
    nb_setval(typhon_turns, Context),
    nb_setval(typhon_probed, Program),
    machine_run(context(typhon_stepping, Agent), Goals, Outcome),
    fault_noted(Note),
    stops_at(Outcome).

%   An agent that is woken repeats its other controls to check the time.  They
%   are no new steps.

stops_at(Outcome) :-
    (   Outcome = effect(Control, _, [_|Goals]),
        control_use(Control, called(_))
    ->  engine_yield(goal(Control, Goals)-none)
    ;   true
    ).

:- public '$mobile'/6.

'$mobile'(Goal, Program:Clause, More, Goals, Barrier, Guard) :-
    plain_goals(Goals, Left),
    engine_yield(goal(Goal, Left)-none),
    nb_getval(typhon_probed, Program),
    Program:'$mobile'(Goal, Clause, More, Goals, Barrier, Guard).

probe_next(Probe, Step) :-
    engine_next(Probe, Step0-Note),
    Step = Step0,
    (   Step = outcome(_, _)
    ->  fault_note(Note),
        probe_stop(Probe)
    ;   true
    ).

probe_stop(Probe) :-
    engine_destroy(Probe).
