:- module(robots_boxes_metrics,
          [ holdings/2,                 % +Events, -Holdings
            jobs/2,                     % +Events, -Jobs
            joined/2,                   % +Events, -Joined
            pair/4,                     % +Script, +Robots, -Names, -Enough
            yields/2,                   % +Jobs, +Names
            together/2,                 % +Jobs, +Names
            pushed/2,                   % +Terms, -Boxes
            from_dock/2,                % +Terms, -Metres
            worked/2,                   % +Holdings, +Robot
            name/2,                     % +Host, -Name
            job_rows/2,                 % +Jobs, -Rows
            rest_rows/2,                % +Jobs, -Rows
            holding_rows/4              % +Hosts, +Jobs, +Holdings, -Rows
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists),
              [append/3, last/2, max_list/2, member/2, memberchk/2, nth1/3,
               sum_list/2]).

/** <module> What the logs say about boxes that were pushed

Events are event(Time, Host, Agent, What), sorted by time; a robot is named
by the address of its host.  Terms are those of arena_log/2.

*Threading*: pure.
*/

%!  holdings(+Events, -Holdings:list) is det.
%
%   Which robot was held for which task, and when:
%   holding(Robot, Task, From, Start, To).  Start is when it began to execute
%   the task, `none` if it did not, as after a back-off.  To is `none` if it
%   was never released.

holdings(Events, Holdings) :-
    findall(Holding, holding(Events, Holding), Holdings).

holding(Events, holding(Robot, Task, From, Start, To)) :-
    append(_, [event(From, _, _, reserved(Robot, Owner, Task))|Later],
           Events),
    (   append(During, [event(To0, _, _, released(Robot, Owner, Task))|_],
               Later)
    ->  To = To0
    ;   During = Later,
        To = none
    ),
    (   member(event(Start0, _, Owner, allocated(Task, Robots)), During),
        memberchk(Robot, Robots)
    ->  Start = Start0
    ;   Start = none
    ).

%!  worked(+Holdings, +Robot) is semidet.

worked(Holdings, Robot) :-
    member(holding(Robot, _, _, Start, _), Holdings),
    number(Start),
    !.

%!  jobs(+Events, -Jobs:list) is det.
%
%   A job(Task, Begun, Allocated, Completed, Robots, Rests) for each task, in
%   the order in which they were begun.  Allocated and Completed are `none`
%   if that never came; Robots are those it was first allocated to, Rests
%   pairs Time-Seconds, when its allocator backed off and for how long.

jobs(Events, Jobs) :-
    findall(job(Task, Begun, Allocated, Completed, Robots, Rests),
            ( member(event(Begun, _, Agent, begun(Task)), Events),
              allocated(Events, Task, Allocated, Robots),
              completed(Events, Task, Completed),
              findall(Time-Seconds,
                      member(event(Time, _, Agent, backoff(Seconds)),
                             Events),
                      Rests) ),
            Jobs).

allocated(Events, Task, Time, Robots) :-
    member(event(Time, _, _, allocated(Task, Robots)), Events),
    !.
allocated(_, _, none, []).

completed(Events, Task, Time) :-
    member(event(Time, _, _, completed(Task)), Events),
    !.
completed(_, _, none).

%!  joined(+Events, -Joined:list) is det.
%
%   Robot-Time, when the agent of each robot was created there.

joined(Events, Joined) :-
    findall(Robot-Time,
            ( member(event(Time, Robot, Agent, created), Events),
              static(Agent, Robot, Events, Time) ),
            Joined).

%   What executes the tasks is created by the robot later.

static(Agent, Robot, Events, Time) :-
    sub_atom(Agent, 0, _, _, 'robot.'),
    \+ ( member(event(Before, Robot, Other, created), Events),
         Before < Time,
         sub_atom(Other, 0, _, _, 'robot.') ).

%!  pair(+Script, +Robots, -Names:pair, -Enough) is nondet.
%
%   The boxes Names of a phase are there together.  Enough is `true` if there
%   are robots enough for both when it begins, with Robots at first, else
%   `false`.  For Script see boxes_play/4.

