% Expects: setting/2 among the state.
% Gives: default/2, and parameter/2 of lib.

/*  The parameters of the sieve (thesis section 3.6); facts
    setting(Name, Value) replace the defaults.

    The thesis does not print gamma, the initial endurance potential: the
    default is the middle between its thresholds; nor the parameters from
    `reading` on.
*/

:- include('../lib/parameters').

default(gamma_max, 1.5).        % above it an agent clones
default(gamma_min, 0.5).        % below it an agent dies
default(alpha, 10).             % of equation 3.2
default(beta, 0.5).
default(kt, 0.5).               % of equation 3.4
default(ku, 0.5).               % of equation 3.5
default(omega, 1000).           % hops a clone lives
default(expiry, inf).           % hops an agent lives that is no clone
default(gamma, 1.0).
default(reading, similar).      % see idiotypic.pl
default(span, 3).               % hops a danger signal spreads
default(patience, 4).           % seconds until it has evaporated
default(calls, 1).              % number of emissions
default(draws, 1000).           % antibodies a host tries at random
default(gather, 3).             % seconds from the first offer to the choice
default(crowd, 12).             % agents at a host that prevent a clone
default(memory_cells, 0).       % memory cells that a host may appoint
default(memory_wins, 3).        % wins that make an agent a memory cell
default(seed, random).
