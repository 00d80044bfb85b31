:- use_module(common).
:- use_module('../experiments/engine/numbers', [median/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3]).
:- use_module(library(readutil), [read_line_to_string/2]).

/*  The cost of loading library(typhon): processor time and resident memory of
    a process that does nothing else, medians of some runs, also with a host.
    */

:- initialization(main, main).

:- prolog_load_context(directory, Dir),
   assertz(bench_directory(Dir)).

:- dynamic bench_directory/1.

main(_) :-
    measured(true, Bare),
    measured(loaded, Loaded),
    measured(host, Host),
    report('load library(typhon)', Bare, Loaded),
    report('load it, start a host', Bare, Host).

report(Name, Seconds0-_, Seconds1-Bytes) :-
    Seconds is (Seconds1-Seconds0)*1000,
    Megabytes is Bytes/1.0e6,
    figure(Name, Seconds, 'ms of processor'),
    atom_concat(Name, ', memory', Memory),
    figure(Memory, Megabytes, 'MB').

%   measured(+What, -Median): Seconds-Bytes of the process.

measured(What, Seconds-Bytes) :-
    findall(S-B, ( between(1, 5, _), run(What, S, B) ), Runs),
    findall(S, member(S-_, Runs), Ss),
    findall(B, member(_-B, Runs), Bs),
    median(Ss, Seconds),
    median(Bs, Bytes).

run(What, Seconds, Bytes) :-
    goal(What, Goal),
    bench_directory(Dir),
    atom_concat(Dir, '/common.pl', Common),
    format(atom(Told),
           '~w,statistics(cputime,S),use_module(~q),\c
            bench_common:resident_bytes(B),print(S-B),nl', [Goal, Common]),
    current_prolog_flag(executable, Swipl),
    setup_call_cleanup(
        process_create(Swipl, ['-g', Told, '-t', halt],
                       [stdout(pipe(Out))]),
        read_line_to_string(Out, Line),
        close(Out)),
    term_string(Seconds-Bytes, Line).

goal(true, true).
goal(loaded, Goal) :-
    load_goal(Goal).
goal(host, Goal) :-
    load_goal(Load),
    atom_concat(Load, ',host_start(a)', Goal).

load_goal(Goal) :-
    bench_directory(Dir),
    format(atom(Goal), 'use_module(\'~w/../prolog/typhon\')', [Dir]).
