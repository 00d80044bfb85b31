% Expects: plan/3, drive/3; fill/1.
% Gives: compare_plans/0, bring_plan/0, fill_new/0.

/*  Plans that change while they are carried out: beyond the thesis.  When a
    travelling agent visits a host, the newer of their two plans replaces the
    older one.  So a change at a few hosts spreads to all others.

    In plan(Sequence, Version, Tasks) Version is a number that is greater the
    newer the plan is; the tuple of a host is the newest plan that an agent
    has brought.
*/

%!  bring_plan is det.
%
%   Leaves the agent's plan at a host that has none.

bring_plan :-
    plan(Sequence, _, _),
    sense(plan(Sequence, _, _)),
    !.
bring_plan :-
    plan(Sequence, Version, Tasks),
    leave(plan(Sequence, Version, Tasks)).

%!  compare_plans is det.
%
%   The newer of two plans replaces the older one, here or in the agent.

compare_plans :-
    plan(Sequence, Mine, _),
    sense(plan(Sequence, Theirs, _)),
    Mine =\= Theirs,
    !,
    (   Mine > Theirs
    ->  replace(Sequence, Theirs)
    ;   adopt(Sequence, Theirs)
    ).
compare_plans.

%   Another agent may replace the same plan at the same time.

replace(Sequence, Old) :-
    (   take(plan(Sequence, Old, _))
    ->  plan(Sequence, Version, Tasks),
        leave(plan(Sequence, Version, Tasks))
    ;   true
    ).

adopt(Sequence, Version) :-
    (   sense(plan(Sequence, Version, Tasks))
    ->  retractall(plan(_, _, _)),
        assertz(plan(Sequence, Version, Tasks)),
        forget_removed,
        fill_new,
        log(adopted(Version))
    ;   true
    ).

forget_removed :-
    plan(_, _, Tasks),
    forall(( drive(Task, _, _), \+ memberchk(Task-_, Tasks) ),
           retractall(drive(Task, _, _))).

%!  fill_new is det.
%
%   Tasks that are new to the agent get the full potential.

fill_new :-
    plan(_, _, Tasks),
    forall(( member(Task-_, Tasks), \+ drive(Task, _, _) ),
           fill(Task)).
