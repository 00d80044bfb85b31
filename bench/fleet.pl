:- use_module(common).
:- use_module(spent).
:- use_module('../experiments/engine/numbers', [median/2]).
:- use_module('../test/lib/redis', [redis_address/2, with_redis/2]).
:- use_module(library(typhon)).
:- use_module(library(typhon/options/fleet/engine),
              [engine/3, engine_script/4]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/3, member/2, nth1/3, numlist/3]).
:- use_module(library(thread), [concurrent_forall/3]).

/*  What a fleet costs: a hop between two processes of a fleet against one
    between two processes without; processes that join; a process that is idle;
    the engine, with the beats and reports of many processes, sent by one; and a
    thousand hosts with a modelled engine, in virtual time.

    Pairs alternate in one run: compare their ratios on a busy machine.

    swipl bench/fleet.pl -- all
    swipl bench/fleet.pl -- hop|join|idle|engine|modelled */

:- initialization(main, main).

main([modelled]) :-
    !,
    modelled.
main([What]) :-
    with_redis(Redis, in_fleet(Redis, measure(What))).

:- meta_predicate in_fleet(+, 0).

in_fleet(Redis, Goal) :-
    redis_address(Redis, Address),
    setup_call_cleanup(fleet_join(bench, [redis(Address)]),
                       once(Goal),
                       fleet_leave(bench)).

measure(all) :-
    forall(part(_, Goal), call(Goal)).
measure(What) :-
    forall(part(What, Goal), call(Goal)).

part(hop, hop).
part(join, join(64)).
part(idle, idle).
part(engine, engine).
part(modelled, modelled).

:- meta_predicate in_network(+, +, -, 0).

%   in_network(+Processes, +Options, -Hosts, :Goal): one host in each process.

in_network(Processes, Options, Hosts, Goal) :-
    setup_call_cleanup(
        network_start(ring(Processes), Network, [processes(Processes)|Options]),
        ( network_property(Network, hosts(Hosts)), once(Goal) ),
        network_stop(Network)).

                /*******************************
                *             HOPS             *
                *******************************/

hop :-
    in_network(2, [fleet(bench)], Members,
               in_network(2, [], Others, compare_hops(Members, Others))).

compare_hops(Members, Others) :-
    rounds(4, Members, _, _),           % warm up
    rounds(4, Others, _, _),
    findall(Pair,
            ( between(1, 20, _), hop_pair(Members, Others, Pair) ),
            Pairs),
    medians('a hop in a fleet, inferences', Pairs, pair(A, B, _, _), A, B,
            inferences),
    medians('a hop in a fleet, processor time', Pairs, pair(_, _, A1, B1),
            A1, B1, us).

hop_pair(Members, Others, pair(A, B, CpuA, CpuB)) :-
    rounds(200, Others, B, CpuB),
    rounds(200, Members, A, CpuA).

%   rounds(+Count, +Hosts, -Inferences, -Cpu): of a hop of ten agents.

rounds(Count, Hosts, Inferences, Cpu) :-
    inferences(Hosts, Before),
    spent(Hosts, back_and_forth(Count, Hosts), Hops, Cpu),
    inferences(Hosts, After),
    Inferences is (After-Before)/Hops.

back_and_forth(Count, [Here,There]) :-
    Program = clauses([ (:- agent(bouncer, [state([left/1])])),
                        (main :- left(0), !),
                        (main :- retract(left(N)), N1 is N-1, assertz(left(N1)),
                                 other(P), move(P), home(H), move(H), main),
                        other(There) ]),
    findall(Agent,
            ( between(1, 10, _),
              agent_create(Program, Agent,
                           [host(Here), facts([left(Count)])]) ),
            Agents),
    forall(member(Agent, Agents), agent_join(Agent, done, 300)).

inferences(Hosts, Sum) :-
    aggregate_all(sum(N),
                  ( member(Host, Hosts),
                    remote(Host,
                           aggregate_all(
                               sum(I),
                               ( thread_property(T, status(running)),
                                 catch(thread_statistics(T, inferences, I),
                                       error(_, _), fail) ),
                               N)) ),
                  Sum).

%   medians(+Name, +Pairs, +Pair, A, B, +Unit): the median of A/B.

