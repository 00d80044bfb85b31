:- module(test_parking, []).

% Agents and messages that wait in the engine for a host, with a real engine.

:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../lib/redis').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(filesex),
              [delete_directory_and_contents/1, directory_file_path/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(pairs), [pairs_keys/2]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_create/3]).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/host), [address_parts/3]).
:- use_module(library(typhon/kernel/wire), [endpoint_peer/2]).
:- use_module(library(typhon/options/fleet),
              [fleet_park_drop/2, fleet_park_send/2]).
:- use_module(library(typhon/options/fleet/parking), []).

:- needs([fleet, journal]).

%   with_robot(+Joins, +Options, -Redis, -Robot, :Goal): this process, with the
%   host alpha, and one with the host Robot, are members.

:- meta_predicate with_robot(+, +, -, -, 0).

with_robot(Joins, Options, Redis, Robot, Goal) :-
    with_fleet([lease(1)|Joins], Redis, [alpha-[]],
               ( member_spec(Redis, robot, [lease(1)|Joins], Options, Spec),
                 with_peers([Spec], ( peer_host(robot, Robot), once(Goal) )) )).

%   visitor(+Host, +Wait, -Agent): its result is the error of its move, or
%   `none`, where it is then, its hops, and what it got until `last`.

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

%   returned(+Agents): they, and no others, wait for alpha.

returned(Agents) :-
    address(alpha, Alpha),
    fleet_parked(lab, Parked),
    findall(A, member(parked(A, _, _, _), Parked), As),
    sort(Agents, Sorted),
    sort(As, Sorted),
    forall(member(parked(_, Host, _, _), Parked), Host == Alpha).

%   engine_knows(+Redis, +Home, +Agent, -Address): where Agent, born at Home, is.

engine_knows(Redis, Home, Agent, Address) :-
    atom_concat('f:{lab}:agents:', Home, Key),
    redis_line(Redis, [hget, Key, Agent], [Text]),
    split_string(Text, " \"", " \"", Words),
    last(Words, Last),
    atom_string(Address, Last).

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

%   time_is_over(+Redis, +Agent): that for which it waits.

time_is_over(Redis, Agent) :-
    redis_line(Redis, [zadd,'f:{lab}:due',xx,0,Agent], _).

%   source_looks(+Agent): its source, this process, looks at once whether the
%   engine has kept it.

source_looks(A) :-
    alarm(A, Token),
    typhon_scheduler:fire(A, Token).

alarm(A, Token) :-
    typhon_scheduler:alarm_stamp(_, A, Token),
    Token = parked(_, _, _, _),
    !.

parked_again(Redis, A, Robot, [Hops,E,_|Others], Parcel) :-
    format(atom(Key), 'f:{lab}:park:~w', [E]),
    redis_line(Redis, [hset, 'f:{lab}:parcels', A, Parcel], _),
    redis_line(Redis, [xadd, Key, *, agent, Robot, id, A, why, ''], [Entry]),
    atomics_to_string([Hops,'\n',E,'\n',Entry], Begin),
    atomic_list_concat([Begin|Others], '\n', Value),
    redis_line(Redis, [hset, 'f:{lab}:parked', A, Value], _).

kept_out(A) :-
    catch(agent_send(A, hello), error(Formal, _), true),
    assertion(nonvar(Formal)),
    fleet_park_drop(lab, A),
    wait_until(test_parking:parked([]), 20),
    agent_send(A, last),
    agent_result(A, _, 60).

%   resident(-Redis, -Robot, -Agent, :Goal): Agent is on the robot,
%   which keeps a journal, and the engine knows that.

:- meta_predicate resident(-, -, -, 0).

resident(Redis, Robot, A, Goal) :-
    with_tmp_dir(Dir,
        with_robot([fsync(always)], [journal(Dir)], Redis, Robot,
                   ( visitor(Robot, 600, A),
                     wait_until(agent_property(A, host(Robot)), 20),
                     typhon_engine:engine_script(lab, where, [A,1,Robot], _),
                     once(Goal) ))).

