:- module(test_parking, []).

% Agents and messages that wait in the engine for a host, with a real engine.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/redis').
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(plunit)).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/fleet),
              [fleet_park_drop/2, fleet_park_send/2]).

:- needs([fleet]).

%   with_robot(+Joins, +Options, -Redis, -Robot, :Goal): this process, with the
%   host alpha, and one with the host Robot, are members.

:- meta_predicate with_robot(+, +, -, -, 0).

with_robot(Joins, Options, Redis, Robot, Goal) :-
    with_fleet([lease(1)|Joins], Redis, [alpha-[]],
               ( member_spec(Redis, robot, [lease(1)|Joins], Options, Spec),
                 with_peers([Spec], ( peer_host(robot, Robot), once(Goal) )) )).

%   visitor(+Host, +Wait, -Agent): its result is the error of its move, or `none`,
%   where it is then, its hops, and what it got until `last`.

visitor(Host, Wait, Agent) :-
    create([ (main :- catch(( move(Host, [wait(Wait)]), R = none ),
                            error(R, _), true),
                      here(Here), hops(Hops), all(Ms),
                      result([R,Here,Hops|Ms])),
             (all(Ms) :- receive(_-M),
                         ( M == last -> Ms = [] ; Ms = [M|More], all(More) )) ],
           Agent, [host(alpha)]).

parked(Agents) :-
    catch(fleet_parked(lab, Parked), error(_, _), fail),
    findall(A, member(parked(A, _, _, _), Parked), Agents0),
    sort(Agents0, Agents).

await_parked(Agents0) :-
    sort(Agents0, Agents),
    wait_until(test_parking:parked(Agents), 30).

%   gone(+Agents): the engine has them for certain.

gone(Agents) :-
    await_parked(Agents),
    wait_until(\+ ( member(A, Agents), typhon_agents:agent_on(A, _) ), 30).

results(Agents, Results) :-
    findall(Result,
            ( member(A, Agents), agent_result(A, Result, 60) ),
            Results).

send_all(Agents, Messages) :-
    forall(( member(M, Messages), member(A, Agents) ), agent_send(A, M)).

nothing_is_left(Redis) :-
    parked([]),
    redis_line(Redis, [keys, 'f:{lab}:park:*'], Keys),
    redis_line(Redis, [hlen, 'f:{lab}:parcels'], Parcels),
    redis_line(Redis, [hlen, 'f:{lab}:bytes'], Bytes),
    redis_line(Redis, [exists, 'f:{lab}:claimed', 'f:{lab}:due'], Others),
    forall(member(Lines, [Keys,Parcels,Bytes,Others]),
           memberchk(Lines, [[""], [], ["0"], ["(integer) 0"]])).

:- begin_tests(parking).

test(parked_agents_and_their_mail_arrive_once_and_in_order) :-
    with_robot([fsync(always)], [], Redis, Robot, robot_returns(Redis, Robot)).

robot_returns(Redis, Robot) :-
    peer_kill(robot),
    findall(A, ( between(1, 20, _), visitor(Robot, 600, A) ), Agents),
    gone(Agents),
    send_all(Agents, [1,2,3,last]),
    fleet_parked(lab, [parked(_, Host, Since, Until)|_]),
    assertion(Host == Robot),
    assertion(Until-Since =< 600.001),
    assertion(Until-Since > 500),
    peer_restart(robot),
    results(Agents, Results),
    assertion(forall(member(R, Results), R == [none,Robot,1,1,2,3])),
    assertion(length(Results, 20)),
    wait_until(test_parking:nothing_is_left(Redis), 10).

test(agent_goes_on_where_it_was_when_the_time_is_over, Result
     == [host_unreachable(Robot),Alpha,2,hello]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 visitor(Robot, 3, A),
                 gone([A]),
                 agent_send(A, hello),
                 agent_send(A, last),
                 agent_result(A, Result, 60),
                 wait_until(test_parking:nothing_is_left(Redis), 10) )).

test(refused_agent_returns_with_the_refusal,
     Result == [move_refused(Robot,capacity),Alpha,2,hello]) :-
    with_robot([fsync(always)], [capacity(0)], Redis, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 visitor(Robot, 600, A),
                 gone([A]),
                 agent_send(A, hello),
                 agent_send(A, last),
                 peer_restart(robot),
                 agent_result(A, Result, 60),
                 wait_until(test_parking:nothing_is_left(Redis), 10) )).

test(operator_returns_an_agent,
     Result == [host_unreachable(Robot),Alpha,2]) :-
    with_robot([fsync(always)], [], _, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 visitor(Robot, inf, A),
                 gone([A]),
                 fleet_parked(lab, [parked(A, Robot, _, Until)]),
                 assertion(Until == inf),
                 fleet_park_drop(lab, A),
                 agent_send(A, last),
                 agent_result(A, Result, 60) )).

test(agent_that_cannot_be_sent_stays_parked,
     Formal == host_unreachable(Robot)) :-
    with_robot([fsync(always)], [], _, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 catch(fleet_park_send(lab, A), error(Formal, _), true),
                 parked([A]),
                 fleet_park_drop(lab, A),
                 agent_send(A, last),
                 agent_result(A, _, 60) )).

test(agent_of_no_fleet_does_not_wait,
     Result == [host_unreachable(Host),Alpha,0]) :-
    free_port(Port),
    format(atom(Host), 'nowhere@127.0.0.1:~d', [Port]),
    with_fleet([], _, [alpha-[]],
               ( address(alpha, Alpha),
                 visitor(Host, 600, A),
                 agent_send(A, last),
                 agent_result(A, Result, 60) )).

:- end_tests(parking).
