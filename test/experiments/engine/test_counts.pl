:- module(test_counts, []).
:- use_module('../../lib/common').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [append/3]).
:- use_module(library(plunit)).

/** <module> Hops, messages and memory of runs, counted
*/

:- begin_tests(counts).

counts(Hosts, Out) :-
    project_file('experiments/counts.pl', Script),
    atom_concat('hosts=', Hosts, Set),
    run_swipl([ Script, '--', '5.5', '--set', 'topology=ring', '--set', Set,
                '--set', 'agents=2', '--set', 'tasks=2', '--runs', '1',
                '--every', '1' ], [], exit(0), Out, _).

%   Each host has one order for each task, and one worker.

test(hops_messages_and_memory) :-
    counts(6, Out),
    sub_string(Out, _, _, _, ", 12 messages, "),
    \+ sub_string(Out, _, _, _, " 0 hops"),
    sub_string(Out, _, _, _, " agents 2 "),
    sub_string(Out, _, _, _, " static 6 ").

%   An agent remembers each host that it has visited; the memory of a host does
%   not depend on the number of hosts.

test(memory_grows_with_hosts) :-
    counts(6, Few),
    counts(24, Many),
    peak(agent_most, Few, AgentFew),
    peak(agent_most, Many, AgentMany),
    assertion(AgentFew < AgentMany),
    peak(host_most, Few, HostFew),
    peak(host_most, Many, HostMany),
    assertion(HostFew > 0),
    assertion(HostFew == HostMany).

peak(Name, Text, Bytes) :-
    split_string(Text, " \n", " ", Words),
    atom_string(Name, Word),
    append(_, [Word, Digits0|_], Words),
    !,
    split_string(Digits0, ",", "", Groups),
    atomic_list_concat(Groups, Digits),
    atom_number(Digits, Bytes).

:- end_tests(counts).