%   no_connection(+Host): a message that is written to a process that has just
%   died is lost with it.

no_connection(Host) :-
    address_parts(Host, _, Endpoint),
    wait_until(\+ endpoint_peer(Endpoint, state(up)), 30).

%   journaled_mail(+Dir, -Got): all is sent before base, whose journal is at
%   Dir, is killed, and before the robot is back.

journaled_mail(Dir, Got) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( member_spec(Redis, base, [lease(1),fsync(always)],
                             [journal(Dir)], Base),
                 collector(C),
                 with_more_peers([Base],
                     ( peer_kill(robot),
                       peer_agent(base,
                                  [ (:- agent(a, [state([to/2])])),
                                    (main :- to(H, C), move(H, [wait(600)]),
                                             all(Ms), send(C, Ms)),
                                    (all(Ms) :- receive(_-M),
                                                ( M == last -> Ms = []
                                                ; Ms = [M|More], all(More) )) ],
                                  [to(Robot,C)], A),
                       wait_until(test_parking:parked([A]), 20),
                       wait_until(\+ peer_do(base, agent_here(A)), 20),
                       peer_agent(base, [ (:- agent(b, [state([to/1])])),
                                          (main :- to(A), send(A, 1),
                                                   send(A, 2), send(A, 3),
                                                   send(A, last)) ],
                                  [to(A)], _),
                       wait_until(test_parking:all_sent(Redis), 60),
                       peer_kill(base),
                       peer_restart(robot),
                       wait_until(test_parking:nothing_is_left(Redis), 30),
                       wait_until(agent_property(C, mailbox([_])), 30),
                       agent_send(C, go),
                       agent_send(C, last),
                       agent_result(C, Got0, 30),
                       findall(G, member(G, Got0), Got) )) )).

%   All four messages are in letters of the engine.

all_sent(Redis) :-
    redis_line(Redis, [keys, 'f:{lab}:park:*'], [Key]),
    redis_line(Redis, [xrange, Key, -, +], Lines),
    aggregate_all(count, ( member(Line, Lines),
                           sub_string(Line, _, _, _, "mail("),
                           sub_string(Line, _, _, _, ",last)") ), 1).

collector(C) :-
    create([ (main :- receive(user-go), all(Ms), result(Ms)),
             (all(Ms) :- receive(_-M),
                         ( M == last -> Ms = [] ; Ms = [M|More], all(More) )) ],
           C, [host(alpha)]).

letters(Redis, Robot, Count) :-
    atomic_list_concat([_,Endpoint], @, Robot),
    atom_concat('f:{lab}:park:', Endpoint, Key),
    redis_line(Redis, [xlen, Key], [Text]),
    number_string(Count, Text).

:- meta_predicate with_more_peers(+, 0).

with_more_peers([Spec], Goal) :-
    test_peers:start(Spec),
    once(Goal).

%   base(+Base, +Options, +Wait, -Redis, -Robot, :Goal, -Got): an agent of the
%   process base is parked for the robot; Got are the messages that it sends.

:- meta_predicate base(+, +, +, -, -, 0, ?).

base(Base, Options, Wait, Redis, Robot, Goal, Got) :-
    with_robot([fsync(always)], Options, Redis, Robot,
               ( member_spec(Redis, base, [lease(1),fsync(always)], Base, Spec),
                 create([ (main :- all([], Ms), result(Ms)),
                          (all(Ms0, Ms) :-
                               receive(_-M),
                               ( M == last -> Ms = Ms0
                               ; append(Ms0, [M], Ms1), all(Ms1, Ms) )) ],
                        Collector, [host(alpha)]),
                 with_more_peers([Spec],
                     ( peer_kill(robot),
                       peer_agent(base,
                                  [ (:- agent(a, [state([to/3])])),
                                    (main :- to(H, S, C),
                                             catch(( move(H, [wait(S)]),
                                                     R = none ),
                                                   error(R, _), true),
                                             here(Here),
                                             send(C, R-Here),
                                             receive(_)) ],
                                  [to(Robot,Wait,Collector)], Agent),
                       await_parked([Agent]),
                       wait_until(\+ peer_do(base, agent_here(Agent)), 20),
                       once(Goal),
                       wait_until(test_parking:nothing_is_left(Redis), 30),
                       agent_send(Collector, last),
                       agent_result(Collector, Got, 60) )) )).

