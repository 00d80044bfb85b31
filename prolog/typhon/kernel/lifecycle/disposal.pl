:- module(typhon_disposal,
          [ agent_dispose/1,            % +Agent
            agent_dispose/2,            % +Agent, +Options
            agent_reschedule/1          % +Id
          ]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/monotonic',
              [deadline/2, monotonic_time/1, poll_within/2]).
:- use_module('../base/own_thread', [abort_quietly/0, in_own_thread/1]).
:- use_module('../base/options', [check_options/2]).
:- use_module('../base/durable', [durable_closed/0]).
:- use_module('../program', [machine_inside/0]).
:- use_module('../host',
              [ alarm_set/3, context_now/2, host_load/2, real_time/3,
                schedule/2, time_signal/1, turn_of/3 ]).
:- use_module('../agent',
              [ agent/5, agent_ordered/1, agent_status/3, agent_wakes/2,
                mail_count/2, with_agent/2 ]).
:- use_module('../travel', [ended_agent/1]).
:- use_module(questions,
              [ agent_asked/4, agent_named/2, agent_urge/4,
                question_answered/2 ]).
:- use_module(orders, [order_take/2]).
:- use_module(ending, [agent_end/3, agent_forgotten/2]).

/** <module> Disposal of agents, also by force, and with their host

An agent at rest ends at once, one that runs at its next effect.  The caller
waits a moment for that, in a thread of its own, as the caller may be a cleanup
handler.  An agent that comes to no effect, because it loops or waits for
something outside, is interrupted if the caller asks for force.  The interrupt
is a signal to the thread that runs the agent, so it affects no other agent.

When a host stops its agents end, and those that do not come to an effect are
interrupted.  Agents that are about to arrive elsewhere may still arrive.  If
the journal has been closed, they are under way in the journal, and the host
does not wait for them.

*Threading*: agent_dispose/2 in any thread but those of the endpoint.
Questions are answered in the threads of connections, too. interrupt/1 is a
signal.  Evacuation runs in the thread that stops the host.
*/

:- multifile
    typhon_options:declared/4,
    typhon_questions:here/3.

:- setting(heed_seconds, number, 1,
           "Seconds after which an agent that still runs is reported").
:- setting(force_seconds, number, 10,
           "Seconds for an interrupted agent to end").

%!  agent_dispose(+Agent) is det.
%!  agent_dispose(+Agent, +Options) is det.
%
%   End Agent, wherever it is: at once if it is at rest, else at its next
%   effect.  If it has not come to an effect within a second (the setting
%   `typhon_disposal:heed_seconds`) this prints a warning; the order stands.
%   Option:
%
%     - force(+Seconds): if it has not ended within Seconds (of the time of
%       day), interrupt it in the middle of its goal.  Then it has ended when
%       agent_dispose/2 returns.  Negative Seconds count as 0.
%
%   An agent that disposes of another agent waits for its end only with force.
%
%   @error existence_error(agent, Agent), ambiguous_agent(Agent, Ids)
%   @error timeout_error(order, Agent) if it cannot be interrupted, since it
%          is in a foreign predicate that does not return
%   @error domain_error(dispose_option, Option)

agent_dispose(Agent) :-
    agent_dispose(Agent, []).

agent_dispose(Agent, Options) :-
    check_options(dispose_option, Options),
    agent_named(Agent, Id),
    (   agent_asked(Id, dispose, 10, State)
    ->  ( option(force(Seconds), Options) -> true ; Seconds = none ),
        wait_for_end(State, Id, Seconds)
    ;   existence_error(agent, Agent)
    ).

typhon_options:declared(dispose_option, force(Seconds), number, Seconds).

%   wait_for_end(+State, +Agent, +Seconds): wait for the end of Agent, if it has
%   only noted the order; interrupt it after Seconds, unless these are `none`.

wait_for_end(ended, _, _).
wait_for_end(noted, Agent, _) :-        % it ends when this goal has ended
    context_now(_, Agent),
    !.
wait_for_end(noted, _, none) :-
    context_now(_, Other),
    Other \== none,
    !.
wait_for_end(noted, Agent, none) :-
    !,
    setting(heed_seconds, Seconds),
    (   in_own_thread(ends_within(Agent, Seconds))
    ->  true
    ;   print_message(warning, typhon(runs_on(Agent, Seconds)))
    ).
wait_for_end(noted, Agent, Seconds0) :-
    Seconds is max(0, Seconds0),
    setting(force_seconds, More),
    Most is Seconds+More,
    deadline(Most, Deadline),
    in_own_thread(( ends_within(Agent, Seconds)
                  ; force(Agent, Deadline)
                  )).

%   ends_within(+Agent, +Seconds) is semidet: Agent ends within Seconds.  Then
%   this ends an agent that is faulty, or at rest because no worker could run
%   it.  An order that follows an agent under way may be answered by `none` or
%   an error while the agent runs on: then it is given again.  Of an agent that
%   has ended here its home need not be asked, which may be away.

ends_within(Agent, Seconds) :-
    deadline(Seconds, Deadline),
    poll_within(Seconds, has_ended(Agent, Deadline)).

has_ended(Agent, Deadline) :-
    catch(ends_by(Agent, Deadline), error(Formal, Context),
          (   ended_agent(Agent)
          ->  true
          ;   throw(error(Formal, Context))
          )).

ends_by(Agent, Deadline) :-
    catch(agent_urge(Agent, order(end), Deadline, answer(ended)),
          error(timeout_error(_, _), _),
          fail),
    !.
ends_by(Agent, _) :-
    (   agent_asked(Agent, dispose, 10, State)
    ->  State == ended
    ;   true
    ).

