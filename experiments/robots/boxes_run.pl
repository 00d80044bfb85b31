:- module(robots_boxes_run,
          [ boxes_run/4                 % +Script, +Options, +Directory,
                                        % -Run
          ]).
:- use_module('../../prolog/typhon', [link/2, remote/2]).
:- use_module('../../agents/allocation/operator',
              [robot_start/3, task_allocate/4]).
:- use_module('../allocation/watch',
              [watch/3, watch_done/2, watch_held/2, watch_over/1,
               watch_start/2]).
:- use_module('../lib/follow', [new_lines/4]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module(arena, [arena_ask/3]).
:- use_module(boxes_script,
              [job_box/2, job_program/1, job_task/3, script_jobs/2]).
:- use_module(crew, [crew_join/2]).
:- use_module(fleet, [fleet_add/3, fleet_start/2, fleet_stop/1]).
:- use_module(stage, [stage/6]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(lists),
              [append/3, last/2, member/2, numlist/3, subtract/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> Robots push boxes, once

Each robot is a host, in a process of its own, with the static agent of a
robot and a brick in the arena.  An allocator is released for each box.

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run: hosts and arena are
stopped.
*/

:- multifile
    prolog:error_message//1.

%   Settings of the allocators that are not the defaults: they rest no
%   longer than a box takes, and have patience with robots that compute.

settings([bi_max-15, monitor-60, seed-random]).

%!  boxes_run(+Script, +Options, +Directory, -Run) is det.
%
%   Plays Script, see robots_boxes_script.  All of these Options are
%   required:
%
%     - seed(S)
%       Of the arena, and of the back-offs.
%     - clock(Rate), hop_time(Min-Max)
%       Of the hosts; the arena has the same clock.
%     - limit(Real)
%       Real seconds that a phase may take, else the run is given up.
%
%   In Directory are afterwards the logs events.pl and arena.pl, and the
%   moving picture arena.svg.  Run is a list of
%
%     - hosts(List), in the order in which they came, named as their robots
%     - events(List), arena(List): what the logs have, the events sorted
%     - wall(Seconds), shift(Seconds): what the hosts' clocks show when that
%       of the arena shows 0
%
%   @error timeout_error(boxes, Done-Total)

boxes_run(Script, Options, Directory, Run) :-
    stage(boxes, [every(0.2)|Options], Directory,
          in_arena(Script, Options, Hosts, Shift), logs(Events0, Terms),
          Wall),
    sort(1, @=<, Events0, Events),
    Run = [ hosts(Hosts), events(Events), arena(Terms), wall(Wall),
            shift(Shift)
          ].

in_arena(Script, Options, Hosts, Shift, Log, Arena, Bricks) :-
    option(clock(Rate), Options),
    option(hop_time(HopTime), Options),
    setup_call_cleanup(
        fleet_start([clock(Rate), log(Log), hop_time(HopTime)], Fleet),
        call_cleanup(
            play(Script, Options, stage(Arena, Fleet, Log), Bricks, Hosts,
                 Shift),
            progress_done(user_error)),
        fleet_stop(Fleet)).

                /*******************************
                *           THE PLAY           *
                *******************************/

play(Script, Options, Stage, Bricks0, Hosts, Shift) :-
    Script = script(Count, Phases),
    Stage = stage(Arena, _, _),
    forall(member(Box, [box1, box2]),           % of the scene
           arena_ask(Arena, 'remove ~w'-[Box], ok)),
    length(Bricks, Count),
    append(Bricks, Others, Bricks0),
    forall(member(Robot-_, Others),
           arena_ask(Arena, 'remove ~w'-[Robot], ok)),
    enlist(Stage, Bricks, [], Hosts0),
    shift(Arena, Hosts0, Shift),
    job_program(Program),
    script_jobs(Script, Jobs),
    length(Jobs, Total),
    Setting = setting(Stage, Program, Options, Total),
    foldl(phase(Setting), Phases, scene(Hosts0, 0, []), scene(Hosts, _, _)).

shift(Arena, [Host|_], Shift) :-
    remote(Host, now(HostTime)),
    arena_ask(Arena, time, time(ArenaTime)),
    Shift is HostTime - ArenaTime.

%   phase(+Setting, +Phase, +Scene0, -Scene): a Scene is scene(Hosts, Done,
%   Boxes): so many jobs have been done before, and the boxes are still
%   where they have been pushed.

phase(Setting, phase(Jobs, Joining), scene(Hosts0, Done0, Old),
      scene(Hosts, Done, Names)) :-
    Setting = setting(stage(Arena, _, Log), _, Options, _),
    option(limit(Limit), Options),
    get_time(Now),
    Deadline is Now + Limit,
    forall(member(Box, Old), arena_ask(Arena, 'remove ~w'-[Box], ok)),
    findall(Name, member(job(Name, _, _), Jobs), Names),
    watch_start(Names, Watch0),
    new_lines(Log, 0, Position0, _),
    forall(member(Job, Jobs), release(Setting, Hosts0, Job)),
    Follow0 = follow(Position0, Watch0, [], Deadline),
    await(all_allocated(Names), Setting, Done0, Follow0, Follow1),
    join(Joining, Setting, Hosts0, Hosts),
    await(over, Setting, Done0, Follow1, _),
    length(Names, Count),
    Done is Done0 + Count.

%   The allocator of the second location begins at the other side.

release(Setting, Hosts, Job) :-
    Setting = setting(stage(Arena, _, _), Program, Options, _),
    job_box(Job, Line),
    arena_ask(Arena, Line, ok),
    job_task(Job, Program, Task),
    Job = job(_, Location, _),
    (   Location =:= 1
    ->  Hosts = [Host|_]
    ;   last(Hosts, Host)
    ),
    option(seed(Seed), Options),
    settings(Settings0),
    subtract(Settings0, [seed-random], Settings),
    task_allocate(Task, Host, [settings([seed-Seed|Settings])], _).

                /*******************************
                *            ROBOTS            *
                *******************************/

%   enlist(+Stage, +Bricks, +Hosts0, -Hosts): robots Name-Port, which are in
%   the arena, get hosts, each linked with the one before it, and the last
%   one with the first.

enlist(stage(_, Fleet, _), Bricks, Hosts0, Hosts) :-
    pairs_keys_values(Bricks, Names, Ports),
    fleet_add(Fleet, Names, New),
    crew_join(New, Ports),
    maplist(equip, New, Names),
    append(Hosts0, New, Hosts),
    forall(( member(Host, New), beside(Hosts, Host, Other) ),
           link(Host, Other)).

%   Robot r3 is at home in slot 3 of the dock.

equip(Host, Name) :-
    atom_concat(r, Number, Name),
    atom_number(Number, Slot),
    remote(Host, leave(slot(Slot))),
    numlist(1, 5, Places),
    findall(place(Place), member(Place, Places), Properties),
    robot_start(Host, [push|Properties], []).

beside(Hosts, Host, Other) :-
    append(_, [Other,Host|_], Hosts).
beside([First|Hosts], Host, First) :-
    append(_, [_,Host], Hosts).

join(0, _, Hosts, Hosts) :-
    !.
join(Count, Setting, Hosts0, Hosts) :-
    Setting = setting(Stage, _, _, _),
    Stage = stage(Arena, _, _),
    length(Hosts0, Have),
    Slot is Have + 1,
    atom_concat(r, Slot, Name),
    arena_ask(Arena, 'robot ~w lane slot~d 0.5 pusher -1'-[Name, Slot],
              brick(Name, pty(Port), _)),
    enlist(Stage, [Name-Port], Hosts0, Hosts1),
    Count1 is Count - 1,
    join(Count1, Setting, Hosts1, Hosts).

                /*******************************
                *            WAITING           *
                *******************************/

%   await(+What, +Setting, +Done, +Follow0, -Follow): Follow is
%   follow(Position, Watch, Allocated, Deadline), how far the log has been
%   read, what it says, and when the phase must be over.

await(What, Setting, Done, Follow0, Follow) :-
    Setting = setting(stage(_, _, Log), _, _, Total),
    Follow0 = follow(Position0, Watch0, Allocated0, Deadline),
    new_lines(Log, Position0, Position, Lines),
    foldl(look_at, Lines, Watch0-Allocated0, Watch-Allocated),
    watch_done(Watch, Some),
    AllDone is Done + Some,
    watch_held(Watch, Held),
    length(Held, Count),
    format(atom(Note), 'boxes pushed, ~d robots held', [Count]),
    progress(user_error, AllDone, Total, Note),
    Follow1 = follow(Position, Watch, Allocated, Deadline),
    get_time(Now),
    (   satisfied(What, Follow1)
    ->  Follow = Follow1
    ;   Now > Deadline
    ->  throw(error(timeout_error(boxes, AllDone-Total), _))
    ;   sleep(0.1),
        await(What, Setting, Done, Follow1, Follow)
    ).

satisfied(all_allocated(Names), follow(_, _, Allocated, _)) :-
    subtract(Names, Allocated, []).
satisfied(over, follow(_, Watch, _, _)) :-
    watch_over(Watch).

look_at(Line, Watch0-Allocated0, Watch-Allocated) :-
    term_string(Event, Line),
    watch(Event, Watch0, Watch),
    (   Event = event(_, _, _, allocated(Name, _))
    ->  Allocated = [Name|Allocated0]
    ;   Allocated = Allocated0
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(timeout_error(boxes, Done-Total)) -->
    [ 'Only ~d of ~d boxes were pushed in time'-[Done, Total] ].
