:- module(typhon_rescheduling,
          [ agent_reschedule/1          % +Id
          ]).
:- use_module('../host', [alarm_set/3, real_time/3, schedule/2]).
:- use_module('../agent',
              [ agent/5, agent_status/3, agent_wakes/2, mail_count/2,
                with_agent/2 ]).

/** <module> Agents that were restored go on

Agents that were about to run are scheduled, those that have mail are woken,
and for those that sleep or wait an alarm is set.

*Threading*: any thread.
*/

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
