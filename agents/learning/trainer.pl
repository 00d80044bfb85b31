:- agent(trainer, [state([setting/2])]).
:- include(parameters).
:- include('../lib/keep').
:- include('../lib/chance').
:- include(telling).
:- include(resources).

/*  The static agent of a host: executes the actions of a problem, and gives
    feedback (thesis section 4.2.2). A payload, the problem, defines the
    actions.  The program that creates the trainer leaves the tuple
    trainer(Id); agents find the trainer by it.

        execute(Plan, Xi)   request of an agent: Plan is a list of actions.
                            The trainer executes these, then random ones,
                            until the execution potential Xi is used up or
                            the goal is reached

        feedback(Start, Units, Outcome)
                            the answer: the sensor vector at the start, the
                            shareable intelligence as pairs Unit-Weight,
                            and reached(Actions), the actions that led to the
                            goal, or unreached

    A problem is a payload file that provides

        start(+Chance, -State)          the initial state of an execution
        actions(-Actions)               all actions
        act(+Action, +State0, -State)
        sensed(+State, -Vector)         the sensor vector, ground
        weight(+Vector0, +Vector, -W)   phi_w of an action between the two;
                                        W > 0 is a positive feedback
        reached(+State)                 true if State is the goal
        shareable(+Steps, -Units)       Steps, step(Vector0, Action, Vector,
                                        W), are the executed actions;
                                        Units, pairs Unit-Weight, the units
                                        worth sharing

    Chance is a state of typhon_prng, a new one for each execution.
*/

main :-
    seed_chance_here.

on_message(Agent, execute(Plan, Xi)) :-
    findall(Steps-Feedback, once(execute(Plan, Xi, Steps, Feedback)),
            [Steps-Feedback]),          % not unfolded, so fast
    trace(Agent, Steps),
    ignore(told(Agent, Feedback)).      % Agent may have ended

%   Logs the actions, in order, for observers.

trace(Agent, Steps) :-
    (   parameter(trace, true)
    ->  performed(Steps, Actions),
        log(tried(Agent, Actions))
    ;   true
    ).

performed(Steps, Actions) :-
    findall(Action, member(step(_, Action, _, _), Steps), Actions).

execute(Plan, Xi, Steps, feedback(Start, Units, Outcome)) :-
    chance(Chance0),
    typhon_prng:chance_below(1<<30, Seed, Chance0, Chance1),
    typhon_prng:chance_seed(Seed, Beginning),
    start(Beginning, State0),
    sensed(State0, Start),
    executed(Plan, Xi, at(State0, Start), Steps, at(State, _), Chance1,
             Chance),
    keep(chance(Chance)),
    shareable(Steps, Units),
    outcome(State, Steps, Outcome).

outcome(State, Steps, reached(Actions)) :-
    reached(State),
    !,
    performed(Steps, Actions).
outcome(_, _, unreached).

%   executed(+Plan, +Xi, +At0, -Steps, -At, +Chance0, -Chance): At0 and At
%   are at(State, Vector).  The reward of equation 4.6 applies only to actions
%   beyond the plan.

executed(_, Xi, At, [], At, Chance, Chance) :-
    At = at(State, _),
    (   Xi =< 0
    ;   reached(State)
    ),
    !.
executed([Action|Plan], Xi0, At0, [Step|Steps], At, Chance0, Chance) :-
    step(Action, At0, At1, Step),
    pay(Xi0, Xi),
    executed(Plan, Xi, At1, Steps, At, Chance0, Chance).
executed([], Xi0, At0, [Step|Steps], At, Chance0, Chance) :-
    actions(Actions),
    typhon_prng:chance_member(Action, Actions, Chance0, Chance1),
    step(Action, At0, At1, Step),
    pay(Xi0, Xi1),
    feedback(Step, Xi1, Xi),
    executed([], Xi, At1, Steps, At, Chance1, Chance).

step(Action, at(State0, Vector0), at(State, Vector),
     step(Vector0, Action, Vector, Weight)) :-
    act(Action, State0, State),
    sensed(State, Vector),
    weight(Vector0, Vector, Weight).

pay(Xi0, Xi) :-
    parameter(k_d, Kd),
    action_cost(Xi0, Kd, Xi).

feedback(step(_, _, _, Weight), Xi0, Xi) :-
    Weight > 0,
    !,
    parameter(k_r, Kr),
    action_reward(Xi0, Kr, Xi).
feedback(_, Xi, Xi).
