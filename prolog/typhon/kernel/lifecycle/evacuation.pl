:- module(typhon_evacuation,
          [ agent_reschedule/1          % +Id
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/own_thread', [abort_quietly/0]).
:- use_module('../base/durable_changes', [durable_closed/0]).
:- use_module('../program', [machine_inside/0]).
:- use_module('../host',
              [ alarm_set/3, context_now/2, host_load/2, real_time/3,
                schedule/2, time_signal/1 ]).
:- use_module('../agent',
              [ agent/5, agent_ordered/1, agent_status/3, agent_wakes/2,
                mail_count/2, with_agent/2 ]).
:- use_module(ending, [agent_end/3, agent_forgotten/2]).
:- use_module(orders, [order_take/2]).

/** <module> The agents on a host that is being stopped

Agents that rest are disposed of at once, those that run at their next
effect; those that do not come to one are interrupted.  Those that are about
to arrive elsewhere may do so; but where the journal has been closed they are
under way in it, and are not waited for.

*Threading*: the thread that stops the host.
*/

:- multifile typhon_hosting:evacuate/2.

typhon_hosting:evacuate(Host, Deadline) :-
    (   durable_closed
    ->  forall(agent(Id, Host, _, _, _),
               ignore(agent_forgotten(Id, under_way)))
    ;   true
    ),
    evacuate(Host, Deadline).

under_way(transit(_, _)).
under_way(cloning(_, _)).

%   Nearly always all rest, and nothing is waited for.  Else it looks again
%   every 10 ms: a notification would make each arrival, return and end of a
%   turn check for a waiting caller.

evacuate(Host, Deadline) :-
    evacuated(Host, Deadline),
    !.
evacuate(Host, Deadline) :-
    end_or_order(Host, Deadline),
    (   evacuated(Host, Deadline)
    ->  true
    ;   thread_self(Me),
        \+ thread_get_message(Me, '$typhon_never', [timeout(0.01)]),
        evacuate(Host, Deadline)
    ).

%   Load counts an agent that ends until that is reported, and one that arrives
%   before it is installed.

last_seconds(1).                        % for an agent that ends at the deadline

evacuated(Host, Deadline) :-
    \+ agent(_, Host, _, _, _),
    (   host_load(Host, Load),
        Load =< 0
    ->  true
    ;   get_time(Now),
        last_seconds(More),
        Now > Deadline+More
    ).

end_or_order(Host, Deadline) :-
    findall(Id, agent(Id, Host, _, _, _), Ids),
    forall(( member(Id, Ids), stays(Id) ),
           ignore(order_take(Id, evacuate(Host)))),
    get_time(Now),
    (   Now > Deadline
    ->  interrupt(Host, Ids)
    ;   true
    ).

%   A ready agent rests, whatever its orders.

stays(Id) :-
    agent_status(Id, Status, _),
    (   Status == ready
    ->  true
    ;   \+ agent_ordered(Id),
        \+ Status = transit(_, _)
    ).

%   That is the one exception that the agent's own catch/3 cannot stop.

interrupt(Host, Ids) :-
    forall(member(Id, Ids),
           ignore(agent_end(Id, idles_on(Host, Id), disposed))),
    (   member(Id, Ids),
        agent_status(Id, running, _)
    ->  time_signal(typhon_evacuation:stop_running(Host))
    ;   true
    ).

idles_on(Host, Id, Status) :-
    Status \== running,
    agent(Id, Host, _, _, _).

stop_running(Host) :-
    (   context_now(Host, Agent),
        Agent \== none,
        machine_inside
    ->  abort_quietly
    ;   true
    ).

                /*******************************
                *         RESCHEDULING         *
                *******************************/

%   Agents that were restored go on.
%
%   Agents that were about to run are scheduled, those that have mail are woken,
%   and for those that sleep or wait an alarm is set.

%!  agent_reschedule(+Id) is det.
%
%   Id, which has been put where it was, is scheduled if it was about to run,
%   and woken when its time has come.  Others are let in already, and what they
%   send may have woken it: an agent that runs by now must not be run by two.

agent_reschedule(Id) :-
    (   with_agent(Id, ( agent_status(Id, Status, Goals),
                         goes_on(Status, Goals, Id) ))
    ->  true
    ;   true
    ),
    (   agent_status(Id, Now, _),
        alarm(Now, Stamp, Token),
        agent(Id, Host, _, _, _)
    ->  rings(Host, Stamp, Id, Token)
    ;   true
    ).

goes_on(ready, _, Id) :-
    agent(Id, Host, _, _, _),
    !,
    schedule(Host, Id).
goes_on(obeying, Goals, Id) :-
    agent_wakes(Id, Goals).
goes_on(faulty(_), Goals, Id) :-
    agent_wakes(Id, Goals).
goes_on(resident, Goals, Id) :-
    has_mail(Id, Goals).
goes_on(waiting(_, _), Goals, Id) :-
    has_mail(Id, Goals).

%   It runs, and sees for itself.

has_mail(Id, Goals) :-
    mail_count(Id, Count),
    Count > 0,
    agent_wakes(Id, Goals).

alarm(waiting(_, Until), Until, until(Until)) :-
    number(Until).
alarm(sleeping(Until), Until, until(Until)).
alarm(leaving(_, At), At, leave).

rings(Host, Until, Id, Token) :-
    real_time(Host, Until, Stamp),
    alarm_set(Stamp, Id, Token).
