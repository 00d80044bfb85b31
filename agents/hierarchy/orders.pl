% Expects: keep/1; memory/1; decided/4 of a payload.
% Gives: orders/2.

%!  orders(+Reports, -Orders) is det.
%
%   Orders are the decision of the mechanism; its memory is updated.

orders(Reports, Orders) :-
    ( memory(Memory0) -> true ; Memory0 = none ),
    decided(Reports, Memory0, Memory, Orders),
    keep(memory(Memory)).
