:- module(test_counts, []).
:- use_module('../../lib/common').
:- use_module(library(plunit)).

/** <module> Hops and messages of runs, counted
*/

:- begin_tests(counts).

%   Each host has one order for each task.

test(hops_and_messages) :-
    project_file('experiments/counts.pl', Script),
    run_swipl([ Script, '--', '5.5', '--set', 'topology=ring', '--set',
                'hosts=6', '--set', 'agents=2', '--set', 'tasks=2', '--runs',
                '1' ], [], exit(0), Out, _),
    sub_string(Out, _, _, _, ", 12 messages, "),
    \+ sub_string(Out, _, _, _, " 0 hops").

:- end_tests(counts).
