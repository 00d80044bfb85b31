:- module(test_robots, []).
:- use_module('../../lib/common').
:- needs(['python3-serial']).
:- use_module('../../lib/fake_agent').
:- use_module('../../lib/fixtures', [wait_state/2, with_hosts/2]).
:- use_module('../../lib/robot_logs').
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists)).
:- use_module(library(process), [process_kill/2]).
:- use_module(library(readutil)).
:- use_module(library(typhon)).
:- use_module(library(yall)).
:- use_module('../../../experiments/robots/arena').
:- use_module('../../../experiments/robots/crew').
:- use_module('../../../experiments/robots/pole_metrics', [pole_states/3]).

/** <module> Robots that carry a pole

The programs of the robots on a simulated robot, tasks that carry their
programs, the arena as a process, and a run of the study.
*/

                /*******************************
                *        A ROBOT OF FACTS      *
                *******************************/

%   Motors turn ten degrees in a second for each per cent of power; the
%   clock is that of the fake host.

:- dynamic
    motor/4,                            % Motor, Degrees, Power, Since
    pole_after/1.                       % Seconds of driving

fake_host:nxt_run(robot, Motors, Power, _) :-
    test_robots:record(run(Motors, Power)),
    test_robots:set_motors(Motors, Power).
fake_host:nxt_stop(robot, Motors) :-
    test_robots:record(stop(Motors)),
    test_robots:set_motors(Motors, 0).
fake_host:nxt_float(robot, Motors) :-
    test_robots:record(float(Motors)),
    test_robots:set_motors(Motors, 0).
fake_host:nxt_tacho(robot, Motor, Degrees) :-
    test_robots:turned(Motor, Degrees).
fake_host:nxt_tacho_reset(robot, Motors) :-
    test_robots:record(reset(Motors)),
    forall(member(Motor, Motors),
           ( retractall(test_robots:motor(Motor, _, _, _)),
             assertz(test_robots:motor(Motor, 0, 0, 0)) )).
fake_host:nxt_touch(robot, 1, Touch) :-
    fake_host:now(Now),
    (   test_robots:pole_after(Seconds),
        Now >= Seconds
    ->  Touch = true
    ;   Touch = false
    ).

record(What) :-
    assertz(fake_host:did(What)).

set_motors(Motors, Power) :-
    ( is_list(Motors) -> List = Motors ; List = [Motors] ),
    fake_host:now(Now),
    forall(member(Motor, List),
           ( turned(Motor, Degrees),
             retractall(motor(Motor, _, _, _)),
             assertz(motor(Motor, Degrees, Power, Now)) )).

turned(Motor, Degrees) :-
    motor(Motor, Degrees0, Power, Since),
    fake_host:now(Now),
    Degrees is Degrees0 + 10*Power*(Now - Since).

set_angles(Angles) :-
    retractall(motor(_, _, _, _)),
    forall(member(Motor-Degrees, Angles),
           assertz(motor(Motor, Degrees, 0, 0))).

%   program(+Payload, +Angles, +Pole, -Outcome, -Acts)

program(robots/Name, Angles, Pole, Outcome, Acts) :-
    format(atom(File), 'payloads/~w.pl', [robots/Name]),
    fake_agent(File, [], [brick(robot)]),
    set_angles(Angles),
    retractall(pole_after(_)),
    forall(member(Seconds, Pole), assertz(pole_after(Seconds))),
    (   call(fake_agent:Name)
    ->  Outcome = true
    ;   Outcome = fail
    ),
    did(Acts).

%   sticks(Name, Angles, Pole, Seconds, Acts): a motor that is far from its
%   end, as one that does not turn.

sticks(robots/approach, [a-(-9999),b-0,c-0], [5], 60,
       [run([b,c], 12),stop([b,c]),run(a, 10),stop(a)]).
sticks(robots/approach, [a-0,b-0,c-0], [], 60, [run([b,c], 12),stop([b,c])]).
sticks(robots/carry, [b-(-9999),c-(-9999)], [], 60, 
       [run([b,c], 10),stop([b,c])]).
sticks(robots/lift, [a-(-9999)], [], 30, [run(a, 3),stop(a)]).
sticks(robots/release, [a-9999], [], 30, [run(a, -3),float(a)]).

:- begin_tests(robot_programs).

test(approach, Outcome-Acts ==
               true-[ run([b,c], 12), stop([b,c]), run(a, 10), stop(a),
                      reset([b,c]) ]) :-
    program(robots/approach, [a-0, b-0, c-0], [5], Outcome, Acts),
    turned(a, Angle),
    assertion(between_(85, 100, Angle)),
    fake_host:now(Now),
    assertion(between_(5, 8, Now)).
