:- use_module('../../lib/common', [wait_until/2, with_tmp_dir/1]).
:- use_module('../../lib/fake_agent').
:- use_module('../../lib/networks').
:- use_module(library(aggregate)).
:- use_module(library(apply)).
:- use_module(library(lists)).
:- use_module(library(plunit)).
:- use_module(library(random)).
:- use_module('../../../prolog/typhon').
:- use_module('../../../experiments/population/metrics',
              [peak/3, populations/3, track/3, track_alive/2,
               track_start/2]).
:- include('../../../agents/population/resource').

/** <module> The cloning controller, the queue of a host
*/

close_to(X, Y) :-
    abs(X - Y) < 1.0e-6.

                /*******************************
                *           EQUATIONS          *
                *******************************/

charged(Resource0, Pressure, Reward, Resource) :-
    recharged(Resource0, Pressure, Reward, charge(0.1, 15, 100), Resource).

:- begin_tests(resource).

test(equation_6_1, [ forall(member(Length-Pressure,
                               [0-4, 1-3, 3-1, 4-0, 5-0, 9-0])),
                 P =:= Pressure ]) :-
    pressure(4, Length, P).
test(equation_6_2, [ forall(member(R-Pressure-Resource-Count,
                             [ round-3-10-0, floor-3-10-0,      % 0.3
                               round-3-25.2-1, floor-3-25.2-0,  % 0.756
                               round-1-50-1, floor-1-50-0,      % 0.5
                               round-3-100-3, floor-3-100-3,
                               round-0-100-0, floor-0-100-0,
                               round-3-0-0, floor-2-50-1 ])),
               C =:= Count ]) :-
    clones(R, Pressure, Resource, 100, C).
test(equation_6_3, R-C == 25-2) :-
    conferred(35, 2, 5, R, C).
test(given_resource_is_conserved, R-C == 10-1) :-
    conferred(20, 1, 10, R, C).
test(too_little_resource_makes_no_clone, R-C == 19.9-0) :-
    conferred(19.9, 1, 10, R, C).
test(all_or_nothing, R-C == 35-0) :-
    conferred(35, 3, 10, R, C).
test(no_clones_to_make, R-C == 35-0) :-
    conferred(35, 0, 10, R, C).
test(little_resource_and_no_clones_to_make, R-C == 3-0) :-
    conferred(3, 0, 10, R, C).
test(equation_6_4) :-
    charged(10, 3, 0, R),
    close_to(R, 10.1947734041),         % 10 + 0.1 exp(2/3)
    charged(10, 2, 0, R2),
    close_to(R2, 10.1648721271).        % 10 + 0.1 exp(1/2)
test(pressure_of_one_by_hand) :-
    charged(10, 1, 0, R),
    close_to(R, 10.0904837418).         % 10 + 0.1 exp(-1/10)
test(no_pressure_by_hand) :-
    charged(1, 0, 0, R),
    close_to(R, 1.0367879441).          % 1 + 0.1 exp(-1)
test(little_resource, R =:= 0.6) :-
    charged(0.5, 0, 0, R).
test(no_resource, R =:= 0.1) :-
    charged(0, 1, 0, R).
test(reward_by_hand) :-
    charged(10, 3, 1, R),
    close_to(R, 25.1947734041).
test(no_more_than_the_maximum, R =:= 100) :-
    charged(95, 3, 1, R).
test(equation_6_5, L1-L2 == 17-10) :-
    prolonged(10, 1, 7, L1),
    prolonged(10, 0, 7, L2).
test(infinite_lifetime_is_not_prolonged, L == inf) :-
    prolonged(inf, 1, 7, L).

%   An agent with full resource, alone and without rewards; the parameters are
%   those of the thesis.

test(nine_clones, Counts == [3, 2, 2, 1, 1, 0]) :-
    spend(round, 6, 100, Counts).
test(seven_clones, Counts == [3, 2, 1, 1, 0, 0]) :-
    spend(floor, 6, 100, Counts).

spend(_, 0, _, []) :-
    !.
spend(Rounding, N, Resource0, [Count|Counts]) :-
    charged(Resource0, 3, 0, Resource1),
    clones(Rounding, 3, Resource1, 100, Count0),
    conferred(Resource1, Count0, 10, Resource, Count),
    N1 is N - 1,
    spend(Rounding, N1, Resource, Counts).

test(properties, [ forall(between(1, 100, Seed)) ]) :-
    set_random(seed(Seed)),
    random_between(0, 8, Length),
    Resource0 is 100*random_float,
    random_between(0, 1, Reward),
    random_member(Rounding, [round, floor]),
    pressure(4, Length, Pressure),
    between(0, 4, Pressure),
    charged(Resource0, Pressure, Reward, Resource1),
    Resource1 =< 100,
    Resource1 >= min(100, Resource0 + 15*Reward),
    Resource1 =< Resource0 + 15*Reward + 0.1*exp(1),
    clones(Rounding, Pressure, Resource1, 100, Count0),
    Count0 =< Pressure,                 % never more than there is capacity for
    conferred(Resource1, Count0, 10, Resource, Count),
    memberchk(Count, [0, Count0]),
    close_to(Resource1, Resource + 10*Count),
    ( Count > 0 -> Resource >= 10 ; true ).

