:- use_module(common).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/prng)).
:- use_module(library(apply), [foldl/6, maplist/3]).
:- use_module(library(lists), [max_list/2, member/2, min_list/2, nth0/3,
                               nth1/3, numlist/3, same_length/2,
                               sum_list/2]).

/*  Waiting times of requests: PherCon against conscientious and random agents.

    swipl bench/phercon.pl -- Runs

On a connected random network of mean degree 6 there is one agent for ten
hosts.  Agents move all the time, a hop takes about one second of host time, and
they serve the requests that they find at a host.  Requests arrive at random
hosts, one in 20 seconds for each agent on average; for PherCon they emit
a pheromone, once, with the default span and period.  In each of the Runs all
strategies have the same network, the same agents and the same requests.

Time is from the request to its service, in host seconds.  Hops are the hops
of the serving agent in this time. */

:- initialization(main, main).

%   size(Hosts, Rate): Rate host seconds per second, so that agents make 100 or
%   200 hops in a second.

size(50, 20).
size(200, 10).

requests(40).
interval(20).                   % host seconds between requests for one agent
warm_up(20).                    % host seconds before the first request

main([Argument]) :-
    atom_number(Argument, Runs),
    forall(size(Hosts, _), compare(Hosts, Runs)).

compare(Hosts, Runs) :-
    findall(Means,
            ( between(1, Runs, Seed),
              maplist(waited(Hosts, Seed),
                      [phercon(request(_)), conscientious, random], Means) ),
            Rows),
    forall(nth0(I, [phercon,conscientious,random], Strategy),
           absolute(Hosts, Strategy, I, Rows)),
    forall(nth1(I, [conscientious,random], Strategy),
           relative(Hosts, Strategy, I, Rows)).

absolute(Hosts, Strategy, I, Rows) :-
    column(I, Rows, Times, Hops),
    mean(Times, Time),
    mean(Hops, Hop),
    atomic_list_concat([Strategy, ', ', Hosts, ' hosts: time'], Name1),
    figure(Name1, Time, 'host s'),
    atomic_list_concat([Strategy, ', ', Hosts, ' hosts: hops'], Name2),
    figure(Name2, Hop, hops).

column(I, Rows, Times, Hops) :-
    findall(Time, ( member(Row, Rows), nth0(I, Row, Time-_) ), Times),
    findall(Hop, ( member(Row, Rows), nth0(I, Row, _-Hop) ), Hops).

%   The ratio of the means, and the least and the greatest ratio of a run.

relative(Hosts, Strategy, I, Rows) :-
    column(0, Rows, Mine, _),
    column(I, Rows, Theirs, _),
    mean(Mine, A),
    mean(Theirs, B),
    atomic_list_concat(['time of phercon to ', Strategy, ', ', Hosts,
                        ' hosts'], Name),
    ratio(Name, A, B, 'host s', Strategy),
    findall(Ratio, ( nth0(Run, Mine, X), nth0(Run, Theirs, Y),
                     Ratio is X/Y ), Ratios),
    min_list(Ratios, Least),
    max_list(Ratios, Most),
    atom_concat(Name, ', least', Name1),
    figure(Name1, Least, times),
    atom_concat(Name, ', most', Name2),
    figure(Name2, Most, times).

mean(Numbers, Mean) :-
    sum_list(Numbers, Sum),
    length(Numbers, Count),
    Mean is Sum/Count.

                /*******************************
                *            ONE RUN           *
                *******************************/

%   waited(+Hosts, +Seed, +Strategy, -Means): Time-Hops, means of a run.

waited(N, Seed, Strategy, Time-Hops) :-
    P is 6/(N - 1),
    size(N, Rate),
    setup_call_cleanup(
        network_start(random(N, P), Network,
                      [ seed(Seed), clock(Rate),
                        hop_time(uniform(0.9, 1.1)) ]),
        ( network_property(Network, hosts(Hosts)),
          serve(Hosts, Seed, Strategy, Served) ),
        network_stop(Network)),
    findall(T, member(T-_, Served), Times),
    findall(H, member(_-H, Served), Counts),
    mean(Times, Time),
    mean(Counts, Hops).

serve(Hosts, Seed, Strategy, Served) :-
    chance_seed(Seed, Chance0),
    length(Hosts, N),
    Count is N//10,
    server(Program),
    numlist(1, Count, Numbers),
    foldl(start(Program, Strategy, Hosts), Numbers, Agents,
          Chance0, Chance),
    warm_up(Pause),
    wait(N, Pause),
    requests(Requests),
    ask(Requests, Strategy, Hosts, Agents, Chance, Asked),
    all_served(600, Hosts, Asked, Served),
    forall(member(Agent, Agents), agent_dispose(Agent)).

%   The agent serves a request, if there is one, and moves on.

server(clauses(
    [ (:- agent(server, [state([strategy/1])])),
      (main :-
           serve,
           strategy(Strategy),
           next_host(Strategy, Next),
           move(Next),
           main),
      (serve :-
           take(request(I)),
           !,
           withdraw(request(I)),
           self(Me), hops(Hops), now(Time),
           leave(served(I, Me, Time, Hops)),
           serve),
      serve
    ])).

start(Program, Strategy, Hosts, _, Agent, Chance0, Chance) :-
    chance_member(Host, Hosts, Chance0, Chance),
    agent_create(Program, Agent,
                 [host(Host), name(server), facts([strategy(Strategy)])]).

%   ask(+Count, ..., -Asked): asked(I, Time, AgentHops) for each request.

ask(0, _, _, _, _, []) :-
    !.
ask(I, Strategy, Hosts, Agents, Chance0,
    [asked(I, Time, AgentHops)|Asked]) :-
    chance_float(Float, Chance0, Chance1),
    chance_member(Host, Hosts, Chance1, Chance),
    interval(Mean),
    length(Hosts, N),
    length(Agents, Count),
    Pause is -log(Float)*Mean/Count,
    wait(N, Pause),
    findall(Agent-Hops, ( member(Agent, Agents),
                          agent_property(Agent, hops(Hops)) ), AgentHops),
    call_for(Strategy, Host, I),
    remote(Host, ( now(Time), leave(request(I)) )),
    I1 is I - 1,
    ask(I1, Strategy, Hosts, Agents, Chance, Asked).

%   The pheromone is emitted before the request exists: otherwise an agent that
%   takes the request at once would withdraw it before it is emitted.

call_for(phercon(_), Host, I) :-
    !,
    remote(Host, emit(request(I))).
call_for(_, _, _).

wait(N, Seconds) :-
    size(N, Rate),
    Real is Seconds/Rate,
    sleep(Real).

%   all_served(+Tries, +Hosts, +Asked, -Served): Time-Hops for each request,
%   once all are served.  Fails after Tries tries.

all_served(Tries, Hosts, Asked, Served) :-
    Tries > 0,
    findall(Service, service(Hosts, Asked, Service), Services),
    (   same_length(Asked, Services)
    ->  Served = Services
    ;   sleep(0.2),
        Tries1 is Tries - 1,
        all_served(Tries1, Hosts, Asked, Served)
    ).

service(Hosts, Asked, Time-Hops) :-
    member(Host, Hosts),
    remote(Host, findall(Fact, sense(Fact), Facts)),
    member(served(I, Agent, Time1, Hops1), Facts),
    memberchk(asked(I, Time0, AgentHops), Asked),
    memberchk(Agent-Hops0, AgentHops),
    Time is Time1 - Time0,
    Hops is Hops1 - Hops0.
