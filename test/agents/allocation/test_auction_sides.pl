:- module(test_auction_sides, []).
:- use_module('../../lib/common').
:- use_module('../../lib/fake_agent').
:- use_module('../../lib/fake_node').
:- use_module(library(lists)).
:- use_module(library(plunit)).

/** <module> The two sides of an auction, one node at a time

Contractors of robots and auctioneers of tasks, on a node of Murdoch.
*/

                /*******************************
                *          CONTRACTOR          *
                *******************************/

%   A node of Murdoch that has bid, that has won, that has reserved its robot.

bidder(Facts, Job) :-
    node(murdoch, Facts),
    announced([], 1, Announce),
    link(a, 0, flood(77, Announce)),
    job(Job),
    receives(answer(ref(Job, 1, 1), bid(7)), robot).

winner(Facts, Job) :-
    bidder(Facts, Job),
    link(a, 0, flood(78, award(Job, 1, [here-1, x-1]))).

reserved(Facts, Job) :-
    winner(Facts, Job),
    receives(answer(ref(Job, 1, 1), reserved), robot),
    sent(_).

other_auction(Details) :-
    offer(Details, Offer),
    link(b, 0, flood(90, announce(job(other, 5), 1, Offer))).

%   contracts(Name, Steps): of a contractor; awards/2 are of an auctioneer.

contracts(contractor_queries_its_robot_and_bids,
     [ bidder([], Job), bodies(Bodies),
       memberchk(robot-ask(ref(Job, 1, 1), need(t, [push], [])), Bodies),
       findall(To, member(To-owner(Job, bids(1, [here-[1-7]])), Bodies),
               [a, b, c]) ]).
contracts(refusing_robot_does_not_bid,
     [ node(murdoch, []), announced([], 1, Announce),
       link(a, 0, flood(77, Announce)), sent(_), job(Job),
       receives(answer(ref(Job, 1, 1), refused(unfit)), robot), sent([]),
       \+ fact(hold(_, _, _, _)) ]).
contracts(bids_for_one_auction_at_a_time,
     [bidder([], _), sent(_), other_auction([]), sends_no(robot-_)]).
contracts(more_urgent_auction_is_preferred,
     [ bidder([], _), sent(_), other_auction([priority(2)]),
       sends(robot-ask(ref(job(other, 5), 1, 1), _)), job(Job),
       link(a, 0, flood(78, award(Job, 1, [here-1]))),
       says(a-owner(Job, report(1, here, refused))) ]).
contracts(bids_again_after_a_lost_auction,
     [ bidder([], Job), link(a, 0, flood(78, award(Job, 1, [x-1, y-1]))),
       sent(_), other_auction([]), sends(robot-ask(_, _)) ]).
contracts(bids_again_after_the_timeout,
     [ bidder([setting(answer, 5)], _), sent(_), at(15), % closed at 10
       other_auction([]), sends(robot-ask(_, _)) ]).
contracts(winner_reserves_its_robot,
     [ winner([], Job),
       says(robot-reserve(ref(Job, 1, 1), boss, need(t, [push], []))),
       receives(answer(ref(Job, 1, 1), reserved), robot),
       says(b-owner(Job, report(1, here, reserved))) ]).
contracts(winner_with_a_reserved_robot_refuses,
     [ winner([], Job), sent(_),
       receives(answer(ref(Job, 1, 1), refused(reserved)), robot),
       says(a-owner(Job, report(1, here, refused))),
       \+ fact(contract(_, _, _, _, _, _)) ]).
contracts(executes_and_reports,
     [ reserved([], Job), link(a, 0, flood(79, start(Job))),
       says(robot-start(ref(Job, 1, 1), sleep(5))),
       link(b, 0, flood(80, start(Job))), sends_no(robot-start(_, _)),
       receives(done(ref(Job, 1, 1)), robot),
       says(a-owner(Job, report(1, here, done))) ]).
contracts(releases_its_robot_once,
     [ reserved([], Job), link(a, 0, flood(79, release(Job, 1, all))),
       sends(robot-release(ref(Job, 1, 1))),
       link(a, 0, flood(80, release(Job, 1, all))),
       sends_no(robot-release(_)) ]).
