% Expects: nothing.
% Gives: tell/2.

%!  tell(+Agent, +Message) is semidet.
%
%   As send/2, but without a warning.  Fails if Agent is known to have ended
%   or to be unreachable.

tell(Agent, Message) :-
    catch(typhon:agent_send(Agent, Message), error(_, _), fail).