pair([phase([job(A, _, Needs1), job(B, _, Needs2)], _)|_], Robots, A-B,
     Enough) :-
    (   Needs1 + Needs2 =< Robots
    ->  Enough = true
    ;   Enough = false
    ).
pair([phase(_, Joining)|Script], Robots0, Names, Enough) :-
    Robots is Robots0 + Joining,
    pair(Script, Robots, Names, Enough).

%!  yields(+Jobs, +Names:pair) is semidet.
%
%   True if one of two jobs backed off, and they were not executed together.

yields(Jobs, A-B) :-
    \+ together(Jobs, A-B),
    member(Name, [A, B]),
    memberchk(job(Name, _, _, _, _, [_|_]), Jobs),
    !.

%!  together(+Jobs, +Names:pair) is semidet.
%
%   True if the robots of two jobs executed them at the same time.

together(Jobs, Name1-Name2) :-
    memberchk(job(Name1, _, Start1, End1, _, _), Jobs),
    memberchk(job(Name2, _, Start2, End2, _, _), Jobs),
    all_numbers([Start1, End1, Start2, End2]),
    Start1 < End2,
    Start2 < End1.

all_numbers(Values) :-
    \+ ( member(Value, Values), \+ number(Value) ).

%!  pushed(+Terms, -Boxes:list(atom)) is det.
%
%   Boxes have come to their destinations.

pushed(Terms, Boxes) :-
    findall(Box, member(event(_, arrived(Box)), Terms), Boxes).

%!  from_dock(+Terms, -Metres) is det.
%
%   How far, in the last state of the arena, the robot that is farthest from
%   where it was first is from there.

from_dock(Terms, Metres) :-
    findall(Robots, member(state(_, Robots, _, _), Terms), States),
    last(States, Last),
    findall(Far,
            ( member(Robot, Last), away(States, Robot, Far) ),
            Distances),
    max_list([0|Distances], Metres).

away(States, robot(Name, X, Y, _, _, _, _), Metres) :-
    member(Robots, States),
    memberchk(robot(Name, X0, Y0, _, _, _, _), Robots),
    !,
    Metres is sqrt((X - X0)**2 + (Y - Y0)**2).

                /*******************************
                *            TABLES            *
                *******************************/

%!  name(+Host, -Name) is det.
%
%   The name in an address.

name(Host, Name) :-
    atomic_list_concat([Name|_], @, Host).

%!  job_rows(+Jobs, -Rows) is det.
%
%   Rows [I, Box, Count, Begun, Allocated, Completed, Backoffs, Rested, Who]:
%   of job I, how many robots it had, how often its allocator backed off and
%   how many seconds it rested, and the names of the robots.

job_rows(Jobs, Rows) :-
    findall(Row, ( nth1(I, Jobs, Job), job_row(Job, I, Row) ), Rows).

job_row(job(Box, Begun, Allocated, Completed, Hosts, Rests), I,
        [I, Box, Count, Begun, Allocated, Completed, Backoffs, Rested, Who]) :-
    length(Hosts, Count),
    length(Rests, Backoffs),
    findall(Seconds, member(_-Seconds, Rests), Times),
    sum_list(Times, Rested),
    maplist(name, Hosts, Names0),
    msort(Names0, Names),
    atomic_list_concat(Names, ' ', Text),
    atom_string(Text, Who).

%!  rest_rows(+Jobs, -Rows) is det.
%
%   Rows [I, From, Seconds]: the allocator of job I rests.

rest_rows(Jobs, Rows) :-
    findall([I, From, Seconds],
            ( nth1(I, Jobs, job(_, _, _, _, _, Rests)),
              member(From-Seconds, Rests) ),
            Rows).

%!  holding_rows(+Hosts, +Jobs, +Holdings, -Rows) is det.
%
%   Rows [I, J, From, Start, To]: robot I was held for job J.

holding_rows(Hosts, Jobs, Holdings, Rows) :-
    findall([I, J, From, Start, To],
            ( member(holding(Robot, Task, From, Start, To), Holdings),
              nth1(I, Hosts, Robot),
              nth1(J, Jobs, job(Task, _, _, _, _, _)) ),
            Rows).
