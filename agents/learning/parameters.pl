% Expects: setting/2 among the state.
% Gives: default/4, and parameter/2 of lib.

/*  The parameters of learning agents (thesis section 4.4); facts
    setting(Name, Value) replace the defaults.

    The thesis prints epsilon and rho_max.  k_d, k_r and `search` were
    calibrated together, once, so that a single agent that learns the maze
    needs about as many executions as in the thesis.
*/

:- include('../lib/parameters').

default(epsilon, 0.2, within(0, 1, 0.01), "probability of a random move").
default(rho_max, 10, range(1, 100, 0.5), "migration resource").
default(rho_min, 1, range(0.1, 10, 0.1),
        "below it the resource is exhausted").
default(c, 0.5, range(0, 5, 0.01), "of equation 4.3").
default(k_d, 1, range(0.01, 10, 0.01), "of equation 4.5").
default(k_r, 0.5, range(0, 5, 0.01), "of equation 4.6").
default(search, 3, range(0, 20, 1), "actions that Xi allows beyond the plan").
default(sharing, true, [true, false],
        "false: agents do not speak to each other").
default(stay, 1, range(0, 20, 0.1), "seconds in the queue of a host").
default(patience, 1, range(0.1, 20, 0.1),
        "seconds before a refused agent tries again").
default(answer, 30, range(1, 300, 0.5),
        "seconds for the answer of another agent").
default(execution, 60, range(1, 600, 0.5),
        "seconds for the trainer's feedback").
default(start, now, [now, order], "order: waits for the message begin").
default(seed, random, [random, range(0, 2147483647, 1)],
        "of the random choices of trainers").
default(trace, false, [true, false], "trainers log the actions tried").
