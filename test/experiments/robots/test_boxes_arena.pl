:- module(test_boxes_arena, []).
:- use_module('../../lib/common').
:- needs(['python3-serial']).
:- use_module('../../lib/fake_agent').
:- use_module('../../lib/robot_logs').
:- use_module(library(plunit)).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists)).
:- use_module(library(typhon)).
:- use_module(library(typhon/nxt), []).
:- use_module(library(yall)).
:- use_module('../../../experiments/robots/arena').

/** <module> Robots that push boxes, in the arena

Their programs, with a clock that only their commands set forward; the study
with few robots, with too few, and interrupted.
*/

                /*******************************
                *      PROGRAMS, THE ARENA     *
                *******************************/

%   Every command takes the arena a tenth of a second, between the two
%   wheels, too.

:- dynamic the_arena/1.

later(Goal) :-
    the_arena(Arena),
    arena_ask(Arena, 'advance 0.1', ok),
    call(typhon_nxt:Goal).

fake_host:nxt_run(B, M, P, O) :-
    (   is_list(M)
    ->  forall(member(One, M),
               test_boxes_arena:later(nxt_run(B, One, P, O)))
    ;   test_boxes_arena:later(nxt_run(B, M, P, O))
    ).
fake_host:nxt_motor(B, M, S) :-
    test_boxes_arena:later(nxt_motor(B, M, S)).
fake_host:nxt_tacho(B, M, D) :-
    test_boxes_arena:later(nxt_tacho(B, M, D)).
fake_host:nxt_tacho_reset(B, M) :-
    test_boxes_arena:later(nxt_tacho_reset(B, M)).

in_arena(Goal) :-
    project_file('bridges/nxt/scenes/boxes.json', Scene),
    no_leaks(setup_call_cleanup(
                 arena_start(Scene, [clock(0), seed(2)], Arena, Bricks),
                 connected(Arena, Bricks, Goal),
                 arena_stop(Arena))).

:- meta_predicate in_arena(0), connected(+, +, 0).

connected(Arena, Bricks, Goal) :-
    memberchk(r3-Port, Bricks),
    setup_call_cleanup(
        ( typhon_nxt:nxt_connect(robot, Port, [deadline(20)]),
          assertz(the_arena(Arena)) ),
        ( call(Goal), ! ),
        ( retractall(the_arena(_)),
          typhon_nxt:nxt_disconnect(robot) )).

follow(Way, X, Y, Heading) :-
    fake_agent:lane_follow(robot, Way),
    the_arena(Arena),
    arena_ask(Arena, 'advance 0.5', ok),
    arena_ask(Arena, state, state(_, Robots, _, _)),
    memberchk(robot(r3, X, Y, Heading, _, _, _), Robots).

near(X, Y) :-
    abs(X - Y) < 0.03.

%   From slot 3, at 1.0, to place 3 of job 1 and of job 2, and back.

there(Turn, Side) :-
    follow([0.5-left,0.3-straight,1.02-stop], X1, Y1, _),
    assertion(near(X1, 2.32)),
    assertion(near(Y1, 1.7)),
    follow([0.64-straight,0.16-Turn,0.28-stop], X2, Y2, Heading),
    assertion(near(X2, 3.12)),
    Wanted is 1.7 + Side*0.28,
    assertion(near(Y2, Wanted)),
    assertion(abs(Heading - Side*90) < 5).

back :-
    follow([0.5-right,0.3-right,0.3-stop], X, Y, _),
    assertion(near(X, 1.0)),
    assertion(near(Y, 2.0)).

:- begin_tests(boxes_programs).

test(between, Way-Count == [0.16-straight,0.16-straight,0.6-right]-3) :-
    fake_agent('payloads/robots/lane.pl', [], []),
    fake_agent:lane_between(3.12, 2.2, right, Way0),
    length(Way0, Count),
    maplist([M0-T, M-T]>>(M is round(100*M0)/100), Way0, Way).
test(legs, Legs == [leg(left, 0.62), leg(straight, 1.16),
                    leg(right, 1.5)]) :-
    fake_agent('payloads/robots/lane.pl', [], []),
    fake_agent:lane_legs([0.5-left,0.3-straight,0.3-straight,0.15-right,
                          0.25-stop], 0, Legs0),
    maplist([leg(T, M0), leg(T, M)]>>(M is round(100*M0)/100), Legs0, Legs).
test(straight_only, Legs == [leg(straight, 0.4)]) :-
    fake_agent('payloads/robots/lane.pl', [], []),
    fake_agent:lane_legs([0.4-stop], 0, Legs).
test(to_job_1) :-
    fake_agent('payloads/robots/lane.pl', [], []),
    in_arena(there(left, 1)).
test(to_job_2) :-
    fake_agent('payloads/robots/lane.pl', [], []),
    in_arena(there(right, -1)).

:- end_tests(boxes_programs).

                /*******************************
                *           THE STUDY          *
                *******************************/

:- begin_tests(boxes_run).

test(two_robots_and_one) :-
    with_tmp_dir(two_robots_and_one).
test(no_robot, error(study_goal_failed(run/2))) :-
    with_tmp_dir(no_robot).
test(interrupted, Status == exit(130)) :-
    with_tmp_dir(interrupted(Status)).

%   The third one comes while the others push.

two_robots_and_one(Dir) :-
    robot_study(boxes, Study),
    Script = [phase([job(box1, 1, 2)], 1)],
    no_leaks(small_run(Study,
                       [ robots-2, hosts-3, script-[Script],
                         hop_time-(0.1-0.2) ],
                       Dir, Case-Ms)),
    assertion(Ms.pushed =:= 1),
    assertion(Ms.completed =:= 1),
    assertion(Ms.from_dock < 0.1),
    assertion(length(Ms.holdings, 2)),
    assertion(Ms.robots = [[1, r1, _], [2, r2, _], [3, r3, _]]),
    directory_file_path(Dir, pictures, Pictures),
    make_directory(Pictures),
    drawn(Study, [Case-Ms], Pictures, Files),
    assertion(subset([ 'arena.svg', 'boxes.gnuplot', 'jobs.dat', 'rests.dat',
                       'reservations.dat', 'robots.dat' ], Files)).

%   A run ends all its processes if there are never enough robots.

no_robot(Dir) :-
    robot_study(boxes, Study),
    Script = [phase([job(box1, 1, 3)], 0)],
    no_leaks(small_run(Study,
                       [robots-2, hosts-2, script-[Script], limit-20],
                       Dir, _)).

%   Ctrl-C, when boxes are being pushed.

interrupted(Status, Dir) :-
    project_file('experiments/study.pl', Script),
    stopped_when("allocated(",
                 [ Script, '--', boxes, '--runs', '1', '--set', 'clock=2',
                   '--out', Dir ], Dir, int, Status).

:- end_tests(boxes_run).
