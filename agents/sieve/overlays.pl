% Overlays of guards and antibodies on the page; facts overlay/4, see
% doc/page.md.

overlay('attacks by antigens', bar, log(attacked(_)), add(1)).
overlay('time until served', bar, log(served(_, _, Wait, _)), Wait).
