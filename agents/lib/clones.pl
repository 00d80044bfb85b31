% Expects: nothing.
% Gives: clone_if_room/1, forget_visits/0.

%!  clone_if_room(-Who) is det.
%
%   As clone/1; Who is `refused` where the host has no place for a clone.

clone_if_room(Who) :-
    catch(clone(Who), error(move_refused(_, _), _), Who = refused).

%!  forget_visits is det.
%
%   A clone has been nowhere else, and chooses its ways by itself.

forget_visits :-
    retractall('$memory'(_)).
