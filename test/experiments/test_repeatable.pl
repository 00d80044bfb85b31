:- module(test_repeatable, []).
:- use_module('../lib/common').
:- needs(['python3-serial']).
:- use_module('../../experiments/engine/cases', [study_cases/3]).
:- use_module('../../experiments/engine/run', [run_log/5]).
:- use_module('../../experiments/engine/studies', [study_load/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3, process_kill/2,
                                 process_wait/2]).
:- use_module(library(readutil), [read_file_to_string/3]).

/** <module> The same seed, the same log: of every mechanism, on any load

Each mechanism is run once alone, and once while two other processes want the
processors; with TYPHON_REPEATS=10 in the environment as many times each.

*Threading*: one test at a time.
*/

:- dynamic alone/2.                     % Name, Text: the log of a run of seed 4

:- begin_tests(repeatable).

test(every_mechanism, [forall(small(Name, File, Given)), true(Logs == [1])]) :-
    with_tmp_dir(different(Name, File, Given, Logs)).
test(other_seed, [forall(small(Name, File, Given)), true(A \== B)]) :-
    log_alone(Name, File, Given, A),
    with_tmp_dir(log_of(File, Given, 5, B)).

:- end_tests(repeatable).

%   small(?Name, -File, -Given): a study of the mechanism with little to do.

small(synchronisation, 'sync/figure_5_9',
      [ topology-grid, hosts-20, agents-3, tasks-2, delta-0.5,
        dynamic-dynamic_2 ]).
small(population, 'population/figure_6_4',
      [ hosts-8, degree-4, tasks-4, threshold-20, crash-2, tick-0.5,
        limit-2000 ]).
small(learning, 'learning/figure_4_13',
      [ size-2, settings-[[rho_max-3]], network-obstacle, obstacle_hosts-10 ]).
small(sieve, 'sieve/figure_3_5',
      [ topology-random(8, 0.4), attacked-1, round-2, omega-8 ]).
small(robots, 'robots/study_pole', [way-in_step, every-1, telegram-0.05]).
small(allocation, 'allocation/figure_7_1_to_7_3',
      [ mechanism-proposed, links-(dynamic), hosts-8, probability-0.4,
        eligible-3, required-2, allocators-2, duration-1 ]).
small(murdoch, 'allocation/figure_7_1_to_7_3',
      [ mechanism-murdoch, links-(dynamic), hosts-8, probability-0.4,
        eligible-3, required-2, allocators-2, duration-1 ]).

repeats(Count) :-
    (   getenv('TYPHON_REPEATS', Atom)
    ->  atom_number(Atom, Count)
    ;   Count = 1
    ).

%   different(+Name, +File, +Given, -Counts, +Dir): Counts is [1] if all logs
%   are the same text.

different(Name, File, Given, [Count], Dir) :-
    repeats(Repeats),
    findall(Text,
            ( member(Busy, [0, 2]),
              beside(Busy, logs(Repeats, File, Given, Dir, Texts)),
              member(Text, Texts) ),
            All),
    All = [Text0|_],
    assertz(alone(Name, Text0)),
    length(All, Runs),
    Runs =:= 2*Repeats,
    sort(All, Different),
    length(Different, Count).

log_alone(Name, _, _, Text) :-
    alone(Name, Text),
    !.
log_alone(_, File, Given, Text) :-
    with_tmp_dir(log_of(File, Given, 4, Text)).

logs(Count, File, Given, Dir, Texts) :-
    findall(Text,
            ( between(1, Count, _), log_of(File, Given, 4, Text, Dir) ),
            Texts).

log_of(File, Given, Seed, Text, Dir) :-
    atom_concat('experiments/', File, Path),
    project_file(Path, Source),
    study_load(Source, Study),
    study_cases(Study, Given, [Case|_]),
    directory_file_path(Dir, 'events.pl', Log),
    no_leaks(run_log(Study, Case, Seed, Log, _)),
    read_file_to_string(Log, Text, [encoding(utf8)]),
    delete_file(Log),
    Text \== "".

:- meta_predicate beside(+, 0).

beside(Count, Goal) :-
    bursts(Bursts),
    setup_call_cleanup(
        findall(Pid,
                ( between(1, Count, _),
                  process_create(path(sh), ['-c', Bursts], [process(Pid)]) ),
                Pids),
        once(Goal),
        forall(member(Pid, Pids),
               ( process_kill(Pid, kill), process_wait(Pid, _) ))).

%   A process that wants a processor again and again.

bursts('while sleep 0.05; do
            i=0
            while [ $i -lt 5000 ]; do i=$((i+1)); done
        done').
