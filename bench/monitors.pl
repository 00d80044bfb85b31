:- use_module(common).
:- use_module(library(typhon)).

/*  What monitors and supervisors cost.

    swipl bench/monitors.pl -- Monitors */

:- initialization(main, main).

main([Text]) :-
    atom_number(Text, Count),
    host_start(alpha, [capacity(100000)]),
    monitors(Count),
    host_stop(alpha).

%   Each of the agents that monitor one tells a counter when that has ended.

monitors(Count) :-
    agent_create(clauses([ (:- agent(target, [])),
                           (main :- receive(_-end)) ]), Target, []),
    agent_create(clauses([ (:- agent(counter, [state([set/1, left/1])])),
                           (main :- left(0), !),
                           (main :- receive(_-What), count(What), main),
                           (count(set) :- retract(set(N)), More is N+1,
                                          assertz(set(More))),
                           (count(told) :- retract(left(N)), Left is N-1,
                                           assertz(left(Left))) ]),
                 Counter, [facts([set(0), left(Count)])]),
    Watcher = clauses([ (:- agent(watcher, [state([of/2])])),
                        (main :- of(Target0, Counter0), monitor(Target0),
                                 send(Counter0, set),
                                 receive(system-down(Target0, done)),
                                 send(Counter0, told)) ]),
    forall(between(1, Count, _),
           agent_create(Watcher, _, [facts([of(Target, Counter)])])),
    all_set(Counter, Count),
    get_time(Begin),
    agent_send(Target, end),
    agent_join(Counter, done, 300),
    get_time(End),
    Seconds is End-Begin,
    figure('the end of one agent with 10,000 monitors', Seconds, s).

all_set(Counter, Count) :-
    agent_property(Counter, facts(Facts)),
    (   memberchk(set(Count), Facts)
    ->  true
    ;   sleep(0.2),
        all_set(Counter, Count)
    ).
