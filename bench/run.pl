:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(filesex), [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(csv), [csv_write_file/2]).

/*  The benchmarks, each in a process of its own: one line per figure, and
all figures in OUT/bench.csv.

    swipl bench/run.pl -- [--out DIR] [NAME ...]

Names are those of the files here; without any, all but
`peers`, `keys`, `journal`, `fleet` and `playground` are run.
Machines are noisy: compare figures of one run, placement by placement. */

:- initialization(main, main).

:- prolog_load_context(directory, Dir),
   assertz(bench_directory(Dir)).

:- dynamic bench_directory/1.

opt_type(out, out, file).
opt_help(out, 'directory to write to (default out/bench)').
opt_meta(out, 'DIR').

main(Argv) :-
    arguments(Argv, Names, Options),
    forall(member(Name, Names), must_be_known(Name)),
    option(out(Out), Options, 'out/bench'),
    make_directory_path(Out),
    current_prolog_flag(version, Version),
    format('# SWI-Prolog ~d; name, value, unit, ratio of~n', [Version]),
    findall(Row, ( job(Script, Prefix, Argument),
                   wanted(Names, Script),
                   figure_of(Script, Prefix, Argument, Row) ),
            Rows),
    directory_file_path(Out, 'bench.csv', File),
    csv_write_file(File, [row(name,value,unit,ratio_of)|Rows]),
    format('# ~w~n', [File]).

must_be_known(Name) :-
    (   job(Name, _, _)
    ->  true
    ;   existence_error(benchmark, Name)
    ).

wanted([], Script) :-
    \+ memberchk(Script, [peers, keys, journal, fleet, playground]). % take minutes
wanted([Name|Names], Script) :-
    memberchk(Script, [Name|Names]).

job(hops, [env], unpinned).
job(hops, [taskset, '-c', '0'], same_cpu).
job(hops, [taskset, '-c', '0'], one_each).
job(messages, [env], unpinned).
job(counts, [env], unpinned).
job(fipa, [env], unpinned).
job(mqtt, [env], unpinned).
job(strangers, [env], unpinned).
job(guard, [env], unpinned).
job(cells, [env], unpinned).
job(keys, [env], unpinned).
job(start, [env], unpinned).
job(hosts, [env], unpinned).
job(processes, [env], unpinned).
job(population, [env], unpinned).
job(virtual, [env], 20000).
job(inferences, [env], 4000).
job(compiled, [env], 4000).
job(tartarus, [env], 2000).
job(watch, [env], 9).
job(monitors, [env], 10000).
job(phercon, [env], 3).
job(sync, [env], unpinned).
job(learning, [env], 1).
job(learning, [env], 2).
job(playground, [env], unpinned).
job(peers, [env], 3).
job(journal, [env], unpinned).
job(fleet, [env], all).

figure_of(Script, Prefix, Argument, row(Name, Value, Unit, Note)) :-
    bench_directory(Dir),
    atomic_list_concat([Dir, /, Script, '.pl'], File),
    current_prolog_flag(executable, Swipl),
    append(Prefix, [Swipl, File, '--', Argument], [Program|Args]),
    setup_call_cleanup(
        process_create(path(Program), Args,
                       [stdout(pipe(Out)), process(Pid)]),
        read_figure(Out, figure(Name, Value, Unit, Note)),
        ( close(Out, [force(true)]), process_wait(Pid, _) )),
    format('~w~t~56|~t~w~12+ ~w~t~10+~w~n', [Name, Value, Unit, Note]).

read_figure(Out, Figure) :-
    repeat,
    read(Out, Term),
    (   Term == end_of_file
    ->  !,
        fail
    ;   Figure = Term
    ).
