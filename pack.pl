name(typhon).
version('0.1.0').
title('Mobile agents that travel in the middle of a clause').
keywords([agent, mobile, distributed, robot, network]).
author('The Typhon developers', '').
requires(prolog >= '9.0.4').