arrived(Peer) :-
    peer_do(Peer, ( agents_here([A]),
                    wait_until(agent_property(A, mailbox([])), 20) )),
    wait_until(peer_do(Peer, ( agents_here([B]),
                               agent_property(B, goals([receive(_)|_])) )), 20).

returns(Base) :-
    fleet_parked(lab, [parked(_, Base, _, inf)]).

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

%   This process has met that of Robot, and has noticed that it is gone.

meets(Robot) :-
    visitor(Robot, 600, A),
    wait_until(agent_property(A, host(Robot)), 20),
    agent_send(A, last),
    agent_result(A, _, 20).

misses(Robot) :-
    atomic_list_concat([_,Endpoint], @, Robot),
    catch(typhon_wire:endpoint_call(Endpoint, hosting, hosts, _, 1),
          error(_, _), true),
    typhon_wire:endpoint_gone(Endpoint).

%   restart_outside(+Peer): its host is in no fleet.

restart_outside(Peer) :-
    retract(test_peers:host(Peer, Address, (_, host_start(Peer, Options0)))),
    exclude(==(fleet(lab)), Options0, Options),
    assertz(test_peers:host(Peer, Address, host_start(Peer, Options))),
    peer_restart(Peer).

killed_while_it_takes(Redis, Robot) :-
    peer_kill(robot),
    findall(A, ( between(1, 40, _), visitor(Robot, 600, A) ), Agents),
    gone(Agents),
    send_all(Agents, [1,2,last]),
    forall(between(1, 3, _),
           ( peer_restart(robot),
             wait_until(test_parking:some_are_taken(Redis, 40), 30),
             peer_kill(robot) )),
    peer_restart(robot),
    results(Agents, Results),
    assertion(forall(member(R, Results), R == [none,Robot,1,1,2])),
    assertion(length(Results, 40)),
    wait_until(test_parking:nothing_is_left(Redis), 30).

some_are_taken(Redis, _) :-
    redis_line(Redis, [exists, 'f:{lab}:claimed'], ["1"]),
    !.
some_are_taken(Redis, Most) :-
    redis_line(Redis, [hlen, 'f:{lab}:parked'], [Text]),
    number_string(Count, Text),
    Count < Most.

%   forgets(+Redis, :Goal): the engine is started again without what it has stored
%   while Goal was called.

:- meta_predicate forgets(+, 0).

forgets(Redis, Goal) :-
    Redis = redis(_, Dir, _),
    directory_file_path(Dir, appendonlydir, Data),
    directory_file_path(Dir, before, Before),
    process_create(path(cp), ['-r', Data, Before], []),
    once(Goal),
    redis_signal(Redis, kill),
    delete_directory_and_contents(Data),
    rename_file(Before, Data),
    redis_restart(Redis).

:- begin_tests(parking).

test(parked_agents_and_their_mail_arrive_once_and_in_order) :-
    with_robot([fsync(always)], [], Redis, Robot, robot_returns(Redis, Robot)).

test(agent_goes_on_where_it_was_when_the_time_is_over, Result
     == [host_unreachable(Robot),Alpha,2,hello]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 visitor(Robot, 600, A),
                 gone([A]),
                 agent_send(A, hello),
                 agent_send(A, last),
                 time_is_over(Redis, A),
                 agent_result(A, Result, 60),
                 wait_until(test_parking:nothing_is_left(Redis), 10) )).

