:- module(test_boxes, []).
:- use_module('../../lib/common', []).
:- use_module('../../lib/project_studies', [holding/3, invalid_claims/2]).
:- use_module('../../lib/robot_logs').
:- use_module(library(plunit)).
:- use_module(library(lists)).
:- use_module('../../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../../experiments/robots/boxes_jobs').
:- use_module('../../../experiments/robots/boxes_metrics').

/** <module> Robots that push boxes

Jobs, metrics, tables and claims, on logs made by hand.
*/

                /*******************************
                *             JOBS             *
                *******************************/

:- begin_tests(boxes_jobs).

test(script, Needs-Robots == [3, 3, 3, 4, 2, 5]-7) :-
    robot_study(boxes, Study),
    study_cases(Study, [], [Case]),
    findall(N, ( member(phase(Jobs, _), Case.script),
                 member(job(_, _, N), Jobs) ), Needs),
    findall(N, member(phase(_, N), Case.script), Joining),
    sum_list([Case.robots|Joining], Robots),
    assertion(Robots =:= Case.hosts).
test(one_team_for_each_place, [ forall(between(2, 5, Needs)),
                                Count == Needs ]) :-
    job_task(job(box, 1, Needs), task(box, Teams, [goal(_)])),
    findall(Place, member(1-[push, place(Place)], Teams), Places),
    sort(Places, Distinct),
    length(Distinct, Count).
test(box, Text == 'box box4 3.04 1.2 -90 4 0.5') :-
    job_box(job(box4, 2, 4), Format-Arguments),
    format(atom(Text), Format, Arguments).

:- end_tests(boxes_jobs).

                /*******************************
                *        METRICS, CLAIMS       *
                *******************************/

%   Three robots, of which `c` joins at 6; box1 needs two of the first two,
%   box2 one of them and c; so one is first, and the other must wait.

script([phase([job(box1, 1, 2), job(box2, 2, 2)], 1)]).

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

:- begin_tests(boxes_metrics).

test(holdings, Holdings == [ holding(a, box1, 1, 4, 10),
                             holding(b, box2, 2, none, 3),
                             holding(b, box1, 4, 4, 10),
                             holding(b, box2, 11, 12, 21),
                             holding(c, box2, 12, 12, 21) ]) :-
    events(Events),
    holdings(Events, Holdings).
test(held_without_end, Holdings == [holding(a, box1, 1, none, none)]) :-
    holdings([event(1, a, robot, reserved(a, owner, box1)),
              event(2, a, robot, released(a, other, box1))], Holdings).
test(jobs, Jobs == [ job(box1, 1, 4, 9, [a, b], []),
                     job(box2, 1, 12, 20, [b, c], [3-2.5]) ]) :-
    events(Events),
    jobs(Events, Jobs).
test(unfinished, Jobs == [job(box1, 1, none, none, [], [])]) :-
    jobs([event(1, a, allocator, begun(box1))], Jobs).
test(joined_robot_is_not_executing, Joined == [a-0, b-0, c-6]) :-
    events(Events),
    joined(Events, Joined).
test(pairs, Pairs == [ (a-b)-false, (c-d)-true ]) :-
    Script = [ phase([job(a, 1, 2), job(b, 2, 2)], 1),
               phase([job(e, 1, 2)], 0),
               phase([job(c, 1, 2), job(d, 2, 2)], 0) ],
    findall(Names-Enough, pair(Script, 3, Names, Enough), Pairs).
test(together) :-
    together([job(a, 0, 1, 5, [], []), job(b, 0, 4, 9, [], [])], b-a).
test(not_together, fail) :-
    together([job(a, 0, 1, 5, [], []), job(b, 0, 5, 9, [], [])], a-b).
test(never_allocated, fail) :-
    together([job(a, 0, 1, 5, [], []), job(b, 0, none, none, [], [])], a-b).
