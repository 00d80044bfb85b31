:- module(typhon_quota_table,
          [ quota/3,                    % ?Host, ?What, -Most
            quota_shared/4,             % ?Host, ?Whose, ?What, -Most
            quota_any/1,                % ?Host
            quotas_put/3,               % +Host, +Quotas, -Changed
            quotas_drop/1,              % +Host
            quota_begin/0,
            quota_passed/1,             % +What
            quota_overrun/1,            % +What
            quota_passed_now/1          % -What
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [domain_error/2, must_be/2, resource_error/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module('../../kernel/base/own_thread', [abort_quietly/0]).
:- use_module('../../kernel/program', [machine_inside/0]).

/** <module> The quotas in force, and the errors of agents that exceed them

See typhon_quotas.  An agent that exceeds a quota ends with the outcome
raised(error(resource_error(What), _)), even if it catches this error.

*Threading*: any thread; quotas change under the mutex of host_start/2.  A
global variable of the thread holds the quota that the running agent has
exceeded.
*/

:- multifile typhon_names:known/2.

:- dynamic
    quota/3,                    % Host, What, Most
    quota_shared/4,             % Host, Whose: owner or host, What, Most
    quota_any/1.                % Host: it has at least one of them

%   kind(?What, -Whose): What may be a quota of each agent, of each owner or of
%   the host, as the list Whose says.

kind(inferences, [agent]).
kind(cells,      [agent]).
kind(payloads,   [agent]).
kind(mailbox,    [agent]).
kind(lifetime,   [agent]).
kind(agents,     [owner]).
kind(clones,     [agent, owner, host]).
kind(tuples,     [agent, owner, host]).
kind(messages,   [agent, owner, host]).
kind(log,        [agent, owner, host]).
kind(facts,      [agent, owner, host]).
kind(hops,       [agent, owner, host]).
kind(calls(_),   [agent, owner, host]).
kind(state,      [agent, owner, host]).
kind(seconds,    [agent, owner, host]).
kind(stack,      [agent, owner, host]).

typhon_names:known(quota, Name) :-
    kind(What, _),
    functor(What, Name, _).

                /*******************************
                *           IN FORCE           *
                *******************************/

%!  quota(?Host, ?What, -Most) is nondet.
%!  quota_shared(?Host, ?Whose, ?What, -Most) is nondet.
%!  quota_any(?Host) is nondet.
%
%   Host limits What for each agent; for the agents of each `owner` or for all
%   agents of the `host` together; Host has any quota.

%!  quotas_put(+Host, +Quotas:list, -Changed:boolean) is det.
%!  quotas_drop(+Host) is det.
%
%   Set the quotas of Host; delete them.  Changed is `true` if the quotas differ
%   from those before.  Of two quotas of the same kind the first one applies.
%
%   @error domain_error(quota, Quota), type_error(number, Most)

quotas_put(Host, Quotas, Changed) :-
    maplist(must_be_quota, Quotas),
    findall(quota(Whose, What, Most),
            in_force(Quotas, Whose, What, Most), News),
    findall(Old, has(Host, Old), Olds),
    (   Olds == News
    ->  Changed = false
    ;   Changed = true,
        quotas_drop(Host),
        forall(member(quota(Whose, What, Most), News),
               add(Whose, Host, What, Most))
    ).

quotas_drop(Host) :-
    retractall(quota(Host, _, _)),
    retractall(quota_shared(Host, _, _, _)),
    retractall(quota_any(Host)).

add(agent, Host, What, Most) :-
    !,
    assertz(quota(Host, What, Most)),
    is_bounded(Host).
add(Whose, Host, What, Most) :-
    assertz(quota_shared(Host, Whose, What, Most)),
    is_bounded(Host).

is_bounded(Host) :-
    (   quota_any(Host)
    ->  true
    ;   assertz(quota_any(Host))
    ).

%   The quotas of each agent come first, as in in_force/4.

has(Host, quota(agent, What, Most)) :-
    quota(Host, What, Most).
has(Host, quota(Whose, What, Most)) :-
    quota_shared(Host, Whose, What, Most).

in_force(Quotas, agent, What, Most) :-
    first_of(Quotas, agent, What, Most).
in_force(Quotas, Whose, What, Most) :-
    first_of(Quotas, Whose, What, Most),
    Whose \== agent.

first_of(Quotas, Whose, What, Most) :-
    append(Before, [Quota|_], Quotas),
    quota_parts(Quota, Whose, What, Most),
    \+ ( member(Other, Before), quota_parts(Other, Whose, What, _) ).

must_be_quota(Quota) :-
    (   quota_parts(Quota, Whose, What, Most),
        kind(What, All),
        memberchk(Whose, All),
        ( What = calls(PI) -> subsumes_term(_/_, PI) ; true )
    ->  must_be(ground, What),
        must_be(number, Most),
        ( Most > 0 -> true ; domain_error(quota, Quota) )
    ;   domain_error(quota, Quota)
    ).

quota_parts(Quota, Whose, What, Most) :-
    compound(Quota),
    (   compound_name_arguments(Quota, Whose0, [Of]),
        memberchk(Whose0, [owner, host]),
        compound(Of)
    ->  Whose = Whose0,
        what_most(Of, What, Most)
    ;   Whose = agent,
        what_most(Quota, What, Most)
    ).

what_most(calls(PI, Most), What, Most) :-
    !,
    What = calls(PI).
what_most(Quota, What, Most) :-
    compound_name_arguments(Quota, What, [Most]).

%!  quota_begin is det.
%
%   The turn of an agent begins in this thread: it has exceeded no quota yet.

quota_begin :-
    nb_setval(typhon_over, none).

%!  quota_passed(+What)
%
%   The running agent has exceeded the quota What.  It ends with its turn, even
%   if it catches this error; a second error aborts it at once, since a turn may
%   have no end.
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

%!  quota_overrun(+What)
%
%   As quota_passed/1, but abort the agent at once.  Called by a signal.

quota_overrun(What) :-
    nb_setval(typhon_over, What),
    abort_quietly.

%!  quota_passed_now(-What) is semidet.
%
%   The agent that this thread ran has exceeded the quota What.  The query
%   clears that, so that it does not count against the next agent of this
%   thread.

quota_passed_now(What) :-
    nb_current(typhon_over, What),
    What \== none,
    nb_setval(typhon_over, none).