test(refused_agent_returns_with_the_refusal,
     Result == [move_refused(Robot,capacity),Alpha,2]) :-
    with_robot([fsync(always)], [capacity(0)], Redis, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 visitor(Robot, 600, A),
                 gone([A]),
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

%   Where the letter was to be sent, the agent was parked at that time.

test(letter_reaches_an_agent_that_has_just_returned,
     Result == [host_unreachable(Robot),Alpha,2]) :-
    with_robot([fsync(always)], [], _, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 visitor(Robot, 600, A),
                 gone([A]),
                 fleet_park_drop(lab, A),
                 wait_until(typhon_agents:agent_on(A, _), 30),
                 atomic_list_concat([_,Here], @, Alpha),
                 typhon_mail:mail_kept(host_unreachable(Robot), A,
                                       [mail(Here, user, last)]),
                 agent_result(A, Result, 60) )).
test(engine_knows_that_an_agent_returns, At == Alpha) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 visitor(Robot, 600, A),
                 gone([A]),
                 fleet_park_drop(lab, A),
                 atomic_list_concat([_,Here], @, Alpha),
                 engine_knows(Redis, Here, A, At),
                 agent_send(A, last),
                 agent_result(A, _, 60) )).

test(operator_sends_an_agent_to_a_host_that_has_left_the_fleet,
     Result == [none,Robot,1,hello]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 agent_send(A, hello),
                 restart_outside(robot),
                 fleet_park_send(lab, A),
                 parked([]),
                 peer_do(robot, agent_here(A)),
                 redis_address(Redis, Address),
                 peer_do(robot, ( fleet_join(lab, [redis(Address),lease(1)]),
                                  host_start(arm, [fleet(lab)]) )),
                 wait_until(test_parking:nothing_is_left(Redis), 20),
                 agent_send(A, last),
                 agent_result(A, Result, 60) )).

test(each_parked_agent_has_its_program_with_it, Result == [none,Robot,1]) :-
    with_robot([fsync(always)], [], _, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 visitor(Robot, 600, B),
                 gone([A,B]),
                 fleet_park_drop(lab, A),
                 await_parked([B]),
                 agent_send(A, last),
                 agent_result(A, _, 60),
                 peer_restart(robot),
                 agent_send(B, last),
                 agent_result(B, Result, 60) )).

test(agent_of_no_fleet_does_not_wait,
     Result == [host_unreachable(Host),Alpha,0]) :-
    free_port(Port),
    format(atom(Host), 'nowhere@127.0.0.1:~d', [Port]),
    with_fleet([], _, [alpha-[]],
               ( address(alpha, Alpha),
                 visitor(Host, 600, A),
                 agent_send(A, last),
                 agent_result(A, Result, 60) )).

test(agent_that_came_before_is_not_let_in_again, Result == [none,Robot,1]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 redis_line(Redis, [hget, 'f:{lab}:parked', A], Parked),
                 redis_line(Redis, [hget, 'f:{lab}:parcels', A], [Parcel]),
                 peer_restart(robot),
                 wait_until(test_parking:nothing_is_left(Redis), 20),
                 parked_again(Redis, A, Robot, Parked, Parcel),
                 wait_until(test_parking:nothing_is_left(Redis), 20),
                 peer_do(robot, aggregate_all(count,
                                              typhon_agents:agent_on(A, _), 1)),
                 agent_send(A, last),
                 agent_result(A, Result, 60) )).

test(damaged_agents_return_and_delay_no_other, Result == [none,Robot,1]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 findall(A-Damage,
                         ( damage(Damage), visitor(Robot, 600, A) ), Damaged),
                 pairs_keys(Damaged, As),
                 gone(As),
                 visitor(Robot, 600, B),
                 gone([B|As]),
                 forall(member(A-Damage, Damaged),
                        redis_line(Redis, [hset, 'f:{lab}:parcels', A, Damage],
                                   _)),
                 peer_restart(robot),
                 agent_send(B, last),
                 agent_result(B, Result, 60),
                 capturing(wait_until(test_parking:returned(As), 30), _) )).