medians(Name, Pairs, Pair, A, B, Unit) :-
    findall(A-B, member(Pair, Pairs), Both),
    findall(R, ( member(X-Y, Both), R is X/Y ), Ratios),
    findall(X, member(X-_, Both), Xs),
    findall(Y, member(_-Y, Both), Ys),
    median(Ratios, Ratio),
    median(Xs, MedianX),
    median(Ys, MedianY),
    format(atom(Note), '~4g ~w against ~4g (without a fleet)',
           [MedianX, Unit, MedianY]),
    figure(Name, Ratio, times, Note).

                /*******************************
                *             JOIN             *
                *******************************/

join(Processes) :-
    findall(pair(A, B),
            ( between(1, 3, _),
              started(Processes, [], B),
              started(Processes, [fleet(bench)], A) ),
            Pairs),
    format(atom(Name), '~w processes start and join, wall', [Processes]),
    medians(Name, Pairs, pair(wall(A1,_), wall(B1,_)), A1, B1, s),
    format(atom(Name2), '~w processes start and join, processor time',
           [Processes]),
    medians(Name2, Pairs, pair(wall(_,A2), wall(_,B2)), A2, B2, s).

%   With a fleet all hosts are known in it when network_start/3 returns.

started(Processes, Options, wall(Seconds, Cpu)) :-
    get_time(T0),
    in_network(Processes, Options, Hosts,
               ( get_time(T1),
                 Seconds is T1-T0,
                 aggregate_all(sum(S),
                               ( member(Host, Hosts),
                                 remote(Host, statistics(process_cputime, S)) ),
                               Cpu),
                 all_known(Options, Processes) )).

all_known([], _).
all_known([fleet(Fleet)], Count) :-
    fleet_hosts(Fleet, Hosts, [state(up)]),
    length(Hosts, Count).

                /*******************************
                *         IDLE PROCESSES       *
                *******************************/

idle :-
    forall(member(Agents, [0, 1000, 10000]),
           in_network(1, [fleet(bench)], [Host], idle(Agents, Host))).

idle(Agents, Host) :-
    Program = clauses([ (:- agent(waits, [])), (main :- receive(_), main) ]),
    forall(between(1, Agents, _), agent_create(Program, _, [host(Host)])),
    remote(Host, sleep(5)),             % the first report
    thread_seconds(Host, Before),
    remote(Host, sleep(10)),
    thread_seconds(Host, After),
    format(atom(Name), 'thread of a fleet, idle process of ~D agents',
           [Agents]),
    figure(Name, 1000*(After-Before)/10, 'ms of processor per second').

thread_seconds(Host, Seconds) :-
    remote(Host,
           ( thread_property(Thread, alias(Alias)),
             sub_atom(Alias, 0, _, _, typhon_fleet_),
             thread_statistics(Thread, cputime, Seconds) )).

                /*******************************
                *          THE ENGINE          *
                *******************************/

engine :-
    engine(1000, 100000, 10000, 10, 16),
    engine(1000, 100000, 10000, 10, 1),
    engine(1000, 0, 0, 10, 16).

%   engine(+Processes, +Agents, +Moves, +Seconds, +Threads): the scripts that so
%   many processes call in so many seconds, by Threads connections, as fast as
%   may be. One at a time each call is on the disk before the next is made. The
%   leases are long, so that none lapses on a slow machine.

engine(Processes, Agents, Moves, Seconds, Threads) :-
    numlist(1, Processes, All),
    Each is Agents//Processes,
    Moved is Moves//Processes,
    of_all(Threads, All, ( beats(1, I, Each), reports(I, Each, 0) ), I),
    engine_spent(Cpu0, _),
    get_time(Start),
    forall(between(1, Seconds, Second),
           ( Load is Each + Second mod 2,
             of_all(Threads, All,
                    ( beats(0, I, Load), reports(I, Moved, Second) ), I) )),
    get_time(End),
    engine_spent(Cpu1, Bytes),
    format(atom(Name),
           'engine: ~D processes, ~D agents, ~D moves/s, ~w at once',
           [Processes, Agents, Moves, Threads]),
    Real is End-Start,
    format(atom(Note), 'of a processor; took ~1f s for ~w', [Real, Seconds]),
    figure(Name, 100*(Cpu1-Cpu0)/Seconds, '%', Note),
    figure('memory of the engine', Bytes, byte).

:- meta_predicate of_all(+, +, 0, -).

of_all(Threads, All, Goal, I) :-
    concurrent_forall(member(I, All), Goal, [threads(Threads)]).

beats(First, I, Load) :-
    modelled(I, Host, Endpoint),
    engine_script(bench, beat,
                  [ Endpoint, I, 600000, First, Endpoint, I, '', '', 0,
                    Host, Load, 2, robot, camera ],
                  [_|_]).

