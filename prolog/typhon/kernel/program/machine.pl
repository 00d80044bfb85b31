:- module(typhon_machine,
          [ machine_run/3,              % +Context, +Goals, -Outcome
            answer_at/3,                % +Control, +Answer, -Goal
            machine_ready/1,            % +Context
            ruled/2,                    % +Heads, +Context
            handed/6                    % +Place, +Vars, +Goals, +Context,
                                        % +Base, -Out
          ]).
:- use_module('../base/error_text', [is_abort/1]).
:- use_module(bodies,
              [ body_goals/4, called_goal/2, goals_body/2, special/2,
                waiting_service/3 ]).
:- use_module(chunks,
              [ chunks_ready/1, frame_goals/4, goals_without/3,
                place_marked/3, plain_goals/2 ]).
:- use_module(faults, [fails/2, fails_inside/2]).
:- use_module(thread_state, [step_ended/1]).

/** <module> The machine: agents that can stop in the middle of a clause

The control state of an agent is a list of goals still to run.  The machine
takes goals from its front.  It unfolds control constructs and mobile
predicates (those that can reach a control predicate, see typhon_mobile) into
the list; it calls every other goal natively.  At a control predicate the
machine stops and returns the remaining goals as a plain term: it can be
printed, stored, sent and run again elsewhere.

A suspended goal list holds only what the programmer wrote.  Three rules make
this possible:

  - A control predicate commits. Choice points left of it are discarded,
    so `!` in a suspended list can only cut choice points that are made after
    it is resumed: to the base of the run.
  - Conditions and catch/3 are _frames_: the rest of a condition is the
    condition of the remaining if-then-else, the rest of a catch/3 is
    inside that catch/3. The else branch and the recovery survive the
    suspension.
  - The control predicate itself is replaced by a _hole_, a variable:
    the caller that resumes the agent binds it to `true`, `fail`, `throw(Error)`
    or any other goal.

*Threading*: pure with respect to the agent; any thread may run any machine.
Two threads must not run the same agent.
*/

:- multifile
    elsewhere/3,                % Context, Goals, Outcome: another process runs
                                % them
    checked/3.                  % Context, Goal, Called: Goal may call Called

%!  machine_run(+Context, +Goals, -Outcome) is det.
%
%   Run Goals up to the next effect.
%
%   @arg Context is context(Program, Agent): the module of the program
%        (see typhon_code) and the module of the agent.
%   @arg Outcome is one of `done`, `failed`, raised(Error) or
%        effect(Control, Hole, Goals), where Control is the control
%        predicate reached and Goals what is left to run.  Goals contains
%        the variable Hole where Control stood.  Where an option runs the
%        agent elsewhere, Outcome is also `held`, if its outcome will come
%        later, or lost(Why).
%
%   The cause of `failed` or raised(_) is noted, see typhon_faults, which knows,
%   as typhon_chunk_faults, the frames of machine_run/3, first_outcome/3,
%   catching/7, inside/5, called/5 and raises/3.

machine_run(Context, Goals, Outcome) :-
    catch(first_outcome(Goals, Context, Outcome), Ball, Raised = true),
    step_ended(Context),
    (   Raised == true                  % no last call: the frame stays
    ->  raised(Ball, Outcome)
    ;   true
    ).

%!  machine_ready(+Context) is det.
%
%   Compile the program, so that compiling does not count in the limits of a
%   run.

machine_ready(context(Program, _)) :-
    ignore(chunks_ready(Program)).

%   Exceptions that end a thread are not passed on to the agent.

raised(Ball, Outcome) :-
    (   is_abort(Ball)
    ->  throw(Ball)
    ;   Outcome = raised(Ball)
    ).

first_outcome(Goals, Context, Outcome) :-
    elsewhere(Context, Goals, Outcome0),
    !,
    Outcome = Outcome0.
first_outcome(Goals, Context, Outcome) :-
    Context = context(Program, Agent),
    (   chunks_ready(Program)           % usually
    ->  X = compiled(Program, Agent)
    ;   X = Context
    ),
    prolog_current_choice(Base),
    continue(Goals, X, Base, Out),
    !,
    outcome(Out, Outcome).
first_outcome(_, _, failed).

outcome(exit, done).
outcome(effect(Control, Hole, [First|Goals0]), Outcome) :-
    Outcome = effect(Control, Hole, [First|Goals]),
    var(First),                         % usually the hole
    !,
    goals_without(Goals0, cuts, Goals).
