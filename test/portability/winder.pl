:- agent(winder, [state([route/3, noted/2, later/1])]).

% Moves from inside every control construct, and notes where it continues.

main :-
    route(A, B, C),
    (   hop(B), note(condition)
    ->  note(then), hop(C), note(branch)
    ;   note(else)
    ),
    (   hop(A), note(failing), fail
    ->  true
    ;   note(otherwise)
    ),
    (   pick(X), hop(B), note(soft(X))
    *-> note(after(X)), hop(C)
    ;   note(none)
    ),
    catch(thrower(A), ball(S, F, I, V, V), ( note(caught(S, F, I)), hop(C) )),
    catch(( hop(A), note(uncaught) ), _, note(never)),
    \+ \+ note(native),
    once(( hop(B) ; note(second) )),
    ignore(( hop(C), note(ignored), fail )),
    call(wind(A), wound),
    Goal = ( hop(B), note(bound_goal) ),
    Goal,
    assertz((later(There) :- hop(There), !, note(later))),
    later(C),
    down(7, [A,B,C]),
    findall(Host-What, noted(Host, What), Notes),
    home(Home),
    move(Home),
    leave(wound(Notes)).

pick(2).
pick(3).

thrower(Host) :-
    hop(Host),
    I is -(2**70),
    throw(ball("caught", -0.0, I, _, _)).

wind(Host, What) :-
    hop(Host),
    note(What).

down(0, _) :-
    !.
down(N, [Host|Hosts]) :-
    hop(Host),
    note(N),
    append(Hosts, [Host], Again),
    N1 is N-1,
    down(N1, Again).

hop(Host) :-
    move(Host).

note(What) :-
    here(Here),
    assertz(noted(Here, What)).
