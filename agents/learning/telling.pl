% Expects: nothing.
% Gives: told/2.

%!  told(+Agent, +Message) is semidet.
%
%   Fails if the process of Agent is known to have ended.

told(Agent, Message) :-
    catch(send(Agent, Message), error(host_unreachable(_), _), fail).
