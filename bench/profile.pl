:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(common).
:- use_module(sampled).
:- use_module(traveller).
:- use_module(library(typhon)).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth0/3, sum_list/2]).
:- use_module(library(option), [option/3]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(solution_sequences), [distinct/2]).

/*  The share of each module in the cost of a hop.

    swipl bench/profile.pl -- [--hops N] [--rounds N] [--agents N]

Two tables, of hops between two processes and between two hosts of one: the
processor time of a hop in microseconds, by module and by thread.  The times
of threads are those of runs without profiler, medians of all rounds; their
composition is sampled by sampled.pl, one thread after the other, in as many
further runs. A module of few microseconds is based on a handful of samples.
*/

:- initialization(main, main).

opt_type(hops, hops, integer).
opt_type(rounds, rounds, integer).
opt_type(agents, agents, integer).
opt_meta(hops, 'N').
opt_meta(rounds, 'N').
opt_meta(agents, 'N').
opt_help(hops, 'hops of a run between processes (default 2000)').
opt_help(rounds, 'runs for each thread (default 10)').
opt_help(agents, 'agents that travel at a time (default 1)').

:- meta_predicate profile(+, +, 1, +, +), with_near(1).

:- dynamic
    thread_took/3,              % Process, Role, Micros: per hop
    source_took/4,                % Process-Role, Source, How, Seconds
    seen_in/3.                  % Process-Role, Cpu, Seen: in the same run

main(Argv) :-
    arguments(Argv, [], Options),
    profile('between processes', 1, with_peer([env]),
            [here-worker, here-reader, there-worker, there-reader], Options),
    profile('within a process', 5, with_near, [here-worker], Options).

%   Makes Times times the requested hops, so that there are enough samples.

profile(What, Times, With, Threads, Options) :-
    option(hops(Hops0), Options, 2000),
    Hops is Times*Hops0,
    option(rounds(Rounds), Options, 10),
    option(agents(Agents), Options, 1),
    retractall(thread_took(_, _, _)),
    retractall(source_took(_, _, _, _)),
    retractall(seen_in(_, _, _)),
    forall(between(1, Rounds, _),
           ( host_start(here),
             call(With, round(hops(Agents, Hops), Hops, Threads)),
             host_stop(here) )),
    table(What, Threads).

with_near(Goal) :-
    host_start(near),
    host_property(near, address(Near)),
    call(Goal, Near),
    host_stop(near).

hops(Agents, Hops, Peer) :-
    travelled(Agents, Hops, Peer, _).

%   Each round has new threads, because a thread can be sampled only once.

round(Run, Hops, Threads, Peer) :-
    call(Run, Peer),                    % warm up
    forall(process_of(Threads, Process), ready(Process, Peer)),
    timed(Run, Hops, Peer, Threads),
    forall(member(Thread, Threads), sampled(Run, Peer, Thread)).

ready(Process, Peer) :-
    module_property(bench_sampled, file(File)),
    (   Process == there
    ->  remote(Peer, user:use_module(File))
    ;   true
    ),
    asked(Process, Peer, patient_threads).

                /*******************************
                *            RUNS             *
                *******************************/

%   timed(:Run, +Hops, +Peer, +Threads): processor time of all roles in these
%   processes.

timed(Run, Hops, Peer, Threads) :-
    findall(Process, process_of(Threads, Process), Processes),
    maplist(times(Peer), Processes, Before),
    call(Run, Peer),
    maplist(times(Peer), Processes, After),
    forall(( nth0(I, Processes, Process), nth0(I, Before, Times0),
             nth0(I, After, Times), member(Role-Seconds0, Times0),
             memberchk(Role-Seconds, Times) ),
           ( Micros is (Seconds-Seconds0)/Hops*1.0e6,
             assertz(thread_took(Process, Role, Micros)) )).

process_of(Threads, Process) :-
    distinct(Process, member(Process-_, Threads)).

times(Peer, Process, Times) :-
    asked(Process, Peer, thread_times(Times)).

sampled(Run, Peer, Process-Role) :-
    asked(Process, Peer, sampling_begin(Role)),
    call(Run, Peer),
    asked(Process, Peer, sampling_end(Cpu-Seen, Spent)),
    assertz(seen_in(Process-Role, Cpu, Seen)),
    forall(member(spent(Source, How, Seconds), Spent),
           assertz(source_took(Process-Role, Source, How, Seconds))).

asked(here, _, Goal) :-
    call(bench_sampled:Goal).
asked(there, Peer, Goal) :-
    remote(Peer, bench_sampled:Goal).

                /*******************************
                *            TABLES            *
                *******************************/

table(What, Threads) :-
    findall(Total-row(Source, Total, Called, Micros),
            ( distinct(Source, source_took(_, Source, _, _)),
              maplist(micros(Source, _), Threads, Micros),
              sum_list(Micros, Total),
              maplist(micros(Source, called), Threads, Calls),
              sum_list(Calls, Called) ),
            Rows0),
    sort(1, @>=, Rows0, Rows),
    pairs_keys(Rows, Totals),
    sum_list(Totals, All),
    others(Others),
    format('~w: ~1f us of processor a hop, and ~1f us in other threads~n',
           [What, All, Others]),
    line([module,us,'%',called|Threads]),
    forall(member(_-row(Source, Total, Called, Micros), Rows),
           ( Share is 100*Total/All,
             line([Source,Total,Share,Called|Micros]) )),
    maplist(overstated, Threads, Factors),
    line(['seen at work, times',' ',' ',' '|Factors]),
    nl.

%   micros(+Source, ?How, +Thread, -Micros): microseconds per hop.

micros(Source, How, Thread, Micros) :-
    took(Thread, Took),
    seconds_in(Thread, _, _, All),
    seconds_in(Thread, Source, How, Part),
    Micros is Took*Part/max(All, 1.0e-9).

seconds_in(Thread, Source, How, Sum) :-
    aggregate_all(sum(S), source_took(Thread, Source, How, S), Sum).

took(Process-Role, Took) :-
    findall(Micros, thread_took(Process, Role, Micros), List),
    msort(List, Sorted),
    length(Sorted, Count),
    Middle is Count//2,
    nth0(Middle, Sorted, Took).

others(Sum) :-
    aggregate_all(sum(Took),
                  ( distinct(Process, thread_took(Process, other, _)),
                    took(Process-other, Took) ),
                  Sum).

%   Ratio of the time in which the thread seemed to work and its processor time.

overstated(Thread, Factor) :-
    aggregate_all(r(sum(C), sum(S)), seen_in(Thread, C, S), r(Cpu, Seen)),
    Factor is Seen/Cpu.

line([Word|Cells]) :-
    format('~w~t~22|', [Word]),
    forall(member(Cell, Cells), cell(Cell)),
    nl.

cell(Number) :-
    number(Number),
    !,
    format(atom(Text), '~1f', [Number]),
    cell(Text).
cell(Term) :-
    format(atom(Text), '~t~w~13|', [Term]),
    write(Text).
