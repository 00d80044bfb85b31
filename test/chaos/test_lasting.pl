:- use_module('../lib/common').
:- use_module(library(plunit)).
:- use_module(lasting/attack).

:- needs([journal]).

:- begin_tests(lasting).

%   A short form of `make chaos`. It ends after a number of faults; the time
%   limit is for hanging runs.

test(killed_journaled_processes_lose_and_duplicate_no_agent,
     Wrong == []) :-
    with_tmp_dir(attacked([ processes(2), agents(40), hops(50),
                            crash(0.0002), kill(1), most(6) ], Wrong)).
test(power_failure_loses_no_acknowledged_commit, Wrong == []) :-
    with_tmp_dir(attacked([ processes(2), agents(10), hops(20), sync(full),
                            crash(0), power(0.1), most(6) ], Wrong)).

test(hops_among_three_processes_lose_and_duplicate_no_agent, Wrong == []) :-
    with_tmp_dir(attacked([ processes(3), agents(60), hops(30),
                            crash(0.0001), kill(1.5), most(12) ],
                          Wrong)).

%   No process is killed here, so each has to commit again by itself.

test(processes_whose_files_may_not_grow_lose_no_agent, Wrong == []) :-
    with_tmp_dir(attacked([ processes(2), agents(10), hops(50), crash(0),
                            kill(0.4), faults([full]), most(6) ], Wrong)).

%   Hosts stop and start again while agents hop and send, and each commit takes
%   a while.

test(stopped_hosts_lose_and_duplicate_no_agent, Wrong == []) :-
    with_tmp_dir(attacked([ processes(3), agents(6), hops(30), crash(0),
                            kill(0.6), faults([rest]), slow(0.05), most(15) ],
                          Wrong)).

:- end_tests(lasting).

:- begin_tests(lasting_fleet, [condition(missing([fleet], []))]).

%   The same with journals in the engine of a fleet, which has faults, too.

test(journals_in_an_engine_lose_and_duplicate_no_agent, Wrong == []) :-
    with_tmp_dir(attacked([ fleet(true), processes(3), agents(15), hops(60),
                            crash(0.0002), kill(0.4),
                            faults([ kill, kill_all, stop, cut, engine_kill,
                                     engine_stop, usurp ]), most(12) ],
                          Wrong)).

%   An engine that is empty has nothing of a process that ends meanwhile.

test(emptied_engine_loses_no_agent_of_processes_that_live, Wrong == []) :-
    with_tmp_dir(attacked([ fleet(true), processes(3), agents(10), hops(60),
                            crash(0), kill(0.4),
                            faults([engine_empty, engine_kill, stop, cut]),
                            most(8) ], Wrong)).

:- end_tests(lasting_fleet).

attacked(Options, Wrong, Dir) :-
    random_between(1, 1000000, Seed),
    format('% seed ~d~n', [Seed]),
    lasting([dir(Dir), seed(Seed), seconds(280)|Options],
            report(Facts, Wrong)),
    format('% ~p~n', [Facts]).
