:- module(test_auction, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fake_agent').
:- use_module('../../lib/fake_node').
:- use_module(library(aggregate)).
:- use_module(library(lists)).
:- use_module(library(plunit)).

/** <module> Murdoch and ANTA, one node at a time

Floods, and the tree of ANTA. Bids and awards: see test_auction_sides.
*/

                /*******************************
                *             FLOOD            *
                *******************************/

%   floods(Name, Steps), and trades(Name, Steps): see failing_step/2.

floods(message_is_forwarded_once_and_not_back,
     [ node(murdoch, []), link(a, 0, flood(77, start(x))),
       bodies([b-start(x), c-start(x)]), link(b, 0, flood(77, start(x))),
       link(a, 0, flood(77, start(x))), bodies([]), fact(sent(start, 2)) ]).
floods(own_flood_goes_to_all_and_does_not_return,
     [ node(murdoch, []), fake_agent:flood(start(x)),
       sent([a-flood(Id, _), b-flood(Id, _), c-flood(Id, _)]),
       link(b, 0, flood(Id, start(x))), bodies([]), fact(sent(start, 3)) ]).
floods(message_waits_until_it_is_due,
     [ node(murdoch, []), link(a, 3, flood(77, start(x))), at(2.9), bodies([]),
       at(3), bodies([b-_, c-_]) ]).
floods(messages_are_delivered_in_order_of_due_time,
     [ node(murdoch, []), link(a, 3, flood(77, start(x))),
       link(b, 2, flood(77, start(x))), at(1.9), bodies([]), at(2),
       bodies([c-start(x)]), at(5), bodies([]) ]).
floods(duplicate_from_both_ends_of_a_link_is_counted_but_not_sent,
     [ node(murdoch, []), link(a, 3, flood(77, start(x))),
       link(b, 2, flood(77, start(x))), link(c, 4, flood(77, start(x))), at(5),
       bodies([]), fact(sent(start, 2)) ]).
floods(link_delay_equals_hop_time,
     [ node(murdoch, [setting(hop_time, uniform(0.5, 1.5))]), at(10),
       forall(between(1, 20, _), fake_agent:flood(start(x))),
       findall(Due, retract(fake_host:did(send(_, link(Due, _, _)))), Dues),
       length(Dues, 60),
       forall(member(Due, Dues), ( Due >= 10.5, Due =< 11.5 )) ]).
floods(processor_delay_does_not_accumulate,
     [ node(murdoch, [setting(hop_time, uniform(1, 1))]), at(10),
       link(a, 3, flood(77, start(x))),
       findall(Due, retract(fake_host:did(send(_, link(Due, _, _)))), Dues),
       sort(Dues, [Due]), Due =:= 4 ]).
floods(host_without_a_node_gets_nothing,
     [ node(murdoch, []), receives(peers([a-na, c-nc]), user),
       fake_agent:flood(start(x)), bodies([a-_, c-_]), fact(sent(start, 2)) ]).
floods(stopped_host_is_forgotten,
     [ node(murdoch, [gone(nb)]), fake_agent:flood(start(x)),
       bodies([a-_, c-_]), \+ fact(peer(b, _)), fact(sent(start, 3)),
       fake_agent:flood(start(y)), fact(sent(start, 5)) ]).
floods(messages_over_one_channel_wait_for_each_other,
     [ one_by_one, at(10), link(a, 10, flood(77, start(x))),
       link(b, 10, flood(78, start(x))), dues([11, 12, 13, 14]) ]).
floods(suppressed_duplicate_occupies_the_channel,
     [ one_by_one, at(5), link(a, 10, flood(77, start(x))),
       link(b, 11, flood(77, start(x))), at(10),
       link(a, 10, flood(78, start(x))), dues([11, 13, 14]) ]).
floods(known_floods_are_bounded,
     [ node(murdoch, [setting(memory, 3)]),
       forall(between(1, 50, I), link(a, 0, flood(I, start(x)))),
       aggregate_all(count, fake_agent:wave(_, _, _), Count), Count == 3 ]).
floods(counts_are_logged_once,
     [ node(murdoch, []), fake_agent:flood(start(x)), receives(account, user),
       receives(account, user), logged([communications(start, 3)]) ]).

one_by_one :-
    node(murdoch, [ setting(hop_time, uniform(2, 2)),
                    setting(sending, one_by_one(0.5)) ]).

%   dues(-Dues): when the messages that were sent are due.

dues(Dues) :-
    findall(Due, ( retract(fake_host:did(send(_, link(Due0, _, _)))),
                   Due is integer(Due0) ),
            Dues).

:- begin_tests(auction_flood).

test(flood, [forall(floods(_, Steps)), Failing == none]) :-
    failing_step(Steps, Failing).

:- end_tests(auction_flood).

                /*******************************
                *             ANTA             *
                *******************************/

%   In a tree of four levels, at level 2: reports at 10*(8-2)/8 = 7.5.

trade(announce(Job, 1, Offer, 0, 2)) :-
    announced([], 1, announce(Job, 1, Offer)).

planted(Job) :-
    planted([], Job).

planted(Facts, Job) :-
    job(Job),
    node(anta, [setting(level, 4)|Facts]),
    trade(Trade),
    link(a, 0, flood(77, Trade)).

from_child(Child, List) :-
    job(Job),
    link(Child, 0, only(owner(Job, bids(1, List)))).

trades(levels_are_counted,
     [ planted(_), bodies(Bodies), memberchk(b-announce(_, _, _, 0, 3), Bodies),
       memberchk(c-announce(_, _, _, 0, 3), Bodies),
       \+ memberchk(a-_, Bodies) ]).
trades(last_level_forwards_nothing,
     [ node(anta, [setting(level, 2)]), trade(Trade),
       link(a, 0, flood(77, Trade)), bodies([robot-_]) ]).
trades(bids_are_merged_and_go_to_the_parent_at_their_time,
     [ planted(Job), receives(answer(ref(Job, 1, 1), bid(7)), robot),
       from_child(b, [x-[1-3], y-[1-9]]), from_child(c, [z-[1-1]]), sent(_),
       at(7.4), sent([]), at(7.5), sent([a-only(owner(Job, bids(1, List)))]),
       msort(List, [x-[1-3], z-[1-1]]) ]). % two are needed
trades(late_bids_are_forwarded_at_once,
     [ planted(Job), at(7.5), sent(_), from_child(b, [x-[1-3]]),
       sent([a-only(owner(Job, bids(1, [x-[1-3]])))]) ]).
trades(no_bids_no_report,
     [planted(_), sent(_), at(9), sent([])]).
trades(without_a_parent_bids_are_flooded,
     [ planted(Job), from_child(b, [x-[1-3]]), sent(_), fake_neighbours([b, c]),
       at(7.5), sent([b-flood(Id, Body), c-flood(Id, Body)]),
       Body == flooded(owner(Job, bids(1, [x-[1-3]]))), fact(sent(bid, 2)) ]).
trades(with_no_node_at_the_parent_bids_are_flooded,
     [ planted([gone(na)], _), from_child(b, [x-[1-3]]), sent(_), at(7.5),
       sent([b-flood(Id, Body), c-flood(Id, Body)]) ]).
trades(awards_are_split_on_the_way_down,
     [ planted(Job), receives(answer(ref(Job, 1, 1), bid(7)), robot),
       from_child(b, [x-[1-3], y-[1-9]]), from_child(c, [z-[1-1]]), at(8),
       sent(_), Award = award(Job, 1, [here-1, x-1, y-1, z-1]),
       link(a, 0, only(robots(Job, [here, x, y, z], Award))), sent(Sent),
       memberchk(robot-reserve(_, boss, _), Sent),
       memberchk(b-only(robots(Job, [x, y], Award)), Sent),
       memberchk(c-only(robots(Job, [z], Award)), Sent), length(Sent, 3),
       fact(sent(award, 2)) ]).
trades(without_a_child_an_award_is_flooded,
     [ planted(Job), from_child(b, [x-[1-3]]), at(8), sent(_),
       fake_neighbours([a, c]),
       link(a, 0, only(robots(Job, [x], award(Job, 1, [x-1])))),
       sent([a-flood(Id, Body), c-flood(Id, Body)]),
       Body == flooded(robots(Job, [x], award(Job, 1, [x-1]))) ]).
trades(a_flooded_award_concerns_its_recipients_only,
     [ planted(Job), receives(answer(ref(Job, 1, 1), bid(7)), robot), sent(_),
       Award = award(Job, 1, [here-1, x-1]),
       link(c, 0, flood(88, flooded(robots(Job, [x], Award)))),
       sends_no(robot-_),
       link(c, 0, flood(89, flooded(robots(Job, [here], Award)))),
       sends(robot-reserve(_, _, _)) ]).
trades(answers_go_up_the_tree,
     [ planted(Job), sent(_),
       link(b, 0, only(owner(Job, report(1, x, reserved)))),
       sent([a-only(owner(Job, report(1, x, reserved)))]),
       fact(sent(ack, 1)) ]).
trades(root_accepts_flooded_messages_and_floods_its_answer,
     [ node(anta, [setting(window, 10), setting(level, 4)]),
       receives(post(task(t, [1-[push]], [])), user),
       fact(job(Job, _, _, _, _, _)), sent(_),
       link(b, 0, only(owner(Job, bids(1, [x-[1-3]])))),
       link(c, 0, flood(90, flooded(owner(Job, bids(1, [y-[1-1]]))))),
       bodies([a-_, b-_]),              % the flood is forwarded all the same
       at(10), bodies(Bodies), Award = award(Job, 1, [y-1]),
       findall(To, member(To-flooded(robots(Job, [y], Award)), Bodies),
               [a, b, c]) ]).
trades(trees_are_bounded,
     [ node(anta, [setting(jobs, 3), setting(level, 4)]), offer([], Offer),
       forall(between(1, 20, I),
              ( link(a, 0, flood(I, announce(job(owner, I), 1, Offer, 0, 2))),
                link(b, 0, only(owner(job(owner, I), bids(1, [x-[1-3]])))) )),
       aggregate_all(count, fake_agent:tree(_, _, _), Count), Count == 3,
       aggregate_all(count, fake_agent:way(_, _, _), Ways), Ways =< 3 ]).

:- begin_tests(auction_anta).

test(trade, [forall(trades(_, Steps)), Failing == none]) :-
    failing_step(Steps, Failing).

:- end_tests(auction_anta).