outcome(effect(Control, Hole, Goals0), effect(Control, Hole, Goals)) :-
    goals_without(Goals0, cuts, Goals).

                /*******************************
                *           THE RUN            *
                *******************************/

%   run(+Goals, +Context, +Base, -Out) is nondet: Out is `exit` for each
%   solution of Goals, or effect(...) where a control predicate is reached.
%   `!` in Goals cuts to Base, the choice point at which the run began.

run([], _, _, exit).
run([Goal|Goals], Context, Base, Out) :-
    step(Goal, Goals, Context, Base, Out).

:- public                               % chunks call these
    continue/4,
    step/5.

%!  continue(+Goals, +Context, +Base, -Out) is nondet.
%
%   As run/4, but goals that are the rest of a clause are run as the chunk that
%   they stand for.

continue([Goal|Goals], X, Base, Out) :-
    Goal == true,
    !,
    continue(Goals, X, Base, Out).
continue([Goal|Goals], X, Base, Out) :-
    X = compiled(Program, Agent),
    nonvar(Goal),
    Goal = '$k'(Place, Vars),
    !,
    @(Program:'$k'(Place, Vars, Goals, X, Base, Out), Agent).
continue(Goals, X, Base, Out) :-
    (   X = compiled(Program, Agent),
        Goals = [Goal|_],
        nonvar(Goal),
        '$get_predicate_attribute'(Program:'$frame'(_, _, _, _, _), defined, 1),
        Program:'$frame'(Goal, Goals, Base, '$k'(Place, Vars), Rest)
    ->  @(Program:'$k'(Place, Vars, Rest, X, Base, Out), Agent)
    ;   run(Goals, X, Base, Out)
    ).

%   step(+Goal, +Goals, +Context, +Base, -Out): one rule for each construct.

step('$k'(Place, Vars), Goals, X, Base, Out) =>
    (   X = compiled(Program, Agent)
    ->  @(Program:'$k'(Place, Vars, Goals, X, Base, Out), Agent)
    ;   frame_goals(Place, Vars, Own, Goals),
        run(Own, X, Base, Out)
    ).
step(true, Goals, X, Base, Out) =>
    run(Goals, X, Base, Out).
step((A,B), Goals, X, Base, Out) =>
    step(A, [B|Goals], X, Base, Out).
step(!, Goals, X, Base, Out) =>
    prolog_cut_to(Base),
    run(Goals, X, Base, Out).
step('$cut'(Barrier), Goals, X, Base, Out) =>
    prolog_cut_to(Barrier),
    run(Goals, X, Base, Out).
step((Or;Else), Goals, X, Base, Out) =>
    either(Or, Else, Goals, X, Base, Out).
step((If->Then), Goals, X, Base, Out) =>
    either((If->Then), fail, Goals, X, Base, Out).
step((If*->Then), Goals, X, Base, Out) =>
    either((If*->Then), fail, Goals, X, Base, Out).
step(\+ Goal, Goals, X, Base, Out) =>
    (   \+ native(Goal, Goals, X)
    ->  run(Goals, X, Base, Out)
    ;   fails(\+ Goal, Goals)
    ).
step(call(Goal), Goals, X, Base, Out) =>
    prolog_current_choice(Barrier),
    body_goals(Goal, Barrier, More, Goals),
    run(More, X, Base, Out).
step(once(Goal), Goals, X, Base, Out) =>
    either((Goal->true), fail, Goals, X, Base, Out).
step(ignore(Goal), Goals, X, Base, Out) =>
    either((Goal->true), true, Goals, X, Base, Out).
step(catch(Goal, Catcher, Recovery), Goals, X, Base, Out) =>
    catching(Goal, Catcher, Recovery, Goals, X, Base, Out).
step('$at'(Control, fail), Goals, _, _, _) =>
    fails(Control, Goals).
step('$at'(Control, throw(Error)), Goals, _, _, _) =>
    raises(Error, Control, Goals).
step(Goal, Goals, X, Base, Out), var(Goal) =>
    called(call(Goal), Goals, X, Base, Out).
step(Goal, Goals, X, Base, Out), special(Goal, Kind) =>
    special(Kind, Goal, Goals, X, Base, Out).
