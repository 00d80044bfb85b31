% Expects: default/4, and setting/2 among the state.
% Gives: parameter/2.

%!  parameter(+Name, -Value) is semidet.
%
%   The fact setting(Name, Value) of the agent's creator replaces
%   default(Name, Value, Range, About); the settings of agents/lib/settings.pl
%   are those in Range.

parameter(Name, Value) :-
    (   setting(Name, Value0)
    ->  Value = Value0
    ;   default(Name, Value, _, _)
    ).
