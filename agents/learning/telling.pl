% Expects: nothing.
% Gives: told/2.

%!  told(+Agent, +Message) is semidet.
%
%   Fails if its process is known to be gone.

told(Agent, Message) :-
    catch(send(Agent, Message), error(host_unreachable(_), _), fail).
