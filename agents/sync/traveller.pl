:- agent(traveller, [state([plan/3, setting/2, drive/3])]).
:- include(potential).

/*  Algorithm 2 of the thesis: agents that know nothing of each other
    execute a sequence of tasks on hosts, and go on to the next task at the
    same time.

    The fact plan(Sequence, Version, Tasks) says what is to be done: the
    name of the sequence, a number that is greater the newer the plan is,
    and a list of Task-Goal in order.  Goal is the task's code, handed over
    at each host.  Facts setting(Name, Value) replace the defaults below.

    On the hosts: task(Sequence, Task, Status, Time) says what was done and
    when.  worker(Sequence, Id) is there while the host's worker is free.
    Who takes it has the host for himself until it is put back, so two
    agents never service one host at the same time.  Where there is none,
    because the host is executing or has no part in the sequence, an agent
    passes.  plan(Sequence, Version, Tasks) is the newest plan that was
    brought there.
*/

default(delta, 0.5).             % penalty bias
default(theta, 15).              % what a history starts with
default(maximum, 100).           % of a potential; its initial value, too
default(window, 15).             % length of the history
default(patience, 1).            % seconds before an isolated agent looks again
default(start, now).             % or `order`: waits for the message `begin`

setting_or_default(Name, Value) :-
    (   setting(Name, Value0)
    ->  Value = Value0
    ;   default(Name, Value)
    ).

main :-
    await_order,
    fill_new,
    log(begun),
    patrol.

await_order :-
    setting_or_default(start, order),
    !,
    receive(_-begin).
await_order.

patrol :-
    compare_plans,
    current(Task),
    !,
    visit(Task),
    travel,
    patrol.
patrol.                          % all potentials are zero

travel :-
    next_host(conscientious, Host),
    !,
    catch(move(Host), error(_, _), pause).
travel :-
    pause.

pause :-
    setting_or_default(patience, Seconds),
    sleep(Seconds).

%   The task it searches for: the first that has potential left.

current(Task) :-
    plan(_, _, Tasks),
    member(Task-_, Tasks),
    drive(Task, Potential, _),
    Potential =\= 0,
    !.

%   At a host that executes a task, an agent is neither rewarded nor
%   penalised.  This is tested first: as printed in the thesis, a task
%   that is executing would be serviced again.

visit(Task) :-
    plan(Sequence, _, Tasks),
    take(worker(Sequence, Worker)),
    !,
    (   missing(Tasks, Sequence, Task, Missing)
    ->  heal(Missing, Task),
        current(Next),
        service_if(Next, Missing, Worker)
    ;   leave(worker(Sequence, Worker)),
        penalise(Task)
    ).
visit(_).

%   Having found a failure, an agent may have to begin with an earlier task
%   than the one that is missing here.

service_if(Missing, Missing, Worker) :-
    !,
    service(Missing, Worker).
service_if(_, _, Worker) :-
    plan(Sequence, _, _),
    leave(worker(Sequence, Worker)).

%   Missing is the first task up to Task that is not completed here: the
%   self-healing line of the algorithm.

missing([Missing-_|_], Sequence, _, Missing) :-
    \+ sense(task(Sequence, Missing, completed, _)),
    !.
missing([Earlier-_|Tasks], Sequence, Task, Missing) :-
    Earlier \== Task,
    missing(Tasks, Sequence, Task, Missing).

service(Task, Worker) :-
    bring_plan,
    plan(Sequence, _, Tasks),
    memberchk(Task-Goal, Tasks),
    ignore(take(task(Sequence, Task, failed(_), _))),
    now(Time),
    leave(task(Sequence, Task, executing, Time)),
    send(Worker, execute(Task, Goal)),
    reward(Task).

                /*******************************
                *         SELF-HEALING         *
                *******************************/

%   A task below the one searched for, found missing, gets as much
%   potential as the last reward or penalty was worth.  If it fell together
%   with others, all from the first of these on are searched for as at the
%   beginning.

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
    setting_or_default(maximum, Maximum),
    increase(Potential0, Theta, Maximum, Potential),
    setting_or_default(theta, Theta0),
    keep(Missing, drive(Potential, [Theta0])),
    log(revived(Missing, Potential)).

%   Who searches for just what is missing here, and has come to that in
%   turn, knows of the failure.

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

reward(Task) :-
    setting_or_default(maximum, Maximum),
    setting_or_default(window, Window),
    drive(Task, Potential0, History0),
    rewarded(drive(Potential0, History0), Maximum, Window, Theta, Drive),
    keep(Task, Drive),
    Drive = drive(Potential, _),
    log(reward(Task, Potential, Theta)).

penalise(Task) :-
    setting_or_default(maximum, Maximum),
    setting_or_default(window, Window),
    setting_or_default(delta, Delta),
    drive(Task, Potential0, History0),
    penalised(drive(Potential0, History0), Maximum, Window, Delta, Theta,
              Drive),
    keep(Task, Drive),
    Drive = drive(Potential, _),
    log(penalty(Task, Potential, Theta)).

fill(Task) :-
    setting_or_default(maximum, Potential),
    setting_or_default(theta, Theta),
    keep(Task, drive(Potential, [Theta])).

keep(Task, drive(Potential, History)) :-
    retractall(drive(Task, _, _)),
    assertz(drive(Task, Potential, History)).

                /*******************************
                *             PLANS            *
                *******************************/

bring_plan :-
    plan(Sequence, _, _),
    sense(plan(Sequence, _, _)),
    !.
bring_plan :-
    plan(Sequence, Version, Tasks),
    leave(plan(Sequence, Version, Tasks)).

%   The newer of two plans replaces the older one, here or in the agent.

compare_plans :-
    plan(Sequence, Mine, _),
    sense(plan(Sequence, Theirs, _)),
    Mine =\= Theirs,
    !,
    (   Mine > Theirs
    ->  replace(Sequence, Theirs)
    ;   adopt(Sequence, Theirs)
    ).
compare_plans.

%   Another agent may be doing the same.

replace(Sequence, Old) :-
    (   take(plan(Sequence, Old, _))
    ->  plan(Sequence, Version, Tasks),
        leave(plan(Sequence, Version, Tasks))
    ;   true
    ).

adopt(Sequence, Version) :-
    (   sense(plan(Sequence, Version, Tasks))
    ->  retractall(plan(_, _, _)),
        assertz(plan(Sequence, Version, Tasks)),
        forget_removed,
        fill_new,
        log(adopted(Version))
    ;   true
    ).

forget_removed :-
    plan(_, _, Tasks),
    forall(( drive(Task, _, _), \+ memberchk(Task-_, Tasks) ),
           retractall(drive(Task, _, _))).

fill_new :-
    plan(_, _, Tasks),
    forall(( member(Task-_, Tasks), \+ drive(Task, _, _) ),
           fill(Task)).
