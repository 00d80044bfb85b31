% An observer changes parameters of workers.      swipl examples/hierarchy.pl

:- use_module('../prolog/typhon').      % library(typhon), once installed
:- use_module('../agents/hierarchy/operator').
:- use_module('../agents/sync/operator').
:- initialization(main, main).

% Two leaders have a part of a grid each.  In the first round the first rows
% have tasks, then all rows, for which the penalty bias of the workers, delta,
% is too large.

main :-
    tmp_file(events, File),
    network_start(grid(8, 4), Network,
                  [ clock(virtual), seed(1), hop_time(uniform(0.3, 0.5)),
                    log(File) ]),
    network_property(Network, hosts(Hosts)),
    length(North, 16),
    append(North, South, Hosts),
    North = [A, B, C, D|_],
    South = [E, F, G, H|_],
    hierarchy_start([A, E], payloads(hierarchy/steps),
                    [settings([workers-1, pool-robots, delta-0.8])], Leaders),
    round(few, [[A, B, C, D], [E, F, G, H]], Leaders),
    forall(member(Round, [all, again]), round(Round, [North, South], Leaders)),
    network_stop(Network),
    log_events(File, Events),
    forall(member(event(_, _, _, decided(Round, [_-Changes|_])), Events),
           format("after ~w: ~p~n", [Round, Changes])).

round(Round, Parts, Leaders) :-
    append(Parts, Hosts),
    sequence_start(Round, Hosts, [sow-sleep(3), water-sleep(3), reap-sleep(3)],
                   [agents(0), pool(robots)], _),
    hierarchy_serve(Leaders, Round, Parts, 3000).
