:- agent(traveller, [state([task/2, setting/2, drive/3])]).
:- include(potential).

/*  Algorithm 2 of the thesis: agents that know nothing of each other
    execute a sequence of tasks on every host, and go on to the next task
    at the same time.

    The sequence is given as facts task(I, Goal), I = 1, 2 ...; Goal is
    the task's code, handed over at each host.  Facts setting(Name, Value)
    replace the defaults below.

    On the hosts: task(I, executing) and task(I, completed) say what was
    done; worker(Id) is there while the host's worker is free.  Who takes
    it has the host for himself until it is put back, so two agents never
    service one host at the same time.
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
    forall(task(Task, _), fill(Task)),
    log(begun),
    patrol.

await_order :-
    setting_or_default(start, order),
    !,
    receive(_-begin).
await_order.

patrol :-
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
    task(Task, _),
    drive(Task, Potential, _),
    Potential =\= 0,
    !.

%   At a host that executes a task, an agent is neither rewarded nor
%   penalised.  This is tested first: as printed in the thesis, a task
%   that is executing would be serviced again.

visit(Task) :-
    take(worker(Worker)),
    !,
    (   missing(Task, Missing)
    ->  revive(Missing, Task),
        service(Missing, Worker)
    ;   leave(worker(Worker)),
        penalise(Task)
    ).
visit(_).

%   Missing is the first task up to Task that was not completed here: the
%   self-healing line of the algorithm.

missing(Task, Missing) :-
    task(Missing, _),
    Missing =< Task,
    \+ sense(task(Missing, completed)),
    !.

%   A task below the one searched for, found missing, gets as much
%   potential as the last reward or penalty was worth.

revive(Task, Task) :-
    !.
revive(Missing, Task) :-
    drive(Task, _, History),
    last(History, Theta),
    drive(Missing, Potential0, _),
    setting_or_default(maximum, Maximum),
    increase(Potential0, Theta, Maximum, Potential),
    setting_or_default(theta, Theta0),
    keep(Missing, drive(Potential, [Theta0])),
    log(revived(Missing, Potential)).

service(Task, Worker) :-
    task(Task, Goal),
    leave(task(Task, executing)),
    send(Worker, execute(Task, Goal)),
    reward(Task).

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
