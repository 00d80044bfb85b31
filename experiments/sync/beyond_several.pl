%   Beyond the thesis: several sequences at once, on sets of hosts that overlap.

:- include(subsets).
:- use_module('../../prolog/typhon', [agent_join/3, network_property/2]).
:- use_module('../../agents/sync/several', [sequences_start/3]).

study(several, "Several sequences at once, on shared hosts").
text("Three sequences of three tasks, each on two thirds of the hosts of a \c
grid, drawn for each, and with agents of its own.  Hosts execute one task at \c
a time.  Dependent: a host executes task 2 of the second sequence after task \c
2 of the first, of the third after that of the second, and task 3 of the \c
first after task 2 of the third, if the host takes part in both.").

vary(dependent, [false, true]).
vary(hosts, [60, 200]).
fixed(sequences, 3, assumed("a cycle of sequences, but not of tasks")).
fixed(share, 2/3, assumed("of the hosts, so most have several sequences")).
derive(agents, Case, Count) :- Count is Case.hosts // 6.

label(early, "Executions before the required task of another sequence").
label(both, "Pairs of simultaneous executions of one host").

run(Case, Network) :-
    network_property(Network, hosts(Hosts)),
    findall(Name, a_sequence(Case, Name), Names),
    subsets(Names, Case, Hosts, Sets),
    findall(sequence(Name, Set, Tasks, Own),
            ( member(Name-Set, Sets),
              tasks(Case, Tasks),
              afters(Case, Name, Afters),
              Own = [after(Afters)] ),
            Sequences),
    sequences_start(Sequences,
                    [ pool(robots), agents(Case.agents), seed(Case.seed),
                      settings([delta-(Case.delta)]) ],
                    Agents),
    forall(( member(Some, Agents), member(Agent, Some) ),
           agent_join(Agent, done, Case.limit)).

afters(Case, Name, Afters) :-
    Case.dependent == true,
    !,
    findall(Task-(Other:First), after(Name, Task, Other, First), Afters).
afters(_, _, []).

after(sequence2, 2, sequence1, 2).
after(sequence3, 2, sequence2, 2).
after(sequence1, 3, sequence3, 2).

measure(both, View, Count) :-
    aggregate_all(count,
                  ( member(Name1-part(_, Executions1), View.parts),
                    member(Name2-part(_, Executions2), View.parts),
                    Name1 @< Name2,
                    member(execution(_, Host, Start1, End1), Executions1),
                    member(execution(_, Host, Start2, End2), Executions2),
                    Start1 < End2,
                    Start2 < End1 ),
                  Count).
measure(early, View, Count) :-
    aggregate_all(count, early(View.parts), Count).

early(Parts) :-
    after(Name, Task, Other, First),
    memberchk(Name-part(_, Executions), Parts),
    memberchk(Other-part(Hosts, Others), Parts),
    member(execution(Task, Host, Start, _), Executions),
    memberchk(Host, Hosts),
    \+ ( member(execution(First, Host, _, End), Others), End =< Start ).

claim("each host executes each task of its sequences once, in order", [ours],
      ( missing =:= 0, out_of_order =:= 0, executions =:= wanted )).
claim("no host executes two tasks at once", [ours], both =:= 0).
claim("no task is executed before the task it waits for", [ours],
      at([dependent=true], early =:= 0)).
claim("without dependences tasks are executed before the tasks they would \c
wait for", [ours],
      at([dependent=false], early > 0)).
claim("without dependences no task begins before all its hosts have the \c
previous one", [ours],
      at([dependent=false], overlaps =:= 0)).
claim("with dependences no task begins before all its hosts have the \c
previous one", [ours], at([dependent=true], overlaps =:= 0)).
claim("with as many agents per host, the largest network takes less than \c
twice as long as the smallest", [ours],
      last(total, along(hosts)) < 2*first(total, along(hosts))).

plot(several, "Several sequences at once",
     lines([x(hosts), y([total, idle, overlaps]), line(dependent)])).
