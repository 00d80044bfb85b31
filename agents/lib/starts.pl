:- module(agent_starts,
          [ starts/4                    % +Count, +Hosts, +Options, -Starts
          ]).
:- use_module('../../prolog/typhon/kernel/base/prng', [chance_sample/5, chance_seed/2]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(random), [random_between/3]).

/** <module> Start hosts of the agents of a mechanism

*Threading*: any thread; no state.
*/

%!  starts(+Count, +Hosts:list(atom), +Options, -Starts:list(atom)) is det.
%
%   Starts are Count hosts. Options:
%
%     - starts(+Given:list(atom))
%       Takes the hosts of Given in turn, repeatedly if Count is greater.
%     - seed(+Integer)
%       Without `starts` they are drawn from Hosts, without repetition until
%       all are used. Default: another seed each time.
%
%   @error domain_error(hosts, []): there is no host

starts(0, _, _, Starts) :-
    !,
    Starts = [].
starts(Count, _, Options, Starts) :-
    option(starts(Given), Options),
    !,
    must_be(list(atom), Given),
    some(Given),
    in_turn(Count, Given, Given, Starts).
starts(Count, Hosts, Options, Starts) :-
    some(Hosts),
    random_between(1, 0x3fffffff, Any),
    option(seed(Seed), Options, Any),
    chance_seed(Seed, Chance),
    chance_sample(Count, Hosts, Starts, Chance, _).

some([_|_]) :-
    !.
some([]) :-
    domain_error(hosts, []).

in_turn(0, _, _, []) :-
    !.
in_turn(Count, [], Hosts, Starts) :-
    !,
    in_turn(Count, Hosts, Hosts, Starts).
in_turn(Count, [Host|Free], Hosts, [Host|Starts]) :-
    Count1 is Count - 1,
    in_turn(Count1, Free, Hosts, Starts).