damage('parcel(').
damage('x.').
damage('').
damage('parcel(a,b,image(a,b,c,d,e,f,g),x-y,p).').

test(damaged_letter_delays_no_other, Result == [none,Robot,1,hello]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 atomic_list_concat([_,Endpoint], @, Robot),
                 atom_concat('f:{lab}:park:', Endpoint, Key),
                 forall(member(Text, ['[', '[mail(_,_,_)].', 'mail(a,b,c).']),
                        redis_line(Redis, [xadd, Key, *, mail, Text, id, A, text,
                                           Text],
                                   _)),
                 agent_send(A, hello),
                 agent_send(A, last),
                 peer_restart(robot),
                 agent_result(A, Result, 60) )).

test(agent_waits_until_its_host_is_started, Result == [none,Arm,1,hello]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_do(robot, host_start(arm, [fleet(lab)])),
                 atomic_list_concat([_,Endpoint], @, Robot),
                 atomic_list_concat([arm,Endpoint], @, Arm),
                 peer_kill(robot),
                 visitor(Arm, 600, A),
                 visitor(Robot, 600, B),
                 gone([A,B]),
                 agent_send(A, hello),
                 peer_restart(robot),
                 agent_send(B, last),
                 results([B], [_]),
                 parked([A]),
                 peer_do(robot, host_start(arm, [fleet(lab)])),
                 wait_until(test_parking:nothing_is_left(Redis), 20),
                 agent_send(A, last),
                 agent_result(A, Result, 60) )).

test(beyond_the_bounds_no_agent_waits) :-
    with_robot([fsync(always)], [], _, Robot,
               ( peer_kill(robot),
                 forall(member(Bound, [ typhon_fleet:parked_items=1,
                                        typhon_fleet:parked_bytes=10,
                                        typhon_fleet:parcel_bytes=10 ]),
                        with_settings([Bound], beyond(Bound, Robot))) )).

beyond(Bound, Robot) :-
    visitor(Robot, 600, A),
    ( Bound = (_=1) -> gone([A]) ; true ),
    visitor(Robot, 600, B),
    agent_send(B, last),
    agent_result(B, [Error|_], 60),
    assertion(Error == host_unreachable(Robot)),
    (   Bound = (_=1)
    ->  kept_out(A)
    ;   agent_send(A, last),
        agent_result(A, _, 60)
    ).

:- end_tests(parking).

:- begin_tests(parking_mail).

test(mail_for_an_agent_whose_host_is_away_arrives_in_order,
     Result == [none,Robot,1,1,2,3]) :-
    resident(Redis, Robot, A,
             ( peer_kill(robot),
               no_connection(Robot),
               send_all([A], [1,2,3,last]),
               peer_restart(robot),
               agent_result(A, Result, 60),
               wait_until(test_parking:nothing_is_left(Redis), 10) )).

test(mail_of_a_process_with_a_journal_arrives_in_order,
     Result == [[1,2,3]]) :-
    with_tmp_dir(Dir, journaled_mail(Dir, Result)).

test(mail_is_kept_while_the_engine_does_not_answer,
     Result == [none,Robot,1,1,2,3]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 agent_send(A, 1),
                 redis_signal(Redis, stop),
                 agent_send(A, 2),
                 agent_send(A, 3),
                 redis_signal(Redis, cont),
                 wait_until(test_parking:letters(Redis, Robot, 4), 30),
                 agent_send(A, last),
                 peer_restart(robot),
                 agent_result(A, Result, 60) )).

%   Else a thread would ask all the time, as long as an engine answers one
%   question, and not the other.