test(motor_that_sticks_is_given_up,
     [ forall(sticks(Name, Angles, Pole, Within, Expected)),
       Outcome-Acts-Seconds == fail-Expected-Within ]) :-
    program(Name, Angles, Pole, Outcome, Acts),
    fake_host:now(Now),
    Seconds is round(Now).
test(outer_wheel_begins,
     [ forall(member(Turn-Runs, [ straight-[run([b,c], 10),run(b, 75)],
                                  left-[run([c,b], 60)],
                                  right-[run([b,c], 60)] ])),
       Acts == Runs ]) :-
    fake_agent('payloads/robots/lane.pl', [], []),
    set_angles([b-0, c-0]),
    fake_agent:lane_steering(Turn, Wheels, Ratio),
    !,
    fake_agent:lane_start(Ratio, robot, Wheels, 360),
    did(Acts).
test(lift, Outcome-Acts == true-[run(a, 3), stop(a)]) :-
    program(robots/lift, [a-90], [], Outcome, Acts),
    turned(a, Angle),
    assertion(between_(265, 275, Angle)).
test(carry, Outcome-Acts == true-[run([b,c], 10), stop([b,c])]) :-
    program(robots/carry, [b-0, c-0], [], Outcome, Acts),
    turned(b, Degrees),
    Metres is Degrees/360 * pi*0.056,
    assertion(between_(1.2, 1.21, Metres)).
test(carry_the_rest, Acts == [run([b,c], 10), stop([b,c])]) :-
    program(robots/carry, [b-2000, c-2000], [], true, Acts),
    fake_host:now(Now),
    assertion(between_(4, 5, Now)).
test(release, Outcome-Acts == true-[run(a, -3), float(a)]) :-
    program(robots/release, [a-270], [], Outcome, Acts),
    turned(a, Angle),
    assertion(between_(-6, 4, Angle)).

between_(Low, High, X) :-
    Low =< X,
    X =< High.

:- end_tests(robot_programs).

                /*******************************
                *            TASKS             *
                *******************************/

:- begin_tests(robot_tasks).

test(load_is_carried, Seen == [hello, none]) :-
    with_hosts([robot1], performed(greet, [(greet :- leave(said(hello)))],
                                   true, Seen)).
test(load_is_laid_down_after_failure, Seen == [failed, none]) :-
    with_hosts([robot1], performed(greet, [(greet :- fail)],
                                   leave(said(failed)), Seen)).
test(load_is_laid_down_after_error, Seen == [raised, none]) :-
    with_hosts([robot1],
               performed(greet, [(greet :- throw(oops))],
                         leave(said(raised)), Seen)).
test(fork_is_unfolded, Seen == [slept, none]) :-
    Clauses = [ (greet :- sleep(0.01), leave(said(slept))) ],
    with_hosts([robot1], performed(greet, Clauses, true, Seen)).

%   performed(+Name, +Clauses, +Otherwise, -Seen): an agent calls the goal of
%   a task with these clauses twice; Otherwise if that fails or raises oops.

%   Seen is what was left, and the payloads that the agent then has.

performed(Name, Clauses, Otherwise, [Said, Payloads]) :-
    crew_task(1, payload(Name, [Name/0], Clauses), 1-Goal),
    agent_create(clauses([ (:- agent(doer, [state([goal/1])])),
                           (main :- do, do, receive(_-end)),
                           (do :- goal(Goal1),
                                  ( catch(Goal1, oops, fail)
                                  ->  true
                                  ;   Otherwise )) ]),
                 Agent, [host(robot1), facts([goal(Goal)])]),
    wait_until(remote(robot1, ( findall(S, sense(said(S)), L),
                                L = [Said, _] )), 20),
    wait_state(Agent, waiting),
    agent_property(Agent, payloads(Names)),
    ( Names == [] -> Payloads = none ; Payloads = Names ),
    agent_dispose(Agent).

:- end_tests(robot_tasks).

                /*******************************
                *           THE ARENA          *
                *******************************/

scene(File) :-
    project_file('bridges/nxt/scenes/pole.json', File).

:- meta_predicate
    with_arena(+, -, -, 0).

with_arena(Options, Arena, Bricks, Goal) :-
    scene(Scene),
    no_leaks(setup_call_cleanup(
                 arena_start(Scene, Options, Arena, Bricks),
                 once(Goal),
                 arena_stop(Arena))).

:- begin_tests(arena).

