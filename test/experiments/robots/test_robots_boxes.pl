:- module(test_robots_boxes, []).
:- use_module('../../lib/common').
:- needs(['python3-serial']).
:- use_module(library(plunit)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists)).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module('../../../experiments/robots/boxes').
:- use_module('../../../experiments/robots/boxes_claims').
:- use_module('../../../experiments/robots/boxes_metrics').
:- use_module('../../../experiments/robots/boxes_picture').
:- use_module('../../../experiments/robots/boxes_script').

/** <module> Robots that push boxes

Script, metrics, claims and the timeline, on logs made by hand.
*/

                /*******************************
                *            SCRIPT            *
                *******************************/

:- begin_tests(boxes_script).

test(thesis, Needs == [3, 3, 3, 4, 2, 5]) :-
    thesis_script(Script),
    script_jobs(Script, Jobs),
    findall(N, member(job(_, _, N), Jobs), Needs).
test(seven_robots, Count == 7) :-
    thesis_script(script(First, Phases)),
    aggregate_all(sum(N), member(phase(_, N), Phases), Joining),
    Count is First + Joining.
test(one_team_for_each_place, [ forall(between(2, 5, Needs)),
                                Count == Needs ]) :-
    job_program(Program),
    job_task(job(box, 1, Needs), Program, task(box, Teams, [goal(_)])),
    findall(Place, member(1-[push, place(Place)], Teams), Places),
    sort(Places, Distinct),
    length(Distinct, Count).
test(box, Text == 'box box4 3.04 1.2 -90 4 0.5') :-
    job_box(job(box4, 2, 4), Format-Arguments),
    format(atom(Text), Format, Arguments).

:- end_tests(boxes_script).

                /*******************************
                *        METRICS, CLAIMS       *
                *******************************/

%   Three robots, of which `c` joins at 6; a needs two of the first two, b
%   one of them and c; so a is first, and b must wait.

script(script(2, [ phase([job(box1, 1, 2), job(box2, 2, 2)], 1) ])).

events([ event(0, a, 'robot.x.0@a', created),
         event(0, b, 'robot.y.0@b', created),
         event(1, a, 'allocator.1', begun(box1)),
         event(1, b, 'allocator.2', begun(box2)),
         event(1, a, 'robot.x.0@a', reserved(a, 'allocator.1', box1)),
         event(2, b, 'robot.y.0@b', reserved(b, 'allocator.2', box2)),
         event(3, b, 'robot.y.0@b', released(b, 'allocator.2', box2)),
         event(3, a, 'allocator.2', backoff(2.5)),
         event(4, b, 'robot.y.0@b', reserved(b, 'allocator.1', box1)),
         event(4, b, 'allocator.1', allocated(box1, [a, b])),
         event(4, b, 'robot.y.1@b', created),
         event(6, c, 'robot.z.0@c', created),
         event(9, a, 'robot.x.0@a', executed(a, 'allocator.1', box1)),
         event(9, b, 'allocator.1', completed(box1)),
         event(10, a, 'robot.x.0@a', released(a, 'allocator.1', box1)),
         event(10, b, 'robot.y.0@b', released(b, 'allocator.1', box1)),
         event(11, b, 'robot.y.0@b', reserved(b, 'allocator.2', box2)),
         event(12, c, 'robot.z.0@c', reserved(c, 'allocator.2', box2)),
         event(12, c, 'allocator.2', allocated(box2, [b, c])),
         event(20, c, 'allocator.2', completed(box2)),
         event(21, b, 'robot.y.0@b', released(b, 'allocator.2', box2)),
         event(21, c, 'robot.z.0@c', released(c, 'allocator.2', box2))
       ]).

terms([ state(0, [robot(r1, 1, 2, 0, open, 0, 0)], none, []),
        event(8, arrived(box1)),
        state(9, [ robot(r1, 3, 2, 0, open, 0, 0),
                   robot(r2, 4, 2, 0, open, 0, 0) ], none, []),
        event(18, arrived(box2)),
        state(20, [ robot(r1, 1, 2.05, 0, open, 0, 0),
                    robot(r2, 4, 2, 0, open, 0, 0) ], none, [])
      ]).

run(Events, Terms, [ hosts([a, b, c]), events(Events), arena(Terms),
                     wall(1) ]).

held(Events, Terms, Helds) :-
    script(Script),
    run(Events, Terms, Run),
    boxes_result(Run, Result),
    boxes_claims(Script, Result, Claims),
    findall(Held, member(claim(_, Held, _), Claims), Helds).

:- begin_tests(boxes_metrics).

test(holdings, Holdings == [ holding(a, box1, 1, 4, 10),
                             holding(b, box2, 2, none, 3),
                             holding(b, box1, 4, 4, 10),
                             holding(b, box2, 11, 12, 21),
                             holding(c, box2, 12, 12, 21) ]) :-
    events(Events),
    holdings(Events, Holdings).
test(held_for_ever, Holdings == [holding(a, box1, 1, none, none)]) :-
    holdings([event(1, a, robot, reserved(a, owner, box1)),
              event(2, a, robot, released(a, other, box1))], Holdings).
test(jobs, Jobs == [ job(box1, 1, 4, 9, [a, b], []),
                     job(box2, 1, 12, 20, [b, c], [3-2.5]) ]) :-
    events(Events),
    jobs(Events, Jobs).
test(unfinished, Jobs == [job(box1, 1, none, none, [], [])]) :-
    jobs([event(1, a, allocator, begun(box1))], Jobs).
