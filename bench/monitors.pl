:- use_module(common).
:- use_module(library(lists), [member/2]).
:- use_module(library(ordsets), [ord_subtract/3]).
:- use_module(library(typhon)).

/*  The cost of monitors and supervisors.

    swipl bench/monitors.pl -- Monitors

The number of children is a tenth of Monitors. */

:- initialization(main, main).

main([Text]) :-
    atom_number(Text, Count),
    host_start(alpha, [capacity(100000)]),
    monitors(Count),
    Children is Count//10,
    forall(member(Strategy, [one_for_one, one_for_all]),
           restarts(Strategy, Children)),
    host_stop(alpha).

%   Each of the agents that monitor the target sends a counter its `down`
%   message.

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

%   All children end by themselves, or one on which all others depend.

restarts(Strategy, Count) :-
    Child = clauses([ (:- agent(child, [])), (main :- receive(_-end)) ]),
    findall(child(Name, Child, []),
            ( between(1, Count, N), atom_concat(c, N, Name) ), Children),
    agent_create(agents(supervisor), S,
                 [ facts([ strategy(Strategy), intensity(Count, 60)
                         | Children ]) ]),
    running(S, Count, [], First),
    (   Strategy == one_for_one
    ->  End = First
    ;   First = [Agent|_],
        End = [Agent]
    ),
    get_time(Begin),
    forall(member(Agent, End), agent_send(Agent, end)),
    running(S, Count, First, _),
    get_time(Now),
    Seconds is Now-Begin,
    format(atom(What), 'a supervisor restarts ~D children, ~w',
           [Count, Strategy]),
    figure(What, Seconds, s),
    agent_send(S, stop),
    agent_join(S, done, 300).

%   running(+Supervisor, +Count, +Old, -Agents): Agents are Count running
%   children that are not in Old.

running(S, Count, Old, Agents) :-
    agent_property(S, facts(Facts)),
    findall(Agent, member(running(_, Agent), Facts), Agents0),
    sort(Agents0, Agents1),
    sort(Old, Old1),
    ord_subtract(Agents1, Old1, New),
    (   length(New, Count)
    ->  Agents = New
    ;   sleep(0.05),
        running(S, Count, Old, Agents)
    ).
