:- agent(learner, [state([setting/2, shareable/1, bag/1, begin/1, count/1,
                          solution/1])]).
:- discontiguous default/4.
:- include(parameters).
:- include('../lib/keep').
:- include('../lib/await_order').
:- include('../lib/clones').
:- include(resources).
:- include(telling).
:- include(sharing).
:- include(breeding).

/*  Algorithm 1 of the thesis: agents that learn from the feedback of hosts to
    their actions, and from each other when they meet.

    Executor      has the trainer of the host execute the plan
    Collector     moves from host to host, and collects in its bag what other
                  agents in the same queue share
    Assimilator   makes a plan of its own and the collected units
    Converger     has reached the goal, and searches for an agent with a
                  better solution

    A payload, the learning algorithm, makes plans. It provides

        plan(+Start, +Units, -Plan)   Units are pairs Unit-Weight, in the
                                      standard order, Start the sensor
                                      vector where executions begin
        better(+Actions, +Others)     true if the solution Actions is better
                                      than Others

    The payload can be exchanged while the agent runs; the agent waits while
    it has none.

    State: shareable(Units), units of its own executions, which it shares;
    bag(Units), units shared by others and not yet assimilated;
    solution(Actions), actions that led to the goal.

    On the hosts: trainer(Id), and queued(Id) for each agent in the queue,
    in the order of arrival.  The capacity of the host limits the length of
    the queue.
*/

main :-
    await_order,
    keep(shareable([])),
    keep(bag([])),
    keep(count(0)),
    endowed,
    executor([]).

                /*******************************
                *           EXECUTOR           *
                *******************************/

executor(Plan) :-
    sense(trainer(Trainer)),
    !,
    length(Plan, Length),
    potential(Length, Xi),
    send(Trainer, execute(Plan, Xi)),
    parameter(execution, Seconds),
    (   await(Trainer, feedback(Start, Units, Outcome), Seconds)
    ->  executed(Start, Length, Units, Outcome),
        bred(Outcome, Length),
        after(Outcome)
    ;   log(unanswered(Trainer)),
        collector
    ).
executor(_) :-
    collector.

potential(Length, Xi) :-
    parameter(search, Search),
    parameter(k_d, Kd),
    initial_potential(Length, Search, Kd, Xi).

executed(Start, Length, Units0, Outcome) :-
    sort(Units0, Units),
    shareable(Old),
    ord_union(Old, Units, All),
    keep(shareable(All)),
    keep(begin(Start)),
    count(Count0),
    Count is Count0 + 1,
    keep(count(Count)),
    length(All, Size),
    functor(Outcome, What, _),
    log(executed(Count, Length, Size, What)).

after(reached(Actions)) :-
    keep(solution(Actions)),
    converger.
after(unreached) :-
    retractall(solution(_)),
    collector.

                /*******************************
                *           COLLECTOR          *
                *******************************/

collector :-
    parameter(rho_max, Rho),
    collector(Rho).

collector(Rho) :-
    exhausted(Rho),
    !,
    assimilator.
collector(Rho0) :-
    hop(Rho0, Rho1),
    visit(anything, Gain),
    rewarded(Gain, Rho1, Rho),
    collector(Rho).

exhausted(Rho) :-
    parameter(rho_min, Minimum),
    Rho < Minimum.

rewarded(none, Rho, Rho).
rewarded(gain(Before, After), Rho0, Rho) :-
    parameter(c, C),
    parameter(rho_max, Maximum),
    migration_reward(Rho0, Before, After, C, Maximum, Rho).

                /*******************************
                *          ASSIMILATOR         *
                *******************************/

%   There is no plan only while the learning algorithm is exchanged.  The
%   machine does not unfold what payloads do in findall/3, so that is much
%   faster.

assimilator :-
    shareable(Own),
    bag(Bag),
    ord_union(Own, Bag, Units),
    learnt(Units, Plan),
    !,
    keep(bag([])),
    executor(Plan).
assimilator :-
    linger,
    assimilator.

learnt([], Plan) :-
    !,
    Plan = [].
learnt(Units, Plan) :-
    begin(Start),
    provided(plan/3),
    findall(Plan0, once(plan(Start, Units, Plan0)), [Plan]).

provided(PI) :-
    once(current_predicate(PI)).

                /*******************************
                *           CONVERGER          *
                *******************************/

converger :-
    parameter(rho_max, Rho),
    solution(Actions),
    length(Actions, Length),
    log(reached(Length)),
    converger(Rho).

converger(Rho) :-
    exhausted(Rho),
    !,
    solution(Actions),
    count(Count),
    hops(Hops),
    log(converged(Count, Hops, Actions)).
converger(Rho0) :-
    hop(Rho0, Rho),
    visit(better, Gain),
    (   Gain == none
    ->  converger(Rho)
    ;   collector
    ).

                /*******************************
                *            MOVING            *
                *******************************/

%   hop(+Rho0, -Rho): moves to another host, however long that takes.  A full
%   host counts as visited, so that the next attempt chooses another one.

hop(Rho0, Rho) :-
    (   moved
    ->  bag(Bag),
        bag_weight(Bag, Pi),
        parameter(rho_max, Maximum),
        migration_penalty(Rho0, Pi, Maximum, Rho)
    ;   linger,
        hop(Rho0, Rho)
    ).

moved :-
    parameter(epsilon, Epsilon),
    next_host(epsilon_conscientious(Epsilon), Host),
    catch(move(Host), error(_, _), fail).

linger :-
    parameter(patience, Seconds),
    deadline(Seconds, Until),
    queue,
    answer_until(Until),
    unqueue.

queue :-
    self(Me),
    leave(queued(Me)).

unqueue :-
    self(Me),
    ignore(take(queued(Me))).
