:- module(chaos_run, []).

/** <module> The chaos suite, from the shell

    swipl test/chaos/run.pl -- [--seconds N] [--seed N] [--scenario NAME]
        [--processes N] [--agents N] [--settle N] [--out DIR]

The exit status is 0 if all is well.

*Threading*: the main thread; see chaos_cluster.
*/

:- use_module('../../app/typhon/arguments', [arguments/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module('../lib/common', [with_tmp_dir/1]).
:- use_module('../lib/quick_swipl', [quick_swipl/2]).
:- use_module(attack).
:- use_module(faults, [scenario/3]).
:- use_module(report, [report_wrong/1]).

:- initialization(main, main).

:- public main/1, opt_type/3, opt_help/2, opt_meta/2.

opt_type(seconds,   seconds,   number).
opt_type(seed,      seed,      integer).
opt_type(scenario,  scenario,  oneof([all|Names])) :-
    findall(Name, scenario(Name, _, _), Names).
opt_type(processes, processes, integer).
opt_type(agents,    agents,    integer).
opt_type(settle,    settle,    number).
opt_type(out,       out,       atom).

opt_help(help(header), " [option ...]").
opt_help(seconds,   "How long the attack lasts, all scenarios together").
opt_help(seed,      "What the schedule of faults follows from").
opt_help(scenario,  "calm, cuts, stops, kills, deaths or all").
opt_help(processes, "How many processes, with three hosts each").
opt_help(agents,    "About so many agents to begin with").
opt_help(settle,    "At the most so long for things to settle").
opt_help(out,       "Directory for ledgers, messages and findings").

opt_meta(seconds, 'N').
opt_meta(seed, 'N').
opt_meta(scenario, 'NAME').
opt_meta(processes, 'N').
opt_meta(agents, 'N').
opt_meta(settle, 'N').
opt_meta(out, 'DIR').

main(Argv) :-
    arguments(Argv, [], Options),
    with_tmp_dir(quickly(Options, Reports)),
    (   member(Report, Reports),
        report_wrong(Report)
    ->  halt(1)
    ;   halt(0)
    ).

%   As in the test suite: processes start from a saved state of the library.

quickly(Options, Reports, Dir) :-
    quick_swipl(Dir, Swipl),
    chaos([swipl(Swipl)|Options], Reports).
