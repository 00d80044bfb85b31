:- module(test_set_clock, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/set_clock').
:- use_module(library(lists)).
:- use_module(library(typhon)).

/** <module> The time of day is set while processes wait

Each scenario of set_clock_main.pl runs in a process whose time of day is set by
half a minute or an hour, forward or back.  Without a compiler these tests are
skipped.

*Threading*: one process after the other.
*/

result(Scenario, Step, Result) :-
    with_settable_clock(Environment,
                        result(Environment, Scenario, Step, Result)).

result(Environment, Scenario, Step, Result) :-
    project_file('test/lib/set_clock_main.pl', Main),
    run_swipl(['-g', set_clock_main, '-t', 'halt(1)', Main, --, Scenario, Step],
              [environment(Environment), timeout(100)], Status, Out, Err),
    (   Status == exit(0)
    ->  term_string(Result, Out)
    ;   Result = Status-Err
    ).

:- begin_tests(set_clock, [condition(clock_is_settable)]).

step(Step) :-
    member(Step, [-3600,-30,30,3600]).

test(sleep, [forall(step(Step)), true(R == done-in_time)]) :-
    result(sleep, Step, R).
test(timeout_of_receive, [forall(step(Step)), true(R == done-in_time)]) :-
    result(receive, Step, R).
test(timeout_of_join, [forall(step(Step)), true(R == timeout-in_time)]) :-
    result(join, Step, R).
test(agents_run, [forall(step(Step)), true(R == in_time)]) :-
    result(agents_run, Step, R).
test(now_does_not_go_back, R =:= 0) :-
    result(now, 0, R).
test(children_have_the_clock_of_their_parent,
     [forall(step(Step)), true(R == same)]) :-
    result(child, Step, R).
test(network_starts_runs_and_stops,
     [forall(step(Step)), true(R == done-in_time)]) :-
    result(network, Step, R).
test(timeouts_of_helpers,
     [ condition(missing([python3], [])), forall(step(Step)),
       true(R == [1,timeout_error,in_time]) ]) :-
    result(python, Step, R).
test(no_agent_is_lost_in_chaos, [forall(member(Step, [30,3600])),
                                 true(R == [done])]) :-
    result(chaos, Step, R).

:- end_tests(set_clock).
