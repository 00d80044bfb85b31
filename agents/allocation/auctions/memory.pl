% Expects: nothing.
% Gives: make_room/2, first_id/0, new_id/1; its state.

/*  Bounded memory of a node, and the numbers of its messages.

        kept(Name, Count)       Count facts with this name are stored
        next_id(Id)
*/

:- dynamic kept/2, next_id/1.

%!  make_room(+Any, +Most) is det.
%
%   Called before a fact that matches Any is asserted: removes the oldest fact
%   if there are Most.  (The caller asserts the fact itself: a clause that
%   asserts a term unknown when it is compiled could add rules, and the
%   machine would run it step by step.)

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
%   Ids of floods and jobs differ among nodes; in a network of a hundred two
%   nodes share ids with a probability of 10^-5.

first_id :-
    First is random(1<<30) << 24,
    assertz(next_id(First)).

new_id(Id) :-
    retract(next_id(Id)),
    Next is Id + 1,
    assertz(next_id(Next)).
