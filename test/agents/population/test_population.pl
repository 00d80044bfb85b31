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

                /*******************************
                *           EQUATIONS          *
                *******************************/

charged(Resource0, Pressure, Reward, Resource) :-
    recharged(Resource0, Pressure, Reward, charge(0.1, 15, 100), Resource).

%   equation(Name, Goal, Value, Expected): Value is of Goal.

equation(equation_6_1, pressure(4, Length, P), P, Is) :-
    member(Length-Is, [0-4, 1-3, 3-1, 4-0, 5-0, 9-0]).
equation(equation_6_2, clones(Rounding, Pressure, Resource, 100, C), C, Is) :-
    member(Rounding-Pressure-Resource-Is,
           [ round-3-10-0, floor-3-10-0, round-3-25.2-1, floor-3-25.2-0,
             round-1-50-1, floor-1-50-0, round-3-100-3, floor-3-100-3,
             round-0-100-0, floor-0-100-0, round-3-0-0, floor-2-50-1,
             round-2-24.9-0, floor-2-49.9-0 ]).
equation(equation_6_3, conferred(35, 2, 5, R, C), R-C, 25-2).
equation(given_resource_is_conserved, conferred(20, 1, 10, R, C), R-C, 10-1).
equation(too_little_makes_no_clone, conferred(19.9, 1, 10, R, C), R-C, 19.9-0).
equation(all_or_nothing, conferred(35, 3, 10, R, C), R-C, 35-0).
equation(no_clones_to_make, conferred(R0, 0, 10, R, C), R-C, R0-0) :-
    member(R0, [35, 3]).
equation(equation_6_4, charged(R0, Pressure, 0, R), R, Is) :-
    member(R0-Pressure-Exponent, [10-3-(2/3), 10-2-0.5, 10-1-(-0.1), 1-0-(-1)]),
    Is is R0 + 0.1*exp(Exponent).
equation(equation_6_5, prolonged(10, Reward, 7, L), L, Is) :-
    member(Reward-Is, [1-17, 0-10]).
equation(infinite_lifetime_is_not_prolonged, prolonged(inf, 1, 7, L), L, inf).
equation(little_resource, charged(0.5, 0, 0, R), R, 0.6).
equation(no_resource, charged(0, 1, 0, R), R, 0.1).
equation(reward_by_hand, charged(10, 3, 1, R), R, 25.194773404105).
equation(no_more_than_the_maximum, charged(95, 3, 1, R), R, 100).
equation(nine_clones, spend(round, 6, 100, Counts), Counts, [3, 2, 2, 1, 1, 0]).
equation(seven_clones, spend(floor, 6, 100, Counts), Counts,
         [3, 2, 1, 1, 0, 0]).

%   An agent with full resource, alone and without rewards; the parameters are
%   those of the thesis.

spend(_, 0, _, []) :-
    !.
spend(Rounding, N, Resource0, [Count|Counts]) :-
    charged(Resource0, 3, 0, Resource1),
    clones(Rounding, 3, Resource1, 100, Count0),
    conferred(Resource1, Count0, 10, Resource, Count),
    N1 is N - 1,
    spend(Rounding, N1, Resource, Counts).

:- begin_tests(resource).

test(equation, [ forall(equation(_, Goal, Value, Expected)),
                 true(alike(Expected, Value)) ]) :-
    call(Goal).
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
    Sum is Resource + 10*Count,
    alike(Resource1, Sum),
    ( Count > 0 -> Resource >= 10 ; true ).

:- end_tests(resource).

                /*******************************
                *           THE ROOM           *
                *******************************/

%   acts(Name, Resource, Lifetime, Facts, Before, Goal, Checks): an agent with
%   Resource and Lifetime, which is fertile, at a host with a queue q; see
%   fake_run/4.

acts(joins_and_waits_for_its_turn, 10, 10, [], [fake_mail(q-turn(2))],
     await_turn(Length), [Length == 2, did=[send(q, join)]]).
acts(dies_in_the_queue, 10, 3, [setting(tick, 2)], [], await_turn(_),
     [ end=disposed, time=8,            % 3 ticks, and one for the answer
       did=[send(q, join), log(state(death)), send(q, quit)] ]).
acts(turn_may_be_in_flight_to_a_dying_agent, 10, 0, [], [fake_mail(q-gone)],
     die, [end=disposed, time=0]).
acts(without_a_queue_no_waiting, 10, inf, [], [fake_host:take(queue(q))],
     await_turn(Length), [Length == 1, did=[], time=0]).
acts(a_turn_costs_a_tick, 10, 10, [], [], depart,
     [lifetime=9, time=1, did=[send(q, leave), move(next)]]).
acts(lifetime_is_counted_in_ticks, 10, 10, [setting(tick, 2)], [], depart,
     [lifetime=9, time=2]).
