:- module(test_starts, []).
:- use_module('../lib/common', []).
:- use_module('../../agents/lib/starts').
:- use_module(library(lists), [member/2, numlist/3, subset/2]).
:- use_module(library(plunit)).

/** <module> The hosts where the agents of a mechanism start
*/

:- begin_tests(starts).

test(given_hosts_are_taken_in_turn, Starts == [b, a, b, a, b]) :-
    starts(5, [a, b, c], [starts([b, a])], Starts).
test(drawn_without_repetition_until_all_are_used,
     [ forall(member(Seed, [1, 2, 3])), First-Then == [a, b, c]-[a, b, c] ]) :-
    starts(8, [a, b, c], [seed(Seed)], [A, B, C, D, E, F|Rest]),
    msort([A, B, C], First),
    msort([D, E, F], Then),
    subset(Rest, [a, b, c]).
test(same_seed_same_hosts, Again == Starts) :-
    numlist(1, 50, Hosts),
    starts(10, Hosts, [seed(7)], Starts),
    starts(10, Hosts, [seed(7)], Again).
test(other_seed_other_hosts, true(Others \== Starts)) :-
    numlist(1, 50, Hosts),
    starts(10, Hosts, [seed(7)], Starts),
    starts(10, Hosts, [seed(8)], Others).
test(no_seed_other_hosts_each_time, true(Others \== Starts)) :-
    numlist(1, 500, Hosts),
    starts(10, Hosts, [], Starts),
    starts(10, Hosts, [], Others).
test(no_agent_needs_no_host, Starts == []) :-
    starts(0, [], [], Starts).
test(no_host, [ forall(member(Options, [[], [starts([])]])),
                error(domain_error(hosts, [])) ]) :-
    starts(1, [], Options, _).

:- end_tests(starts).