step(Goal, Goals, X, Base, Out) =>
    called(Goal, Goals, X, Base, Out).

special(control, Goal, Goals, _, _, effect(Goal, Hole, [Hole|Goals])).
special(call, Goal, Goals, X, Base, Out) :-
    (   called_goal(Goal, Called)
    ->  step(call(Called), Goals, X, Base, Out)
    ;   called(Goal, Goals, X, Base, Out)       % raises an error
    ).
special(checked, Goal, Goals, X, Base, Out) :-
    arg(1, X, Program),
    arg(2, X, Agent),
    checked(context(Program, Agent), Goal, Called),
    step(call(Called), Goals, X, Base, Out).

%   called(+Goal, ...): a goal that is no construct.  It is unfolded by a
%   clause of the program or of the agent's own rules, or called natively.

called(Goal, Goals, X, Base, Out) :-
    arg(2, X, Agent),
    (   entry(X, Goal, Goals, Base, Out, Entry, Condition),
        mobile(Condition, Agent)
    ->  @(Entry, Agent)
    ;   state_rule(Agent, Goal)
    ->  prolog_current_choice(Barrier),
        (   clause(Agent:Goal, Body)
        *-> body_goals(Body, Barrier, More, Goals),
            run(More, X, Base, Out)
        ;   fails(Goal, Goals)
        )
    ;   service_waits(Goal, Agent, Body)
    ->  body_goals(Body, _, More, Goals),
        run(More, X, Base, Out)
    ;   Agent:Goal
    *-> still_needed(Goal, Goals),
        run(Goals, X, Base, Out)
    ;   fails(Goal, Goals)
    ).

%   entry(+Context, +Goal, +Goals, +Base, -Out, -Entry, -Condition) is
%   semidet: Entry runs Goal, which is to be unfolded if Condition holds, and
%   then Goals.

entry(compiled(Program, Agent), Goal, Goals, Base, Out, Program:Run,
      Condition) :-
    Program:'$run'(Goal, Run, Goals, compiled(Program, Agent), Base, Out,
                   Condition).
entry(context(Program, Agent), Goal, Goals, Base, Out,
      typhon_machine:unfolded(Program:Clause, Goal, Barrier, More, Goals,
                              context(Program, Agent), Base, Out),
      Condition) :-
    Program:'$mobile'(Goal, Clause, More, Goals, Barrier, Condition).

unfolded(Clause, Goal, Barrier, More, Goals, X, Base, Out) :-
    prolog_current_choice(Barrier),
    (   Clause
    *-> run(More, X, Base, Out)
    ;   fails(Goal, Goals)
    ).

%   either(+Or, +Else, ...): (Or;Else), where Or may be a condition.

either((If->Then), Else, Goals, X, Base, Out) =>
    Frame = Sub-(Sub->Then;Else),
    (   inside(If, Frame, Goals, X, Out0)
    ->  proceed(Out0, Then, Goals, Frame, X, Base, Out)
    ;   otherwise(Else, (If->Then), Goals, X, Base, Out)
    ).
either((If*->Then), Else, Goals, X, Base, Out) =>
    Frame = Sub-(Sub*->Then;Else),
    (   each_inside(If, Frame, Goals, X, Out0)
    *-> proceed(Out0, Then, Goals, Frame, X, Base, Out)
    ;   otherwise(Else, (If*->Then), Goals, X, Base, Out)
    ).
either(Or, Else, Goals, X, Base, Out) =>
    (   step(Or, Goals, X, Base, Out)
    ;   step(Else, Goals, X, Base, Out)
    ).

%   Without an else branch the whole construct fails.

otherwise(Else, If, Goals, X, Base, Out) :-
    (   Else == fail
    ->  fails(If, Goals)
    ;   step(Else, Goals, X, Base, Out)
    ).

%   inside(+Goal, +Frame, +Goals, +X, -Out): run Goal as the part of a
%   construct that Frame continues, see proceed/7.  Faults are read from this
%   call's Prolog frame, so Frame and Goals stay alive until Goal has ended.

inside(Goal, Frame, Goals, X, Out) :-
    prolog_current_choice(Base),
    step(Goal, [], X, Base, Out),
    still_needed(Frame, Goals).

still_needed(_, _).

%   each_inside(+Goal, +Frame, +Goals, +X, -Out) is nondet: likewise, for each
%   solution of Goal.  A cut in Goal cannot cut to the choice point of *->,
%   which no longer exists when the second solution of Goal is computed.

