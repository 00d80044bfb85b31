%   Figure 5.12: healing of cascaded failures.

:- include(ground).
:- include(drawn).

study('5.12', "Healing of cascaded failures").

vary(links, [none, dynamic_2]).
fixed(topology, grid, printed("section 5.6.6")).
derive(delta, Case, Delta) :- member(Case.links-Delta, [none-0.5, dynamic_2-0.2]).
fixed(failure, cascaded(2, 60, 5), printed("section 5.6.6: at all nodes")).

label(none, "Grid").
label(dynamic_2, "Dynamic II").
label(lost, "Executions lost").
label(redone, "Lost executions that were repeated").
label(healing_time, "Time of healing (s)").
label(healing_tau, "Distinct tasks required while healing (τ)").
label(later_tau, "Distinct tasks required after healing (τ)").

claim(Text, [line(Line)], at([links=Links], Test)) :-
    member(Links, [none, dynamic_2]),
    label(Links, Title),
    said(Said, Line, Test),
    format(string(Text), "~w: ~w", [Title, Said]).

said("every host executes T2 and the later tasks again", 3650,
     ( lost >= 180, lost_hosts =:= 60, redone =:= lost )).
said("every host executes these tasks in order", 3656, out_of_order =:= 0).
said("no overlapped executions before or after the failure", 3656,
     overlaps =:= 0).
said("two distinct tasks at most while healing and after (τ)", 3656,
     ( healing_tau =< 2, later_tau =< 2 )).

plot('5.12', "Healing of cascaded failures", Picture) :-
    gallery("All hosts lose T2 and later tasks when T5 begins (dashed); left: \c
switched on; right: required and executed", 2, Picture).

row_title(Case, Ms, Title) :-
    label(Case.links, Name),
    healed_title(Name, Case.delta, Ms, Title).
