:- module(test_bounds, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Tables that are bounded never have more facts

*Threading*: several threads add facts; another counts them meanwhile.
*/

%   table(?Setting, ?Module, -Goal, ?I): Goal adds fact I to a table of Module.

table(Setting, Module, Goal, I) :-
    member(t(Setting, Module, Goal),
           [ t(typhon_whereabouts:outcomes, typhon_whereabouts,
               typhon_endpoint:received(whereabouts, [ended(Id, done, 1)],
                                        '127.0.0.1:1')),
             t(typhon_outcomes:results, typhon_outcomes,
               typhon_outcomes:results_keep(Id, [result(I)])),
             t(typhon_outcomes:clones, typhon_outcomes,
               typhon_outcomes:clone_born(parent, Id)),
             t(typhon_whereabouts:endings, typhon_whereabouts,
               typhon_whereabouts:agent_ends(Id, 1)),
             t(typhon_whereabouts:forwards, typhon_whereabouts,
               typhon_whereabouts:agent_departed(Id, address, 2, here)),
             t(typhon_questions:met, typhon_questions,
               typhon_questions:agent_met(Id)) ]),
    freeze(I, format(atom(Id), 'x.~d@far@127.0.0.1:1', [I])).

%   All tables of a module have the same bound.

most(Module, Bound, Most) :-
    aggregate_all(count, table(_, Module, _, _), Tables),
    Most is Tables*Bound.

:- begin_tests(bounds).

test(tables_have_never_more_facts_than_their_bound,
     [ forall(( member(Bound, [50, 500]),
                member(Module, [ typhon_whereabouts, typhon_outcomes,
                                 typhon_questions ]),
                test_bounds:most(Module, Bound, Bounds) )),
       true(( Most =< Bounds, Last > Bounds-max(2, Bound//50) )) ]) :-
    with_bounds(Bound, with_hosts([alpha], filled(Module, Most, Last))).
test(lower_setting_holds_after_a_hundred_additions,
     [ forall(( member(Module, [ typhon_whereabouts, typhon_outcomes,
                                 typhon_questions ]),
                test_bounds:most(Module, 50, Bounds) )),
       true(Count =< Bounds) ]) :-
    with_hosts([alpha],
               ( with_bounds(5000, test_bounds:added(Module, 1, 1500)),
                 with_bounds(50, test_bounds:added(Module, 9001, 9101)),
                 state_size(Module, Count) )).

:- meta_predicate with_bounds(+, 0).

with_bounds(Bound, Goal) :-
    findall(Setting=Bound, test_bounds:table(Setting, _, _, _), Settings),
    with_settings(Settings, Goal).

filled(Module, Most, Last) :-
    findall(T, ( member(First, [1, 1001, 2001, 3001]),
                 Until is First+499,
                 thread_create(test_bounds:added(Module, First, Until), T) ),
            Ts),
    largest(Ts, Module, 0, Most),
    forall(member(T, Ts), thread_join(T, true)),
    state_size(Module, Last).

largest(Ts, Module, Most0, Most) :-
    state_size(Module, Count),
    Most1 is max(Most0, Count),
    (   member(T, Ts),
        thread_property(T, status(running))
    ->  largest(Ts, Module, Most1, Most)
    ;   Most = Most1
    ).

:- end_tests(bounds).

added(Module, First, Last) :-
    forall(( between(First, Last, I), table(_, Module, Goal, I) ), call(Goal)).
