:- module(robots_boxes_metrics,
          [ holdings/2,                 % +Events, -Holdings
            jobs/2,                     % +Events, -Jobs
            joined/2,                   % +Events, -Joined
            pair/4,                     % +Script, +Robots, -Names, -Enough
            yields/2,                   % +Jobs, +Names
            together/2,                 % +Jobs, +Names
            from_dock/2                 % +Terms, -Metres
          ]).
:- use_module(library(lists),
              [append/3, last/2, max_list/2, member/2, memberchk/2]).
:- use_module(library(solution_sequences), [distinct/2]).

/** <module> Measures of pushed boxes, from the logs

Events are event(Time, Host, Agent, What), sorted by time; the address of its
host names a robot.  Terms are the terms of the log of an arena.

*Threading*: pure.
*/

%!  holdings(+Events, -Holdings:list) is det.
%
%   Holdings are holding(Robot, Task, From, Start, To): the reservations of
%   robots.  Start is the start of the execution, `none` if there was none, as
%   after a back-off.  To is `none` if the robot was never released.

holdings(Events, Holdings) :-
    findall(Holding, holding(Events, Holding), Holdings).

holding(Events, holding(Robot, Task, From, Start, To)) :-
    append(_, [event(From, _, _, reserved(Robot, Owner, Task))|Later],
           Events),
    (   append(During, [event(To, _, _, released(Robot, Owner, Task))|_],
               Later)
    ->  true
    ;   During = Later,
        To = none
    ),
    (   member(event(Start, _, Owner, allocated(Task, Robots)), During),
        memberchk(Robot, Robots)
    ->  true
    ;   Start = none
    ).

%!  jobs(+Events, -Jobs:list) is det.
%
%   A job(Task, Begun, Allocated, Completed, Robots, Rests) for each task, in
%   order of Begun.  Allocated and Completed are `none` if that did not happen;
%   Robots are the robots of the first allocation, Rests are pairs Time-Seconds,
%   the start and the length of each back-off.

jobs(Events, Jobs) :-
    findall(job(Task, Begun, Allocated, Completed, Robots, Rests),
            ( member(event(Begun, _, Agent, begun(Task)), Events),
              when(allocated(Task, Robots0), Events, Allocated),
              ( var(Robots0) -> Robots = [] ; Robots = Robots0 ),
              when(completed(Task), Events, Completed),
              findall(Time-Seconds,
                      member(event(Time, _, Agent, backoff(Seconds)),
                             Events),
                      Rests) ),
            Jobs).

when(What, Events, Time) :-
    memberchk(event(Time, _, _, What), Events),
    !.
when(_, _, none).

%!  joined(+Events, -Joined:list) is det.
%
%   Robot-Time, when the agent of each robot was created on it.  The other
%   agents there execute the tasks.

joined(Events, Joined) :-
    findall(Robot-Time,
            distinct(Robot,
                     ( member(event(Time, Robot, Agent, created), Events),
                       sub_atom(Agent, 0, _, _, 'robot.') )),
            Joined).

%!  pair(+Script, +Robots, -Names:pair, -Enough) is nondet.
%
%   The boxes Names of a phase are present together.  Enough is `true` if there
%   are enough robots for both when the phase begins, with Robots at first, else
%   `false`.  Script is described in boxes_play/4.

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
    \+ memberchk(none, [Start1, End1, Start2, End2]),
    Start1 < End2,
    Start2 < End1.

%!  from_dock(+Terms, -Metres) is det.
%
%   The greatest distance, over all robots, between a robot's first and last
%   position in the arena.

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
