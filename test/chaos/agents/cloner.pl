% Makes a number of clones, here and elsewhere, each of which makes a few
% journeys and ends.

:- agent(cloner,
         [state([me/1, tick/1, steps/1, hosts/1, heard/1, made/1])]).
:- include(steps).
:- include(mail).

main :-
    (   halted
    ->  true
    ;   multiply(Branch),
        continue(Branch)
    ).

multiply(Branch) :-
    retract(made(N0)),
    !,
    N is N0+1,
    assertz(made(N)),
    note(cloning(N)),
    catch(divide(Branch), error(Why, _), Branch = refused(Why)).

divide(Branch) :-
    random(X),
    (   X < 0.4
    ->  clone(Branch)
    ;   another_host(Host),
        clone(Host, Branch)
    ).

% The number of a refused clone is not used again: a clone of that number
% would be a duplicate.

continue(parent(Clone)) :-
    made(N),
    note(clone(N, Clone)),
    journey,
    sleep(0.3),
    main.
continue(refused(Why)) :-
    made(N),
    note(no_clone(N, Why)),
    sleep(0.3),
    main.
continue(clone(Parent)) :-
    be_another,
    note(born(Parent)),
    journey,
    journey,
    note(end),
    dispose.

be_another :-
    me(Me),
    made(N),
    atomic_list_concat([Me, '+', N], Name),
    retractall(me(_)),
    retractall(tick(_)),
    retractall(steps(_)),
    assertz(me(Name)),
    assertz(tick(0)),
    assertz(steps(0)).