test(bricks) :-
    with_arena([clock(0)], arena(_, _, _, Dir), Bricks,
        ( maplist([Name-Port, Name]>>exists_link(Port), Bricks, Names),
          Names == [r1, r2, r3, r4],
          exists_directory(Dir) )).
test(time_advances_by_order, [A, B, C] == [time(0.0), ok, time(2.5)]) :-
    with_arena([clock(0), seed(3)], Arena, _,
        ( arena_ask(Arena, time, A),
          arena_ask(Arena, 'advance ~w'-[2.5], B),
          arena_ask(Arena, time, C) )).
test(time_does_not_go_back, [A, B, C] == [ok, ok, time(2.5)]) :-
    with_arena([clock(0)], Arena, _,
        ( arena_ask(Arena, 'until 2.5', A),
          arena_ask(Arena, 'until 1', B),
          arena_ask(Arena, time, C) )).
test(unknown_request, error(arena_error('fly away', _))) :-
    with_arena([clock(0)], Arena, _,
               arena_ask(Arena, 'fly away', _)).
test(missing_scene, error(existence_error(_, _))) :-
    no_leaks(arena_start('/no/such/scene.json', [], _, _)).
test(bad_scene, error(arena_error(start, _))) :-
    project_file('bridges/nxt/world.py', Bad),
    no_leaks(arena_start(Bad, [], _, _)).
test(killed, error(arena_error(time, _))) :-
    with_arena([clock(0)], Arena, Bricks, killed(Arena, Bricks)).
test(log_and_picture) :-
    with_tmp_dir(logged).

exists_link(Port) :-
    read_link(Port, _, _).

killed(Arena, _) :-
    Arena = arena(Pid, _, _, _),
    process_kill(Pid, kill),
    repeat,
    arena_ask(Arena, time, _),
    fail.

logged(Dir) :-
    atom_concat(Dir, '/arena.pl', Log),
    atom_concat(Dir, '/arena.svg', Picture),
    with_arena([clock(0), log(Log), every(0.5), picture(Picture)],
               Arena, _,
               arena_ask(Arena, 'advance 2', ok)),
    read_file_to_terms(Log, Terms, []),
    aggregate_all(count, member(state(_, [_,_,_,_], _, []), Terms), Count),
    assertion(Count >= 4),
    pole_states(Terms, [0-(-1)], States),
    assertion(States = [_, _|_]),
    read_file_to_string(Picture, Text, []),
    assertion(sub_string(Text, _, _, _, "<svg")),
    !.

:- end_tests(arena).

                /*******************************
                *           THE STUDY          *
                *******************************/

:- begin_tests(pole_run).

test(in_step) :-
    with_tmp_dir(Dir,
        ( robot_study(pole, Study),
          no_leaks(small_run(Study, [way-in_step], Dir, Case-Ms)),
          assertion(Ms.executions =:= 16),
          assertion(Ms.out_of_order =:= 0),
          assertion(Ms.overlaps =:= 0),
          assertion(Ms.tilt =< Ms.tilt_limit),
          assertion(abs(Ms.carried - 1.2) < 0.05),
          atom_concat(Dir, '/arena.pl', Log),
          read_file_to_terms(Log, Terms, []),
          forall(member(What, [clasped(_), lifted(pole), released(_)]),
                 assertion(memberchk(event(_, What), Terms))),
          directory_file_path(Dir, pictures, Pictures),
          make_directory(Pictures),
          drawn(Study, [Case-Ms], Pictures, Files),
          assertion(subset([ 'in_step.svg', '5.14.gnuplot', 'hosts.dat',
                             'starts.dat', 'tasks.dat', 'tau.dat',
                             'tilt.dat' ], Files)) )).
test(in_real_time) :-
    with_tmp_dir(carried_in_real_time).
test(interrupted, Status == exit(130)) :-
    with_tmp_dir(interrupted(Status)).

%   Hosts in processes of their own, on a fast clock: robots may be late.

carried_in_real_time(Dir) :-
    robot_study(pole, Study),
    no_leaks(small_run(Study,
                       [way-in_step, clock-10, processes-4, limit-2000], Dir,
                       _-Ms)),
    assertion(Ms.out_of_order =:= 0),
    assertion(forall(member(Name, [first, second, third, fourth]),
                     get_dict(Name, Ms, _))),
    assertion(Ms.carried > 0.2).

%   test/run.pl reports processes that are left behind.

interrupted(Status, Dir) :-
    project_file('experiments/study.pl', Script),
    stopped_when("executing(",
                 [ Script, '--', pole, '--runs', '1', '--jobs', '1', '--set',
                   'clock=1', '--out', Dir ], Dir, int, Status).

:- end_tests(pole_run).
