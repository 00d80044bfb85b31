%   Figure 5.11: healing of atomic failures.

:- include(ground).
:- include(drawn).

study('5.11', "Healing of atomic failures").

vary(topology, [star_bus, ring, tree, grid]).
derive(delta, Case, Delta) :- best_delta(Case.topology, Delta).
fixed(failure, atomic(2, 20, 5), printed("section 5.6.6")).

printed(redone, [], 20).
printed(healing_tau, [], 3).
printed(later_tau, [], 2).

label(redone, "Lost executions that were repeated").
label(healing_time, "Time of healing (s)").
label(healing_tau, "Distinct tasks required while healing (τ)").
label(meanwhile, "Executions of other tasks while healing").
label(later_tau, "Distinct tasks required after healing (τ)").

claim(Text, [line(Line)], at([topology=Name], Test)) :-
    best_delta(Name, _),
    label(Name, Title),
    said(Said, Line, Test),
    format(string(Text), "~w: ~w", [Title, Said]).

said("20 hosts lose T2, and each executes it again", 3633,
     ( lost =:= 20, redone =:= 20 )).
said("three distinct tasks are required while healing (τ)", 3640,
     healing_tau =:= 3).
said("other agents execute other tasks while healing", 3639, meanwhile > 0).
said("all hosts finish T5 and T6, nothing else is repeated", 3641,
     ( missing =:= 0, executions =:= hosts*tasks + 20 )).
said("two distinct tasks at most after healing (τ)", 3641, later_tau =< 2).
said("no host executes a task before the earlier ones", 3566,
     out_of_order =:= 0).
said("no overlapped executions, except repeated ones", 3628, overlaps =:= 0).

plot('5.11', "Healing of atomic failures", Picture) :-
    gallery("20 hosts lose T2 when T5 begins (dashed); left: executions \c
switched on; right: required and executed", 4, Picture).

row_title(Case, Ms, Title) :-
    label(Case.topology, Name),
    healed_title(Name, Case.delta, Ms, Title).
