:- module(typhon_overuse, []).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [last/2, member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/stop_thread', [abort_quietly/0]).
:- use_module('../program', [machine_inside/0]).
:- use_module('../host',
              [ alarm_in/3, context_now/2, quota/3, quota_any/1,
                quota_shared/4, scheduler_call/1, turn_of/3, turns_now/3 ]).
:- use_module('../agent',
              [ agent/5, agent_status/3, state_text/2, stay_owner/3,
                stay_until/3 ]).
:- use_module(ending, [agent_end/3]).

/** <module> Agents that exceed quotas without an effect

What is not counted when it is used a thread looks after, see typhon_quotas:
how long an agent has not stopped, how large its stack is, and what agents of
one owner, or all of a host, have of these and of state together.  And an agent
ends that has been on a host for as long as it may.

*Threading*: look/0 in the thread that watches, too_long/2 in a worker;
interrupt/2 and pause/2 are signals.
*/

:- setting(pause, between(0.0, 1.0), 0.8,
           "Agents that run for long where there are quotas pause for this part \c
            of the time while others run").

:- multifile
    typhon_quotas:look/0,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

                /*******************************
                *             EACH             *
                *******************************/

%   A stack is not bounded by its limit: see typhon_metering.

typhon_quotas:look :-
    turn(Agent, Host, Thread, Seconds),
    (   quota(Host, stack, Most),
        stack_used(Thread, Used),
        Used > Most
    ->  stop_in(Thread, Agent, stack)
    ;   quota(Host, seconds, Most),
        Seconds > Most
    ->  stop_in(Thread, Agent, seconds)
    ;   long(Seconds),
        quota_any(Host),
        another_runs(Thread)
    ->  pause_in(Thread, Agent)
    ;   true
    ),
    fail.
typhon_quotas:look :-
    quota_shared(Host, Whose, What, Most),
    used(What, Host, Used),
    too_much(Whose, Used, Most, Agent),
    stop(Agent, What),
    fail.
typhon_quotas:look.

%   An agent that does not stop for so long lets others go first, if there are some that
%   are not like that.  Priorities of threads would do the same if systems kept
%   to them.

long(Seconds) :-
    Seconds > 0.1.

another_runs(Thread) :-
    turns_now(_, Other, Seconds),
    Other \== Thread,
    \+ long(Seconds),
    !.

pause_in(Thread, Agent) :-
    setting(pause, Part),
    get_time(Now),
    Until is Now+0.1*Part,
    signal(Thread, pause(Agent, Until)).

turn(Agent, Host, Thread, Seconds) :-
    turns_now(Agent, Thread, Seconds),
    agent(Agent, Host, _, _, _),
    agent_status(Agent, running, _).

stack_used(Thread, Used) :-
    catch(thread_statistics(Thread, stack, Used), error(_, _), fail).

                /*******************************
                *            TOGETHER          *
                *******************************/

%   used(+What, +Host, -Used): Used is a list of Owner-(Amount-Agent).

used(seconds, Host, Used) :-
    findall(Owner-(Seconds-Agent),
            ( turn(Agent, Host, _, Seconds), stay_owner(Agent, Host, Owner) ),
            Used).
used(stack, Host, Used) :-
    findall(Owner-(Bytes-Agent),
            ( turn(Agent, Host, Thread, _), stack_used(Thread, Bytes),
              stay_owner(Agent, Host, Owner) ),
            Used).
used(state, Host, Used) :-
    findall(Owner-(Bytes-Agent),
            ( stay_owner(Agent, Host, Owner), agent(Agent, Host, Module, _, _),
              module_property(Module, program_size(Size)),
              state_text(Agent, Text), Bytes is Size+Text ),
            Used).

%   too_much(+Whose, +Used, +Most, -Agent): Agent is the one that uses most, of
%   an owner that uses too much, or, if it is all together, of the one that uses
%   most.

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

                /*******************************
                *           LIFETIME           *
                *******************************/

typhon_scheduler:fire(Id, stays(Until)) :-
    !,
    scheduler_call(typhon_overuse:too_long(Id, Until)).

typhon_scheduler:over(Id, stays(Until)) :-
    \+ stay_until(Id, _, Until).

:- public too_long/2.

%   An agent under way may come back to where it was.

too_long(Id, Until) :-
    (   stay_until(Id, _, Until)
    ->  stop(Id, lifetime),
        (   stay_until(Id, _, Until)
        ->  alarm_in(0.1, Id, stays(Until))
        ;   true
        )
    ;   true
    ).

                /*******************************
                *             STOP             *
                *******************************/

%   stop(+Agent, +What): it ends, if it rests, or is interrupted.

stop(Agent, What) :-
    Outcome = raised(error(resource_error(What), _)),
    (   agent_end(Agent, at_rest, Outcome)
    ->  print_message(warning, typhon(over_quota(Agent, What)))
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
    catch(thread_signal(Thread, typhon_overuse:Goal),
          error(existence_error(_, _), _), true).

:- public interrupt/2, pause/2.

%   Only inside its goals, as in typhon_disposal.

interrupt(Agent, What) :-
    (   inside(Agent)
    ->  nb_setval(typhon_over, What),
        abort_quietly
    ;   true
    ).

%   Nor may others wait for what it has; where the signal comes late, as after
%   a long call of a foreign predicate, there is nothing left of the pause.

pause(Agent, Until) :-
    (   inside(Agent),
        \+ has_mutex
    ->  get_time(Now),
        Seconds is Until-Now,
        sleep(Seconds)                  % not at all if it is negative
    ;   true
    ).

inside(Agent) :-
    context_now(_, Agent),
    machine_inside.

has_mutex :-
    prolog_current_frame(Frame),
    prolog_frame_attribute(Frame, parent_goal, system:with_mutex(_, _)).
