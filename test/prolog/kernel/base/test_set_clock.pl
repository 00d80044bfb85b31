:- module(test_set_clock, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/set_clock').
:- use_module(library(lists)).
:- use_module(library(thread), [concurrent_maplist/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/monotonic),
              [monotonic_start/0, monotonic_stop/0]).

/** <module> The time of day is set while processes wait

The scenarios of set_clock_main.pl run in processes whose time of day is set by
half a minute or an hour, forward or back.  Without a compiler these tests are
skipped.

*Threading*: each process is started and awaited by a thread.
*/

%   Each step has a process of its own; two run at a time.

at_once(Scenarios, Steps, Results) :-
    concurrent_maplist(results(Scenarios), Steps, Results).

results(Scenarios, Step, Results) :-
    with_settable_clock(Environment,
                        results(Environment, Step, Scenarios, Results)).

results(Environment, Step, Scenarios, Results) :-
    project_file('test/lib/set_clock_main.pl', Main),
    run_swipl(['-g', set_clock_main, '-t', 'halt(1)', Main, --, Step|Scenarios],
              [environment(Environment), timeout(100)], Status, Out, Err),
    (   Status == exit(0)
    ->  split_string(Out, "\n", "\n ", Lines),   % after output of children
        last(Lines, Line),
        term_string(Results, Line)
    ;   Results = Status-Err
    ).

%   A sleep, a receive and a join with a timeout, agents_run/1, and two calls of
%   Python, of which one has too short a timeout.

waits([done-in_time,done-in_time,timeout-in_time,done-in_time|Naps]) :-
    (   python_waits
    ->  Naps = [1-in_time,timeout_error-in_time]
    ;   Naps = []
    ).

:- begin_tests(set_clock, [condition(clock_is_settable)]).

step(Step) :-
    member(Step, [-30,3600]).

test(waits_networks_and_children, Results == Expected) :-
    waits(Waits),
    findall(Step, step(Step), Steps),
    findall([waits-Waits,network-(done-in_time),child-same], step(_), Expected),
    at_once([waits,network,child], Steps, Results).
test(now_does_not_go_back, R =:= 0) :-
    results([now], 0, [now-R]).
test(no_agent_is_lost_in_chaos, Results == [chaos-[done]]) :-
    results([chaos], 3600, Results).

:- end_tests(set_clock).

:- begin_tests(clock_thread).

%   The thread ends by itself just before monotonic_stop/0 signals it.

test(thread_has_ended_before_it_is_stopped) :-
    monotonic_start,
    retract(typhon_monotonic:ticker(Thread)),
    wait_until(thread_property(Thread, status(true)), 10),
    assertz(typhon_monotonic:ticker(Thread)),
    monotonic_stop,
    assertion(\+ is_thread(Thread)).

:- end_tests(clock_thread).
