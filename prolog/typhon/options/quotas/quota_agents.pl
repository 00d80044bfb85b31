:- module(typhon_quota_agents,
          [ quota_agents_again/1,       % +Host
            quota_owner/3,              % ?Id, ?Host, -Owner
            quota_owned/3,              % +Host, ?Owner, -Count
            quota_until/3,              % +Id, ?Host, -Until
            quota_text/2                % +Id, -Characters
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [append/3]).
:- use_module('../../kernel/host',
              [ alarm_in/3, alarm_set/3, amended/5, context_now/2,
                host_address/2, host_time/2, real_time/3, scheduler_call/1 ]).
:- use_module('../../kernel/agent',
              [ agent/5, agent_origin/5, mail_count/2, origin_key/2,
                with_agent/2 ]).
:- use_module(quota_table,
              [quota/3, quota_any/1, quota_passed/1, quota_shared/4]).
:- use_module('../../kernel/travel', [mail_lost/3]).

/** <module> Agents on hosts with quotas

The module decides which agents may enter, records the owner of each and until
when it may stay, and bounds the size of its state.

On a host with the quota `mailbox` at most that many messages wait for an agent.
Further messages become dead letters, which are reported here and where they
were sent, see typhon_mail.  Those of one second are reported together,
so that a flood of messages is not a flood of warnings.

*Threading*: any thread.  Agents arrive and leave inside with_agent/2.  Agents
that arrive at the same moment may exceed a quota, by one agent for each thread.
Mailboxes are also checked inside with_agent/2; workers report the messages that
do not fit.
*/

:- multifile
    typhon_gate:forbidden/2,
    typhon_host_parts:part/4.

:- dynamic
    admitted/4,                 % Id, Host, Owner: an atom, Until or inf
    text/2.                     % Id, Characters: of atoms in its state

                /*******************************
                *           ADMISSION          *
                *******************************/

typhon_host_parts:part(admit, Host, 40, typhon_quota_agents:forbids) :-
    quota_any(Host).

typhon_gate:forbidden(error(resource_error(program_space), _), quota(state)).

:- public forbids/4.

forbids(From, Entrant, Host, refused(quota(What))) :-
    too_much(What, From, Entrant, Host).

%   too_much(-What, +From, +Entrant, +Host)

too_much(mailbox, From, Entrant, Host) :-
    quota(Host, mailbox, Most),
    brought(From, Entrant, Count),
    Count > Most.
too_much(state, _, entrant(_, _, _, module(Module), _), Host) :-
    quota(Host, state, Most),
    module_property(Module, program_size(Size)),
    Size > Most.
too_much(agents, From, entrant(Agent, Hash, _, State, _), Host) :-
    quota_shared(Host, owner, agents, Most),
    owned(From, Agent, State, Host, Id, Owned),
    agent_origin(Host, Id, Hash, Owned, Owner),
    origin_key(Owner, Key),
    quota_owned(Host, Key, Count),
    Count >= Most.

brought(going, entrant(Id, _, _, _, _), Count) :-
    !,
    mail_count(Id, Count).
brought(_, entrant(_, _, _, _, Mail), Count) :-
    length(Mail, Count).

%   owned(+From, +Agent, +State0, +Host, -Id, -State): Id and State determine
%   the owner.  An agent that is being created has no id yet; its owner depends
%   only on this process, so any id of this process serves.

owned(going, Id, State, _, Id, State).
owned(here, _, State, Host, Id, State) :-
    newborn(Host, Id).
owned(from(Peer, _, Shown), Agent, State0, Host, Id, State) :-
    ( Shown == newborn -> newborn(Host, Id) ; Id = Agent ),
    amended(created, Host, Peer, State0, State).

newborn(Host, Id) :-
    host_address(Host, Address),
    atom_concat('newborn@', Address, Id).

                /*******************************
                *         COME AND GO          *
                *******************************/

typhon_host_parts:part(comes, Host, 10, typhon_quota_agents:comes) :-
    quota_any(Host).
typhon_host_parts:part(goes, Host, 10, typhon_quota_agents:goes) :-
    quota_any(Host).

:- public comes/4, goes/3.

comes(Id, Host, Module, Hash) :-
    state_bounded(Host, Module),
    (   agent_origin(Host, Id, Hash, module(Module), Owner)
    ->  origin_key(Owner, Key),
        until(Host, Until),
        assertz(admitted(Id, Host, Key, Until)),
        ends_at(Until, Host, Id)
    ;   true
    ).

goes(Id, _, Module) :-
    set_module(Module:program_space(0)),
    retractall(admitted(Id, _, _, _)),
    retractall(text(Id, _)).

%!  quota_agents_again(+Host) is det.
%
%   The quotas of Host have changed: apply them to the agents on it.

quota_agents_again(Host) :-
    forall(agent(Id, Host, _, _, _),
           ignore(with_agent(Id, readmit(Id, Host)))).

readmit(Id, Host) :-
    agent(Id, Host, Module, Hash, _),
    !,
    goes(Id, Host, Module),
    (   quota_any(Host)
    ->  comes(Id, Host, Module, Hash)
    ;   true
    ).

until(Host, Until) :-
    quota(Host, lifetime, Seconds),
    host_time(Host, Now),
    !,
    Until is Now+Seconds.
until(_, inf).

ends_at(inf, _, _) :-
    !.
ends_at(Until, Host, Id) :-
    real_time(Host, Until, Stamp),
    alarm_set(Stamp, Id, stays(Until)).

%!  quota_owner(?Id, ?Host, -Owner:atom) is nondet.
%
%   The agent Id is on Host, which has quotas, and belongs to Owner.

quota_owner(Id, Host, Owner) :-
    admitted(Id, Host, Owner, _).

%!  quota_owned(+Host, ?Owner:atom, -Count:integer) is det.
%
%   Owner has Count agents on Host.  If Owner is unbound Count includes the
%   agents of all owners.

quota_owned(Host, Owner, Count) :-
    aggregate_all(count, admitted(_, Host, Owner, _), Count).

%!  quota_until(+Id, ?Host, -Until:number) is semidet.
%
%   The lifetime of Id on Host ends at Until, a time of the clock of Host.

quota_until(Id, Host, Until) :-
    admitted(Id, Host, _, Until),
    Until \== inf,
    !.

                /*******************************
                *             STATE            *
                *******************************/

%   While a module gets its state it may not exceed the quota; afterwards it may
%   be as large as it was on arrival.

typhon_host_parts:part(module, Host, 10, typhon_quota_agents:module(Most)) :-
    quota(Host, state, Most).

:- public module/2.

module(Most, Module) :-
    set_module(Module:program_space(Most)).

state_bounded(Host, Module) :-
    (   quota(Host, state, Most)
    ->  module_property(Module, program_size(Size)),
        Space is max(integer(Most), Size),
        set_module(Module:program_space(Space))
    ;   true
    ).

%   The size of a clause does not include the text of its atoms, which Prolog
%   stores elsewhere.  So the text of added clauses is counted.  Removed clauses
%   are not subtracted: when the count exceeds the quota, the present text is
%   counted again.

typhon_host_parts:part(adds_clause, Host, 10,
                       typhon_quota_agents:text_added(Most)) :-
    quota(Host, state, Most).

:- public text_added/3.

%   text_added(+Most, +Module, +Clause): the running agent, whose state is in
%   Module, adds Clause.
%
%   @error resource_error(state)

text_added(Most, Module, Clause) :-
    (   context_now(_, Id),
        Id \== none
    ->  atoms_length(Clause, Length),
        add(Id, Length, Count),
        (   Count =< Most
        ->  true
        ;   recount(Id, Module, Length, Most)
        )
    ;   true
    ).

add(Id, Length, Count) :-
    (   retract(text(Id, Count0))
    ->  Count is Count0+Length
    ;   Count = Length
    ),
    assertz(text(Id, Count)).

%   atoms_length(+Term, -Length): Length is the sum of the lengths of the atoms in
%   Term, which is acyclic.

atoms_length(Term, Length) :-
    atoms_length(Term, 0, Length).

atoms_length(Term, N0, N) :-
    (   compound(Term)
    ->  compound_name_arity(Term, _, Arity),
        atoms_below(Arity, Term, N0, N)
    ;   atom(Term)
    ->  atom_length(Term, Length),
        N is N0+Length
    ;   N = N0
    ).

atoms_below(0, _, N, N) :-
    !.
atoms_below(I, Term, N0, N) :-
    arg(I, Term, Arg),
    atoms_length(Arg, N0, N1),
    I1 is I-1,
    atoms_below(I1, Term, N1, N).

recount(Id, Module, Length, Most) :-
    aggregate_all(sum(Its),
                  ( state_clause(Module, Head, Body),
                    atoms_length(Head-Body, Its) ),
                  There),
    retractall(text(Id, _)),
    Count is There+Length,
    assertz(text(Id, Count)),
    (   Count =< Most
    ->  true
    ;   quota_passed(state)
    ).

state_clause(Module, Head, Body) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    clause(Module:Head, Body).

%!  quota_text(+Id, -Characters:integer) is det.
%
%   Characters is the length of the text added to the state of Id.  It may
%   include text that was removed since.

quota_text(Id, Characters) :-
    (   text(Id, Count)
    ->  Characters = Count
    ;   Characters = 0
    ).

                /*******************************
                *          MAILBOXES           *
                *******************************/

:- multifile
    typhon_host_parts:part/4,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- dynamic refused/2.           % Id, Mail: not reported yet

most_unreported(1000).

typhon_host_parts:part(deliver, Host, 10, typhon_quota_agents:fits(Most)) :-
    quota(Host, mailbox, Most).

:- public fits/5.

%   fits(+Most, +Host, +Id, +Mail, -Fitting): the mailbox of Id has space for
%   Fitting, a prefix of Mail, see typhon_mail; the rest becomes dead
%   letters.

fits(Most, _, Id, Mail, Fitting) :-
    mail_count(Id, There),
    Space is max(0, integer(Most)-There),
    length(Mail, Count),
    (   Count > Space
    ->  length(Fitting, Space),
        append(Fitting, Rest, Mail),
        refuse(Id, Rest)
    ;   Fitting = Mail
    ).

%   The thread adds its fact before it looks for other facts.  So either a
%   reporting thread finds this fact too, or it has taken all others, and this
%   thread sets a new alarm.

refuse(Id, Mail) :-
    assertz(refused(Id, Mail), Ref),
    (   clause(refused(Id, _), true, Other),
        Other \== Ref
    ->  true
    ;   alarm_in(1, Id, refused)
    ),
    predicate_property(refused(_, _), number_of_clauses(Count)),
    most_unreported(Most),
    (   Count mod Most =:= 0
    ->  scheduler_call(typhon_quota_agents:report(Id))
    ;   true
    ).

typhon_scheduler:fire(Id, refused) :-
    !,
    scheduler_call(typhon_quota_agents:report(Id)).

typhon_scheduler:over(Id, refused) :-
    \+ refused(Id, _).

:- public report/1.

report(Id) :-
    taken(Id, Mail),
    (   Mail == []
    ->  true
    ;   mail_lost(resource_error(mailbox), Id, Mail)
    ).

taken(Id, Mail) :-
    (   retract(refused(Id, Some))
    ->  append(Some, More, Mail),
        taken(Id, More)
    ;   Mail = []
    ).