acts(the_first_agent_never_dies, 10, inf, [], [], depart, [lifetime=inf]).
acts(dies_during_its_turn, 10, 0.4, [], [fake_mail(q-gone)], depart,
     [end=disposed, time=0.4, did=[log(state(death)), send(q, quit)]]).
acts(refused_agent_leaves_the_head, 10, 10, [], [fake_refusal(next)], depart,
     [end=fail, did=[send(q, leave)]]).
acts(reward, 10, 10, [], [], gain(1, 1),
     [resource=R, lifetime=17, did=[log(resource(R))]]) :-
    R = 25.194773404105.
acts(no_reward, 10, 10, [], [], gain(0, 4),
     [resource=10.090483741804, lifetime=10, did=[]]).
acts(clones_after_a_reward, 25, 10, [], [], replicate(1, 1, Role),
     [Role == parent, did=[log(state(replicate)), log(resource(15))]]).
acts(no_clones, Resource, 10, Facts, Before, replicate(Reward, Length, Role),
     [Role == parent, did=[]]) :-
    member([Resource, Facts, Before, Reward, Length],
           [ [25, [setting(rounding, floor)], [], 1, 1], [25, [], [], 0, 1],
             [25, [], [retractall(fake_agent:fertile)], 1, 1],
             [100, [], [], 1, 4] ]).    % the queue is full
acts(clones_without_reward_if_configured, 25, 10,
     [setting(replication, always)], [], replicate(0, 1, parent),
     [resource=15]).
acts(several_clones, 100, 10, [], [], replicate(1, 1, parent),
     [resource=70, ( aggregate_all(count, fake_host:did(log(state(replicate))),
                                   Count), Count == 3 )]).
acts(slot_is_taken_before_the_clone, 100, 10, [],
     [ fake_clone(parent(child)),
       fake_clone(error(move_refused(here, capacity), _)) ],
     replicate(1, 1, Role), [Role == parent, resource=90]).
acts(resources_given_to_a_clone, 100, 3,
     [setting(lifetime, 8), '$memory'(elsewhere)], [fake_clone(clone(me))],
     replicate(1, 1, Role),
     [ Role == clone, resource=10, lifetime=8, \+ '$memory'(_),
       did=[log(state(replicate)), log(cloned)] ]).

:- begin_tests(controller).

test(agent_acts, [ forall(acts(_, Resource, Lifetime, Facts, Before, Goal,
                               Checks)), Wrong == [] ]) :-
    fake_agent('agents/population/cloning.pl',
               [resource(Resource), lifetime(Lifetime)|Facts], [queue(q)]),
    fake_run([fake_fact(fertile)|Before], Goal, Checks, Wrong).

:- end_tests(controller).

%   answers(Name, Mail, Answers, Seconds): the answers of the queue to messages
%   of agents, in sequence. Without further messages the head is removed, and
%   at the end the queue waits without a limit.

answers(first_come_first_served,
        [a-join, b-join, c-join, a-leave, b-leave, c-leave],
        [a-turn(1), b-turn(2), c-turn(1)], _).
answers(only_the_head_has_a_turn,
        [a-join, b-join, c-join, b-leave, a-leave, c-leave],
        [a-turn(1), c-turn(1)], _).
answers(returning_agent_goes_to_the_tail,
        [ a-join, b-join, c-join, a-leave, a-join, b-leave, c-leave, a-leave ],
        [a-turn(1), b-turn(2), c-turn(2), a-turn(1)], _).
answers(single_agent_gets_the_next_turn, [a-join, a-leave, a-join, a-leave],
        [a-turn(1), a-turn(1)], _).
answers(agent_is_in_the_queue_once, [a-join, b-join, a-join, a-leave, b-leave],
        [a-turn(1), b-turn(1)], _).
answers(absent_agent_cannot_leave, [b-leave, a-join], [a-turn(1)], _).
answers(dying_agents_get_an_answer, [a-join, b-join, a-quit, b-leave],
        [a-turn(1), a-gone, b-turn(1)], _).
answers(vanished_head_is_removed, [a-join, b-join, c-join],
        [a-turn(1), b-turn(2), c-turn(1)], 180).

:- begin_tests(queue).

test(agent_offers_itself, Tuples == [queue(me)]) :-
    fake_agent('agents/population/queue.pl', [], []),
    \+ fake_agent:main,
    tuples(Tuples).
test(queue_answers, [ forall(answers(_, Mail, Expected, Seconds)),
                      Answers-Time = Expected-Seconds ]) :-
    fake_agent('agents/population/queue.pl', [], []),
    maplist(fake_mail, Mail),
    \+ fake_agent:serve([]),
    did(Acts),
    findall(Agent-What, member(send(Agent, What), Acts), Answers),
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
