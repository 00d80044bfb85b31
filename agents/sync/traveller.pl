:- agent(traveller, [state([plan/3, setting/2, drive/3, after/3])]).
:- include('../lib/parameters').
:- include('../lib/await_order').
:- include(potential).
:- include(plans).
:- include(dependence).

/*  Algorithm 2 of the thesis: independent agents execute a sequence of tasks
    on hosts, and proceed to the next task at the same time.  Lines are those
    of the algorithm.

    The fact plan(Sequence, Version, Tasks) has the name of the sequence, and
    a list of Task-Goal in order.  Goal is the code of the task, which the
    agent sends to the worker of each host.  plans.pl explains Version,
    dependence.pl explains after/3; both can be skipped. There is a fact
    drive(Task, Potential, History) for each task.  Facts setting(Name, Value)
    replace the defaults below.

    On the hosts: task(Sequence, Task, Status, Time) records the status of
    Task.  worker(Sequence, Id) is present while the host's worker is free.
    The agent that takes this tuple has the host for itself until it is put
    back, so two agents never service one host at the same time.  Without the
    tuple the host is executing or takes no part in the sequence, and the
    agent moves on.
*/

default(delta, 0.5, range(0.01, 2, 0.01), "penalty bias").
default(theta, 15, range(1, 100, 0.5), "initial value of a history").
default(maximum, 100, range(1, 1000, 0.5),
        "of a potential; its initial value, too").
default(window, 15, range(1, 100, 1), "length of the history").
default(strategy, conscientious, ground, "of migration, see next_host/2").
default(patience, 1, range(0.1, 20, 0.1),
        "seconds between attempts to leave a host").
default(start, now, [now, order], "order: waits for the message begin").

main :-
    await_order,
    fill_new,
    log(begun),
    patrol.

patrol :-
    compare_plans,
    current(Task),
    !,
    visit(Task),
    travel,
    patrol.
patrol.                          % all potentials are zero

%   Lines 15, 18 and 23.

travel :-
    parameter(strategy, Strategy),
    next_host(Strategy, Host),
    !,
    catch(move(Host), error(_, _), pause).
travel :-
    pause.

pause :-
    parameter(patience, Seconds),
    sleep(Seconds).

%   Lines 2 to 10: Task is the task the agent searches for, the first one with
%   potential left.

current(Task) :-
    plan(_, _, Tasks),
    member(Task-_, Tasks),
    drive(Task, Potential, _),
    Potential =\= 0,
    !.

%   Lines 11 to 24.  At a host that executes a task, an agent is neither
%   rewarded nor penalised.  This is tested first: as printed in the thesis,
%   a task that is executing would be serviced again.

visit(Task) :-
    plan(Sequence, _, Tasks),
    seize(Worker),
    !,
    (   missing(Tasks, Sequence, Task, Missing)
    ->  heal(Missing, Task),
        current(Next),
        service_if(Next, Missing, Worker)
    ;   give_back(Worker),
        penalise(Task)
    ).
visit(_).

%   If the agent finds a failure, it may have to begin with an earlier task
%   than the one that is missing here.  A host that waits for another sequence
%   will need the task: this gives the same reward as a service.

service_if(Missing, Missing, Worker) :-
    held_up(Missing),
    !,
    give_back(Worker),
    reward(Missing).
service_if(Missing, Missing, Worker) :-
    !,
    service(Missing, Worker).
service_if(_, _, Worker) :-
    give_back(Worker).

%   Line 29, for line 11: Missing is the first task up to Task that is not
%   completed here.

missing([Missing-_|_], Sequence, _, Missing) :-
    \+ sense(task(Sequence, Missing, completed, _)),
    !.
missing([Earlier-_|Tasks], Sequence, Task, Missing) :-
    Earlier \== Task,
    missing(Tasks, Sequence, Task, Missing).

%   Lines 12 to 14.

service(Task, Worker) :-
    bring_plan,
    plan(Sequence, _, Tasks),
    memberchk(Task-Goal, Tasks),
    ignore(take(task(Sequence, Task, failed(_), _))),
    now(Time),
    leave(task(Sequence, Task, executing, Time)),
    order(Task, Goal, Order),
    send(Worker, Order),
    reward(Task).

                /*******************************
                *         SELF-HEALING         *
                *******************************/

%   A missing task before the task searched for gets as much potential as the
%   last reward or penalty.  After a cascaded failure all tasks from its first
%   one on get their initial potential and history.

heal(Missing, Task) :-
    plan(Sequence, _, Tasks),
    sense(task(Sequence, Missing, failed(cascaded(First)), _)),
    append(_, [First-_|Later], Tasks),
    begins_again(First, Missing, Task),
    !,
    forall(member(Next-_, Later), fill(Next)),
    refill(First, Task).
heal(Task, Task) :-
    !.
heal(Missing, Task) :-
    drive(Task, _, History),
    last(History, Theta),
    drive(Missing, Potential0, _),
    parameter(maximum, Maximum),
    increase(Potential0, Theta, Maximum, Potential),
    parameter(theta, Theta0),
    keep(Missing, drive(Potential, [Theta0])),
    log(revived(Missing, Potential)).

%   An agent that searches for Missing, a later task than First, has begun again
%   with First before.

begins_again(Missing, Missing, _) :-
    !.
begins_again(_, Missing, Task) :-
    Missing \== Task.

refill(Task, Task) :-
    !.
refill(First, _) :-
    fill(First),
    drive(First, Potential, _),
    log(revived(First, Potential)).

                /*******************************
                *      REWARDS, PENALTIES      *
                *******************************/

%   Lines 13 and 14, 21 and 22.

reward(Task) :-
    parameter(maximum, Maximum),
    parameter(window, Window),
    drive(Task, Potential0, History0),
    rewarded(drive(Potential0, History0), Maximum, Window, Theta, Drive),
    keep(Task, Drive),
    Drive = drive(Potential, _),
    log(reward(Task, Potential, Theta)).

penalise(Task) :-
    parameter(maximum, Maximum),
    parameter(window, Window),
    parameter(delta, Delta),
    drive(Task, Potential0, History0),
    penalised(drive(Potential0, History0), Maximum, Window, Delta, Theta,
              Drive),
    keep(Task, Drive),
    Drive = drive(Potential, _),
    log(penalty(Task, Potential, Theta)).

fill(Task) :-
    parameter(maximum, Potential),
    parameter(theta, Theta),
    keep(Task, drive(Potential, [Theta])).

keep(Task, drive(Potential, History)) :-
    retractall(drive(Task, _, _)),
    assertz(drive(Task, Potential, History)).
