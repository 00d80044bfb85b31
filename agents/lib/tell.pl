% Expects: nothing.
% Gives: tell/2.

%!  tell(+Agent, +Message) is semidet.
%
%   As send/2, but without a warning.  Fails if it is known at once that
%   Agent has ended, or cannot be reached.

tell(Agent, Message) :-
    catch(typhon:agent_send(Agent, Message), error(_, _), fail).
