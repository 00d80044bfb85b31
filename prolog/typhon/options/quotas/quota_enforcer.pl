:- module(typhon_quota_enforcer,
          [ enforcer_adapt/0
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../../kernel/base/bounds', [space_used_up/1]).
:- use_module('../../kernel/base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../../kernel/base/server', [server_start/4, server_stop/1]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/program',
              [ fault_note/1, fault_noted/1, machine_inside/0, machine_run/3,
                plain_goals/2 ]).
:- use_module('../../kernel/host',
              [ alarm_in/3, context_now/2, context_set/3, scheduler_call/1,
                turn_of/3, turns_now/3 ]).
:- use_module('../../kernel/agent', [agent/5, agent_status/3]).
:- use_module('../../kernel/lifecycle', [agent_end/3, turn_over_limit/3]).
:- use_module(quota_agents, [quota_owner/3, quota_text/2, quota_until/3]).
:- use_module(quota_table,
              [ quota/3, quota_any/1, quota_overrun/1, quota_passed_now/1,
                quota_shared/4 ]).
:- use_module(usage, [usage_begin/0]).

/** <module> Enforcement of quotas

The module limits the inferences of a turn and the size of the stored goals of
an agent.  While hosts have quotas of resources that are not counted as they are
used, a server checks ten times a second how long each agent has run without a
stop, the size of its stack, and the sums of run time, stack and state for the
agents of an owner and for all agents of a host.  An agent also ends when its
lifetime on a host has expired.

*Threading*: run/3 in the worker that runs the turn, look/0 in the thread of the
enforcer, lifetime_over/2 in a worker; interrupt/2 and pause/2 are signals.
*/

:- setting(pause, between(0.0, 1.0), 0.8,
           "Agents that run for long where there are quotas pause for this \c
            part of the time while others run").
:- multifile
    typhon_host_parts:part/4,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2,
    typhon_turn:limit_passed/1.

:- dynamic enforcer/1.          % Server

                /*******************************
                *             TURNS            *
                *******************************/

typhon_host_parts:part(turn, Host, 10, typhon_quota_enforcer:run) :-
    quota_any(Host).

:- public run/3.

run(turn(Id, Host, Context), Goals, Outcome) :-
    Context = context(_, Module),
    context_set(Host, Id, Module),      % starts the clock of its turn
    usage_begin,
    far_limit(Host),
    within_inferences(Host, Context, Goals, Outcome0),
    over(Outcome0, Module, Outcome1),
    storable(Outcome1, Host, Outcome).

%   The enforcer interrupts an agent that exceeds the quota of stack long before
%   its stack is full.  An agent that fills its stack while it catches all
%   exceptions leaves no space for exceptions, and then SWI-Prolog 9.0.4 ends
%   the process.  A stack limit near the quota would be worse, since the stack
%   would fill up sooner.

far_limit(Host) :-
    (   quota(Host, stack, Most),
        Far is 4*integer(Most),
        current_prolog_flag(stack_limit, Limit),
        Limit < Far
    ->  set_prolog_flag(stack_limit, Far)
    ;   true
    ).

within_inferences(Host, Context, Goals, Outcome) :-
    quota(Host, inferences, Most),
    !,
    statistics(inferences, Before),
    call_with_inference_limit(machine_run(Context, Goals, Outcome0), Most, _),
    statistics(inferences, After),
    (   After-Before >= Most
    ->  Outcome = over(inferences)
    ;   Outcome = Outcome0
    ).
within_inferences(_, Context, Goals, Outcome) :-
    machine_run(Context, Goals, Outcome).

%   over(+Outcome0, +Module, -Outcome): Outcome is over(What) if the agent has
%   passed a quota.  An error alone does not show that: the agent may have raised
%   it.

over(_, _, over(What)) :-
    quota_passed_now(What),
    !.
over(raised(error(Formal, _)), Module, Outcome) :-
    nonvar(Formal),
    Formal = resource_error(What),
    exhausted(What, Module, Outcome),
    !.
over(raised(Ball), _, over(cells)) :-
    \+ is_tree(Ball, 10 000),          % printing it would never end
    !.
over(Outcome, _, Outcome).

%   exhausted(+What, +Module, -Outcome): SWI-Prolog raises these errors at its
%   own limits.

exhausted(What, Module, over(state)) :-
    What == program_space,
    space_used_up(Module),
    !.
exhausted(What, _, ends(What)) :-
    ( What == stack ; What == program_space ),
    !.

%   storable(+Outcome0, +Host, -Outcome): the remaining goals of the agent are
%   stored as a tree, while other threads wait for its mutex.  So their size is
%   checked as a tree.

storable(Outcome0, Host, Outcome) :-
    (   kept(Outcome0, Kept),
        quota(Host, cells, Most),
        \+ is_tree(Kept, Most)
    ->  fault_note(none),
        Outcome = over(cells)
    ;   Outcome = Outcome0
    ).

kept(effect(Control, _, Goals0), Control-Goals) :-
    plain_goals(Goals0, Goals).
kept(failed, Fault) :- fault_noted(Fault).
kept(raised(_), Fault) :- fault_noted(Fault).

typhon_turn:limit_passed(raised(error(resource_error(What), _))) :-
    quota_passed_now(What).

                /*******************************
                *          THE ENFORCER        *
                *******************************/

%!  enforcer_adapt is det.
%
%   The quotas of hosts have changed: start or stop the enforcer as needed.

enforcer_adapt :-
    is_needed,
    !,
    (   enforcer(_)
    ->  true
    ;   server_start(quota_enforcer, typhon_quota_enforcer:enforces, none,
                     Enforcer),
        assertz(enforcer(Enforcer))
    ).
enforcer_adapt :-
    (   retract(enforcer(Enforcer))
    ->  server_stop(Enforcer)
    ;   true
    ).

is_needed :-
    quota(_, seconds, _).
is_needed :-
    quota(_, stack, _).
is_needed :-
    member(What, [seconds, stack, state]),
    quota_shared(_, _, What, _).

:- public enforces/3.

enforces(begin, State, Next) :-
    set_timer(State, Next).
enforces(timeout, State, Next) :-
    look,
    set_timer(State, Next).

set_timer(State, until(Stamp, State)) :-
    deadline(0.1, Stamp).

look :-
    forall(( turn(Agent, Host, Thread, Seconds),
             exceeds(Agent, Host, Thread, Seconds, Act) ),
           call(Act)),
    forall(( quota_shared(Host, Whose, What, Most),
             used(What, Host, Used),
             too_much(Whose, Used, Most, Agent) ),
           stop(Agent, What)).

turn(Agent, Host, Thread, Seconds) :-
    turns_now(Agent, Thread, Seconds),
    agent(Agent, Host, _, _, _),
    agent_status(Agent, running, _).

%   exceeds(+Agent, +Host, +Thread, +Seconds, -Act) is semidet.
%
%   The limit of a stack is above its quota, see far_limit/1.  An agent that
%   runs for long without a stop pauses if agents run that have not.  Thread
%   priorities would do the same if operating systems respected them.

exceeds(Agent, Host, Thread, _, stop_in(Thread, Agent, stack)) :-
    quota(Host, stack, Most),
    stack_used(Thread, Used),
    Used > Most,
    !.
exceeds(Agent, Host, Thread, Seconds, stop_in(Thread, Agent, seconds)) :-
    quota(Host, seconds, Most),
    Seconds > Most,
    !.
exceeds(Agent, Host, Thread, Seconds, pause_in(Thread, Agent)) :-
    long(Seconds),
    quota_any(Host),
    another_runs(Thread).

stack_used(Thread, Used) :-
    catch(thread_statistics(Thread, stack, Used), error(_, _), fail).

long(Seconds) :-
    Seconds > 0.1.

another_runs(Thread) :-
    turns_now(_, Other, Seconds),
    Other \== Thread,
    \+ long(Seconds),
    !.

pause_in(Thread, Agent) :-
    setting(pause, Part),
    Seconds is 0.1*Part,
    deadline(Seconds, Until),
    signal(Thread, pause(Agent, Until)).

%   used(+What, +Host, -Used): Used is a list of Owner-(Amount-Agent).

used(seconds, Host, Used) :-
    findall(Owner-(Seconds-Agent),
            ( turn(Agent, Host, _, Seconds), quota_owner(Agent, Host, Owner) ),
            Used).
used(stack, Host, Used) :-
    findall(Owner-(Bytes-Agent),
            ( turn(Agent, Host, Thread, _), stack_used(Thread, Bytes),
              quota_owner(Agent, Host, Owner) ),
            Used).
used(state, Host, Used) :-
    findall(Owner-(Bytes-Agent),
            ( quota_owner(Agent, Host, Owner),
              agent(Agent, Host, Module, _, _),
              module_property(Module, program_size(Size)),
              quota_text(Agent, Text), Bytes is Size+Text ),
            Used).

%   too_much(+Whose, +Used, +Most, -Agent): Most is exceeded, by an owner if
%   Whose is `owner`, or by all agents of the host.  Agent uses most among the
%   agents of that owner, or of the owner that uses most.

too_much(Whose, Used, Most, Agent) :-
    keysort(Used, Sorted),
    group_pairs_by_key(Sorted, Owners0),
    findall(Sum-Its, ( member(_-Its, Owners0), sum(Its, Sum) ), Owners1),
    keysort(Owners1, Owners),
    over(Whose, Owners, Most, Its),
    keysort(Its, Agents),
    last(Agents, _-Agent).

over(owner, Owners, Most, Its) :-
    member(Sum-Its, Owners),
    Sum > Most.
over(host, Owners, Most, Its) :-
    aggregate_all(sum(Sum), member(Sum-_, Owners), All),
    All > Most,
    last(Owners, _-Its).

sum(Its, Sum) :-
    aggregate_all(sum(Amount), member(Amount-_, Its), Sum).

typhon_scheduler:fire(Id, stays(Until)) :-
    !,
    scheduler_call(typhon_quota_enforcer:lifetime_over(Id, Until)).

typhon_scheduler:over(Id, stays(Until)) :-
    \+ quota_until(Id, _, Until).

:- public lifetime_over/2.

%   stop/2 cannot end an agent in transit, which may yet return to this host.
%   So the alarm is set again.

lifetime_over(Id, Until) :-
    (   quota_until(Id, _, Until)
    ->  stop(Id, lifetime),
        (   quota_until(Id, _, Until)
        ->  alarm_in(0.1, Id, stays(Until))
        ;   true
        )
    ;   true
    ).

                /*******************************
                *             STOP             *
                *******************************/

%   stop(+Agent, +What): end Agent if it rests, interrupt it if it runs.

stop(Agent, What) :-
    Outcome = raised(error(resource_error(What), _)),
    (   agent(Agent, Host, _, _, _),
        agent_end(Agent, at_rest, Outcome)
    ->  turn_over_limit(Host, Agent, What)
    ;   turn_of(Agent, Thread, _)
    ->  stop_in(Thread, Agent, What)
    ;   true
    ).

at_rest(ready).
at_rest(sleeping(_)).
at_rest(waiting(_, _)).
at_rest(resident).
at_rest(held).
at_rest(leaving(_, _)).

stop_in(Thread, Agent, What) :-
    signal(Thread, interrupt(Agent, What)).

signal(Thread, Goal) :-
    catch(thread_signal(Thread, typhon_quota_enforcer:Goal),
          error(existence_error(_, _), _), true).

:- public interrupt/2, pause/2.

%   An agent is interrupted only inside its goals, as in typhon_disposal.

interrupt(Agent, What) :-
    (   inside(Agent)
    ->  quota_overrun(What)
    ;   true
    ).

%   An agent does not pause while it holds a mutex for which others wait.  If
%   the signal is late, as after a long call of a foreign predicate, the pause
%   is already over.

pause(Agent, Until) :-
    (   inside(Agent),
        \+ has_mutex
    ->  monotonic_time(Now),
        Seconds is Until-Now,
        sleep(Seconds)                  % returns at once if negative
    ;   true
    ).

inside(Agent) :-
    context_now(_, Agent),
    machine_inside.

has_mutex :-
    prolog_current_frame(Frame),
    prolog_frame_attribute(Frame, parent_goal, system:with_mutex(_, _)).