:- end_tests(resource).

                /*******************************
                *           THE ROOM           *
                *******************************/

%   An agent that includes the file, at a host with a queue q.

member_of(Resource, Lifetime, More) :-
    fake_agent('agents/population/cloning.pl',
               [ resource(Resource), lifetime(Lifetime) | More ],
               [queue(q)]),
    retractall(fake_agent:fertile),
    assertz(fake_agent:fertile).

account(Resource, Lifetime) :-
    fake_agent:resource(Resource),
    fake_agent:lifetime(Lifetime).

:- begin_tests(controller).

test(joins_and_waits_for_its_turn) :-
    member_of(10, 10, []),
    fake_mail(q-turn(2)),
    fake_agent:await_turn(Length),
    Length == 2,
    did_just([send(q, join)]).
test(dies_in_the_queue) :-
    member_of(10, 3, [setting(tick, 2)]),
    catch(fake_agent:await_turn(_), disposed, true),
    fake_host:time(Time),
    Time =:= 8,                         % 3 ticks, and one for the answer
    did_just([send(q, join), log(state(death)), send(q, quit)]).
test(turn_may_be_in_flight_to_a_dying_agent) :-
    member_of(10, 0, []),
    fake_mail(q-gone),
    catch(fake_agent:die, disposed, true),
    fake_host:time(Time),
    Time =:= 0.
test(without_a_queue_no_waiting, [Length, Acts, Time] == [1, [], 0]) :-
    fake_agent('agents/population/cloning.pl', [lifetime(inf)], []),
    fake_agent:await_turn(Length),
    did(Acts),
    fake_host:time(Time).
test(a_turn_costs_a_tick) :-
    member_of(10, 10, []),
    fake_agent:depart,
    account(_, Lifetime),
    Lifetime =:= 9,
    fake_host:time(Time),
    Time =:= 1,
    did_just([send(q, leave), move(next)]).
test(lifetime_is_counted_in_ticks) :-
    member_of(10, 10, [setting(tick, 2)]),
    fake_agent:depart,
    account(_, Lifetime),
    Lifetime =:= 9,
    fake_host:time(Time),
    Time =:= 2.
test(the_first_agent_never_dies, Lifetime == inf) :-
    member_of(10, inf, []),
    fake_agent:depart,
    account(_, Lifetime).
test(dies_during_its_turn) :-
    member_of(10, 0.4, []),
    fake_mail(q-gone),
    catch(fake_agent:depart, disposed, true),
    fake_host:time(Time),
    close_to(Time, 0.4),
    did_just([log(state(death)), send(q, quit)]).
test(refused_agent_leaves_the_head, Acts == [send(q, leave)]) :-
    member_of(10, 10, []),
    fake_refusal(next),
    \+ fake_agent:depart,
    did(Acts).
test(reward) :-
    member_of(10, 10, []),
    fake_agent:gain(1, 1),
    account(Resource, Lifetime),
    close_to(Resource, 25.1947734041),
    Lifetime =:= 17,
    did_just([log(resource(Resource))]).
test(no_reward) :-
    member_of(10, 10, []),
    fake_agent:gain(0, 4),
    account(Resource, Lifetime),
    close_to(Resource, 10.0904837418),
    Lifetime =:= 10,
    did_just([]).
test(clones_after_a_reward, Role-Acts == parent-[log(state(replicate)),
                                                 log(resource(15))]) :-
    member_of(25, 10, []),
    fake_agent:replicate(1, 1, Role),
    did(Acts).
test(rounding_decides_the_number_of_clones, Role-Acts == parent-[]) :-
    member_of(25, 10, [setting(rounding, floor)]),
    fake_agent:replicate(1, 1, Role),
    did(Acts).
test(no_clone_without_reward, Acts == []) :-
    member_of(25, 10, []),
    fake_agent:replicate(0, 1, parent),
    did(Acts).
test(clones_without_reward_if_configured, Resource =:= 15) :-
    member_of(25, 10, [setting(replication, always)]),
    fake_agent:replicate(0, 1, parent),
    account(Resource, _).
test(no_clone_while_not_fertile, Acts == []) :-
    member_of(25, 10, []),
    retractall(fake_agent:fertile),
    fake_agent:replicate(1, 1, parent),
    did(Acts).
test(no_clone_in_a_full_queue, Acts == []) :-
    member_of(100, 10, []),
    fake_agent:replicate(1, 4, parent),
    did(Acts).
