% Expects: task/3; lib, common; deadline, messages, held_robots, attendance.
% Gives: execute/1.

/*  Execution: the allocator starts its reserved robots, and monitors them
    until all have executed the task.
*/

%!  execute(-Outcome) is det.
%
%   Outcome is `done`, or `missing` as soon as robots must be replaced.
%
%   @throws missed

execute(Outcome) :-
    keep(stage(executing)),
    findall(Host, held(Host, _, _, _, reserved), Hosts),
    start(Hosts),
    monitor(Outcome).

start(Hosts) :-
    task(_, _, Details),
    task_goal(Details, Goal),
    forall(( member(Host, Hosts), held(Host, Robot, Ref, _, _) ),
           start(Host, Robot, Ref, Goal)).

start(Host, Robot, Ref, Goal) :-
    mark(Ref, started),
    (   post(Host, Robot, start(Ref, Goal))
    ->  true
    ;   give_up(Host, Ref, unreachable)
    ).

%   monitor(+Asked, +Look, -Outcome): at the time Look it sends status
%   requests to the robots that have not finished.  Asked are the robots that
%   have not answered the previous request.

monitor(Outcome) :-
    look_again(Look),
    monitor([], Look, Outcome).

monitor(_, _, missing) :-
    \+ complete,
    !.
monitor(_, _, done) :-
    \+ ( held(_, _, _, _, Phase), Phase \== done ),
    !.
monitor(Asked, Look, Outcome) :-
    check_deadline,
    now(Now),
    Left is max(0, Look - Now),
    soon(Left, Seconds),
    (   receive(From-Message, Seconds)
    ->  heed(Message, From),
        subtract(Asked, [From], Asked1),
        monitor(Asked1, Look, Outcome)
    ;   inquire(Asked, Asked1),
        look_again(Look1),
        monitor(Asked1, Look1, Outcome)
    ).

look_again(Look) :-
    now(Now),
    parameter(monitor, Seconds),
    Look is Now + Seconds.

%   Gives up a robot that did not answer the previous request.

inquire(Asked, Asking) :-
    forall(( held(Host, Robot, Ref, _, started),
             memberchk(Robot, Asked) ),
           give_up(Host, Ref, silent)),
    forall(held(Host, Robot, Ref, _, started),
           ignore(post(Host, Robot, status(Ref)))),
    findall(Robot, held(_, Robot, _, _, started), Asking).
