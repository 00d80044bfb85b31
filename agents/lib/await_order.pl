% Expects: parameters; the parameter `start`.
% Gives: await_order/0.

%!  await_order is det.
%
%   With the parameter start-order the agent waits for the message `begin`.

await_order :-
    parameter(start, order),
    !,
    receive(_-begin).
await_order.
