:- module(test_whereabouts, []).
:- use_module('../../../lib/fixtures').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(prolog_wrap)).
:- use_module(library(random)).
:- use_module(library(typhon)).

/** <module> Where agents are, as far as a process knows

Reports come in any order; that of the latest hop holds.
*/

:- begin_tests(whereabouts).

test(latest_hop_holds,
     [forall(member(Home, [here, far])), Wrong == []]) :-
    with_hosts([alpha],
               ( findall(Order-Address,
                         ( between(1, 50, _), wrong(Home, Order, Address) ),
                         Wrong) )).

%   wrong(+Home, -Order, -Address): reports of an agent of Home in this order
%   led to Address, which is not that of its latest hop.

wrong(Home, Order, Address) :-
    agent_of(Home, Id),
    random_permutation([1,2,3,4,5,6], Order),
    ( Home == here -> typhon_whereabouts:agent_born(Id, 'x@y:1') ; true ),
    forall(member(Hops, Order), reported(Home, Id, Hops)),
    typhon_whereabouts:whereabouts(Id, Address),
    aggregate_all(count, typhon_whereabouts:agent_location(Id, _, _, _), N),
    typhon_identity:id_anew(Id),
    N-Address \== 1-'6@y:1'.

reported(Home, Id, Hops) :-
    atom_concat(Hops, '@y:1', Address),
    (   Home == here,
        maybe
    ->  typhon_whereabouts:home_moved(Id, Address, Hops, unknown)
    ;   typhon_whereabouts:agent_departed(Id, Address, Hops, unknown)
    ).

test(home_that_was_restarted_learns_where_its_agents_are,
     [ forall(member(By, [home_moved, agent_departed])), Address == '2@y:1' ]) :-
    with_hosts([alpha],
               ( agent_of(here, Id),
                 call(typhon_whereabouts:By, Id, '2@y:1', 2, unknown),
                 typhon_whereabouts:home_knows(Id, Address, 2, unknown),
                 typhon_identity:id_anew(Id) )).
test(news_of_an_agent_of_another_home_is_ignored) :-
    with_hosts([alpha],
               ( agent_of(far, Id),
                 typhon_whereabouts:home_moved(Id, '2@y:1', 2, unknown),
                 \+ typhon_whereabouts:agent_location(Id, _, _, _) )).
test(departure_before_the_end_is_no_location) :-
    with_hosts([alpha],
               ( agent_of(here, Id),
                 typhon_whereabouts:home_ended(Id, done, 3, []),
                 typhon_whereabouts:agent_departed(Id, '3@y:1', 3, unknown),
                 \+ typhon_whereabouts:agent_location(Id, _, _, _),
                 typhon_whereabouts:agent_departed(Id, '4@y:1', 4, unknown),
                 typhon_whereabouts:whereabouts(Id, '4@y:1'),
                 typhon_identity:id_anew(Id) )).
test(agent_that_came_home_and_ended_does_not_come_again) :-
    with_hosts([alpha],
               ( agent_of(here, Id),
                 typhon_whereabouts:agent_born(Id, '1@y:1'),
                 typhon_whereabouts:agent_ends(Id, 2),
                 \+ typhon_whereabouts:hop_is_new(Id, 2, _),
                 typhon_whereabouts:hop_is_new(Id, 3, here),
                 typhon_identity:id_anew(Id) )).
test(agent_is_known_while_its_end_is_recorded, Anew == none) :-
    with_hosts([alpha],
               ( agent_of(here, Id),
                 typhon_whereabouts:agent_born(Id, '1@y:1'),
                 typhon_whereabouts:agent_departed(Id, '2@y:1', 1, unknown),
                 nb_setval(anew, unseen),
                 setup_call_cleanup(
                     wrap_predicate(typhon_outcomes:results_keep(Ended, _), noted,
                                    W, ( W, test_whereabouts:note_anew(Ended) )),
                     typhon_whereabouts:home_ended(Id, done, 2, [result(1)]),
                     unwrap_predicate(typhon_outcomes:results_keep/2, noted)),
                 nb_getval(anew, Anew),
                 typhon_identity:id_anew(Id) )).

agent_of(here, Id) :-
    host_property(alpha, address(Address)),
    agent_of_home(Address, Id).
agent_of(far, Id) :-
    agent_of_home('far@y:1', Id).

agent_of_home(Address, Id) :-
    random_between(1, 1 000 000 000, N),
    atomic_list_concat([x, ., N, '.0@', Address], Id).

:- end_tests(whereabouts).

note_anew(Id) :-
    (   typhon_whereabouts:hop_is_new(Id, 1, _)
    ->  nb_setval(anew, Id)
    ;   nb_setval(anew, none)
    ).
