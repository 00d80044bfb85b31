% Expects: setting/2 among the state.
% Gives: default/4, and parameter/2 of lib.

/*  The parameters of the sieve (thesis section 3.6); facts
    setting(Name, Value) replace the defaults.

    The thesis does not print gamma, the initial endurance potential: the
    default is the middle between its thresholds; nor the parameters from
    `reading` on.
*/

:- include('../lib/parameters').

default(gamma_max, 1.5, range(0, 5, 0.01), "above it an agent clones").
default(gamma_min, 0.5, range(0, 5, 0.01), "below it an agent dies").
default(alpha, 10, range(1, 100, 0.5), "of equation 3.2").
default(beta, 0.5, range(0, 5, 0.01), "of equation 3.2").
default(kt, 0.5, range(0, 5, 0.01), "of equation 3.4").
default(ku, 0.5, range(0, 5, 0.01), "of equation 3.5").
default(omega, 1000, range(1, 10000, 1), "hops a clone lives").
default(expiry, inf, [inf, range(1, 10000, 1)],
        "hops an agent lives that is no clone").
default(gamma, 1.0, range(0, 5, 0.01), "the first endurance potential").
default(reading, similar, [similar, current, common, total],
        "of the better agent, see idiotypic.pl").
default(span, 3, range(0, 20, 1), "hops a danger signal spreads").
default(patience, 4, range(0.1, 60, 0.1),
        "seconds until it has evaporated").
default(calls, 1, range(1, 20, 1), "number of emissions").
default(draws, 1000, range(0, 10000, 1), "antibodies a host tries at random").
default(gather, 3, range(0.1, 60, 0.1),
        "seconds from the first offer to the choice").
default(crowd, 12, range(1, 100, 1), "agents at a host that prevent a clone").
default(memory_cells, 0, range(0, 20, 1),
        "memory cells that a host may appoint").
default(memory_wins, 3, range(1, 20, 1),
        "wins that make an agent a memory cell").
default(seed, random, [random, range(0, 2147483647, 1)],
        "of the choices of hosts").