test(yields) :-
    yields([job(a, 0, 1, 5, [], [3-1]), job(b, 0, 6, 9, [], [])], a-b).
test(job_without_conflict_yields_to_none, fail) :-
    yields([job(a, 0, 1, 5, [], [3-1]), job(b, 0, 4, 9, [], [])], a-b).
test(no_job_yields, fail) :-
    yields([job(a, 0, 1, 5, [], []), job(b, 0, 6, 9, [], [])], a-b).
test(from_dock, Centimetres == 5) :-
    terms(Terms),
    from_dock(Terms, Metres),
    Centimetres is round(100*Metres).

:- end_tests(boxes_metrics).

                /*******************************
                *            CLAIMS            *
                *******************************/

%   point(+Events, +Terms, -Point), with two robots at first.

point(Events, Terms, Point) :-
    robot_study(boxes, Study),
    script(Script),
    measured(Study, [robots-2, script-[Script]], [a, b, c], Events, Terms,
             Point).

worse(_{pushed:1}, 1).
worse(_{completed:1}, 2).
worse(_{yielded:0}, 3).
worse(_{together:0, enough:1}, 4).
worse(_{newcomers_used:0}, 5).
worse(_{from_dock:0.2}, 6).

:- begin_tests(boxes_claims).

test(well_formed, Problems == []) :-
    robot_study(boxes, Study),
    invalid_claims(Study, Problems).
test(measures) :-
    events(Events),
    terms(Terms),
    point(Events, Terms, _-Ms),
    forall(member(Name-Value,
                  [ boxes-2, pushed-2, completed-2, backoffs-1, rested-2.5,
                    contending-1, yielded-1, enough-0, together-0,
                    newcomers-1, newcomers_used-1, from_dock-0.05, end-20 ]),
           assertion(abs(Ms.Name - Value) < 1.0e-6)).
test(tables) :-
    events(Events),
    terms(Terms),
    point(Events, Terms, _-Ms),
    assertion(Ms.jobs == [ [1, box1, 2, 0, 3, 8, 0, 0, "a b"],
                           [2, box2, 2, 0, 11, 19, 1, 2.5, "b c"] ]),
    assertion(Ms.rests == [[2, 2, 2.5]]),
    assertion(Ms.holdings == [ [1, 1, 0, 3, 9], [2, 2, 1, none, 2],
                               [2, 1, 3, 3, 9], [2, 2, 10, 11, 20],
                               [3, 2, 11, 11, 20] ]),
    assertion(Ms.robots == [[1, a, -1], [2, b, -1], [3, c, 5]]).
test(all_hold, Numbers == [1, 2, 3, 4, 5, 6]) :-
    robot_study(boxes, Study),
    events(Events),
    terms(Terms),
    point(Events, Terms, Point),
    holding(Study, [Point], Numbers).
test(each_claim_can_fail, [forall(worse(Worse, N)), Failing == [N]]) :-
    robot_study(boxes, Study),
    events(Events),
    terms(Terms),
    point(Events, Terms, Case-Ms),
    holding(Study, [Case-(Ms.put(Worse))], Numbers),
    subtract([1, 2, 3, 4, 5, 6], Numbers, Failing).
test(newcomer_idle, Count =:= 0) :-
    events(Events0),
    findall(Event,
            ( member(Event, Events0),
              \+ ( Event = event(_, _, _, What), What =.. [_,c,_,_] ) ),
            Events),
    terms(Terms),
    point(Events, Terms, _-Ms),
    Count = Ms.newcomers_used.
test(reserved_twice, fail) :-
    terms(Terms),
    point([ event(1, a, robot, reserved(a, one, box1)),
            event(2, a, robot, reserved(a, two, box2)),
            event(3, a, robot, released(a, two, box2)) ], Terms, _).
test(left_reserved, fail) :-
    terms(Terms),
    point([event(1, a, robot, reserved(a, one, box1))], Terms, _).

:- end_tests(boxes_claims).
