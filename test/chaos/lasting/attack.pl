:- module(lasting_attack,
          [ lasting/2                   % +Options, -Report
          ]).

/** <module> Processes with journals are killed, again and again

Whenever processes die, no agent is lost and nothing is duplicated: each agent
ends once with the right count, the counts at the hosts agree with them, each
token exists once, each message has arrived once, and messages of a static
agent arrive in order.

*Threading*: the main thread.
*/

:- use_module(ends).
:- use_module(nodes).
:- use_module(verdict).
:- use_module('../../lib/common', [project_file/2]).
:- use_module('../../lib/redis', [with_redis/2]).
:- use_module('../../../prolog/typhon').
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [append/2, append/3, member/2, nth0/3]).
:- use_module(library(option), [option/2, option/3]).

%!  lasting(+Options, -Report) is det.
%
%   Options: dir(Dir), processes(N), agents(N), hops(N) of each, seed(Seed),
%   crash(P) at each step, power(P) for a power failure at a commit, for
%   sync(full) only, kill(Seconds) between faults from outside, most(N) faults,
%   sync(How), seconds(Limit), fleet(true) for journals in the engine of a
%   fleet.  Report is report(Facts, Wrong).

lasting(Options, report(Facts, Wrong)) :-
    option(seed(Seed), Options, 1),
    option(agents(Agents), Options, 6),
    option(hops(Each), Options, 100),
    set_random(seed(Seed)),
    get_time(Start),
    with_engine(Options, All,
                setup_call_cleanup(
                    host_start(driver),
                    with_nodes(All, Nodes, attacked(Nodes, All, Wrong), Told),
                    host_stop(driver))),
    get_time(End),
    Seconds is End-Start,
    Hops is Agents*Each,
    PerSecond is Hops/Seconds,
    Facts = [seconds(Seconds), hops(Hops), per_second(PerSecond)|Told].

:- meta_predicate with_engine(+, -, 0).

with_engine(Options, All, Goal) :-
    (   option(fleet(true), Options)
    ->  with_redis(Redis, ( All = [engine(Redis)|Options], call(Goal) ))
    ;   All = Options,
        once(Goal)
    ).

attacked(Nodes, Options, Wrong) :-
    option(agents(Agents), Options, 6),
    option(hops(Each), Options, 100),
    option(seconds(Limit), Options, 100),
    maplist(node_host, Nodes, Hosts),
    people(Hosts, Agents, Each, People),
    faults_begin(Options),
    all_end(People, Limit, _, _),
    faults_end,
    all_end(People, Limit, Deadline, Ends),    % what is late now is stuck
    catch(findall(W, wrong(People, Ends, Hosts, Each, Deadline, W), Wrong),
          Ball, true),
    evidence(Ball, Wrong, Ends, Nodes).

%   evidence(?Ball, +Wrong, +Ends, +Nodes): if anything is wrong, or does not
%   answer, the processes print their pending data.

evidence(Ball, Wrong, _, _) :-
    var(Ball),
    Wrong == [],
    !.
evidence(Ball, _, Ends, Nodes) :-
    forall(( member(Agent-End, Ends), End \== done ),
           format(user_error, '~w: ~p~n', [Agent, End])),
    nodes_check(Nodes),
    nodes_said(Nodes, Lines),
    forall(member(Line, Lines), format(user_error, '~w~n', [Line])),
    (   var(Ball)
    ->  true
    ;   throw(Ball)
    ).

                /*******************************
                *             WORK             *
                *******************************/

%   Agents are created before faults begin, because a creation without an
%   answer may have succeeded.

people(Hosts, Agents, Each, people(Hoppers, Porters, Talkers, Sinks)) :-
    findall(Sink, ( member(H, Hosts), begins(sink, H, [], Sink) ), Sinks),
    findall(A, ( between(1, Agents, I), hopper(I, Hosts, Sinks, Each, A) ),
            Hoppers),
    forall(( member(H, Hosts), between(1, 3, I) ),
           remote(H, leave_new(token(H-I)))),
    findall(A, ( member(H, Hosts), turned(H, Hosts, Route),
                 begins(porter, H, [todo(Each), route(Route)], A) ),
            Porters),
    findall(A, ( nth0(I, Hosts, H), length(Hosts, N),
                 J is (I+1) mod N, nth0(J, Sinks, Sink),
                 Words is min(Each, 200),
                 begins(talker, H, [todo(Words), sink(Sink)], A) ),
            Talkers).

hopper(I, Hosts, Sinks, Each, Agent) :-
    length(Hosts, Count),
    J is I mod Count,
    nth0(J, Hosts, Host),
    nth0(J, Sinks, Sink),
    turned(Host, Hosts, Route),
    begins(hopper, Host, [todo(Each), route(Route), sink(Sink)], Agent).

turned(Host, Hosts, Route) :-
    append(Before, [Host|After], Hosts),
    append(After, Before, Others),
    append(Others, [Host], Route),
    !.

begins(Name, Host, Facts, Agent) :-
    format(atom(Relative), 'test/chaos/lasting/agents/~w.pl', [Name]),
    project_file(Relative, File),
    agent_create(File, Agent, [host(Host), facts(Facts)]).

all_end(people(Hoppers, Porters, Talkers, _), Limit, Deadline, Ends) :-
    append([Hoppers, Porters, Talkers], All),
    get_time(Now),
    Deadline is Now+Limit,
    agents_end(All, Deadline, Ends).
