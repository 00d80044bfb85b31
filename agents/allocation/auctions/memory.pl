% Expects: nothing.
% Gives: remember/3, first_id/0, new_id/1; its state.

/*  What a node remembers for a while, and how it numbers what it sends.

        kept(Name, Count)       how many facts of a name are remembered
        next_id(Id)
*/

:- dynamic kept/2, next_id/1.

%!  remember(+Fact, +Any, +Most) is det.
%
%   Assert Fact; of more than Most that match Any the oldest goes.

remember(Fact, Any, Most) :-
    assertz(Fact),
    functor(Fact, Name, _),
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
