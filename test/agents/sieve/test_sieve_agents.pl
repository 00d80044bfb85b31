:- module(test_sieve_agents, []).
:- use_module('../../lib/common', [project_file/2]).
:- use_module('../../lib/fake_agent').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_terms/3]).
:- use_module(library(typhon)).

/** <module> Guards and antibodies, one agent on a simulated host
*/

%   sieved(+Program, +Facts, +Tuples): with the five bits of the thesis.

sieved(Program, Facts, Tuples) :-
    project_file('payloads/sieve/bits.pl', File),
    read_file_to_terms(File, [(:- payload(_, _))|Bits], []),
    append(Facts, Bits, All),
    fake_agent(Program, All, Tuples).

antibody(Facts, Tuples) :-
    sieved('agents/sieve/antibody.pl',
           [ antibody([1,1,1,1,1]), gamma(1.2), memory([]), wins(1),
             shunned([]) | Facts ], Tuples).

guard(Facts) :-
    sieved('agents/sieve/guard.pl', Facts, []).

attack(Number, attack([0,0,0,0,0], here, Number)).

%   under_attack(+Facts, +Reply, -Acts): what the antibody does at a host under
%   attack whose guard answers Reply.

under_attack(Facts, Reply, Acts) :-
    attack(1, Attack),
    antibody(Facts, [attacked(Attack, g)]),
    fake_mail(g-reply(Attack, Reply)),
    fake_agent:attend,
    did(Acts).

state(Fact) :-
    call(fake_agent:Fact),
    !.

:- begin_tests(antibody).

test(offers_its_antibody, Acts == [send(g, offer(Attack, [1,1,1,1,1], 1.2, [],
                                                 1))]) :-
    attack(1, Attack),
    under_attack([expiry(inf)], redundant, Acts).
test(attack_that_did_not_need_it_is_ignored, Acts == []) :-
    attack(1, Attack),
    antibody([expiry(inf)], [attacked(Attack, g)]),
    fake_mail(g-reply(Attack, redundant)),
    fake_agent:attend,
    retractall(fake_host:did(_)),
    fake_agent:attend,
    did(Acts).
test(another_attack_of_the_antigen_is_not_ignored, To == g) :-
    attack(1, First),
    attack(2, Second),
    antibody([expiry(inf), shunned([First])], []),
    retractall(fake_agent:shunned([])),
    fake_host:leave(attacked(Second, g)),
    fake_agent:attend,
    did([send(To, _)|_]).
test(attack_that_it_cannot_answer_is_ignored, Acts == []) :-
    antibody([expiry(inf)], [attacked(attack([1,1,0,0,0], here, 1), g)]),
    fake_agent:attend,
    did(Acts).
test(affinity_at_the_threshold_is_enough, To == g) :-
    antibody([expiry(inf)], [attacked(attack([1,0,0,0,0], here, 1), g)]),
    fake_agent:attend,
    did([send(To, _)|_]).
test(outcome_is_kept, [Gamma, Memory, Wins] == [1.3, [a-20], 2]) :-
    under_attack([expiry(inf)], outcome(1.3, [a-20], 2, false), _),
    state(gamma(Gamma)),
    state(memory(Memory)),
    state(wins(Wins)).
test(appointed_agent_is_a_memory_cell, Expiry-Offered == never-0) :-
    under_attack([expiry(9)], outcome(1.3, [a-20], 2, true), Acts),
    memberchk(log(memory_cell([1,1,1,1,1])), Acts),
    state(expiry(Expiry)),
    attack(2, Attack),
    fake_agent:offer(Attack, offer(_, _, _, _, Offered)).
test(suppressed_agent_dies, throws(disposed)) :-
    under_attack([expiry(9)], outcome(0.4, [], 1, false), _).
test(memory_cell_is_not_suppressed, Gamma == 1.0) :-
    under_attack([expiry(never)], outcome(0.4, [], 0, false), _),
    state(gamma(Gamma)).
test(memory_cell_does_not_age) :-
    antibody([expiry(never)], []),
    fake_agent:age.
test(agent_without_expiry_does_not_age) :-
    antibody([expiry(inf)], []),
    fake_agent:age.
test(clone_dies_at_its_last_hop, throws(disposed)) :-
    antibody([expiry(3)], []),              % after three hops
    fake_agent:age.
test(clone_lives_until_its_last_hop) :-
    antibody([expiry(4)], []),
    fake_agent:age.
test(agent_that_has_cloned_itself_begins_again, Gamma-Wins == 1.0-2) :-
    under_attack([expiry(inf)], outcome(1.7, [a-20], 2, false), _),
    state(gamma(Gamma)),
    state(wins(Wins)).
test(clone_begins_with_the_knowledge_of_its_parent,
     [Gamma, Memory, Wins, Expiry] == [1.0, [a-20], 0, 203]) :-
    attack(1, Attack),
    antibody([expiry(inf), setting(omega, 200)], [attacked(Attack, g)]),
    fake_clone(clone(me)),
    fake_mail(g-reply(Attack, outcome(1.7, [a-20], 2, false))),
    fake_agent:attend,
    state(gamma(Gamma)),
    state(memory(Memory)),
    state(wins(Wins)),
    state(expiry(Expiry)).
test(host_may_refuse_the_clone, Acts == []) :-
    antibody([expiry(inf)], []),
    fake_clone(error(move_refused(here, capacity), _)),
    fake_agent:multiply,
    did(Acts).
test(strongest_signal_is_followed, Attack == b) :-
    antibody([expiry(inf)], []),
    fake_agent:strongest([3-a, 7-b, 5-c], Attack).

:- end_tests(antibody).

:- begin_tests(guard).

%   No antibody is drawn.

test(each_attack_has_its_own_signal, Signals == [First, Second]) :-
    attack(1, First),
    attack(2, Second),
    guard([setting(draws, 0)]),
    maplist(fake_mail, [u-attack([0,0,0,0,0]), u-attack([0,0,0,0,0])]),
    \+ fake_agent:main,
    did(Acts),
    findall(Signal, member(emit(Signal), Acts), Signals).
test(signal_is_withdrawn, Ends == [withdraw(Attack),
                                   log(unanswered([0,0,0,0,0]))]) :-
    attack(1, Attack),
    guard([setting(draws, 0)]),
    fake_mail(u-attack([0,0,0,0,0])),
    \+ fake_agent:main,
    did(Acts),
    append(_, Ends, Acts),
    Ends = [withdraw(_)|_],
    !,
    \+ fake_host:tuple(attacked(_, _)).
test(signal_is_emitted_as_often_as_is_set, Count-Time == 3-12) :-
    guard([setting(draws, 0), setting(calls, 3)]),
    fake_mail(u-attack([0,0,0,0,0])),
    \+ fake_agent:main,
    did(Acts),
    aggregate_all(count, member(emit(_), Acts), Count),
    fake_host:time(Time).
test(wins_that_make_a_memory_cell, Cells == [2-false, 3-true, 4-false]) :-
    guard([setting(memory_cells, 1), cells(0)]),
    findall(Wins-Cell, ( member(Wins, [2, 3, 4]),
                         fake_agent:appoint(Wins, Cell) ), Cells).
test(no_memory_cells_by_default, Cell == false) :-
    guard([cells(0)]),
    fake_agent:appoint(9, Cell).
test(application_need_not_define_similar, Gammas == [1.5, 0.5]) :-
    guard([]),
    abolish(fake_agent:similar/2),
    fake_agent:interaction(similar, a, 0.5-0.5,
                           [cell(1, 1.0, [a-31]), cell(2, 1.0, [a-30, b-9])],
                           Gammas).

:- end_tests(guard).
