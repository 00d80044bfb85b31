:- module(test_push, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/fake_agent').
:- use_module(library(lists), [append/3]).
:- use_module(library(plunit)).

/** <module> The robot that pushes a box: its ways, and when it gives up

*Threading*: one test at a time.
*/

%   The lines and the brick obey orders; driven(Metres) are the next measurements.

stands_for((lane_follow(b, Way) :- log(follow(Way)))).
stands_for((lane_find(b, Colour, Most) :- log(find(Colour, Most)))).
stands_for((lane_check(b, Compass) :- log(check(Compass)))).
stands_for((lane_driven(b, Metres) :- take(driven(Metres)), !)).
stands_for(lane_driven(b, 0)).
stands_for(nxt_tacho_reset(b, [b,c])).
stands_for((nxt_run(b, [b,c], Power, Options) :- log(run(Power, Options)))).
stands_for((nxt_touch(b, 1, true) :- sense(touches))).
stands_for((nxt_stop(b, [b,c]) :- log(stop))).
stands_for((nxt_float(b, [b,c]) :- log(float))).

pusher(Slot, Tuples) :-
    findall(Clause, stands_for(Clause), Clauses),
    fake_agent('payloads/robots/push.pl', Clauses,
               [brick(b),slot(Slot)|Tuples]).

%   ways(Slot, Job, Place, First, Second, Compass)

ways(1, 1, 1, [0.5-left,0.3-straight,1.62-stop], [0.375-left,0.28-stop], 0).
ways(6, 2, 1, [0.5-left,0.3-straight,0.12-stop], [0.375-right,0.28-stop],
     180).
ways(7, 1, 2, [0.5-left,0.12-stop],
     [0.375-straight,0.16-left,0.28-stop], 0).
ways(7, 2, 5, [0.5-left,0.12-stop],
     [0.855-straight,0.16-right,0.28-stop], 180).

%   lost(Tuples, Metres, Why): the robot gives up after four minutes.

lost([], 1, no_box).
lost([touches], 1, alone).

:- begin_tests(push).

test(way_to_the_place_of_the_job,
     [ forall(ways(Slot, Job, Place, First, Second, Compass)),
       true(alike([log(follow(First)),log(find(red, 0.24)),
                   log(follow(Second)),log(check(Compass))], Begin)) ]) :-
    pusher(Slot, [touches,driven(2),driven(2)]),
    fake_agent:push_box(Job, Place, 1, _),
    did([A,B,C,D|_]),
    Begin = [A,B,C,D].

%   It pushes at least 5 cm further, until the box does not move any more.

test(pushes_until_the_box_rests, Away-Rest == 0.78-[]) :-
    pusher(1, [ touches, driven(0.2), driven(0.55), driven(0.56),
                driven(0.564), driven(0.5) ]),
    fake_agent:push_box(1, 1, 0.5, Away),
    Degrees is round(0.8/(pi*0.056)*360),
    did([_,_,_,_|Acts]),
    assertion(Acts == [ log(run(50, [regulated(true),degrees(Degrees)])),
                        log(stop), log(run(-50, [regulated(true)])),
                        log(stop) ]),
    findall(Metres, fake_host:tuple(driven(Metres)), Rest).
test(gives_up_after_four_minutes, [ forall(lost(Tuples, Metres, Why)), nondet,
                                    true(alike([240,log(float)], Ended)) ]) :-
    pusher(1, Tuples),
    catch(fake_agent:push_box(1, 1, Metres, _), error(Formal, _), true),
    assertion(Formal == robot_lost(Why)),
    fake_host:time(Time),
    did(Acts),
    append(_, [Last], Acts),
    Whole is floor(Time),
    Ended = [Whole,Last].

:- end_tests(push).