contracts(release_of_others_is_ignored,
     [ reserved([], Job), link(a, 0, flood(79, release(Job, 1, [x, y]))),
       sends_no(robot-release(_)) ]).
contracts(award_after_the_release_is_void,
     [ bidder([], Job), link(a, 0, flood(79, release(Job, 1, all))),
       link(a, 0, flood(78, award(Job, 1, [here-1]))),
       sends_no(robot-reserve(_, _, _)) ]).
contracts(a_late_release_does_not_end_the_next_round,
     [ bidder([], Job), announced([], 2, Announce),
       fake_agent:retractall(hold(_, _, _, _)), link(a, 0, flood(80, Announce)),
       receives(answer(ref(Job, 2, 1), bid(7)), robot),
       link(a, 0, flood(81, award(Job, 2, [here-1]))),
       receives(answer(ref(Job, 2, 1), reserved), robot), sent(_),
       link(a, 0, flood(82, release(Job, 1, all))),
       sends_no(robot-release(_)) ]).
contracts(a_contract_that_is_not_renewed_lapses,
     [ reserved([setting(contract, 60)], Job), at(59), sent([]), at(60),
       sends(robot-release(ref(Job, 1, 1))),
       \+ fact(contract(_, _, _, _, _, _)) ]).
contracts(renewed_contract_does_not_lapse,
     [ reserved([setting(contract, 60)], Job), at(50),
       link(a, 50, flood(79, renew(Job, reserved))),
       says(a-owner(Job, report(1, here, reserved))), at(109), sent([]),
       at(110), sends(robot-release(_)) ]).
contracts(missed_start_is_repeated_by_a_renewal,
     [ reserved([], Job), link(a, 0, flood(79, renew(Job, executing))),
       bodies(Bodies), memberchk(robot-start(_, _), Bodies),
       memberchk(a-owner(Job, report(1, here, executing)), Bodies) ]).
contracts(a_lost_robot_is_reported,
     [ reserved([], Job), receives(lost(ref(Job, 1, 1), preempted), robot),
       says(a-owner(Job, report(1, here, lost(preempted)))) ]).
contracts(robot_learns_whether_it_is_still_needed,
     [ reserved([], Job), receives(still(ref(Job, 1, 1)), robot),
       receives(still(ref(other, 1, 1)), robot), sent(Sent),
       Sent == [robot-yes(ref(Job, 1, 1)), robot-no(ref(other, 1, 1))] ]).

:- begin_tests(auction_contractor).

test(contractor, [forall(contracts(_, Steps)), Failing == none]) :-
    failing_step(Steps, Failing).

:- end_tests(auction_contractor).

                /*******************************
                *          AUCTIONEER          *
                *******************************/

%   An auctioneer that needs two robots; its bidders are x, y and z.

auctioneer(Facts, Job) :-
    node(murdoch, [setting(window, 10), setting(answer, 10)|Facts]),
    receives(post(task(t, [2-[push]], [])), user),
    fact(job(Job, _, 1, bidding, 0, 0)).

bid(Job, Round, Host, Cost) :-
    deliver(Job, bids(Round, [Host-[1-Cost]])).

deliver(Job, Body) :-
    flag(test_auction, N, N+1),
    Id is 1000 + N,
    link(a, 0, flood(Id, owner(Job, Body))).

report(Job, Round, Host, Phase) :-
    deliver(Job, report(Round, Host, Phase)).

award(Job) :-
    bid(Job, 1, x, 5), bid(Job, 1, y, 3), bid(Job, 1, z, 4),
    sent(_),
    at(10).

executing(Job) :-
    award(Job),
    report(Job, 1, y, reserved),
    report(Job, 1, z, reserved),
    sent(_).

silent :-
    bodies(Bodies),
    \+ ( member(_-Body, Bodies), Body \= owner(_, _) ).

%   Each round gets one bid, which is too few.

node_backs_off(0, _, []) :-
    !.
