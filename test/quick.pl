:- module(test_quick, []).

/** <module> Runs the suites that the change touches, and some of the others

    swipl test/quick.pl [-- --seconds N] [--seed N] [--list]

runs, by test/run.pl, suites that take about so long together, on the
processors of this machine: those that the change touches (see
lib/changed_files.pl and lib/touched.pl), the nearest and quickest first, and
then others, drawn at random. Suites that alone take longer are left out.

*Threading*: the main thread only.
*/

:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(lib/changed_files, [changed_files/1]).
:- use_module(lib/common, [project_file/2]).
:- use_module(lib/touched,
              [suite_times/1, touched_suites/2, within_budget/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/3, member/2, subtract/3]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(random), [random_between/3, random_permutation/2]).

:- initialization(main, main).

:- public main/1.

opt_type(seconds, seconds, nonneg).
opt_type(seed, seed, nonneg).
opt_type(list, list, boolean).
opt_help(seconds, 'time that the suites take together (default 120)').
opt_help(seed, 'of the sample (default a random one)').
opt_help(list, 'only list the suites').

main(Argv) :-
    arguments(Argv, [], Options),
    option(seconds(Seconds), Options, 120),
    budget(Seconds, Budget),
    changed_files(Files),
    touched_suites(Files, Touched),
    within_budget(Touched, Budget, Near, Far),
    sum(Near, Spent),
    seed(Options, Seed),
    sample(Touched, Budget, Spent, Drawn, Rest),
    report(Files, Near, Far),
    report_sample(Drawn, Rest, Seed),
    append(Near, Drawn, Chosen),
    findall(Suite, member(time(Suite, _, _), Chosen), Suites),
    (   option(list(true), Options)
    ->  forall(member(Suite, Suites), format('~w~n', [Suite]))
    ;   run(Suites)
    ).

%   Suites also wait, so that they use this share of the processors.

budget(Seconds, budget(Processor, Longest)) :-
    current_prolog_flag(cpu_count, Processors),
    Processor is 0.65*Seconds*Processors,
    Longest is 0.8*Seconds.

seed(Options, Seed) :-
    (   option(seed(Seed), Options)
    ->  true
    ;   random_between(1, 99 999, Seed)
    ),
    set_random(seed(Seed)).

sample(Touched, budget(Processor, Longest), Spent, Drawn, Rest) :-
    suite_times(Times),
    subtract(Times, Touched, Others),
    random_permutation(Others, Shuffled),
    Left is Processor-Spent,
    within_budget(Shuffled, budget(Left, Longest), Drawn, Rest).

sum(Suites, Sum) :-
    aggregate_all(sum(P), member(time(_, P, _), Suites), Sum).

report(Files, Near, Far) :-
    maplist(length, [Files, Near, Far], [Changed, Run, Left]),
    format("~d files are changed; of the suites that they touch, ~d run, \c
            ~d are left out~n", [Changed, Run, Left]).

report_sample(Drawn, Rest, Seed) :-
    maplist(length, [Drawn, Rest], [Run, Left]),
    format("of the other suites, ~d run, ~d are left out (seed ~d)~n",
           [Run, Left, Seed]),
    flush_output.

run([]) :-
    !.
run(Suites) :-
    current_prolog_flag(executable, Swipl),
    project_file('test/run.pl', Run),
    process_create(Swipl, [Run, --|Suites], [process(Pid)]),
    process_wait(Pid, exit(Status)),
    halt(Status).