test(letter_that_an_engine_did_not_take_is_sent_later,
     [ setup(( flag(test_parking_asked, _, 0),
               wrap_predicate(typhon_parking:letter_asked(_, _, _, _, Answer),
                              unanswered, _,
                              ( flag(test_parking_asked, N, N+1),
                                ( N < 3 -> Answer = unknown
                                ; Answer = none ) )) )),
       cleanup(unwrap_predicate(typhon_parking:letter_asked/5, unanswered)),
       Asked == 1 ]) :-
    with_hosts([alpha],
               setup_call_cleanup(
                   assertz(typhon_parking:letter(nobody, 1,
                                                 letter('', [], none))),
                   typhon_parking:letters_sent(nobody),
                   retractall(typhon_parking:letter(nobody, _, _)))),
    flag(test_parking_asked, Asked, Asked).

test(mail_for_an_agent_that_the_engine_does_not_know_is_an_error,
     error(host_unreachable(_))) :-
    free_port(Port),
    format(atom(Id), 'none.b7b4qcym.1@nowhere@127.0.0.1:~d', [Port]),
    with_fleet([], _, [alpha-[]], agent_send(Id, one)).

test(mail_for_an_agent_that_ended_elsewhere_is_an_error,
     error(host_unreachable(_))) :-
    free_port(Port),
    format(atom(Id), 'none.b7b4qcym.1@nowhere@127.0.0.1:~d', [Port]),
    with_fleet([], _, [alpha-[]],
               ( typhon_engine:engine_script(lab, where, [Id,1,'b@x:1'], _),
                 typhon_engine:engine_script(lab, ends, [9,Id,done], _),
                 agent_send(Id, one) )).

test(letters_that_an_engine_has_lost_are_sent_again,
     Result == [none,Robot,1,1,2,3]) :-
    with_robot([], [], Redis, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 with_settings([typhon_fleet:sure_seconds=600],
                               forgets(Redis, send_all([A], [1,2]))),
                 send_all([A], [3,last]),
                 wait_until(test_parking:letters(Redis, Robot, 5), 30),
                 wait_until(\+ typhon_parking:letter(A, _, _), 30),
                 peer_restart(robot),
                 agent_result(A, Result, 60) )).

test(where_senders_are_checked_messages_of_agents_are_not_kept) :-
    with_robot([fsync(always)], [], _, Robot,
               ( peer_kill(robot),
                 visitor(Robot, 600, A),
                 gone([A]),
                 setup_call_cleanup(
                     typhon_travel:senders_check(true),
                     ( assertion(\+ typhon_mail:mail_kept(none, A,
                                                          [mail(none,A,1)])),
                       assertion(typhon_mail:mail_kept(none, A,
                                                       [mail(none,user,1)])) ),
                     typhon_travel:senders_check(false)) )).

:- end_tests(parking_mail).

:- begin_tests(parking_faults).

%   Of an engine that may lose its last second.

test(agent_is_parked_again_in_an_engine_that_came_back_empty,
     Result == [none,Robot,1]) :-
    with_robot([], [], Redis, Robot,
               ( peer_kill(robot),
                 with_settings([typhon_fleet:sure_seconds=600],
                               ( visitor(Robot, 600, A),
                                 await_parked([A]),
                                 wait_until(test_parking:alarm(A, _), 30) )),
                 assertion(typhon_agents:agent_on(A, _)),
                 redis_signal(Redis, kill),
                 Redis = redis(_, Dir, _),
                 directory_file_path(Dir, appendonlydir, Data),
                 delete_directory_and_contents(Data),
                 redis_restart(Redis),
                 source_looks(A),
                 gone([A]),
                 peer_restart(robot),
                 agent_send(A, last),
                 agent_result(A, Result, 60) )).

test(agent_waits_for_an_engine_that_does_not_answer,
     [ forall(member(Away-Back, [stop-cont, kill-start])),
       Result == [none,Robot,1] ]) :-
    with_robot([], [], Redis, Robot,
               ( peer_kill(robot),
                 redis_signal(Redis, Away),
                 visitor(Robot, 600, A),
                 agent_send(A, last),
                 wait_until(typhon_engine:down(lab, _, _), 20),
                 ( Back == cont -> redis_signal(Redis, cont)
                 ; redis_restart(Redis) ),
                 gone([A]),
                 peer_restart(robot),
                 agent_result(A, Result, 60) )).

