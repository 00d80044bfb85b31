%   Figure 5.5 and Table 5.1: one run in each of four topologies.

:- include(ground).
:- include(drawn).

study('5.5', "Execution in step in four topologies, and Table 5.1").

vary(topology, [star_bus, ring, tree, grid]).
derive(delta, Case, Delta) :- best_delta(Case.topology, Delta).
real([topology=grid], [clock=10, processes=4]).

label(burst, "Hosts on which T1 begins within one second").
label(serviced, "T1 has begun everywhere (s)").
label(unrequired, "T1 is no longer required (s)").
label(second, "T2 begins (s)").
label(pause, "Longest time without execution within a task (s)").

measure(serviced, View, Time) :-
    memberchk(task(1, _, Time, _, _, _), View.rows).
measure(unrequired, View, Time) :-
    aggregate_all(max(To), member(segment(_, 1, _, To), View.segments), Time).
measure(second, View, Time) :-
    memberchk(task(2, Time, _, _, _, _), View.rows).
measure(pause, View, Most) :-
    aggregate_all(max(Pause), ( member(Task, View.tasks),
                                pause(View.executions, Task, Pause) ), Most).

%   The longest time without an execution of Task, between its first and its
%   last execution; executions are in order of their starts.

pause(Executions, Task, Pause) :-
    findall(Start-End, member(execution(Task, _, Start, End), Executions),
            [First-End0|Others]),
    foldl([S-E, Last0-P0, Last-P]>>( Last is max(Last0, E),
                                     P is max(P0, S - Last0) ),
          [First-End0|Others], End0-0, _-Pause).

printed(idle, [topology=star_bus], 66).
printed(idle, [topology=ring],     32).
printed(idle, [topology=tree],    142).
printed(idle, [topology=grid],     25).
printed(burst, [topology=star_bus], 19).
printed(serviced, [topology=star_bus], 9).
printed(unrequired, [topology=star_bus], 6).
printed(second, [topology=star_bus], 37).

claim(Text, [line(Line)], at([topology=Name], Test)) :-
    best_delta(Name, _),
    label(Name, Title),
    said(Said, Line, Test),
    format(string(Text), "~w: ~w", [Title, Said]).
claim(Text, [line(3393)|Why], at([topology=Name], near(idle, Printed, Fifth))) :-
    printed(idle, [topology=Name], Printed),
    label(Name, Title),
    format(string(Text), "~w: total idle time ~w s, within a fifth",
           [Title, Printed]),
    Fifth is Printed/5,
    why(Name, Why).
claim("idle time is longest on tree, then star-bus, ring, grid",
      [line(3393), why("as for the tree")],
      ( at([topology=tree], idle) > at([topology=star_bus], idle),
        at([topology=star_bus], idle) > at([topology=ring], idle),
        at([topology=ring], idle) > at([topology=grid], idle) )).
claim("without the tree idle time is longest on star-bus, ring, grid",
      [line(3393)],
      ( at([topology=star_bus], idle) > at([topology=ring], idle),
        at([topology=ring], idle) > at([topology=grid], idle) )).
claim("Star-bus: T1 begins on more hosts than there are agents within a second",
      [line(3357)], at([topology=star_bus], burst > agents)).
claim("Star-bus: T1 begins on 19 hosts within a second", [line(3356)],
      at([topology=star_bus], near(burst, 19, 2))).
claim("Star-bus: T1 has begun everywhere by the 9th second", [line(3360)],
      at([topology=star_bus], serviced =< 9)).
claim("Star-bus: T1 is required up to 6 s", [line(3381)],
      at([topology=star_bus], near(unrequired, 6, 2))).
claim("Star-bus: T2 begins at the 37th second, within a fifth", [line(3362)],
      at([topology=star_bus], near(second, 37, 7.4))).

said("two distinct tasks are required at most (τ)", 3387, tau =< 2).
said("no overlapped executions", 3376, overlaps =:= 0).
said("every host executes every task once, in order", 2966,
     ( missing =:= 0, executions =:= hosts*tasks, out_of_order =:= 0 )).
said("all hosts are idle between any two tasks", 3368, least_gap > 0).
said("the first burst is the largest", 3423, burst > later_burst).
said("there are gaps in the execution of some task", 3412, pause > 0).

why(tree, [why("Figure 5.7 a has 48 s for the same case: one of the two is \c
an error")]) :-
    !.
why(_, []).

plot('5.5', "Execution in step in four topologies", Picture) :-
    gallery("Left: executions switched on in each second; right: required \c
(light) and executed (full colour)", 4, Picture).

row_title(Case, Ms, Title) :-
    label(Case.topology, Name),
    format(string(Title), "{/:Bold ~w (δ = ~w)}   ~1f s idle, ~d overlapped \c
executions, {/:Italic τ} at most ~d",
           [Name, Case.delta, Ms.idle, Ms.overlaps, Ms.tau]).
