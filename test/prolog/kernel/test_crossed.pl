:- module(test_crossed_modules, []).
:- use_module('../../lib/common').
:- use_module('../../lib/peers').
:- use_module(library(apply), [exclude/3]).
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon/language), []).

/** <module> The life of an agent without options needs no options

An agent is created, gets a message, hops to another process and back, and
ends.  Which modules of the kernel are called meanwhile varies: periodic work
of the platform's threads adds some.  None may be of another layer, but those
that read the program.

*Threading*: the main thread; the hosts are in other processes.
*/

:- begin_tests(crossed).

test(life_without_options_calls_the_kernel_and_the_language_alone) :-
    with_peers([a, b], later_life(Modules)),
    assertion(memberchk(typhon_agents, Modules)),
    exclude(of_layer, Modules, Others),
    assertion(Others == []).

:- end_tests(crossed).

of_layer(Module) :-
    module_property(Module, file(File)),
    member(Layer, [kernel, language]),
    atomic_list_concat(['/prolog/typhon/', Layer, /], Path),
    sub_atom(File, _, _, _, Path),
    !.

%   later_life(-Modules): the first life connects, and transfers the program.

later_life(Modules) :-
    life,
    peer_crossing(a),
    peer_crossing(b),
    crossed(Modules).

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
