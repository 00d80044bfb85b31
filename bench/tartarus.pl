:- use_module(common).
:- use_module(tartarus_ring).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [max_list/2, sum_list/2]).

/*  Programs written for Tartarus: hops per second of an agent that moves round
a ring of four platforms, each a process of its own; and the number of agents,
of 35, that return from a thousand hops between two platforms without a pause.
The figures of the original are 740 and 0.

    swipl bench/tartarus.pl -- 2000 */

:- initialization(main, main).

main([Argument]) :-
    atom_number(Argument, Hops),
    with_ring(4, ring(Hops)),
    with_ring(2, back_and_forth(1000, 35)).

ring(Hops, Nodes) :-
    findall(Rate,
            ( between(1, 5, I),
              round_trip(Nodes, I, Hops, Seconds),
              Rate is Hops/Seconds ),
            [_|Rates]),                 % the first one warms up
    max_list(Rates, Best),
    sum_list(Rates, Sum),
    Mean is Sum/4,
    format(atom(Note), 'mean of four ~0f; original 740', [Mean]),
    figure('hops of a Tartarus program, ring of four', Best, '1/s', Note).

back_and_forth(Hops, Agents, Nodes) :-
    aggregate_all(count,
                  ( between(1, Agents, I),
                    round_trip(Nodes, I, Hops, _) ),
                  Home),
    figure('of 35, home after 1000 hops between two', Home, agents,
           'original 0').
