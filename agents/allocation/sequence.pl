:- module(allocation_sequence,
          [ sequence_allocate/7,        % +Name, +Teams, +Host, +Tasks,
                                        % +Options, -Robots, -Outcome
            sequence_begin/6,           % +Name, +Teams, +Host, +Tasks,
                                        % +Options, -Sequence
            sequence_proceed/2,         % +Sequence0, -Sequence
            sequence_over/3             % +Sequence, -Robots, -Outcome
          ]).
:- use_module('../../prolog/typhon',
              [ agent_dispose/1, agent_join/3, agent_property/2,
                agent_send/2, remote/2 ]).
:- use_module('../../prolog/typhon/kernel/base/options', [check_options/2]).
:- use_module('../population/operator',
              [population_join/2, population_leave/2, population_start/5]).
:- use_module(operator, [allocation_stage/3, robot_status/2, task_allocate/4]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [last/2, subtract/3]).
:- use_module(library(option), [option/3]).

/** <module> A sequence of tasks on the robots that an allocator has found

Combines chapters 7 and 6 of the thesis: an allocator finds and reserves the
robots and holds them, while a self-regulating population of agents has them
execute a sequence of tasks in step.  Then the allocator releases the robots.

*Threading*: any thread, which waits; no state.
*/

:- multifile typhon_options:declared/4.

%!  sequence_allocate(+Name, +Teams, +Host, +Tasks:list(pair), +Options,
%!                    -Robots:list(atom), -Outcome) is det.
%
%   Robots, the hosts of the robots that Teams require, execute Tasks, pairs
%   Task-Goal, in order.  An allocator is released at Host; the sequence is
%   called Name.  Outcome is `completed`, or `missed` if the deadline passes
%   first; then Robots are those that had begun, or none.
%   Options:
%
%     - deadline(Seconds)
%       Default 600 seconds of host time.  If the caller dies, the allocator
%       holds the robots until the deadline.
%     - priority(Number)
%     - allocation(Options), population(Options)
%       For task_allocate/4 and population_start/5.
%
%   A robot that fails during the sequence executes no more of it.  The
%   allocator finds another one, which executes the whole sequence.
%
%   @error domain_error(sequence_allocation_option, Option)
%   @error errors of task_allocate/4 and population_start/5; after them the
%   robots end their reservations by themselves

sequence_allocate(Name, Teams, Host, Tasks, Options, Robots, Outcome) :-
    sequence_begin(Name, Teams, Host, Tasks, Options, Sequence),
    see_through(Sequence, Robots, Outcome).

see_through(Sequence0, Robots, Outcome) :-
    catch(sequence_proceed(Sequence0, Sequence), Error,
          ( abandon(Sequence0),
            throw(Error) )),
    (   sequence_over(Sequence, Robots0, Outcome0)
    ->  Robots = Robots0,
        Outcome = Outcome0
    ;   wait(Sequence),
        see_through(Sequence, Robots, Outcome)
    ).

%   Waits a moment, in real or virtual time.

wait(sequence(_, Agent, _)) :-
    catch(agent_join(Agent, _, 0.1), error(existence_error(agent, _), _),
          true).

%!  sequence_begin(+Name, +Teams, +Host, +Tasks:list(pair), +Options,
%!                 -Sequence) is det.
%!  sequence_proceed(+Sequence0, -Sequence) is det.
%!  sequence_over(+Sequence, -Robots, -Outcome) is semidet.
%
%   The same for callers with several sequences: sequence_proceed/2 is called
%   repeatedly until sequence_over/3 succeeds.
%
%   @error as sequence_allocate/7; then Sequence0 is invalid

sequence_begin(Name, Teams, Host, Tasks, Options,
               sequence(searching, Agent, plan(Name, Tasks, Population))) :-
    must_be(list(pair), Tasks),
    check_options(sequence_allocation_option, Options),
    option(deadline(Deadline), Options, 600),
    option(priority(Priority), Options, 0),
    option(allocation(Allocation), Options, []),
    option(population(Population), Options, []),
    task_allocate(task(Name, Teams,
                       [ deadline(Deadline), priority(Priority),
                         goal(receive(_-finish)) ]),
                  Host, Allocation, Agent).

typhon_options:declared(sequence_allocation_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(deadline(X), number, X).
option_type(priority(X), number, X).
option_type(allocation(X), list, X).
option_type(population(X), list, X).

%   The stage is searching, executing(Robots, Agents), leaving(Robots), and
%   in the end over(Robots, Outcome).

sequence_proceed(sequence(Stage0, Agent, Plan), sequence(Stage, Agent, Plan)) :-
    (   next(Stage0, Agent, Plan, Stage1)
    ->  Stage = Stage1
    ;   catch(agent_property(Agent, state(State)), error(_, _), fail),
        State \= faulty(_)
    ->  Stage = Stage0
    ;   left(Stage0, Stage)
    ).

next(searching, Agent, plan(Name, Tasks, Options),
     executing(Robots, Agents)) :-
    held(Agent, Name, Robots),
    population_start(Name, Robots, Tasks, Options, Agents).
next(executing(Robots0, Agents), Agent, plan(Name, _, _),
     executing(Robots, Agents)) :-
    allocation_stage(Agent, _, Held),
    subtract(Robots0, Held, Lost),
    Lost = [_|_],
    !,
    subtract(Robots0, Lost, Robots),
    maplist(retire(Name), Lost).
next(executing(Robots0, Agents), Agent, plan(Name, _, _),
     executing(Robots, Agents)) :-
    held(Agent, Name, Robots),
    subtract(Robots, Robots0, New),
    New = [_|_],
    !,
    maplist(population_join(Name), New).
next(executing(Robots, Agents), Agent, plan(Name, Tasks, _),
     leaving(Robots)) :-
    allocation_stage(Agent, executing, Held),
    subtract(Held, Robots, []),
    last(Tasks, Last-_),
    maplist(completed(Name, Last), Robots),
    maplist(dismiss, Agents),
    catch(agent_send(Agent, finish), error(_, _), true).

%   The allocator of the sequence has ended.

left(searching, over([], missed)).
left(executing(Robots, Agents), over(Robots, missed)) :-
    maplist(dismiss, Agents).
left(leaving(Robots), over(Robots, completed)).
left(over(Robots, Outcome), over(Robots, Outcome)).

sequence_over(sequence(over(Robots, Outcome), _, _), Robots, Outcome).

abandon(sequence(Stage, Agent, _)) :-
    (   Stage = executing(_, Agents)
    ->  maplist(dismiss, Agents)
    ;   true
    ),
    dismiss(Agent).

%   True when all robots have answered that they execute the task.

held(Agent, Name, Robots) :-
    allocation_stage(Agent, executing, Robots),
    maplist(executing(Agent, Name), Robots).

executing(Agent, Name, Host) :-
    catch(robot_status(Host, executing(Agent, Name)), error(_, _), fail).

%   The host of a lost robot may have ended.

retire(Name, Host) :-
    catch(population_leave(Name, Host), error(_, _), true).

completed(Name, Task, Host) :-
    catch(remote(Host, sense(task(Name, Task, completed, _))),
          error(_, _), fail).

%   Clones of Agent die by themselves when they find no work.

dismiss(Agent) :-
    catch(agent_dispose(Agent), error(_, _), true).
