:- module(test_allocation_people, []).
:- use_module('../../lib/common').
:- use_module('../../lib/pages', [ask/3]).
:- use_module('../../../agents/allocation/operator',
              [robot_start/3, task_allocate/4]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> The mechanism of the thesis as it is, with people for robots

*Threading*: one test at a time.
*/

page(Link, Questions) :-
    ask(Link, _{ask:"page"}, Answer),
    Questions = Answer.answer.questions.

:- begin_tests(allocation_people).

test(allocator_finds_the_person_that_fits) :-
    no_leaks(setup_call_cleanup(
                 ( host_start(desk),
                   people_start([anna, ben], [_-Anna, _-Ben],
                                [port(0), link(desk)]) ),
                 allocated(Anna, Ben),
                 ( people_stop,
                   host_stop(anna), host_stop(ben), host_stop(desk) ))).

allocated(Anna, Ben) :-
    host_property(anna, address(First)),
    host_property(ben, address(Second)),
    robot_start(First, [tall], []),
    robot_start(Second, [], []),
    Goal = choose("Please wipe the board.", [done], done),
    task_allocate(task(wipe, [1-[tall]], [goal(Goal)]), desk, [], Agent),
    wait_until(page(Anna, [Question]), 20),
    page(Ben, []),
    ask(Anna, _{do:"answer", number:Question.number, answer:1}, _{answer:_}),
    agent_join(Agent, done, 60).

:- end_tests(allocation_people).
