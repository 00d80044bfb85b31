:- use_module(common).
:- use_module(traveller).
:- use_module(library(typhon)).
:- use_module(library(filesex), [delete_directory_and_contents/1]).
:- use_module(library(process), [process_create/3, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).

/*  What a journal costs: the hops of bench/hops.pl without one, and with one
in both processes; and how long a process with many agents takes to be there
again.

    swipl bench/journal.pl -- unpinned */

:- initialization(main, main).

main([unpinned]) :-
    rates(none, Plain, _),
    rates(normal, Normal, Normal100),
    rates(full, _, Full100),
    figure('1 agent without a journal: hops per second', Plain, '1/s'),
    ratio('a hop with sync(normal)', Plain, Normal, '1/s', 'without'),
    figure('100 agents, sync(normal): hops per second', Normal100, '1/s'),
    figure('100 agents, sync(full): hops per second', Full100, '1/s'),
    recovery(100000).

rates(Sync, One, Hundred) :-
    with_directory(rates(Sync, One, Hundred)).

with_directory(Goal) :-
    tmp_file(journal, Dir),
    make_directory(Dir),
    setup_call_cleanup(true, once(call(Goal, Dir)),
                       delete_directory_and_contents(Dir)).

rates(Sync, One, Hundred, Dir) :-
    here(Sync, Dir, Options),
    host_start(here, Options),
    with_other(Sync, Dir, both(One, Hundred)),
    host_stop(here).

here(none, _, []) :-
    !.
here(Sync, Dir, [journal(Own), sync(Sync)]) :-
    atom_concat(Dir, '/here', Own).

both(One, Hundred, Peer) :-
    travelled(1, 3000, Peer, _),
    travelled(1, 10000, Peer, rates(One, _)),
    travelled(100, 20000, Peer, rates(Hundred, _)).

:- meta_predicate with_other(+, +, 1).

with_other(Sync, Dir, Goal) :-
    module_property(bench_traveller, file(File)),
    (   Sync == none
    ->  Options = []
    ;   atom_concat(Dir, '/there', There),
        Options = [journal(There), sync(Sync)]
    ),
    format(atom(Start),
           'typhon:host_start(peer, ~q), typhon:host_property(peer, \c
            address(A)), writeln(A), read(_)', [Options]),
    setup_call_cleanup(
        process_create(path(swipl), ['-q', '-g', Start, '-t', halt, File],
                       [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
        ( read_line_to_string(Out, Line),
          atom_string(Address, Line),
          call(Goal, Address) ),
        ( close(In), process_wait(Pid, _), close(Out) )).

recovery(Count) :-
    with_directory(recovery(Count)).

recovery(Count, Dir) :-
    Program = clauses([ (:- agent(waits, [state([fact/2])])),
                        (on_message(_, _) :- true) ]),
    findall(fact(I, value(I)), between(1, 8, I), Facts),
    host_start(here, [journal(Dir)]),
    seconds(forall(between(1, Count, _),
                   agent_create(Program, _, [facts(Facts)])), Made),
    figure('agents created per second', Count/Made, '1/s'),
    host_stop(here),
    seconds(host_start(here, [journal(Dir)]), Seconds),
    host_property(here, load(Load)),
    Load =:= Count,
    format(atom(Name), '~D agents are there again', [Count]),
    figure(Name, Seconds, s),
    statistics(process_cputime, Cpu0),
    sleep(2),
    statistics(process_cputime, Cpu1),
    Share is (Cpu1-Cpu0)/2,
    figure('processors that they take while they wait', Share, '').
