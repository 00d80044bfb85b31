:- module(robots_boxes_play,
          [ boxes_play/4,               % +Case, +Network, +Arena, +Bricks
            robot_name/2                % +Host, -Name
          ]).
:- use_module('../../prolog/typhon',
              [agent_join/3, link/2, network_advance/2, network_property/2,
               remote/2, unlink/2]).
:- use_module('../../agents/allocation/operator',
              [allocation_stage/3, robot_start/3, robot_status/2,
               task_allocate/4]).
:- use_module(arena, [arena_ask/3]).
:- use_module(boxes_jobs, [job_box/2, job_task/2]).
:- use_module(crew, [crew_join/2]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3, maplist/4]).
:- use_module(library(lists), [append/3, last/2, member/2, memberchk/2]).
:- use_module(library(pairs), [pairs_keys/2]).

/** <module> Robots push boxes

Each robot is a host, in a process of its own, with the static agent of a
robot and a brick in the arena.  An allocator is released for each box.

*Threading*: the caller's thread waits.
*/

%!  boxes_play(+Case, +Network, +Arena, +Bricks) is semidet.
%
%   Plays the phases of Case.script, one after the other, in Arena; its original
%   boxes and robots, with Bricks, are not used.  Case has
%
%     - script: a list of phase(Jobs, Joining).  The boxes of a phase are
%       present at the same time; while robots push the last of them, Joining
%       more robots join.
%     - robots: the number of robots at first.  The other hosts of Network have
%       no robots yet, and no links.
%     - seed: of the back-offs
%     - limit, rate: host seconds after which a wait fails; host seconds in one
%       second of agent_join/3.

boxes_play(Case, Network, Arena, Bricks) :-
    network_property(Network, hosts(Hosts)),
    length(First, Case.robots),
    append(First, Later, Hosts),
    stand_apart(Network, First, Later),
    pairs_keys(Bricks, Robots),
    forall(member(Name, [box1, box2|Robots]), remove(Arena, Name)),
    enlist(Arena, First),
    foldl(phase(stage(Case, Network, Arena)), Case.script, First-Later, _).

remove(Arena, Name) :-
    arena_ask(Arena, 'remove ~w'-[Name], ok).

%   The network is a ring: the first hosts form a smaller ring, the later ones
%   have no links.

stand_apart(Network, First, Later) :-
    network_property(Network, edges(Edges)),
    forall(( member(A-B, Edges),
             ( memberchk(A, Later) -> true ; memberchk(B, Later) ) ),
           unlink(A, B)),
    First = [A|_],
    last(First, B),
    link(A, B).

                /*******************************
                *             PHASES           *
                *******************************/

phase(Stage, phase(Jobs, Joining), Here0-Later0, Here-Later) :-
    Stage = stage(Case, Network, Arena),
    Limit = Case.limit,
    Seconds is Limit / Case.rate,
    maplist(job_task, Jobs, Tasks),
    maplist(release(Stage, Here0), Jobs, Tasks, Allocators),
    forall(member(Allocator, Allocators),
           until(begun(Allocator), Network, Limit)),
    length(New, Joining),
    append(New, Later, Later0),
    foldl(join(Arena), New, Here0, Here),
    forall(member(Allocator, Allocators),
           agent_join(Allocator, done, Seconds)),
    forall(member(Host, Here), until(idle(Host), Network, Limit)),
    forall(member(job(Box, _, _), Jobs), remove(Arena, Box)).

%   The allocator of the second location begins at the last host.  Allocators
%   back off no longer than a box takes, and wait long enough for busy robots.

release(stage(Case, _, Arena), Hosts, Job, Task, Allocator) :-
    job_box(Job, Line),
    arena_ask(Arena, Line, ok),
    Job = job(_, Location, _),
    (   Location =:= 1
    ->  Hosts = [Host|_]
    ;   last(Hosts, Host)
    ),
    task_allocate(Task, Host,
                  [settings([bi_max-15, monitor-60, seed-(Case.seed)])],
                  Allocator).

begun(Allocator) :-
    allocation_stage(Allocator, executing, _).
begun(Allocator) :-
    agent_join(Allocator, Outcome, 0),
    Outcome \== timeout.

idle(Host) :-
    robot_status(Host, Status),
    memberchk(Status, [free, failed]).

%   Checks the goal every second.

:- meta_predicate until(0, +, +).

until(Goal, _, _) :-
    call(Goal),
    !.
until(Goal, Network, Seconds) :-
    Seconds > 0,
    network_advance(Network, 1),
    Seconds1 is Seconds - 1,
    until(Goal, Network, Seconds1).

                /*******************************
                *            ROBOTS            *
                *******************************/

%   enlist(+Arena, +Hosts): places the robots of Hosts, and connects them.

enlist(Arena, Hosts) :-
    maplist(robot_name, Hosts, Names),
    maplist(place_robot(Arena), Names, Ports),
    crew_join(Hosts, Ports),
    maplist(equip, Hosts, Names).

%!  robot_name(+Host, -Name) is det.
%
%   A host has the name of its robot.

robot_name(Host, Name) :-
    atomic_list_concat([Name|_], @, Host).

%   Slot 3 of the dock belongs to robot r3.

place_robot(Arena, Name, Port) :-
    slot(Name, Slot),
    arena_ask(Arena, 'robot ~w lane slot~d 0.5 pusher -1'-[Name, Slot],
              brick(Name, pty(Port), _)).

slot(Name, Slot) :-
    atom_concat(r, Number, Name),
    atom_number(Number, Slot).

equip(Host, Name) :-
    slot(Name, Slot),
    remote(Host, leave(slot(Slot))),
    findall(place(Place), between(1, 5, Place), Places),
    robot_start(Host, [push|Places], []).

%   A host that joins is linked with the last and the first host.

join(Arena, Host, Hosts0, Hosts) :-
    enlist(Arena, [Host]),
    Hosts0 = [First|_],
    last(Hosts0, Last),
    link(Last, Host),
    link(Host, First),
    append(Hosts0, [Host], Hosts).
