:- module(test_bounds, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).

/** <module> Tables that are bounded never have more facts

*Threading*: several threads add facts; another counts them meanwhile.
*/

%   Facts of each table, and a goal that adds one with the number I.

table(Setting, Fact, I, Goal) :-
    member(t(Setting, Fact, Goal),
           [ t(typhon_whereabouts:outcomes, typhon_home:outcome(_, _, _),
               typhon_home:home_ended(Id, done, 1, [])),
             t(typhon_outcomes:results, typhon_outcomes:left(_, _),
               typhon_outcomes:results_keep(Id, [result(I)])),
             t(typhon_outcomes:clones, typhon_outcomes:clone_of(_, _),
               typhon_outcomes:clone_born(parent, Id)),
             t(typhon_whereabouts:endings, typhon_whereabouts:ended_here(_, _),
               typhon_whereabouts:agent_ends(Id, 1)),
             t(typhon_whereabouts:forwards,
               typhon_whereabouts:forward(_, _, _, _),
               typhon_whereabouts:remember_forward(Id, address, 1, here)),
             t(typhon_questions:met, typhon_questions:met(_, _),
               typhon_questions:agent_met(Id)) ]),
    freeze(I, atom_concat('x.', I, Id)).

:- begin_tests(bounds).

test(table_has_never_more_facts_than_its_bound,
     [ forall(( member(Bound, [50, 500]),
                test_bounds:table(Setting, _, _, _) )),
       true(( Most =< Bound, Last > Bound-max(1, Bound//100) )) ]) :-
    with_settings([Setting=Bound],
                  with_hosts([alpha], filled(Setting, Most, Last))).

test(lower_setting_holds_after_a_hundred_additions,
     [ forall(test_bounds:table(Setting, _, _, _)), true(Count =< 50) ]) :-
    with_hosts([alpha],
               ( with_settings([Setting=5000],
                               forall(member(Part, [0, 1000, 2000]),
                                      test_bounds:added(Setting, Part))),
                 with_settings([Setting=50],
                               forall(between(9001, 9101, I),
                                      test_bounds:added_one(Setting, I))),
                 test_bounds:count(Setting, Count) )).

filled(Setting, Most, Last) :-
    findall(T, ( member(Part, [0, 1000, 2000, 3000]),
                 thread_create(test_bounds:added(Setting, Part), T) ), Ts),
    most(Ts, Setting, 0, Most),
    forall(member(T, Ts), thread_join(T, true)),
    test_bounds:count(Setting, Last).

most(Ts, Setting, Most0, Most) :-
    test_bounds:count(Setting, Count),
    Most1 is max(Most0, Count),
    (   member(T, Ts),
        thread_property(T, status(running))
    ->  most(Ts, Setting, Most1, Most)
    ;   Most = Most1
    ).

:- end_tests(bounds).

added(Setting, Part) :-
    forall(between(1, 500, K),
           ( I is Part+K, added_one(Setting, I) )).

added_one(Setting, I) :-
    once(table(Setting, _, I, Goal)),
    call(Goal).

count(Setting, Count) :-
    once(table(Setting, Fact, _, _)),
    predicate_property(Fact, number_of_clauses(Count)).
