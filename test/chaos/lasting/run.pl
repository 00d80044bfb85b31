:- module(lasting_run, []).

/** <module> Processes with journals are killed, from the shell

    swipl test/chaos/lasting/run.pl -- [--seed N] [--seconds N]
        [--processes N] [--agents N] [--hops N] [--crash P] [--power P]
        [--kill SECONDS] [--faults '[kill,kill_all,stop,cut,full,rest]']
        [--slow SECONDS] [--sync normal|full] [--limit SECONDS] [--fleet]

With --fleet the journals are in the engine of a fleet, and faults may also be
engine_kill, engine_stop, engine_empty and usurp.

Runs rounds until the given seconds are over, each with the next seed, with
sync(normal) and sync(full) in turn if none is given. The exit status is 0 if
nothing was lost or duplicated.

*Threading*: the main thread.
*/

:- use_module('../../../app/typhon/arguments', [arguments/3]).
:- use_module(attack).
:- use_module(words).
:- use_module('../../lib/common', [with_tmp_dir/1]).
:- use_module('../../lib/quick_swipl', [quick_swipl/2]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(main), [main/0]).
:- use_module(library(option), [option/2, option/3, select_option/4]).

:- initialization(main, main).

:- public main/1, opt_type/3.

opt_type(seed,      seed,      integer).
opt_type(seconds,   seconds,   number).
opt_type(work,      work,      oneof([lasting, words])).
opt_type(limit,     limit,     number).
opt_type(processes, processes, integer).
opt_type(agents,    agents,    integer).
opt_type(hops,      hops,      integer).
opt_type(crash,     crash,     number).
opt_type(power,     power,     number).
opt_type(kill,      kill,      number).
opt_type(slow,      slow,      number).
opt_type(faults,    faults,    term).
opt_type(fleet,     fleet,     boolean).
opt_type(sync,      sync,      oneof([normal, full])).

main(Argv) :-
    arguments(Argv, [], Options),
    with_tmp_dir(quickly(Options, Wrong)),
    (   Wrong == 0
    ->  halt(0)
    ;   halt(1)
    ).

%   Processes with a saved state of the library restart sooner.

quickly(Options0, Wrong, Dir) :-
    quick_swipl(Dir, Swipl),
    select_option(seconds(Seconds), Options0, Options1, 1),
    Options = [swipl(Swipl)|Options1],
    option(seed(Seed), Options, 1),
    get_time(Now),
    Until is Now+Seconds,
    rounds(Seed, Until, Options, sum(0, 0, 0), sum(Hops, Deaths, Wrong)),
    format('~D hops, ~D deaths, ~D things wrong~n', [Hops, Deaths, Wrong]).

rounds(Seed, Until, Options, Sum0, Sum) :-
    with_tmp_dir(round(Seed, Options, Sum0, Sum1)),
    get_time(Now),
    (   Now < Until
    ->  Next is Seed+1,
        rounds(Next, Until, Options, Sum1, Sum)
    ;   Sum = Sum1
    ).

round(Seed, Options, sum(Hops0, Deaths0, Wrong0), sum(Hops, Deaths, Wrong),
      Dir) :-
    findall(Option, default(Seed, Option), Defaults),
    option(limit(Limit), Options, 300),
    append([dir(Dir), seed(Seed), seconds(Limit)|Options], Defaults, All),
    option(work(Work), All, lasting),
    call(Work, All, report(Facts, Faults)),
    option(sync(Sync), All),
    format('seed ~d, sync(~w): ~p~n', [Seed, Sync, Facts]),
    forall(member(Fault, Faults), format('  wrong: ~p~n', [Fault])),
    flush_output,
    length(Faults, Count),
    Wrong is Wrong0+Count,
    option(hops(Made), Facts),
    Hops is Hops0+Made,
    ( memberchk(death-Died, Facts) -> true ; Died = 0 ),
    Deaths is Deaths0+Died.

default(Seed, sync(Sync)) :-
    ( Seed mod 2 =:= 0 -> Sync = normal ; Sync = full ).
default(Seed, power(P)) :-
    ( Seed mod 2 =:= 0 -> P = 0 ; P = 0.001 ).
default(_, crash(0.0002)).
default(_, kill(3)).
default(_, processes(3)).
default(_, agents(40)).
default(_, hops(250)).
