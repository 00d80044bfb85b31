% Expects: default/2, and setting/2 among the state.
% Gives: parameter/2.

%!  parameter(+Name, -Value) is semidet.
%
%   A fact setting(Name, Value), given to the agent by its creator,
%   replaces the default(Name, Value).

parameter(Name, Value) :-
    (   setting(Name, Value0)
    ->  Value = Value0
    ;   default(Name, Value)
    ).