%   Agents of a process have homes in many others.

reports(_, 0, _) :-
    !.
reports(I, Moved, Hops) :-
    modelled(I, Host, _),
    findall(Arg,
            ( between(1, Moved, J),
              Home is (I*37+J*101) mod 1000 + 1,
              modelled(Home, Other, _),
              format(atom(Id), 'walker.abcdefgh.~w-~w@~w', [I,J,Other]),
              member(Arg, [Id, Hops, Host]) ),
            Args),
    engine_script(bench, where, Args, _).

modelled(I, Host, Endpoint) :-
    format(atom(Endpoint), '10.0.~w.~w:9700', [I, I]),
    atom_concat('h@', Endpoint, Host).

engine_spent(Seconds, Bytes) :-
    engine(bench, info(everything), Text),
    value(Text, "used_cpu_user_main_thread", User),
    value(Text, "used_cpu_sys_main_thread", System),
    value(Text, "used_memory", Bytes),
    Seconds is User+System.

value(Text, Key, Value) :-
    split_string(Text, "\n", "\r", Lines),
    member(Line, Lines),
    split_string(Line, ":", "", [Key,Value0]),
    !,
    number_string(Value, Value0).

                /*******************************
                *      THE MODELLED ENGINE     *
                *******************************/

%   A thousand hosts in virtual time, for five minutes after the first: idle,
%   and with a thousand agents that go to and fro between two hosts each, six
%   times a minute. In the last row every third host is away for half of
%   these.

modelled :-
    setup_call_cleanup(
        fleet_join(model, [engine(modelled), lease(60), report(10)]),
        forall(( case(Name, Fleet, Agents, Away),
                 thousand(Fleet, Agents, Away, Spent) ),
               spent_figure(Name, Spent)),
        fleet_leave(model)).

case('1,000 hosts, idle, in a fleet', [fleet(model)], 0, none).
case('the same with 1,000 agents, without a fleet', [], 1000, none).
case('the same in a fleet', [fleet(model)], 1000, none).
case('the same, a third of the hosts away', [fleet(model)], 1000, third).

spent_figure(Name, spent(Cpu, Inferences, Parked)) :-
    Millions is Inferences/1.0e6,
    format(atom(Note), '~1f million inferences; parked: ~D',
           [Millions, Parked]),
    figure(Name, Cpu, s, Note).

%   thousand(+Fleet, +Agents, +Away, -Spent): what five minutes cost.

thousand(Fleet, Agents, Away, spent(Cpu, Inferences, Parked)) :-
    setup_call_cleanup(
        network_start(ring(1000), Network, [clock(virtual), seed(1)|Fleet]),
        ( network_property(Network, hosts(Hosts)),
          goers(Agents, Hosts),
          network_advance(Network, 60),
          spent_until_now(Network, Cpu0, Inferences0),
          third_away(Away, Hosts, true),
          network_advance(Network, 150),
          fleet_parked(model, All),
          length(All, Parked),
          third_away(Away, Hosts, false),
          network_advance(Network, 150),
          spent_until_now(Network, Cpu1, Inferences1) ),
        network_stop(Network)),
    Cpu is Cpu1-Cpu0,
    Inferences is Inferences1-Inferences0.

%   Of the thread of virtual time.

spent_until_now(Network, Cpu, Inferences) :-
    message_queue_create(Queue),
    network_at(Network, 0,
               ( statistics(inferences, I),
                 thread_send_message(Queue, inferences(I)) )),
    network_advance(Network, 0.001),
    thread_get_message(Queue, inferences(Inferences)),
    message_queue_destroy(Queue),
    statistics(process_cputime, Cpu).

goers(Agents, Hosts) :-
    append(Hosts, Hosts, Twice),
    forall(( between(1, Agents, N), nth1(N, Twice, From), Next is N+1,
             nth1(Next, Twice, To) ),
           agent_create(clauses([ (:- agent(goer)),
                                  (main :- go(From, To)),
                                  (go(A, B) :- sleep(10),
                                               moved(B),
                                               go(B, A)),
                                  (moved(B) :- catch(move(B, [wait(inf)]),
                                                     error(_, _), true)) ]),
                        _, [host(From)])).

third_away(none, _, _).
third_away(third, Hosts, Away) :-
    forall(( nth1(N, Hosts, Host), N mod 3 =:= 0 ),
           host_change(Host, away(Away))).
