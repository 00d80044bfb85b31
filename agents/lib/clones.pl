% Expects: nothing.
% Gives: clone_if_room/1, forget_visits/0.

%!  clone_if_room(-Branch) is det.
%
%   As clone/1; Branch is `refused` if the host refuses the clone.

clone_if_room(Branch) :-
    catch(clone(Branch), error(move_refused(_, _), _), Branch = refused).

%!  forget_visits is det.
%
%   Clears the memory of visits, so that a clone chooses its own way.

forget_visits :-
    retractall('$memory'(_)).
