:- module(test_sieve_agents, []).
:- use_module('../../lib/common', [project_file/2]).
:- use_module('../../lib/fake_agent').
:- use_module(library(lists), [append/3, member/2, memberchk/2]).
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

attack(Number, attack([0,0,0,0,0], here, Number)).

%   antibody(Name, Facts, Reply, Checks): what an antibody does at a host under
%   attack whose guard answers Reply; acts(Name, Facts, Before, Goal, Checks):
%   what it does elsewhere. See fake_run/4.

antibody(offers_its_antibody, [expiry(inf)], redundant,
         [did=[send(g, offer(Attack, [1,1,1,1,1], 1.2, [], 1))]]) :-
    attack(1, Attack).
antibody(outcome_is_kept, [expiry(inf)], outcome(1.3, [a-20], 2, false),
         [gamma=1.3, memory=[a-20], wins=2]).
antibody(appointed_agent_is_a_memory_cell, [expiry(9)],
         outcome(1.3, [a-20], 2, true),
         [ fake_host:did(log(memory_cell([1,1,1,1,1]))), expiry=never,
           ( offer(Attack, offer(_, _, _, _, Wins)), Wins == 0 ) ]) :-
    attack(2, Attack).
antibody(suppressed_agent_dies, [expiry(9)], outcome(0.4, [], 1, false),
         [end=disposed]).
antibody(memory_cell_is_not_suppressed, [expiry(never)],
         outcome(0.4, [], 0, false), [gamma=1.0]).
antibody(agent_that_has_cloned_itself_begins_again, [expiry(inf)],
         outcome(1.7, [a-20], 2, false), [gamma=1.0, wins=2]).

acts(attack_that_did_not_need_it_is_ignored, [expiry(inf)],
     [ fake_host:leave(attacked(Attack, g)),
       fake_mail(g-reply(Attack, redundant)) ],
     ( attend, retractall(fake_host:did(_)), attend ), [did=[]]) :-
    attack(1, Attack).
acts(another_attack_of_the_antigen_is_not_ignored,
     [expiry(inf), shunned([First])], [fake_host:leave(attacked(Second, g))],
     attend, [did=[send(g, _)|_]]) :-
    attack(1, First),
    attack(2, Second).
acts(affinity_decides_on_an_answer, [expiry(inf)],
     [fake_host:leave(attacked(attack(Antigen, here, 1), g))], attend,
     [did=Acts]) :-
    member(Antigen-Acts, [ [1,0,0,0,0]-[send(g, _)|_], % at the threshold
                           [1,1,0,0,0]-[] ]).
acts(clones_alone_age, [expiry(Expiry)], [], age, [end=End]) :-
    member(Expiry-End, [ never-true, inf-true, 4-true,
                         3-disposed ]). % after three hops
acts(clone_begins_with_the_knowledge_of_its_parent,
     [expiry(inf), setting(omega, 200)],
     [ fake_host:leave(attacked(Attack, g)), fake_clone(clone(me)),
       fake_mail(g-reply(Attack, outcome(1.7, [a-20], 2, false))) ], attend,
     [gamma=1.0, memory=[a-20], wins=0, expiry=203]) :-
    attack(1, Attack).
acts(host_may_refuse_the_clone, [expiry(inf)],
     [fake_clone(error(move_refused(here, capacity), _))], multiply, [did=[]]).
acts(strongest_signal_is_followed, [expiry(inf)], [],
     strongest([3-a, 7-b, 5-c], Attack), [Attack == b]).

:- begin_tests(antibody).

test(antibody_acts, [ forall(( acts(_, Facts, Before, Goal, Checks)
                             ; antibody(_, Facts, Reply, Checks),
                               attack(1, Attack),
                               Before = [ fake_host:leave(attacked(Attack, g)),
                                          fake_mail(g-reply(Attack, Reply)) ],
                               Goal = attend )),
                      Wrong == [] ]) :-
    sieved('agents/sieve/antibody.pl',
           [ antibody([1,1,1,1,1]), gamma(1.2), memory([]), wins(1) | Facts ],
           []),
    ( memberchk(shunned(_), Facts) -> true ; fake_fact(shunned([])) ),
    fake_run(Before, Goal, Checks, Wrong).

:- end_tests(antibody).

%   guards(Name, Facts, Attacks, Goal, Checks): no antibody is drawn.

guards(each_attack_has_its_own_signal, [], 2, main,
       [ end=fail, ( findall(S, fake_host:did(emit(S)), Signals),
                     Signals == [First, Second] ) ]) :-
    attack(1, First),
    attack(2, Second).
guards(signal_is_withdrawn, [], 1, main,
       [ end=fail, ( findall(Act, fake_host:did(Act), Acts),
                     append(_, [withdraw(Attack), Last], Acts),
                     Last == log(unanswered([0,0,0,0,0])) ),
         \+ sense(attacked(_, _)) ]) :-
    attack(1, Attack).
guards(signal_is_emitted_as_often_as_is_set, [setting(calls, 3)], 1, main,
       [ end=fail, time=12,
         ( aggregate_all(count, fake_host:did(emit(_)), Count), Count == 3 ) ]).
guards(wins_that_make_a_memory_cell, [setting(memory_cells, 1), cells(0)], 0,
       findall(Wins-Cell, ( member(Wins, [2, 3, 4]), appoint(Wins, Cell) ),
               Cells), [Cells == [2-false, 3-true, 4-false]]).
guards(no_memory_cells_by_default, [cells(0)], 0, appoint(9, Cell),
       [Cell == false]).
guards(application_need_not_define_similar, [], 0,
       ( abolish(fake_agent:similar/2),
         interaction(similar, a, 0.5-0.5,
                     [cell(1, 1.0, [a-31]), cell(2, 1.0, [a-30, b-9])],
                     Gammas) ), [Gammas == [1.5, 0.5]]).

:- begin_tests(guard).

test(guard_acts, [ forall(guards(_, Facts, Attacks, Goal, Checks)),
                   Wrong == [] ]) :-
    sieved('agents/sieve/guard.pl', [setting(draws, 0)|Facts], []),
    findall(fake_mail(u-attack([0,0,0,0,0])), between(1, Attacks, _), Before),
    fake_run(Before, Goal, Checks, Wrong).

:- end_tests(guard).
