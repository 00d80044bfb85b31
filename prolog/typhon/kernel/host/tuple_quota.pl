:- module(typhon_tuple_quota,
          [ may_leave/1,                % +Host
            leaver/2,                   % +Host, -By
            leaving_begins/1,           % +By
            leaving_ends/1              % +By
          ]).
:- use_module(context, [context_now/2]).
:- use_module(quotas, [quota/3, quota_any/1, quota_shared/4]).
:- use_module(rate_limits, [quota_passed/1, quota_spend/3]).

/** <module> Tuples by the agents that left them

Where there are quotas of tuples it is counted how many facts in the tuple
space are from an agent, from agents of one owner, and from all.  Facts stay
when their agent goes.

*Threading*: any thread; a mutex guards the counts.
*/

:- multifile
    typhon_quotas:forgotten/1,
    typhon_rate_limits:owner/3.

:- dynamic left/4.              % Host, agent or owner, Id, Count

%!  may_leave(+Host) is det.
%
%   The running agent may leave a fact.  Of many that leave facts at once each
%   may be one too many.
%
%   @error resource_error(facts), resource_error(tuples)

may_leave(Host) :-
    (   quota_any(Host),
        context_now(_, Agent),
        Agent \== none
    ->  may_leave(Host, Agent)
    ;   true
    ).

may_leave(Host, Agent) :-
    quota_spend(Host, Agent, facts),
    (   tuples_bounded(Host),
        too_many(Host, Agent)
    ->  quota_passed(tuples)
    ;   true
    ).

tuples_bounded(Host) :- quota(Host, tuples, _), !.
tuples_bounded(Host) :- quota_shared(Host, _, tuples, _), !.

too_many(Host, Agent) :-
    quota(Host, tuples, Most),
    count(Host, agent, Agent, Count),
    Count >= Most,
    !.
too_many(Host, Agent) :-
    quota_shared(Host, Whose, tuples, Most),
    typhon_rate_limits:owner(Host, Agent, Owner),
    count(Host, owner, Owner, Count),
    too_many(Whose, Host, Count, Most),
    !.

%   When the space is full the agents that use most of it have to go.

too_many(owner, _, Count, Most) :-
    Count >= Most.
too_many(host, Host, Count, Most) :-
    count(Host, all, all, All),
    All >= Most,
    \+ ( left(Host, owner, _, More), More > Count ).

count(Host, Kind, Id, Count) :-
    (   left(Host, Kind, Id, Count0)
    ->  Count = Count0
    ;   Count = 0
    ).

%!  leaver(+Host, -By) is det.
%!  leaving_begins(+By) is det.
%!  leaving_ends(+By) is det.
%
%   By is the agent that leaves a fact now, `none` where they are not counted; a fact that is
%   By's is there, or is there no more.

leaver(Host, By) :-
    (   tuples_bounded(Host),
        context_now(_, Agent),
        typhon_rate_limits:owner(Host, Agent, Owner)
    ->  By = by(Host, Agent, Owner)
    ;   By = none
    ).

leaving_begins(By) :-
    counted(By, 1).

leaving_ends(By) :-
    counted(By, -1).

counted(none, _).
counted(by(Host, Agent, Owner), Change) :-
    with_mutex(typhon_tuple_quota,
               ( more(Host, agent, Agent, Change),
                 more(Host, owner, Owner, Change),
                 more(Host, all, all, Change) )).

more(Host, Kind, Id, Change) :-
    (   retract(left(Host, Kind, Id, Count0))
    ->  Count is Count0+Change
    ;   Count is Change
    ),
    (   Count > 0
    ->  assertz(left(Host, Kind, Id, Count))
    ;   true
    ).

typhon_quotas:forgotten(Host) :-
    with_mutex(typhon_tuple_quota, retractall(left(Host, _, _, _))).
