:- module(allocation_sequence,
          [ sequence_allocate/7         % +Name, +Teams, +Host, +Tasks,
                                        % +Options, -Robots, -Outcome
          ]).
:- use_module('../../prolog/typhon',
              [ agent_dispose/1, agent_join/3, agent_property/2,
                agent_send/2, remote/2 ]).
:- use_module('../population/operator', [population_start/5]).
:- use_module(operator, [allocation_stage/3, robot_status/2, task_allocate/4]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [last/2]).
:- use_module(library(option), [option/3]).

:- meta_predicate wait_for(+, 0, -).

/** <module> A sequence of tasks on the robots that an allocator has found

Chapters 7 and 6 of the thesis together: an allocator finds and reserves the
robots, and holds them, while agents whose number regulates itself have them
execute a sequence of tasks in step.  Then it lets them go.

*Threading*: any thread, which waits; no state.
*/

%!  sequence_allocate(+Name, +Teams, +Host, +Tasks:list(pair), +Options,
%!                    -Robots:list(atom), -Outcome) is det.
%
%   Robots, the hosts of the robots that Teams require, execute Tasks, pairs
%   Task-Goal, in order.  An allocator is released at Host; the sequence has
%   its Name.  Outcome is `completed`, or `missed` if that is not done by
%   the deadline; then Robots are those that had begun, or none.
%   Options:
%
%     - deadline(Seconds)
%       Default 600 seconds of host time.  If the caller dies meanwhile, the
%       robots are held so long and no longer.
%     - priority(Number)
%     - allocation(Options), population(Options)
%       For task_allocate/4 and population_start/5.
%
%   A robot that fails in the middle of the sequence is replaced for the
%   task, but the sequence is not extended to the new one.
%
%   @error errors of task_allocate/4 and population_start/5, after which
%   the robots free themselves

sequence_allocate(Name, Teams, Host, Tasks, Options, Robots, Outcome) :-
    must_be(list(pair), Tasks),
    last(Tasks, Last-_),
    option(deadline(Deadline), Options, 600),
    option(priority(Priority), Options, 0),
    option(allocation(Allocation), Options, []),
    option(population(Population), Options, []),
    task_allocate(task(Name, Teams,
                       [ deadline(Deadline), priority(Priority),
                         goal(receive(_-finish)) ]),
                  Host, Allocation, Agent),
    catch(conduct(Agent, Name, Tasks, Population, Last, Robots, Outcome),
          Error,
          ( catch(agent_dispose(Agent), error(_, _), true),
            throw(Error) )).

conduct(Agent, Name, Tasks, Options, Last, Robots, Outcome) :-
    wait_for(Agent, held(Agent, Name, Robots0), Found),
    (   Found == true
    ->  Robots = Robots0,
        setup_call_cleanup(
            population_start(Name, Robots, Tasks, Options, Agents),
            wait_for(Agent, maplist(completed(Name, Last), Robots), Done),
            maplist(dismiss, Agents))
    ;   Robots = [],
        Done = false
    ),
    conclude(Done, Agent, Outcome).

conclude(true, Agent, Outcome) :-
    !,
    catch(agent_send(Agent, finish), error(_, _), true),
    agent_join(Agent, _, inf),
    Outcome = completed.
conclude(false, _, missed).

%   wait_for(+Agent, :Goal, -Result): `true` as soon as Goal is, `false` if
%   Agent has ended before.

wait_for(Agent, Goal, Result) :-
    (   call(Goal)
    ->  Result = true
    ;   catch(agent_property(Agent, host(_)), error(_, _), fail)
    ->  sleep(0.1),
        wait_for(Agent, Goal, Result)
    ;   Result = false
    ).

%   All robots have answered that they hold the task.

held(Agent, Name, Robots) :-
    allocation_stage(Agent, executing, Robots),
    maplist(executing(Agent, Name), Robots).

executing(Agent, Name, Host) :-
    catch(robot_status(Host, executing(Agent, Name)), error(_, _), fail).

completed(Name, Task, Host) :-
    catch(remote(Host, sense(task(Name, Task, completed, _))),
          error(_, _), fail).

%   Clones of it die by themselves when there is nothing to do.

dismiss(Agent) :-
    catch(agent_dispose(Agent), error(_, _), true).