node_backs_off(N, Job, [Interval|Intervals]) :-
    fact(job(Job, _, Round, bidding, _, _)),
    bid(Job, Round, x, 5),
    logged(_),
    pass(11),
    logged(Logged),
    memberchk(backoff(Interval), Logged),
    pass(Interval),
    N1 is N - 1,
    node_backs_off(N1, Job, Intervals).

pass(Seconds) :-
    fake_host:time(Now),
    Time is Now + Seconds,
    at(Time).

awards(first_hosts_by_name_win_at_equal_costs,
     [ auctioneer([], Job), bid(Job, 1, z, 3), bid(Job, 1, y, 3),
       bid(Job, 1, x, 3), sent(_), at(10),
       says(a-award(Job, 1, [x-1, y-1])) ]).
awards(announces_to_all,
     [ auctioneer([], Job), bodies(Bodies),
       subtract(Bodies, [robot-_], Announced),
       Announced = [a-Announce, b-Announce, c-Announce],
       Announce = announce(Job, 1, offer(t, me, [(1-[push])-2], [], Close)),
       Close =:= 10, logged([begun(t)]) ]).
awards(lowest_cost_wins,
     [ auctioneer([], Job), award(Job), says(a-award(Job, 1, Winners)),
       Winners == [y-1, z-1] ]).
awards(second_bid_of_a_host_is_ignored,
     [ auctioneer([], Job), bid(Job, 1, x, 5), bid(Job, 1, x, 1),
       bid(Job, 1, x, 0), sent(_), at(10), \+ says(a-award(_, _, _)) ]).
awards(two_teams,
     [ node(murdoch, [setting(window, 10)]),
       receives(post(task(t, [1-[push], 1-[lift]], [])), user),
       fact(job(Job, _, 1, _, _, _)), deliver(Job, bids(1, [x-[1-1, 2-1]])),
       deliver(Job, bids(1, [y-[2-9]])), sent(_), at(10),
       says(a-award(Job, 1, Winners)), Winners == [x-1, y-2] ]).
awards(starts_when_all_winners_have_answered,
     [ auctioneer([], Job), award(Job), report(Job, 1, y, reserved), sent(_),
       logged(_), report(Job, 1, z, reserved), says(a-start(Job)),
       logged([allocated(t, Robots)]), msort(Robots, [y, z]) ]).
awards(completes_and_releases_when_all_winners_are_done,
     [ auctioneer([], Job), executing(Job), logged(_), report(Job, 1, y, done),
       silent, report(Job, 1, z, done), says(b-release(Job, 1, all)),
       logged([completed(t)]), \+ fact(job(_, _, _, _, _, _)),
       report(Job, 1, z, done),         % a second report
       silent ]).
awards(done_may_come_before_reserved,
     [ auctioneer([], Job), award(Job), report(Job, 1, y, done),
       report(Job, 1, z, reserved), report(Job, 1, y, reserved),
       report(Job, 1, z, done),
       logged([begun(t), allocated(t, _), completed(t)]) ]).
awards(too_few_bids_release_and_back_off,
     [ auctioneer([setting(bi_min, 4), setting(bi_max, 100)], Job),
       bid(Job, 1, x, 5), sent(_), logged(_), at(10),
       says(c-release(Job, 1, all)), logged([backoff(Interval)]), Interval >= 4,
       Interval =< 12,                  % 4 + [0, 8]
       Early is 9.99 + Interval, at(Early), silent, Then is 10.01 + Interval,
       at(Then), says(a-announce(Job, 2, _)) ]).
awards(without_bids_nothing_is_released,
     [ auctioneer([], _), sent(_), logged(_), at(10), silent,
       logged([backoff(_)]) ]).
awards(intervals_grow_with_bids_and_back_offs,
     [ auctioneer([setting(bi_min, 4), setting(bi_max, 1.0e9)], Job),
       node_backs_off(12, Job, Intervals), last(Intervals, Last), Last >= 4,
       forall(nth1(I, Intervals, Interval), Interval =< 4 + 2**I*4),
       max_list(Intervals, Max), Max > 100 ]).
awards(intervals_are_bounded,
     [ auctioneer([setting(bi_min, 4), setting(bi_max, 10)], Job),
       node_backs_off(30, Job, Intervals),
       min_list(Intervals, Least), Least >= 4, max_list(Intervals, Most),
       Most =< 14 ]).
