%   Figure 5.6: effects of the penalty bias.

:- include(ground).

study('5.6', "Idle time and overlaps against the penalty bias δ").

vary(topology, [star_bus, ring, tree, grid]).
vary(delta, [0.2, 0.3, 0.5, 0.8, 1.0]).

printed(idle, [topology=star_bus, delta=0.2], 66).
printed(idle, [topology=ring,     delta=0.8], 32).
printed(idle, [topology=tree,     delta=0.2], 142).
printed(idle, [topology=grid,     delta=0.5], 25).
printed(overlaps, [topology=Name, delta=Delta], 0) :-
    best_delta(Name, Delta).
printed(overlaps, [topology=ring, delta=1.0], 0).

claim(Text, [line(3437)],
      at([topology=Name], holds(in_order(idle, >=)))) :-
    of(Name, "idle time never rises as δ grows", Text).
claim(Text, [line(3443)],
      holds(no_overlaps_up_to(Name, Delta))) :-
    best_delta(Name, Delta),
    of(Name, "no overlaps up to the best δ", Text).
claim(Text, [line(3444)],
      at([topology=Name], rises(overlaps, along(delta), ends))) :-
    member(Name, [star_bus, tree, grid]),
    of(Name, "overlaps above the best δ", Text).
claim(Text, [line(3444)],
      at([topology=Name], holds(in_order(overlaps, =<)))) :-
    member(Name, [star_bus, tree, grid]),
    of(Name, "no fewer overlaps with each larger δ", Text).
claim("Star-bus, tree: overlaps at the next δ, 0.3", [line(3445)],
      ( at([topology=star_bus, delta=0.3], overlaps > 0),
        at([topology=tree, delta=0.3], overlaps > 0) )).
claim("Ring: no overlaps up to δ = 1.0", [line(3450)],
      at([topology=ring], overlaps =:= 0)).
claim("overlaps begin at a smaller δ on star-bus and tree than on grid and \c
ring", [line(3448)],
      holds(earlier([star_bus, tree], [grid, ring]))).
claim("if executions overlap three distinct tasks are required (τ)",
      [ line(3438),
        why("as τ is defined an executing host requires nothing, so a few \c
overlaps pass without a third task") ],
      holds(three_where_overlaps)).

of(Name, Said, Text) :-
    best_delta(Name, _),
    label(Name, Title),
    format(string(Text), "~w: ~w", [Title, Said]).

%   in_order(+Measure, +Order, +Points): Order holds for each pair of successive
%   values of δ.

in_order(Measure, Order, Points) :-
    findall(Value, ( member(_-Ms, Points), get_dict(Measure, Ms, Value) ),
            Values),
    Values = [_, _|_],
    forall(append(_, [A, B|_], Values), call(Order, A, B)).

no_overlaps_up_to(Name, Best, Points) :-
    forall(( member(Case-Ms, Points), Case.topology == Name,
             Case.delta =< Best ),
           Ms.overlaps =:= 0).

%   The least bias at which executions overlap; a large one if none do.

onset(Points, Name, Onset) :-
    aggregate_all(min(Delta),
                  ( member(Case-Ms, Points), Case.topology == Name,
                    Ms.overlaps > 0, Delta = Case.delta ),
                  Onset),
    !.
onset(_, _, 10).

earlier(Early, Late, Points) :-
    forall(( member(A, Early), member(B, Late) ),
           ( onset(Points, A, OnsetA), onset(Points, B, OnsetB),
             OnsetA < OnsetB )).

three_where_overlaps(Points) :-
    findall(Tau, ( member(_-Ms, Points), Ms.overlaps > 0, Tau = Ms.tau ),
            Taus),
    Taus = [_|_],
    forall(member(Tau, Taus), Tau >= 3).

plot('5.6', "Idle time and overlaps against the penalty bias",
     lines([x(delta), y([idle, overlaps]), line(topology),
            subtitle("60 hosts, 10 agents")])).
