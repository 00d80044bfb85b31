% Expects: nothing.
% Gives: keep/1.

%!  keep(+Fact) is det.
%
%   Fact replaces all facts of its name and arity.

keep(Fact) :-
    functor(Fact, Name, Arity),
    functor(Old, Name, Arity),
    retractall(Old),
    assertz(Fact).
