:- module(allocation_operator,
          [ robot_start/3,              % +Host, +Properties, +Options
            robot_state/2,              % +Host, +State
            robot_fail/1,               % +Host
            robot_repair/1,             % +Host
            robot_status/2,             % +Host, -Status
            task_allocate/4,            % +Task, +Host, +Options, -Agent
            allocation_stage/3          % +Agent, -Stage, -Robots
          ]).
:- use_module('../../prolog/typhon',
              [agent_create/3, agent_property/2, agent_send/2, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../../prolog/typhon/kernel/program/paths', []).
:- use_module('../lib/settings', [setting_facts/3]).
:- use_module(tasks, [check_task/1]).
:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(option), [option/3]).

/** <module> Allocating tasks to robots, for users and programs

Puts the static agents of robots on hosts, and releases allocators (thesis
chapter 7).  Hosts are addresses, so these predicates work from any process
with the cookie, also if another process started the hosts.  A host has at most
one robot; its address names the robot.

A task is task(Name, Teams, Details).  Teams are pairs Count-Requirements;
requirements and the properties of robots are described in
common/requirements.pl.  Details is a list of optional terms:

  - priority(Number)
    Default 0.  A task of greater priority takes over robots that are reserved
    for another task but not executing it yet.
  - deadline(Seconds)
    Counted from the start of the allocator.  After it the allocator reports
    the task as missed and releases all its robots.
  - duration(Seconds), goal(Goal)
    What each robot executes; default sleep(Seconds), of 5 seconds.
  - terms that the payloads for cost and negotiation read

*Threading*: any thread; no state.
*/

:- multifile
    agent_settings:takes/4,
    typhon_options:declared/4.

typhon_options:declared(robot_option, cost(X), ground, X).
typhon_options:declared(robot_option, settings(X), list, X).
typhon_options:declared(task_option, negotiation(X), ground, X).
typhon_options:declared(task_option, settings(X), list, X).
typhon_options:declared(task_option, name(X), atom, X).

agent_settings:takes(robot_start, [agents(allocation/robot)], [], refused).
agent_settings:takes(task_allocate, [agents(allocation/allocator)], [], refused).

%!  robot_start(+Host, +Properties:list, +Options) is det.
%
%   Puts a robot with Properties on Host, if Host has none.  Options:
%
%     - cost(Payload)
%       Computes the cost of a task: default payloads(allocation/nearest).
%     - settings(Pairs)
%       Name-Value, to replace the defaults in robot.pl.
%
%   @error existence_error(host, Host), host_unreachable(Host)
%   @error domain_error(robot_option, Option), domain_error(setting, X)

robot_start(Host, Properties, Options) :-
    must_be(list(ground), Properties),
    check_options(robot_option, Options),
    setting_facts(robot_start, Options, Settings),
    (   remote(Host, sense(robot(_)))
    ->  true
    ;   create_robot(Host, Properties, Settings, Options)
    ).

create_robot(Host, Properties, Settings, Options) :-
    option(cost(Payload), Options, payloads(allocation/nearest)),
    findall(Fact,
            ( member(Property, Properties), Fact = property(Property)
            ; member(Fact, Settings) ),
            Facts),
    agent_create(agents(allocation/robot), Robot,
                 [ host(Host), static(true), payloads([Payload]),
                   facts(Facts) ]),
    remote(Host, leave(robot(Robot))).

%!  robot_state(+Host, +State) is det.
%!  robot_fail(+Host) is det.
%!  robot_repair(+Host) is det.
%
%   robot_state/2 sets the state Name=Value of the robot at Host.
%   robot_fail/1 makes the robot fail: its reservation ends, and it refuses
%   all tasks until robot_repair/1.
%
%   @error existence_error(robot, Host)

robot_state(Host, Name=Value) :-
    must_be(ground, Name=Value),
    order(Host, state(Name=Value)).

robot_fail(Host) :-
    order(Host, fail).

robot_repair(Host) :-
    order(Host, repair).

order(Host, Order) :-
    robot(Host, Robot),
    agent_send(Robot, Order).

robot(Host, Robot) :-
    (   remote(Host, sense(robot(Robot0)))
    ->  Robot = Robot0
    ;   existence_error(robot, Host)
    ).

%!  robot_status(+Host, -Status) is det.
%
%   Status is `failed`, `free`, reserved(Owner, Task), executing(Owner, Task)
%   or done(Owner, Task); Owner is the allocator.
%
%   @error existence_error(robot, Host)

robot_status(Host, Status) :-
    robot(Host, Robot),
    (   agent_property(Robot, facts(Facts))
    ->  status(Facts, Status)
    ;   existence_error(robot, Host)
    ).

status(Facts, Status) :-
    memberchk(hold(_, Owner, need(Task, _, _), _, Phase), Facts),
    !,
    functor(Phase, Name, _),            % reserved, executing, done
    Status =.. [Name, Owner, Task].
status(Facts, failed) :-
    memberchk(failed, Facts),
    !.
status(_, free).

%!  task_allocate(+Task, +Host, +Options, -Agent) is det.
%
%   Creates Agent, an allocator, at Host.  Agent allocates Task, has it
%   executed, and ends.  Options:
%
%     - negotiation(Payload)
%       Decides which robots Agent reserves: default
%       payloads(allocation/willing).
%     - settings(Pairs)
%       Name-Value, to replace the defaults in allocator.pl.  With
%       start-order Agent waits for the message `begin`.
%     - name(Name)
%       The id of Agent begins with Name.
%
%   @error domain_error(task_option, Option)
%   @error type_error(task, Task), domain_error(setting, X)
%   @error existence_error(host, Host), host_unreachable(Host)

task_allocate(Task, Host, Options, Agent) :-
    check_task(Task),
    check_options(task_option, Options),
    setting_facts(task_allocate, Options, Settings),
    option(negotiation(Payload), Options, payloads(allocation/willing)),
    option(name(Name), Options, allocator),
    agent_create(agents(allocation/allocator), Agent,
                 [ name(Name), host(Host), payloads([Payload]),
                   facts([Task|Settings]) ]).

%!  allocation_stage(+Agent, -Stage, -Robots:list(atom)) is semidet.
%
%   Stage is the stage of the allocator Agent, `waiting`, `searching`,
%   `resting` or `executing`, and Robots are the hosts of the robots it holds.
%   Fails when Agent has ended.

allocation_stage(Agent, Stage, Robots) :-
    agent_property(Agent, facts(Facts)),
    memberchk(stage(Stage0), Facts),
    Stage = Stage0,
    findall(Host, member(held(Host, _, _, _, _), Facts), Robots).
