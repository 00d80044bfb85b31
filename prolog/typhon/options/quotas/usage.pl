:- module(typhon_usage,
          [ usage_begin/0,
            usage_forget/1              % +Host
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../../kernel/base/error_text', [is_tree/2]).
:- use_module('../../kernel/host', [context_now/2]).
:- use_module('../../kernel/agent', [agent/5, life_payloads/2]).
:- use_module(quota_agents, [quota_owned/3, quota_owner/3]).
:- use_module(quota_table,
              [ quota/3, quota_any/1, quota_begin/0, quota_passed/1,
                quota_shared/4 ]).

/** <module> Counters for the quotas of acts, clones and tuples

Acts with a quota for each second are counted for the agent and, where such
quotas exist, for its owner and for all agents on the host.  Where quotas of
tuples exist, the facts in the tuple space are counted for each agent, for each
owner, and in all; a fact still counts when its agent has left.

*Threading*: the thread that runs the agent.  Only one thread at a time counts
for an agent; counts that agents share are changed under a mutex.
*/

:- multifile
    typhon_host_parts:part/4,
    typhon_place:counted/2.

:- dynamic
    spent/4,                    % Agent, What, Second, Count
    shared/5,                   % Host, What, Owner or all, Second, Count
    left/4.                     % Host, agent or owner, Id, Count: of tuples

                /*******************************
                *              ACTS            *
                *******************************/

typhon_host_parts:part(acts, Host, 10, typhon_usage:acts(Host)) :-
    quota_any(Host).

:- public acts/3.

%   acts(+Host, +Agent, +Act): Agent is `none` for calls outside of agents.
%
%   @error resource_error(What)

acts(Host, Agent, send(Message)) =>
    spend(Host, Agent, messages),
    must_be_small(Host, Message).
acts(Host, Agent, log(What)) =>
    spend(Host, Agent, log),
    must_be_small(Host, What).
acts(Host, Agent, leave(Fact)) =>
    may_leave(Host, Agent),
    must_be_small(Host, Fact).
acts(Host, Agent, emit(What)) =>
    spend(Host, Agent, facts),
    must_be_small(Host, What).
acts(Host, _, say(Term)) =>
    must_be_small(Host, Term).
acts(Host, Agent, service(PI)) =>
    spend(Host, Agent, calls(PI)).
acts(Host, Agent, move) =>
    spend(Host, Agent, hops).
acts(Host, Agent, clone) =>
    may_clone(Host, Agent).
acts(Host, Agent, attach) =>
    may_attach(Host, Agent).

must_be_small(Host, Term) :-
    (   quota(Host, cells, Most),
        \+ is_tree(Term, Most)
    ->  quota_passed(cells)
    ;   true
    ).

may_attach(Host, Agent) :-
    (   quota(Host, payloads, Most),
        agent(Agent, _, _, _, Life),
        life_payloads(Life, Payloads),
        length(Payloads, Count),
        Count >= Most
    ->  quota_passed(payloads)
    ;   true
    ).

%!  usage_forget(+Host) is det.
%
%   Host has ended: drop its counts.

usage_forget(Host) :-
    with_mutex(typhon_usage,
               ( retractall(shared(Host, _, _, _, _)),
                 retractall(left(Host, _, _, _)) )),
    (   quota(_, _, _)
    ->  true
    ;   retractall(spent(_, _, _, _))
    ).

                /*******************************
                *          IN A SECOND         *
                *******************************/

%   spend(+Host, +Agent, +What): count one more act What of Agent in this
%   second.

spend(_, none, _) :-
    !.
spend(Host, Agent, What) :-
    (   quota(Host, What, Most)
    ->  this_second(Second),
        spend(Agent, What, Second, Most)
    ;   true
    ),
    spend_shared(Host, Agent, What).

this_second(Second) :-
    monotonic_time(Now),
    Second is integer(Now).

spend(Agent, What, Second, Most) :-
    (   retract(spent(Agent, What, Then, Count0)),
        Then =:= Second
    ->  Count is Count0+1
    ;   Count = 1,
        forget_some
    ),
    assertz(spent(Agent, What, Second, Count)),
    (   Count =< Most
    ->  true
    ;   quota_passed(What)
    ).

%   Agents that have left do not remove their counts, so old counts are dropped
%   when there are many.

forget_some :-
    predicate_property(spent(_, _, _, _), number_of_clauses(Count)),
    Count > 10 000,
    !,
    this_second(Second),
    Old is Second-2,
    forall(( clause(spent(_, _, Then, _), true, Ref), Then < Old ),
           catch(erase(Ref), error(_, _), true)).
forget_some.

spend_shared(Host, Agent, What) :-
    once(quota_shared(Host, _, What, _)),
    owner(Host, Agent, Owner),
    with_mutex(typhon_usage, exceeds(Host, What, Owner)),
    !,
    quota_passed(What).
spend_shared(_, _, _).

owner(Host, Agent, Owner) :-
    quota_owner(Agent, Host, Owner),
    !.

%   exceeds(+Host, +What, +Owner): with one more act What of Owner in this
%   second, its agents act too often.

exceeds(Host, What, Owner) :-
    this_second(Second),
    begin_second(Host, What, Second),
    count_one(Host, What, Owner, Second, Count),
    count_one(Host, What, all, Second, All),
    too_often(Host, What, Count, All).

begin_second(Host, What, Second) :-
    (   shared(Host, What, all, Second, _)
    ->  true
    ;   retractall(shared(Host, What, _, _, _))
    ).

count_one(Host, What, Owner, Second, Count) :-
    (   retract(shared(Host, What, Owner, Second, Count0))
    ->  Count is Count0+1
    ;   Count = 1
    ),
    assertz(shared(Host, What, Owner, Second, Count)).

%   An agent must not end because of the acts of others: if all agents together
%   exceed the quota of the host, it ends only if no owner acts more often than
%   its own.

too_often(Host, What, Count, _) :-
    quota_shared(Host, owner, What, Most),
    Count > Most,
    !.
too_often(Host, What, Count, All) :-
    quota_shared(Host, host, What, Most),
    All > Most,
    \+ ( shared(Host, What, Other, _, More),
         Other \== all,
         More > Count ).

%   may_clone(+Host, +Agent): the quotas limit the number of agents with the
%   program and owner of Agent, with its owner, and in all on the host.  They
%   also limit the clones made in a second.  Otherwise a program would clone for
%   ever, as fast as its surplus clones end.

may_clone(Host, Agent) :-
    owner(Host, Agent, Owner),
    !,
    family_may_clone(Host, Agent, Owner),
    (   quota_shared(Host, Whose, clones, Most),
        ( Whose == host -> true ; Of = Owner ),
        quota_owned(Host, Of, Count),
        Count > Most
    ->  quota_passed(clones)
    ;   true
    ).
may_clone(_, _).

family_may_clone(Host, Agent, Owner) :-
    quota(Host, clones, Most),
    !,
    agent(Agent, _, _, Hash, _),
    aggregate_all(count,
                  ( quota_owner(Other, Host, Owner),
                    agent(Other, Host, _, Hash, _) ),
                  Count),
    atomic_list_concat([Owner,Hash], ' ', Family),
    (   Count =< Most,
        clones_in_second(Host, Family, Cloned),
        Cloned =< Most
    ->  true
    ;   quota_passed(clones)
    ).
family_may_clone(_, _, _).

clones_in_second(Host, Family, Count) :-
    this_second(Second),
    with_mutex(typhon_usage,
               ( begin_second(Host, clones, Second),
                 count_one(Host, clones, Family, Second, Count),
                 count_one(Host, clones, all, Second, _) )).

                /*******************************
                *             TUPLES           *
                *******************************/

%   Agents that leave facts at the same moment may exceed the quota, by one fact
%   each.

may_leave(_, none) :-
    !.
may_leave(Host, Agent) :-
    spend(Host, Agent, facts),
    (   tuples_bounded(Host),
        too_many(Host, Agent)
    ->  quota_passed(tuples)
    ;   true
    ).

tuples_bounded(Host) :- quota(Host, tuples, _), !.
tuples_bounded(Host) :- quota_shared(Host, _, tuples, _), !.

too_many(Host, Agent) :-
    quota(Host, tuples, Most),
    left_by(Host, agent, Agent, Count),
    Count >= Most,
    !.
too_many(Host, Agent) :-
    quota_shared(Host, Whose, tuples, Most),
    owner(Host, Agent, Owner),
    left_by(Host, owner, Owner, Count),
    too_many(Whose, Host, Count, Most),
    !.

%   When the tuple space is full, only agents of the owner with most facts end.

too_many(owner, _, Count, Most) :-
    Count >= Most.
too_many(host, Host, Count, Most) :-
    left_by(Host, all, all, All),
    All >= Most,
    \+ ( left(Host, owner, _, More), More > Count ).

left_by(Host, Kind, Id, Count) :-
    (   left(Host, Kind, Id, Count0)
    ->  Count = Count0
    ;   Count = 0
    ).

%   A fact that an agent leaves is marked with by(Host, Agent, Owner).

typhon_host_parts:part(tuple, Host, 10, typhon_usage:by) :-
    tuples_bounded(Host).

:- public by/4.

by(Host, Agent, _, By) :-
    (   owner(Host, Agent, Owner)
    ->  By = by(Host, Agent, Owner)
    ;   By = none
    ).

typhon_place:counted(by(Host, Agent, Owner), Change) :-
    with_mutex(typhon_usage,
               ( add_tuples(Host, agent, Agent, Change),
                 add_tuples(Host, owner, Owner, Change),
                 add_tuples(Host, all, all, Change) )).

add_tuples(Host, Kind, Id, Change) :-
    (   retract(left(Host, Kind, Id, Count0))
    ->  Count is Count0+Change
    ;   Count is Change
    ),
    (   Count > 0
    ->  assertz(left(Host, Kind, Id, Count))
    ;   true
    ).

%!  usage_begin is det.

usage_begin :-
    quota_begin,
    nb_setval(typhon_atoms, 0).

typhon_host_parts:part(makes_text, Host, 10, typhon_usage:atoms_made(Most)) :-
    quota(Host, stack, Most).

:- public atoms_made/2.

%   atoms_made(+Most, +Length): the running agent makes atoms with Length
%   characters in all.  The text of atoms is not on the stack, but the text made
%   since the last stop of the agent counts like its stack.
%
%   @error resource_error(stack)

atoms_made(Most, Length) :-
    (   context_now(_, Agent),
        Agent \== none,
        nb_current(typhon_atoms, Length0)
    ->  Length1 is Length0+Length,
        nb_setval(typhon_atoms, Length1),
        ( Length1 > Most -> quota_passed(stack) ; true )
    ;   true
    ).