test(several_clones, Resource-Count == 70-3) :-
    member_of(100, 10, []),
    fake_agent:replicate(1, 1, parent),
    account(Resource, _),
    did(Acts),
    aggregate_all(count, member(log(state(replicate)), Acts), Count).
test(slot_is_taken_before_the_clone, Role-Resource == parent-90) :-
    member_of(100, 10, []),
    fake_clone(parent(child)),
    fake_clone(error(move_refused(here, capacity), _)),
    fake_agent:replicate(1, 1, Role),
    account(Resource, _).
test(resources_given_to_a_clone) :-
    member_of(100, 3, [setting(lifetime, 8), '$memory'(elsewhere)]),
    fake_clone(clone(me)),
    fake_agent:replicate(1, 1, Role),
    Role == clone,
    account(Resource, Lifetime),
    Resource-Lifetime == 10-8,
    \+ fake_agent:'$memory'(_),
    did_just([log(state(replicate)), log(cloned)]).

:- end_tests(controller).

%   The answers of the queue to messages Mail of agents, in sequence. Without
%   further messages the head is removed, and at the end the queue waits
%   without a limit.

queue_answers(Mail, Told) :-
    fake_agent('agents/population/queue.pl', [], []),
    maplist(fake_mail, Mail),
    \+ fake_agent:serve([]),
    did(Acts),
    findall(Agent-What, member(send(Agent, What), Acts), Told).

:- begin_tests(queue).

test(agent_offers_itself, Tuples == [queue(me)]) :-
    fake_agent('agents/population/queue.pl', [], []),
    \+ fake_agent:main,
    tuples(Tuples).
test(first_come_first_served,
     Told == [a-turn(1), b-turn(2), c-turn(1)]) :-
    queue_answers([a-join, b-join, c-join, a-leave, b-leave, c-leave], Told).
test(only_the_head_has_a_turn, Told == [a-turn(1), c-turn(1)]) :-
    queue_answers([a-join, b-join, c-join, b-leave, a-leave, c-leave], Told).
test(returning_agent_goes_to_the_tail,
     Told == [a-turn(1), b-turn(2), c-turn(2), a-turn(1)]) :-
    queue_answers([ a-join, b-join, c-join, a-leave, a-join, b-leave, c-leave,
                    a-leave ], Told).
test(single_agent_gets_the_next_turn, Told == [a-turn(1), a-turn(1)]) :-
    queue_answers([a-join, a-leave, a-join, a-leave], Told).
test(agent_is_in_the_queue_once, Told == [a-turn(1), b-turn(1)]) :-
    queue_answers([a-join, b-join, a-join, a-leave, b-leave], Told).
test(absent_agent_cannot_leave, Told == [a-turn(1)]) :-
    queue_answers([b-leave, a-join], Told).
test(dying_agents_get_an_answer, Told == [a-turn(1), a-gone, b-turn(1)]) :-
    queue_answers([a-join, b-join, a-quit, b-leave], Told).
test(vanished_head_is_removed,
     Told-Time == [a-turn(1), b-turn(2), c-turn(1)]-180) :-
    queue_answers([a-join, b-join, c-join], Told),
    fake_host:time(Time).

:- end_tests(queue).

                /*******************************
                *           DEMAND             *
                *******************************/

%   Agents on three hosts are rewarded at each visit: they fill the queues, and
%   no queue ever overflows.

harvester([ ":- agent(harvester, [state([harvest/1])]).",
            ":- include(agents(population/cloning)).",
            "main :- live.",
            "visit(1).",
            "fertile."
          ]).

write_harvester(Dir, File) :-
    harvester(Lines),
    atomic_list_concat([Dir, '/harvester.pl'], File),
    setup_call_cleanup(
        open(File, write, Out),
        forall(member(Line, Lines), format(Out, '~s~n', [Line])),
        close(Out)).

crowd(Most, Dir) :-
    write_harvester(Dir, File),
    with_logged_network(
        ring(3), [clock(20), hosts([capacity(5)]), seed(1)], Hosts, Log,
        ( forall(member(Host, Hosts),
                 agent_create(agents(population/queue), _,
                              [host(Host), static(true)])),
          Hosts = [Host1|_],
          agent_create(File, _, [host(Host1), name(agent1)]),
          wait_until(alive(Log, 12), 60),
          wait_until(serviced(Log, 300), 60) ), Events),
    populations(Events, [1], Steps),
    peak(total, Steps, _-Most).

alive(Log, Enough) :-
    log_events(Log, Events),
    track_start([], State0),
    foldl(track, Events, State0, State),
    track_alive(State, Count),
    Count >= Enough.

serviced(Log, Enough) :-
    log_events(Log, Events),
    aggregate_all(count, member(event(_, _, _, resource(_)), Events), Count),
    Count >= Enough.

:- begin_tests(demand).

test(demand_fills_the_queues_exactly, Most =:= 12) :-
    with_tmp_dir(crowd(Most)).

:- end_tests(demand).
