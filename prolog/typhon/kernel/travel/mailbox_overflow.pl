:- module(typhon_mailbox_overflow,
          [ mail_fits/3                 % +Id, +Mail, -Fitting
          ]).
:- use_module(library(lists), [append/3]).
:- use_module('../host', [alarm_in/3, quota/3, scheduler_call/1]).
:- use_module('../agent', [agent_space/2]).
:- use_module(dead_letters, [mail_lost/3]).

/** <module> Messages that do not fit in a mailbox

On a host with the quota `mailbox` no more messages wait for an agent.  Those
that do not fit are lost, and this is reported here and where they were
sent, see typhon_dead_letters: those of a second together, so that a flood of
messages is not a flood of warnings.

*Threading*: mail_fits/3 inside with_agent/2 of the agent; told by workers.
*/

:- multifile
    typhon_scheduler:fire/2,
    typhon_scheduler:over/2.

:- dynamic refused/2.           % Id, Mail

most_untold(1000).

%!  mail_fits(+Id, +Mail:list, -Fitting:list) is det.
%
%   Of Mail, as of typhon_routing, there is space for Fitting in the mailbox of Id,
%   if that stands here; the rest is lost.

mail_fits(Id, Mail, Fitting) :-
    (   quota(_, mailbox, _),
        agent_space(Id, Space),
        length(Mail, Count),
        Count > Space
    ->  length(Fitting, Space),
        append(Fitting, Rest, Mail),
        refuse(Id, Rest)
    ;   Fitting = Mail
    ).

%   Added before it looks for others: a thread that reports meanwhile finds it, or has taken
%   them all.

refuse(Id, Mail) :-
    assertz(refused(Id, Mail), Ref),
    (   clause(refused(Id, _), true, Other),
        Other \== Ref
    ->  true
    ;   alarm_in(1, Id, refused)
    ),
    predicate_property(refused(_, _), number_of_clauses(Count)),
    most_untold(Most),
    (   Count mod Most =:= 0
    ->  scheduler_call(typhon_mailbox_overflow:tell(Id))
    ;   true
    ).

typhon_scheduler:fire(Id, refused) :-
    !,
    scheduler_call(typhon_mailbox_overflow:tell(Id)).

typhon_scheduler:over(Id, refused) :-
    \+ refused(Id, _).

:- public tell/1.

tell(Id) :-
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
