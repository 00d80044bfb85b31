:- module(allocation_watch,
          [ watch_start/2,              % +Tasks, -State
            watch/3,                    % +Event, +State0, -State
            watch_done/2,               % +State, -Count
            watch_held/2,               % +State, -Robots
            watch_over/1                % +State
          ]).
:- use_module(library(ordsets),
              [ord_add_element/3, ord_del_element/3]).

/** <module> How far an allocation has come

What a log says of it while it grows: which tasks are still to be done,
which robots are held, how many mobile agents there are.

*Threading*: pure.
*/

%!  watch_start(+Tasks:list(atomic), -State) is det.
%
%   State, before any event, of an allocation of tasks with these names.

watch_start(Tasks, watch(Count, Open, [], [])) :-
    sort(Tasks, Open),
    length(Open, Count).

%!  watch(+Event, +State0, -State) is det.
%
%   Event is event(Time, Host, Agent, What), of an allocator, a child of
%   one, a robot, or of anything else.

watch(event(_, _, Agent, What), State0, State) :-
    seen(What, Agent, State0, State),
    !.
watch(_, State, State).

seen(completed(Task), _, watch(All, Open0, Held, Alive),
     watch(All, Open, Held, Alive)) :-
    ord_del_element(Open0, Task, Open).
seen(missed(Task, _), _, watch(All, Open0, Held, Alive),
     watch(All, Open, Held, Alive)) :-
    ord_del_element(Open0, Task, Open).
seen(reserved(Robot, _, _), _, watch(All, Open, Held0, Alive),
     watch(All, Open, Held, Alive)) :-
    ord_add_element(Held0, Robot, Held).
seen(released(Robot, _, _), _, watch(All, Open, Held0, Alive),
     watch(All, Open, Held, Alive)) :-
    ord_del_element(Held0, Robot, Held).
seen(created, Agent, watch(All, Open, Held, Alive0),
     watch(All, Open, Held, Alive)) :-
    mobile(Agent),
    ord_add_element(Alive0, Agent, Alive).
seen(ended(_), Agent, watch(All, Open, Held, Alive0),
     watch(All, Open, Held, Alive)) :-
    ord_del_element(Alive0, Agent, Alive).

%   Static agents stay; those that search, and their children, end.

mobile(Agent) :-
    atom_concat(allocator, _, Agent).

%!  watch_done(+State, -Count:integer) is det.
%
%   So many tasks have been completed, or missed their deadline.

watch_done(watch(All, Open, _, _), Count) :-
    length(Open, Left),
    Count is All - Left.

%!  watch_held(+State, -Robots:list(atom)) is det.

watch_held(watch(_, _, Held, _), Held).

%!  watch_over(+State) is semidet.
%
%   All tasks are done, all robots free, and all who searched have ended.

watch_over(watch(_, [], [], [])).