%   The move itself is shown as `true`.

test(goals_of_an_agent_that_waits_are_those_after_its_move, Move == true) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( peer_kill(robot),
                 redis_signal(Redis, stop),
                 visitor(Robot, 600, A),
                 wait_until(agent_property(A, state(in_doubt)), 30),
                 agent_property(A, goals([catch((Move,_), _, _)|_])),
                 redis_signal(Redis, cont),
                 gone([A]),
                 peer_restart(robot),
                 agent_send(A, last),
                 agent_result(A, _, 60) )).

test(time_that_is_over_while_the_engine_is_suspended_ends_the_wait_once,
     Result == [host_unreachable(Robot),Alpha]) :-
    with_robot([], [], Redis, Robot,
               ( peer_kill(robot),
                 address(alpha, Alpha),
                 redis_signal(Redis, stop),
                 visitor(Robot, 0.5, A),
                 agent_send(A, last),
                 wait_until(typhon_engine:down(lab, _, _), 20),
                 redis_signal(Redis, cont),
                 agent_result(A, [Error,Here|_], 60),
                 Result = [Error,Here],
                 wait_until(test_parking:nothing_is_left(Redis), 20) )).

test(agent_arrives_though_its_source_was_killed, Got == [none-Robot]) :-
    base([], [], 600, Redis, Robot,
         ( peer_kill(base),
           peer_restart(robot),
           wait_until(test_parking:nothing_is_left(Redis), 30),
           arrived(robot) ),
         Got).

test(home_knows_where_an_agent_is_parked,
     Outcome-Result == timeout-[Robot,1]) :-
    with_robot([fsync(always)], [], Redis, Robot,
               ( member_spec(Redis, base, [lease(1),fsync(always)], [], Spec),
                 with_more_peers([Spec],
                     ( meets(Robot),
                       peer_kill(robot),
                       wait_until(test_parking:misses(Robot), 30),
                       peer_host(base, Base),
                       create([ (main :- move(Base), move(Robot, [wait(600)]),
                                         here(Here), receive(_-M),
                                         result([Here,M])) ],
                              A, [host(alpha)]),
                       wait_until(test_parking:parked([A]), 20),
                       wait_until(typhon_travel:whereabouts(A, Robot), 20),
                       peer_kill(base),
                       agent_join(A, Outcome, 0.5),
                       agent_send(A, 1),
                       peer_restart(robot),
                       agent_result(A, Result, 60) )) )).

test(agent_whose_time_is_over_waits_for_its_source,
     Got == [host_unreachable(Robot)-Base]) :-
    base([], [], 600, Redis, Robot,
         ( peer_host(base, Base),
           peer_kill(base),
           parked([A]),
           time_is_over(Redis, A),
           wait_until(test_parking:returns(Base), 30),
           peer_restart(base),
           wait_until(peer_do(base, agents_here([_])), 30),
           arrived(base) ),
         Got).

test(agent_arrives_once_though_both_processes_were_killed,
     Got == [none-Robot]) :-
    with_tmp_dir(Dir1, with_tmp_dir(Dir2,
        base([journal(Dir1)], [journal(Dir2)], 600, Redis, Robot,
             ( peer_kill(base),
               peer_restart(robot),
               wait_until(test_parking:nothing_is_left(Redis), 30),
               arrived(robot),
               peer_kill(robot),
               peer_restart(base),
               peer_restart(robot),
               arrived(robot),
               assertion(peer_do(base, agents_here([]))) ),
             Got))).

test(host_that_is_killed_while_it_takes_agents_has_each_once) :-
    with_tmp_dir(Dir,
        with_robot([fsync(always)], [journal(Dir)], Redis, Robot,
                   killed_while_it_takes(Redis, Robot))).

:- end_tests(parking_faults).
