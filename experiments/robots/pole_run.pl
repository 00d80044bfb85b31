:- module(robots_pole_run,
          [ pole_run/4,                 % +Case, +Options, +Directory, -Result
            pole_result/5               % +Options, +Events, +Terms, +Run,
                                        % -Result
          ]).
:- use_module('../../prolog/typhon',
              [ agent_create/3, agent_join/3, agent_send/2,
                network_property/2, network_start/3, network_stop/1, remote/2
              ]).
:- use_module('../../prolog/typhon/program/paths', []).
:- use_module('../../agents/sync/operator', [sequence_start/5]).
:- use_module('../lib/follow', [new_lines/4]).
:- use_module('../lib/progress', [progress/4, progress_done/1]).
:- use_module('../sync/run', [sync_result/4]).
:- use_module(arena, [arena_ask/3]).
:- use_module(crew, [crew_join/2, crew_services/1, crew_task/3]).
:- use_module(pole_metrics, [pole_states/4]).
:- use_module(stage, [scene_file/2, stage/6]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/6, maplist/3]).
:- use_module('../../prolog/typhon/nxt/json', [json_read_dict/2]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, reverse/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> Four robots carry a pole, once

Four hosts in a ring, each in a process of its own, each with a robot in
the arena.  The robots are to execute the four tasks of the sequence.

*Threading*: one run at a time; it is the caller's thread that waits.  A
signal that raises an exception there ends the run: network and arena are
stopped.
*/

%   pole_task(?Number, ?Payload): the sequence of the thesis.

pole_task(1, payloads(robots/approach)).
pole_task(2, payloads(robots/lift)).
pole_task(3, payloads(robots/carry)).
pole_task(4, payloads(robots/release)).

%!  pole_run(+Case, +Options, +Directory, -Result) is det.
%
%   In the case `synchronised` agents that travel have the tasks executed
%   (thesis chapter 5); in the case `alone` each host executes them by
%   itself.  All of these Options are required:
%
%     - seed(S), clock(Rate), hop_time(Min-Max)
%       Of network_start/3; the arena has the same clock and seed.
%     - agents(N), delta(D)
%       That travel, and their penalty bias.
%     - limit(Real)
%       Real seconds after which nobody is waited for any longer.
%
%   In Directory are afterwards the logs events.pl and arena.pl, and the
%   moving picture arena.svg.  Result is that of pole_result/5.

pole_run(Case, Options, Directory, Result) :-
    stage(pole, [every(0.1)|Options], Directory,
          in_arena(Case, Options, Run), logs(Events, Terms), Wall),
    pole_result(Options, Events, Terms, [case(Case), wall(Wall)|Run],
                Result).

in_arena(Case, Options, Run, Log, Arena, Bricks) :-
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    crew_services(Services),
    length(Bricks, Count),
    setup_call_cleanup(
        network_start(ring(Count), Network,
                      [ processes(Count), clock(Rate), seed(Seed), log(Log),
                        hop_time(uniform(Min, Max)),
                        hosts([services(Services)])
                      ]),
        in_network(Case, Options, Network, Log, Arena, Bricks, Run),
        network_stop(Network)).

in_network(Case, Options, Network, Log, Arena, Bricks, Run) :-
    network_property(Network, hosts(Hosts)),
    pairs_values(Bricks, Ports),
    crew_join(Hosts, Ports),
    findall(Task, ( pole_task(N, Spec), crew_task(N, Spec, Task) ), Tasks),
    begin(Case, Hosts, Tasks, Options, Agents),
    await_all(Agents, watch(Log, Hosts, Arena), Options, Outcomes, Moments),
    tilt_limit(Limit),
    Run = [ hosts(Hosts), moments(Moments), outcomes(Outcomes),
            tilt_limit(Limit)
          ].

tilt_limit(Limit) :-
    scene_file(pole, File),
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        json_read_dict(In, Scene),
        close(In)),
    Limit = Scene.pole.limit.

begin(synchronised, Hosts, Tasks, Options, Agents) :-
    option(agents(Count), Options),
    option(seed(Seed), Options),
    option(delta(Delta), Options),
    sequence_start(pole, Hosts, Tasks,
                   [ agents(Count), seed(Seed), settings([delta-Delta]) ],
                   Agents).
begin(alone, Hosts, Tasks, _, Agents) :-
    maplist(create_alone(Tasks), Hosts, Agents),
    forall(member(Agent, Agents), agent_send(Agent, begin)).

create_alone(Tasks, Host, Agent) :-
    agent_create(agents(robots/alone), Agent,
                 [host(Host), facts([tasks(pole, Tasks)]), static(true)]).

                /*******************************
                *            WAITING           *
                *******************************/

%   Moments are pairs ArenaTime-HostTime, in order: what the clocks showed.
%   On a busy computer that of the arena may fall behind.

await_all(Agents, Watch, Options, Outcomes, Moments) :-
    option(limit(Limit), Options),
    get_time(Now),
    Deadline is Now + Limit,
    moment(Watch, First),
    call_cleanup(
        foldl(await(Watch, Deadline), Agents, Outcomes, [First], Reversed),
        progress_done(user_error)),
    reverse(Reversed, Moments).

await(Watch, Deadline, Agent, Outcome, Moments0, Moments) :-
    get_time(Now),
    Left is max(0, min(0.2, Deadline - Now)),
    agent_join(Agent, Outcome0, Left),
    show(Watch),
    moment(Watch, Moment),
    Moments1 = [Moment|Moments0],
    (   Outcome0 == timeout,
        Now < Deadline
    ->  await(Watch, Deadline, Agent, Outcome, Moments1, Moments)
    ;   Outcome = Outcome0,
        Moments = Moments1
    ).

moment(watch(_, [Host|_], Arena), ArenaTime-HostTime) :-
    remote(Host, now(HostTime)),
    arena_ask(Arena, time, time(ArenaTime)).

show(watch(Log, Hosts, _)) :-
    new_lines(Log, 0, _, Lines),
    aggregate_all(count,
                  ( member(Line, Lines),
                    sub_string(Line, _, _, _, "completed(pole,") ),
                  Done),
    aggregate_all(count, ( member(_, Hosts), pole_task(_, _) ), Total),
    Shown is min(Done, Total),
    progress(user_error, Shown, Total, executions).

                /*******************************
                *          EVALUATION          *
                *******************************/

%!  pole_result(+Options, +Events, +Terms, +Run, -Result) is det.
%
%   What the log of the network, Events, and that of the arena, Terms, say.
%   Run is a list of case(Case), wall(Seconds), hosts(List), outcomes(List)
%   of agent_join/3, tilt_limit(Degrees), beyond which the pole must not be
%   tilted, and moments(List) of pairs ArenaTime-HostTime, what the clocks
%   showed.  Result is Run, and that of sync_result/4, and
%
%     - states(List): see pole_states/4; the time begins with the first
%       agent, in all that is in Result

pole_result(Options, Events0, Terms, Run, Result) :-
    memberchk(hosts(Hosts), Run),
    memberchk(moments(Moments), Run),
    sort(1, @=<, Events0, Events),
    (   memberchk(event(Start, _, _, begun), Events)
    ->  true
    ;   Moments = [_-Start|_]
    ),
    aggregate_all(count, pole_task(_, _), Tasks),
    sync_result([tasks(Tasks), failure(none)|Options], Events, Hosts, Sync),
    pole_states(Terms, Moments, Start, States),
    append(Run, [states(States)|Sync], Result).
