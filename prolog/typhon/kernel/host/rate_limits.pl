:- module(typhon_rate_limits,
          [ quota_spend/3,              % +Host, +Agent, +What
            quota_spend/4,              % +Host, +Family, +What, +Most
            quota_cells/2,              % +Host, +Term
            quota_begin/0,
            quota_passed/1              % +What
          ]).
:- use_module(library(error), [resource_error/1]).
:- use_module('../base/stop_thread', [abort_quietly/0]).
:- use_module('../base/trees', [is_tree/2]).
:- use_module('../program', [machine_inside/0]).
:- use_module(context, [context_now/2]).
:- use_module(quotas, [quota/3, quota_any/1, quota_shared/4]).

/** <module> What agents use in a second

What is bounded by the second is counted when it is done: for the agent, and
where there are quotas of these, for its owner and for all on the host.

*Threading*: the thread that runs the agent.  An agent is counted by one
thread at a time; what it shares with others is counted under a mutex.
*/

:- multifile
    typhon_host_parts:part/4,
    typhon_quotas:forgotten/1,
    owner/3.                    % +Host, +Agent, -Owner

:- dynamic
    spent/4,                    % Agent, What, Second, Count
    shared/5.                   % Host, What, Owner or all, Second, Count

%!  quota_spend(+Host, +Agent, +What) is det.
%
%   Agent does What once more in this second.
%
%   @error resource_error(What)

quota_spend(Host, _, _) :-
    \+ quota_any(Host),
    !.
quota_spend(_, none, _) :-              % not an agent
    !.
quota_spend(Host, Agent, What) :-
    quota(Host, What, Most),
    !,
    this_second(Second),
    spend(Agent, What, Second, Most),
    spend_shared(Host, Agent, What).
quota_spend(Host, Agent, What) :-
    spend_shared(Host, Agent, What).

this_second(Second) :-
    get_time(Now),
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

%   An agent that left spends no more.

forget_some :-
    predicate_property(spent(_, _, _, _), number_of_clauses(Count)),
    Count > 10 000,
    !,
    this_second(Second),
    Old is Second-2,
    forall(( clause(spent(_, _, Then, _), true, Ref), Then < Old ),
           catch(erase(Ref), error(_, _), true)).
forget_some.

typhon_quotas:forgotten(Host) :-
    with_mutex(typhon_rate_limits, retractall(shared(Host, _, _, _, _))),
    (   quota(_, _, _)
    ->  true
    ;   retractall(spent(_, _, _, _))
    ).

                /*******************************
                *            TOGETHER          *
                *******************************/

spend_shared(Host, Agent, What) :-
    quota_shared(Host, _, What, _),
    !,
    (   owner(Host, Agent, Owner)
    ->  with_mutex(typhon_rate_limits, count(Host, What, Owner, Passed)),
        (   Passed == true
        ->  quota_passed(What)
        ;   true
        )
    ;   true                            % not an agent
    ).
spend_shared(_, _, _).

count(Host, What, Owner, Passed) :-
    this_second(Second),
    begin_second(Host, What, Second),
    one_more(Host, What, Owner, Second, Count),
    one_more(Host, What, all, Second, All),
    (   too_much(Host, What, Owner, Count, All)
    ->  Passed = true
    ;   Passed = false
    ).

begin_second(Host, What, Second) :-
    (   shared(Host, What, all, Second, _)
    ->  true
    ;   retractall(shared(Host, What, _, _, _))
    ).

one_more(Host, What, Owner, Second, Count) :-
    (   retract(shared(Host, What, Owner, Second, Count0))
    ->  Count is Count0+1
    ;   Count = 1
    ),
    assertz(shared(Host, What, Owner, Second, Count)).

%   No agent ends for what others do: of all, the most frequent end.

too_much(Host, What, _, Count, _) :-
    quota_shared(Host, owner, What, Most),
    Count > Most,
    !.
too_much(Host, What, _, Count, All) :-
    quota_shared(Host, host, What, Most),
    All > Most,
    \+ ( shared(Host, What, Other, _, More),
         Other \== all,
         More > Count ).

%!  quota_spend(+Host, +Family, +What, +Most) is det.
%
%   Agents of Family, an atom, do What once more in this second.
%
%   @error resource_error(What) if that has been more often than Most

quota_spend(Host, Family, What, Most) :-
    this_second(Second),
    with_mutex(typhon_rate_limits,
               ( begin_second(Host, What, Second),
                 one_more(Host, What, Family, Second, Count),
                 one_more(Host, What, all, Second, _) )),
    (   Count =< Most
    ->  true
    ;   quota_passed(What)
    ).

                /*******************************
                *             TERMS            *
                *******************************/

%!  quota_cells(+Host, +Term) is det.
%
%   @error resource_error(cells) if Term is too large to be said

quota_cells(Host, Term) :-
    quota(Host, cells, Most),
    \+ is_tree(Term, Most),
    !,
    quota_passed(cells).
quota_cells(_, _).

typhon_host_parts:part(makes_text, Host, 10, typhon_rate_limits:atoms_made) :-
    once(quota(Host, stack, _)).

:- public atoms_made/1.

%   atoms_made(+Length): the running agent makes atoms of that length together.
%   Their text is not part of the stack: what an agent makes between two stops
%   counts as if it were.
%
%   @error resource_error(stack)

atoms_made(Length) :-
    (   context_now(Host, Agent),
        Agent \== none,
        quota(Host, stack, Most),
        nb_current(typhon_atoms, Length0)
    ->  Length1 is Length0+Length,
        nb_setval(typhon_atoms, Length1),
        ( Length1 > Most -> quota_passed(stack) ; true )
    ;   true
    ).

%!  quota_begin is det.
%
%   The turn of an agent begins.

quota_begin :-
    nb_setval(typhon_over, none),
    nb_setval(typhon_atoms, 0).

%!  quota_passed(+What)
%
%   The running agent ends with its turn, even if it catches this; and at once
%   if it does so again, since a turn may have no end.
%
%   @error resource_error(What)

quota_passed(_) :-
    nb_current(typhon_over, Over),
    Over \== none,
    machine_inside,
    !,
    abort_quietly.
quota_passed(What) :-
    nb_setval(typhon_over, What),
    resource_error(What).
