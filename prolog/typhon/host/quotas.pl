:- module(typhon_quotas,
          [ quota_set/3,                % +Host, +Policy, +Quotas
            quota_forget/1,             % +Host
            quota/3,                    % ?Host, ?What, -Most
            quota_spend/3,              % +Host, +Agent, +What
            quota_cells/2,              % +Host, +Term
            quota_passed/1              % +What
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2, resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/trees', [is_tree/2]).
:- use_module('../base/own_thread', [in_own_thread/1]).

/** <module> How much an agent may use on a host

Quotas are What(Most), of each agent that stands on the host:

  - inferences(N), seconds(S): between two stops
  - stack(Bytes), state(Bytes)
  - cells(N): parts of what it sends, logs, leaves or gives as its result
  - clones(N): agents of one program and one owner that are here when it
    clones
  - payloads(N): that it carries when it attaches one
  - tuples(N): facts in the tuple space when it leaves one
  - messages(N), log(N), facts(N): sent, logged and left in a second

A host that guards has those of the setting `guarded`, where it is not said
otherwise.  A host without quotas does without all of this: looking whether
there are some is all that it costs.

While there are hosts with the quota `seconds` or `stack`, a thread looks ten times a
second at who runs.

*Threading*: quota_set/3 and quota_forget/1 as host_start/2, the others in
any thread.
*/

:- multifile look/0.            % who runs for too long is interrupted

:- dynamic
    quota/3,                    % Host, What, Most
    spent/4,                    % Agent, What, Second, Count
    watching/1.                 % Thread

%   quota_default(?Quota): where strangers are let in.

quota_default(seconds(5)).
quota_default(stack(67 108 864)).
quota_default(state(16 777 216)).
quota_default(cells(200 000)).
quota_default(clones(100)).
quota_default(payloads(100)).
quota_default(tuples(100 000)).
quota_default(messages(10 000)).
quota_default(facts(10 000)).
quota_default(log(1000)).

%!  quota_set(+Host, +Policy, +Quotas:list) is det.
%
%   @error domain_error(quota, Quota), type_error(number, Most)

quota_set(Host, Policy, Quotas) :-
    maplist(must_be_quota, Quotas),
    findall(What-Most, in_force(Policy, Quotas, What, Most), Pairs),
    retractall(quota(Host, _, _)),
    forall(member(What-Most, Pairs), assertz(quota(Host, What, Most))),
    watch.

must_be_quota(Quota) :-
    (   compound(Quota),
        Quota =.. [What,Most],
        memberchk(What, [ inferences, seconds, stack, state, cells, clones, payloads,
                          tuples, messages, facts, log ])
    ->  must_be(number, Most),
        ( Most > 0 -> true ; domain_error(quota, Quota) )
    ;   domain_error(quota, Quota)
    ).

in_force(_, Quotas, What, Most) :-
    member(Quota, Quotas),
    Quota =.. [What,Most].
in_force(Policy, Quotas, What, Most) :-
    Policy \== trusted,
    quota_default(Default),
    Default =.. [What,Most],
    functor(Given, What, 1),
    \+ memberchk(Given, Quotas).

%!  quota(?Host, ?What, -Most) is nondet.
%
%   A host of this process has a quota.

%!  quota_forget(+Host) is det.

quota_forget(Host) :-
    retractall(quota(Host, _, _)),
    watch,
    (   quota(_, _, _)
    ->  true
    ;   retractall(spent(_, _, _, _))
    ).

%!  quota_spend(+Host, +Agent, +What) is det.
%
%   Agent does What once more in this second.
%
%   @error resource_error(What)

quota_spend(Host, Agent, What) :-
    quota(Host, What, Most),
    !,
    get_time(Now),
    Second is integer(Now),
    spend(Agent, What, Second, Most).
quota_spend(_, _, _).

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

%!  quota_cells(+Host, +Term) is det.
%
%   @error resource_error(cells) if Term is too large to be said

quota_cells(Host, Term) :-
    quota(Host, cells, Most),
    \+ is_tree(Term, Most),
    !,
    quota_passed(cells).
quota_cells(_, _).

%!  quota_passed(+What)
%
%   The running agent ends with its turn, even if it catches this.
%
%   @error resource_error(What)

quota_passed(What) :-
    nb_setval(typhon_over, What),
    resource_error(What).

%   Who has gone does not come to spend more.

forget_some :-
    predicate_property(spent(_, _, _, _), number_of_clauses(Count)),
    Count > 10 000,
    !,
    get_time(Now),
    Old is integer(Now)-2,
    forall(( clause(spent(_, _, Second, _), true, Ref), Second < Old ),
           catch(erase(Ref), error(_, _), true)).
forget_some.

                /*******************************
                *           THE WATCH          *
                *******************************/

watch :-
    ( quota(_, seconds, _) ; quota(_, stack, _) ),
    !,
    (   watching(_)
    ->  true
    ;   thread_create(typhon_quotas:watch_on, Thread,
                      [alias(typhon_quota_watch)]),
        assertz(watching(Thread))
    ).
watch :-
    (   retract(watching(Thread))
    ->  thread_send_message(Thread, stop),
        in_own_thread(thread_join(Thread, _))
    ;   true
    ).

:- public watch_on/0.

watch_on :-
    thread_self(Me),
    (   thread_get_message(Me, stop, [timeout(0.1)])
    ->  true
    ;   catch(forall(look, true), error(Formal, Context),
              print_message(error, error(Formal, Context))),
        watch_on
    ).
