:- module(typhon_mailbox_quota, []).
:- use_module(library(lists), [append/3]).
:- use_module('../../kernel/host', [alarm_in/3, scheduler_call/1]).
:- use_module('../../kernel/agent', [mail_count/2]).
:- use_module('../../kernel/travel', [mail_lost/3]).
:- use_module(quota_table, [quota/3]).

/** <module> Messages that do not fit in a mailbox

On a host with the quota `mailbox` no more messages wait for an agent.  Those
that do not fit are lost, and this is reported here and where they were
sent, see typhon_dead_letters: those of a second together, so that a flood of
messages is not a flood of warnings.

*Threading*: fits/5 inside with_agent/2 of the agent; workers report.
*/

:- multifile
    typhon_host_parts:part/4,
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- dynamic refused/2.           % Id, Mail: not reported yet

most_unreported(1000).

typhon_host_parts:part(deliver, Host, 10, typhon_mailbox_quota:fits(Most)) :-
    quota(Host, mailbox, Most).

:- public fits/5.

%   fits(+Most, +Host, +Id, +Mail, -Fitting): of Mail, as of typhon_routing,
%   there is space for Fitting in the mailbox of Id; the rest is lost.

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

%   Added before it looks for others: a thread that reports meanwhile finds it,
%   or has taken them all.

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
    ->  scheduler_call(typhon_mailbox_quota:report(Id))
    ;   true
    ).

typhon_scheduler:fire(Id, refused) :-
    !,
    scheduler_call(typhon_mailbox_quota:report(Id)).

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
