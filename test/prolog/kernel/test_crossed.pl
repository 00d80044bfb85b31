:- module(test_crossed_modules, []).
:- use_module('../../lib/common').
:- use_module('../../lib/peers').
:- use_module(library(lists), [append/3]).
:- use_module(library(plunit)).

/** <module> The number of modules that an agent's life calls without options

An agent is created, gets a message, hops to another process and back, and
ends.  The modules called meanwhile in either process are counted. Periodic
work of the platform's threads can only add modules, so the smallest number of
several lives counts. The bound is the measured number: it is lowered as
modules are merged.

*Threading*: the main thread; the hosts are in other processes.
*/

:- begin_tests(crossed).

test(modules_of_an_agent_life) :-
    with_peers([a, b], fewest(15, Modules)),
    assertion(no_more_than(59, Modules)).

:- end_tests(crossed).

no_more_than(Bound, Modules) :-
    length(Modules, Count),
    Count =< Bound.

%   fewest(+Lives, -Modules): the first life connects, and transfers the
%   program.

fewest(Lives, Modules) :-
    life,
    peer_crossing(a),
    peer_crossing(b),
    findall(Count-Crossed,
            ( between(1, Lives, _),
              crossed(Crossed),
              length(Crossed, Count) ),
            All),
    keysort(All, [_-Modules|_]).

crossed(Modules) :-
    peer_do(a, test_crossed:called_modules(_)),
    peer_do(b, test_crossed:called_modules(_)),
    life,
    peer_do(a, test_crossed:called_modules(A)),
    peer_do(b, test_crossed:called_modules(B)),
    append(A, B, Both),
    sort(Both, Modules).

peer_crossing(Peer) :-
    project_file('test/lib/crossed.pl', File),
    peer_do(Peer, use_module(File, [])),
    peer_do(Peer, test_crossed:calls_record).

life :-
    peer_host(b, B),
    plain(Clauses),
    peer_do(a, agent_create(clauses(Clauses), Id,
                            [host(a), facts([to(B)])])),
    peer_do(a, agent_send(Id, go)),
    peer_do(a, agent_join(Id, Outcome, 10)),
    assertion(Outcome == done).

plain([ (:- agent(plain, [state([to/1])])),
        (main :- receive(_-go), to(B), here(A), move(B), move(A)) ]).