each_inside(Goal, Frame, Goals, X, Out) :-
    prolog_current_choice(Other),       % the other clause
    inside(Goal, Frame, Goals, X, Out),
    prolog_current_choice(Now),
    ( Now == Other -> ! ; true ).
each_inside(_, _, _, _, _) :-
    fail.

%   Errors that are not caught here pass unchanged: to catch and rethrow them
%   would lose the place where they were raised.  Prolog itself raises an abort
%   again when the second goal of catch/3 ends, so no agent catches it.

catching(Goal, Catcher, Recovery, Goals, X, Base, Out) :-
    Frame = Sub-catch(Sub,Catcher,Recovery),
    (   catch(inside(Goal, Frame, Goals, X, Out0), Catcher,
              Out0 = caught(Catcher))
    *-> recovered(Out0, Recovery, Goals, Frame, X, Base, Out)
    ;   fails_inside(Frame, Goals)
    ).

recovered(caught(_), Recovery, Goals, _, X, Base, Out) =>
    step(call(Recovery), Goals, X, Base, Out).
recovered(Out0, _, Goals, Frame, X, Base, Out) =>
    proceed(Out0, true, Goals, Frame, X, Base, Out).

%   proceed(+Out0, +Then, +Goals, +Frame, ...): a sub run has ended or stopped.
%   Frame is Sub-Goal: Goal continues the rest Sub of the sub run.

proceed(exit, Then, Goals, _, X, Base, Out) :-
    step(Then, Goals, X, Base, Out).
proceed(effect(Control, Hole, Sub), _, Goals, Rest-Frame, _, _,
        effect(Control, Hole, [Frame|Goals])) :-
    plain_goals(Sub, Plain),
    goals_body(Plain, Rest).

%!  answer_at(+Control, +Answer, -Goal) is det.
%
%   Bind the hole to Goal to make Control fail or raise an error: Answer is
%   `fail` or throw(Error).

answer_at(Control, Answer, '$at'(Control, Answer)).

raises(Error, Control, Goals) :-
    throw(Error),
    still_needed(Control, Goals).

%!  ruled(+Heads, +Context) is semidet.
%
%   For chunks: one of Heads is a predicate of the agent's state that has
%   rules, so that it may stop.

ruled(Heads, X) :-
    arg(2, X, Agent),
    has_rule(Heads, Agent).

%!  handed(+Place, +Vars, +Goals, +Context, +Base, -Out) is nondet.
%
%   For chunks: the machine runs the rest of the chunk at Place, and Goals.

handed(Place, Vars, Goals, X, Base, Out) :-
    place_marked(Place, Vars, Left-Goals),
    run(Left, X, Base, Out).

%   mobile(+Condition, +Agent): this static predicate must be unfolded.

mobile(mobile, _).
mobile(outside(Heads), Agent) :-
    has_rule(Heads, Agent).

has_rule([Head|Heads], Agent) :-
    (   '$get_predicate_attribute'(Agent:Head, number_of_rules, Count),
        Count \== 0,                    % usually not: no more is called
        ( state_rule(Agent, Head) ; service_waits(Head, Agent, _) )
    ->  true
    ;   has_rule(Heads, Agent)
    ).

%   Goal is a predicate of the agent's own state that has rules.

state_rule(Agent, Goal) :-
    '$get_predicate_attribute'(Agent:Goal, number_of_rules, N),
    N > 0,
    '$c_current_predicate'(_, Agent:Goal),
    predicate_property(Agent:Goal, dynamic),
    \+ predicate_property(Agent:Goal, imported_from(_)).

%   service_waits(+Goal, +Agent, -Body) is semidet: Goal is a service of the
%   place, and not a predicate of the agent or of the vocabulary.

service_waits(Goal, Agent, Body) :-
    waiting_service(Goal, Begin, Body),
    '$get_predicate_attribute'(Agent:Begin, defined, 1),
    !.

native(Goal, Goals, X) :-
    inside(Goal, _-(\+ Goal), Goals, X, Out),
    (   Out = effect(Control, _, _)
    ->  functor(Control, Name, Arity),
        raises(error(permission_error(call, control_predicate,
                                      Name/Arity), _),
               \+ Goal, Goals)
    ;   true
    ).
