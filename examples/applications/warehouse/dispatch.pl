:- module(warehouse_dispatch,
          [ dispatch_begin/4,           % +Order, +Office, +Options, -Job
            dispatch_proceed/2,         % +Job0, -Job
            dispatch_carries/2,         % +Job, -Robot
            dispatch_over/1             % +Job
          ]).
:- use_module('../../../prolog/typhon',
              [ agent_create/3, agent_dispose/1, agent_property/2, agent_send/2,
                remote/2 ]).
:- use_module('../../../prolog/typhon/kernel/program/paths', []).
:- use_module('../../../prolog/typhon/language/programs',
              [payload_load/2]).
:- use_module('../../../agents/allocation/operator',
              [allocation_stage/3, robot_status/2, task_allocate/4]).
:- use_module('../../../agents/sync/operator', [sequence_start/5]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, subset/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> Orders, and the agents that execute them

An order is order(Id, Corners, From, To): move a load from From to To.  One
robot carries a load with a single corner: an allocator finds it (chapter 7 of
the thesis).  Others need a robot at each corner: an allocator finds and holds
them, and agents have them execute a sequence of tasks in step (chapter 5).
When one of these fails the allocator finds another, and the sequence begins
again at the current position of the load.

*Threading*: any thread; no state.
*/

%!  dispatch_begin(+Order, +Office, +Options, -Job) is det.
%
%   Releases an allocator at the host Office.  Options: seed(S); way(Way), how
%   several robots execute their tasks: `in_step`, default, or `alone`, without
%   synchronisation; delta(D), the penalty bias in step, default 2; fast(S),
%   metres per second with a load at several corners, default 0.15; deadline(S)
%   of an order in seconds, default 600; an order whose beam has fallen waits
%   for it; place(Goal), call(Goal, Id, Place) gives the position of a load.

dispatch_begin(Order, Office, Options, job(Order, Options, Agent, searching)) :-
    Order = order(Id, Corners, From, _),
    length(Corners, Count),
    option(seed(Seed), Options, 1),
    option(deadline(Deadline), Options, 600),
    robot_goal(Order, Goal),
    task_allocate(task(Id, [Count-[carry]],
                       [at(From), goal(Goal), deadline(Deadline)]),
                  Office, [name(Id), settings([seed-Seed, bi_max-60])], Agent).

robot_goal(order(_, [_], From, To), carry(From, To)) :-
    !.
robot_goal(_, receive(_-finish)).

%!  dispatch_proceed(+Job0, -Job) is det.
%!  dispatch_over(+Job) is semidet.
%
%   dispatch_proceed/2 is called repeatedly, until dispatch_over/1 succeeds.

dispatch_over(job(_, _, _, over)).

dispatch_proceed(job(Order, Options, Agent, Stage0),
                 job(Order, Options, Agent, Stage)) :-
    (   \+ there(Agent)
    ->  dismiss(Stage0),
        Stage = over
    ;   next(Stage0, Order, Options, Agent, Stage)
    ->  true
    ;   Stage = Stage0
    ).

%   The stage is searching, executing(Sequence, Robots, Agents),
%   regrouping(Sequence), leaving, and at the end over.

next(searching, Order, Options, Agent, executing(Id, Robots, Agents)) :-
    Order = order(Id, [_,_|_], _, _),
    all_held(Agent, Id, Robots),
    steps(Order, Robots, Options, Tasks),
    begin(Id, Robots, Tasks, Options, Agents).
next(executing(Sequence, Robots, Agents), _, _, Agent, regrouping(Sequence)) :-
    allocation_stage(Agent, _, Held),
    \+ subset(Robots, Held),
    !,
    dismiss(executing(Sequence, Robots, Agents)).
next(executing(Sequence, Robots, Agents), _, _, Agent, leaving) :-
    (   maplist(lowered(Sequence), Robots)
    ;   \+ ( member(One, Agents), there(One) )
    ),
    !,
    dismiss(executing(Sequence, Robots, Agents)),
    agent_send(Agent, finish).
next(regrouping(Sequence0), Order0, Options, Agent,
     executing(Sequence, Robots, Agents)) :-
    Order0 = order(Id, Corners, _, To),
    all_held(Agent, Id, Robots),
    \+ ( member(Robot, Robots), does(Sequence0, _, Robot) ),
    option(place(Place), Options),
    call(Place, Id, From),
    steps(order(Id, Corners, From, To), Robots, Options, Tasks),
    step(let_go, LetGo),
    atom_concat(Sequence0, +, Sequence),
    begin(Sequence, Robots, [let_go-LetGo|Tasks], Options, Agents).

all_held(Agent, Id, Robots) :-
    allocation_stage(Agent, executing, Robots),
    maplist(executes(Agent, Id), Robots).

%   The worker of a remaining robot continues its task.

does(Sequence, Task, Robot) :-
    remote(Robot, sense(task(Sequence, Task, executing, _))).

%!  dispatch_carries(+Job, -Robot) is nondet.
%
%   Robot carries a load together with others.

dispatch_carries(job(_, _, _, executing(Sequence, Robots, _)), Robot) :-
    member(Robot, Robots),
    does(Sequence, carry, Robot).

executes(Agent, Id, Robot) :-
    robot_status(Robot, executing(Agent, Id)).

lowered(Sequence, Robot) :-
    remote(Robot, sense(task(Sequence, lower, completed, _))).

there(Agent) :-
    catch(agent_property(Agent, state(State)), error(_, _), fail),
    State \= faulty(_).

dismiss(executing(_, _, Agents)) :-
    !,
    forall(member(Agent, Agents), catch(agent_dispose(Agent), error(_, _), true)).
dismiss(_).

begin(Sequence, Robots, Tasks, Options, Agents) :-
    option(way(Way), Options, in_step),
    begin(Way, Sequence, Robots, Tasks, Options, Agents).

begin(in_step, Id, Robots, Tasks, Options, Agents) :-
    option(delta(Delta), Options, 2),
    sequence_start(Id, Robots, Tasks,
                   [starts(Robots), settings([delta-Delta])], Agents).
begin(alone, Id, Robots, Tasks, _, Agents) :-
    maplist(create_alone(Id, Tasks), Robots, Agents),
    forall(member(Agent, Agents), agent_send(Agent, begin)).

create_alone(Id, Tasks, Robot, Agent) :-
    agent_create(agents(robots/alone), Agent,
                 [host(Robot), facts([tasks(Id, Tasks)]), static(true)]).

%   steps(+Order, +Robots, +Options, -Tasks): assigns a robot to each corner.

steps(order(_, Corners, From, To), Robots, Options, Tasks) :-
    option(fast(Fast), Options, 0.15),
    maplist(corner_at(From), Corners, Starts),
    maplist(corner_at(To), Corners, Ends),
    pairs_keys_values(Begins, Robots, Starts),
    pairs_keys_values(Finals, Robots, Ends),
    findall(Task-Goal,
            ( member(Task-Does, [ approach-drive(Begins, 1), lift-take_up,
                                  carry-drive(Finals, Fast), lower-put_down ]),
              step(Does, Goal) ),
            Tasks).

corner_at(p(X0, Y0), p(DX, DY), p(X, Y)) :-
    X is X0+DX,
    Y is Y0+DY.

%   The worker of a host attaches the payload, and detaches it afterwards.

step(Does, ( attach(Payload),
             catch(( Goal -> Done = true ; Done = fail ), Ball,
                   Done = throw(Ball)),
             detach(Entry),
             Done )) :-
    payload_load(payloads(robots/rover), Payload),
    Payload = payload(Entry, _, _),
    acts(Does, Goal).

acts(drive(Places, Fastest),
     ( here(Host), memberchk(Host-Place, Places), drive_to(Place, Fastest) )).
acts(take_up, take_up).
acts(put_down, put_down).
acts(let_go, catch(put_down, error(rover_error(_, _), _), true)).