awards(refused_award_is_auctioned_again,
     [ auctioneer([], Job), award(Job), report(Job, 1, y, reserved), sent(_),
       report(Job, 1, z, refused),
       says(a-announce(Job, 2, offer(_, _, Places, _, _))),
       Places == [(1-[push])-1], bid(Job, 2, x, 9), sent(_), at(20),
       says(a-award(Job, 2, [x-1])), report(Job, 2, x, reserved),
       says(a-start(Job)) ]).
awards(silent_winner_is_released_and_replaced,
     [ auctioneer([], Job), award(Job), report(Job, 1, y, reserved), sent(_),
       at(20), bodies(Bodies), memberchk(a-release(Job, 1, [z]), Bodies),
       memberchk(a-announce(Job, 2, _), Bodies), report(Job, 1, z, reserved),
       says(a-release(Job, 1, [z])) ]).
awards(backs_off_after_some_rounds,
     [ auctioneer([setting(tries, 2)], Job), award(Job),
       report(Job, 1, y, reserved), report(Job, 1, z, refused),
       bid(Job, 2, x, 9), at(20), sent(_), logged(_),
       report(Job, 2, x, refused), says(a-release(Job, 2, all)),
       logged([backoff(_)]), \+ fact(member(_, _, _, _, _, _)) ]).
awards(robot_lost_during_execution_is_replaced,
     [ auctioneer([], Job), executing(Job), report(Job, 1, y, done),
       report(Job, 1, z, lost(failed)), says(a-announce(Job, 2, _)),
       bid(Job, 2, x, 9), at(25), sent(_), logged(_),
       report(Job, 2, x, reserved), says(a-start(Job)), report(Job, 2, x, done),
       logged([completed(t)]) ]).
awards(task_of_a_lost_robot_stays_done,
     [ auctioneer([setting(renew, 20)], Job), executing(Job),
       report(Job, 1, y, done), report(Job, 1, y, lost(failed)), silent,
       forall(member(Time, [30, 50, 70, 90]),
              ( at(Time), report(Job, 1, z, executing) )),
       logged(_), report(Job, 1, z, done), logged([completed(t)]) ]).
awards(contracts_are_renewed,
     [ auctioneer([setting(renew, 20)], Job), executing(Job), at(30),
       says(a-renew(Job, executing)), report(Job, 1, y, executing),
       report(Job, 1, z, executing), sent(_), at(50),
       says(a-renew(Job, executing)) ]).
awards(contractor_that_misses_renewals_is_lost,
     [ auctioneer([setting(renew, 20)], Job), executing(Job),
       forall(member(Time, [30, 50]),
              ( at(Time), report(Job, 1, y, executing) )),
       sent(_), at(70), bodies(Bodies),
       memberchk(a-release(Job, 1, [z]), Bodies),
       memberchk(a-announce(Job, 2, offer(_, _, [_-1], _, _)), Bodies) ]).
awards(a_missed_deadline_releases_all,
     [ node(murdoch, []),
       receives(post(task(t, [2-[push]], [deadline(25)])), user),
       fact(job(Job, _, 1, _, _, _)), executing(Job), logged(_), at(25),
       says(a-release(Job, 1, all)), logged([missed(t, 25)]),
       \+ fact(job(_, _, _, _, _, _)), at(500), silent ]).
awards(two_jobs_of_one_auctioneer_are_independent,
     [ auctioneer([], Job1), receives(post(task(u, [1-[push]], [])), user),
       fact(job(Job2, task(u, _, _), _, _, _, _)), bid(Job1, 1, x, 5),
       bid(Job1, 1, y, 5), bid(Job2, 1, z, 1), sent(_), at(10), bodies(Bodies),
       memberchk(a-award(Job1, 1, [x-1, y-1]), Bodies),
       memberchk(a-award(Job2, 1, [z-1]), Bodies) ]).

:- begin_tests(auction_auctioneer).

test(auctioneer, [forall(awards(_, Steps)), Failing == none]) :-
    failing_step(Steps, Failing).

:- end_tests(auction_auctioneer).
