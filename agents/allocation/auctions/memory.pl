% Expects: nothing.
% Gives: make_room/2, first_id/0, new_id/1; its state.

/*  Bounded memory of a node, and the numbers of its messages.

        kept(Name, Count)       how many facts of a name are remembered
        next_id(Id)
*/

:- dynamic kept/2, next_id/1.

%!  make_room(+Any, +Most) is det.
%
%   The caller is about to assert a fact that matches Any: of more than Most
%   the oldest goes.  (A clause that asserts what it does not know by name
%   could add rules, and would be run by the machine, step by step.)

make_room(Any, Most) :-
    functor(Any, Name, _),
    (   retract(kept(Name, Count0))
    ->  true
    ;   Count0 = 0
    ),
    (   Count0 >= Most
    ->  once(retract(Any)),
        Count = Count0
    ;   Count is Count0 + 1
    ),
    assertz(kept(Name, Count)).

%!  first_id is det.
%!  new_id(-Id) is det.
%
%   Numbers of floods and jobs differ among nodes but for a chance of one in
%   10^5 in a network of a hundred.

first_id :-
    First is random(1<<30) << 24,
    assertz(next_id(First)).

new_id(Id) :-
    retract(next_id(Id)),
    Next is Id + 1,
    assertz(next_id(Next)).
