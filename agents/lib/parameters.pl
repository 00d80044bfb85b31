% Expects: default/2, and setting/2 among the state.
% Gives: parameter/2.

%!  parameter(+Name, -Value) is semidet.
%
%   The fact setting(Name, Value) of the agent's creator replaces
%   default(Name, Value).

parameter(Name, Value) :-
    (   setting(Name, Value0)
    ->  Value = Value0
    ;   default(Name, Value)
    ).
