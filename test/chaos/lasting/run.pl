:- module(lasting_run, []).

/** <module> Processes with journals are killed, from the shell

    swipl test/chaos/lasting/run.pl -- [--seed N] [--processes N]
        [--agents N] [--hops N] [--crash P] [--kill SECONDS]
        [--sync normal|full] [--seconds N]

The exit status is 0 if nothing was lost or doubled.

*Threading*: the main thread.
*/

:- use_module(attack).
:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module(library(main), [argv_options/3, main/0]).

:- initialization(main, main).

:- public main/1, opt_type/3.

opt_type(seed,      seed,      integer).
opt_type(processes, processes, integer).
opt_type(agents,    agents,    integer).
opt_type(hops,      hops,      integer).
opt_type(crash,     crash,     number).
opt_type(kill,      kill,      number).
opt_type(sync,      sync,      oneof([normal, full])).
opt_type(seconds,   seconds,   number).

main(Argv) :-
    argv_options(Argv, _, Options),
    with_tmp_dir(attacked(Options, Wrong)),
    (   Wrong == []
    ->  halt(0)
    ;   halt(1)
    ).

attacked(Options, Wrong, Dir) :-
    lasting([dir(Dir)|Options], report(Facts, Wrong)),
    format('~p~nwrong: ~p~n', [Facts, Wrong]).