test(joined_is_not_executing, Joined == [a-0, b-0, c-6]) :-
    events(Events),
    joined(Events, Joined).
test(together) :-
    together([job(a, 0, 1, 5, [], []), job(b, 0, 4, 9, [], [])], b, a).
test(not_together, fail) :-
    together([job(a, 0, 1, 5, [], []), job(b, 0, 5, 9, [], [])], a, b).
test(never_allocated, fail) :-
    together([job(a, 0, 1, 5, [], []), job(b, 0, none, none, [], [])], a,
             b).
test(pushed, Boxes-Centimetres == [box1, box2]-5) :-
    terms(Terms),
    pushed(Terms, Boxes),
    from_dock(Terms, Metres),
    Centimetres is round(100*Metres).

:- end_tests(boxes_metrics).

:- begin_tests(boxes_claims).

test(all_hold, Helds == [true, true, true, true, true]) :-
    events(Events),
    terms(Terms),
    held(Events, Terms, Helds).
test(box_left, Helds == [false, true, true, true, true]) :-
    events(Events),
    terms(Terms0),
    selectchk(event(18, _), Terms0, Terms),
    held(Events, Terms, Helds).
test(not_completed, Helds == [true, false, true, true, true]) :-
    events(Events0),
    selectchk(event(20, _, _, _), Events0, Events),
    terms(Terms),
    held(Events, Terms, Helds).
test(no_back_off, Helds == [true, true, false, true, true]) :-
    events(Events0),
    selectchk(event(_, _, _, backoff(_)), Events0, Events),
    terms(Terms),
    held(Events, Terms, Helds).
test(newcomer_idle, Helds == [true, true, true, false, true]) :-
    events(Events0),
    exclude_robot(c, Events0, Events),
    terms(Terms),
    held(Events, Terms, Helds).
test(not_back, Helds == [true, true, true, true, false]) :-
    events(Events),
    terms(Terms0),
    append(Terms0, [state(21, [robot(r1, 1, 2.2, 0, open, 0, 0)], none, [])],
           Terms),
    held(Events, Terms, Helds).
test(side_by_side, Found-Held == '1 of 1 pairs'-true) :-
    thesis_script(_),
    Jobs = [job(a, 0, 1, 5, [], []), job(b, 0, 2, 6, [], [])],
    boxes_claims(script(2, [phase([job(a, 1, 1), job(b, 2, 1)], 0)]),
                 [ pushed([]), jobs(Jobs), hosts([]), holdings([]),
                   from_dock(0) ], Claims),
    memberchk(claim('two jobs for which there are enough robots go on \c
side by side', Held, Found), Claims).
test(reserved_twice, error(robot_reservations([twice(a, _, _, _)|_]))) :-
    terms(Terms),
    run([ event(1, a, robot, reserved(a, one, box1)),
          event(2, a, robot, reserved(a, two, box2)),
          event(3, a, robot, released(a, two, box2)) ], Terms, Run),
    boxes_result(Run, _).
test(left_reserved, error(robot_reservations([held(a, one, box1)]))) :-
    terms(Terms),
    run([event(1, a, robot, reserved(a, one, box1))], Terms, Run),
    boxes_result(Run, _).

exclude_robot(Robot, Events0, Events) :-
    findall(Event,
            ( member(Event, Events0),
              \+ ( Event = event(_, _, _, What), What =.. [_,Robot,_,_] ) ),
            Events).

:- end_tests(boxes_claims).

:- begin_tests(boxes_picture).

%   Columns: middle, row, left, right, low, high, colour.

test(timeline, Rows == [[2.5, 2, 2, 3], [12.5, 2, 4, 21], [12, 3, 6, 21]]) :-
    events(Events),
    terms(Terms),
    run(Events, Terms, Run0),
    boxes_result(Run0, Result0),
    selectchk(end(_), Result0, Result),
    Rows = [[2.5, 2, 2, 3], _, _],
    findall(Row, robots_boxes_picture:robot_row([end(20)|Result], Row),
            All),
    % b, for box2: reserved from 1 to 2 since the first allocator began
    assertion(memberchk([1.5, 2, 1, 2, 1.6, 2.4, _], All)),
    % b, for box1: reserved and executing at once, from 3 to 9
    aggregate_all(count, member([6, 2, 3, 9, 1.6, 2.4, _], All), 2),
    % c is there from 5 to the end
    assertion(memberchk([12.5, 3, 5, 20, _, _, 0xbbbbbb], All)),
    Rows = [_, [12.5, 2, 4, 21], [12, 3, 6, 21]].
test(allocators) :-
    events(Events),
    terms(Terms),
    run(Events, Terms, Run),
    boxes_result(Run, Result),
    findall(Row, robots_boxes_picture:job_row(Result, Row), All),
    assertion(memberchk([_, 1, 0, 3, _, _, _], All)),
    assertion(memberchk([_, 1, 3, 8, _, _, _], All)),
    assertion(memberchk([3.25, 2, 2, 4.5, 1.75, 2.25, 0x999999], All)),
    length(All, 5).
test(files) :-
    with_tmp_dir(drawn).

drawn(Dir) :-
    events(Events),
    terms(Terms),
    run(Events, Terms, Run),
    boxes_result(Run, Result),
    draw_boxes(Dir, boxes, 'a test', Result),
    directory_file_path(Dir, 'boxes.gnuplot', File),
    read_file_to_string(File, Text, []),
    assertion(sub_string(Text, _, _, _, "\"box2 (2)\" 2")).

:- end_tests(boxes_picture).