%   This repeats because the signal may arrive between two goals, or the agent
%   may hop to a process that is not known here yet.

force(Agent, Deadline) :-
    (   \+ agent_asked(Agent, force, 10, _)
    ->  true
    ;   ends_within(Agent, 0.2)
    ->  true
    ;   monotonic_time(Now),
        Now > Deadline
    ->  throw(error(timeout_error(order, Agent), _))
    ;   force(Agent, Deadline)
    ).

                /*******************************
                *           ANSWERS            *
                *******************************/

typhon_questions:here(dispose, Agent, Asker) :-
    catch(( order_take(Agent, dispose),
            (   agent(Agent, _, _, _, _)
            ->  Answer = answer(noted)
            ;   Answer = answer(ended)
            )
          ),
          error(Formal, _),
          Answer = error(Formal)),
    question_answered(Asker, Answer).
typhon_questions:here(force, Agent, Asker) :-
    agent(Agent, _, _, _, _),
    (   agent_status(Agent, running, _),
        turn_of(Agent, Thread, _)
    ->  catch(thread_signal(Thread, typhon_disposal:interrupt(_, Agent)),
              error(existence_error(_, _), _), true)
    ;   true
    ),
    question_answered(Asker, answer(ok)).

:- public interrupt/2.

%   interrupt(?Host, ?Agent): interrupt the agent that this thread runs, if it
%   is Agent on Host.  Interrupts only its goals: operations of the platform on
%   the agent must not be split.  The agent cannot catch this exception
%   permanently.

interrupt(Host, Agent) :-
    (   context_now(Host, Agent),
        Agent \== none,
        machine_inside
    ->  abort_quietly
    ;   true
    ).

                /*******************************
                *       HOSTS THAT STOP        *
                *******************************/

:- multifile typhon_hosting:evacuate/2.

typhon_hosting:evacuate(Host, Deadline) :-
    evacuate(Host, Deadline).

%   Nearly always all agents are at rest, and this does not wait.  Else it polls
%   every 10 ms: with a notification each arrival, return and end of a turn
%   would have to check for a waiting caller.

evacuate(Host, Deadline) :-
    evacuated(Host, Deadline),
    !.
evacuate(Host, Deadline) :-
    end_or_order(Host, Deadline),
    (   evacuated(Host, Deadline)
    ->  true
    ;   sleep(0.01),
        evacuate(Host, Deadline)
    ).

%   An agent that ends counts in the load until its end is reported, and an
%   agent that arrives counts before it is installed.

last_seconds(1).                        % for an agent that ends at the deadline

evacuated(Host, Deadline) :-
    \+ agent(_, Host, _, _, _),
    (   host_load(Host, Load),
        Load =< 0
    ->  true
    ;   monotonic_time(Now),
        last_seconds(More),
        Now > Deadline+More
    ).

end_or_order(Host, Deadline) :-
    findall(Id, agent(Id, Host, _, _, _), Ids),
    (   durable_closed                  % the journal has it under way
    ->  forall(member(Id, Ids), ignore(agent_forgotten(Id, under_way)))
    ;   true
    ),
    forall(( member(Id, Ids), stays(Id) ),
           ignore(order_take(Id, evacuate(Host)))),
    monotonic_time(Now),
    (   Now > Deadline
    ->  interrupt_all(Host, Ids)
    ;   true
    ).

under_way(transit(_, _)).
under_way(cloning(_, _)).

%   An agent that is `ready` is at rest, whatever its orders.

stays(Id) :-
    agent_status(Id, Status, _),
    (   Status == ready
    ->  true
    ;   \+ agent_ordered(Id),
        \+ Status = transit(_, _)
    ).

interrupt_all(Host, Ids) :-
    forall(member(Id, Ids),
           ignore(agent_end(Id, idles_on(Host, Id), disposed))),
    (   member(Id, Ids),
        agent_status(Id, running, _)
    ->  time_signal(typhon_disposal:interrupt(Host, _))
    ;   true
    ).

idles_on(Host, Id, Status) :-
    Status \== running,
    agent(Id, Host, _, _, _).

                /*******************************
                *         RESCHEDULING         *
                *******************************/

%!  agent_reschedule(+Id) is det.
%
%   Resume Id, which was restored: schedule it if it was about to run, wake it
%   if it has mail, and set an alarm if it sleeps or waits for a time.  Other
%   agents run already, and their messages may have woken it: an agent that
%   runs by now must not be run by two workers.

agent_reschedule(Id) :-
    ignore(with_agent(Id, ( agent_status(Id, Status, Goals),
                            resume_from(Status, Goals, Id) ))),
    (   agent_status(Id, Now, _),
        alarm(Now, Until, Token),
        agent(Id, Host, _, _, _)
    ->  real_time(Host, Until, Stamp),
        alarm_set(Stamp, Id, Token)
    ;   true
    ).

resume_from(ready, _, Id) :-
    agent(Id, Host, _, _, _),
    !,
    schedule(Host, Id).
resume_from(obeying, Goals, Id) :-
    agent_wakes(Id, Goals).
resume_from(faulty(_), Goals, Id) :-
    agent_wakes(Id, Goals).
resume_from(resident, Goals, Id) :-
    wake_if_mail(Id, Goals).
resume_from(waiting(_, _), Goals, Id) :-
    wake_if_mail(Id, Goals).

%   An agent that runs looks for mail itself.

wake_if_mail(Id, Goals) :-
    mail_count(Id, Count),
    Count > 0,
    agent_wakes(Id, Goals).

alarm(waiting(_, Until), Until, until(Until)) :-
    number(Until).
alarm(sleeping(Until), Until, until(Until)) :-
    number(Until).
alarm(leaving(_, At), At, leave).
