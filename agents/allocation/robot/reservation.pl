% Expects: property/1, failed/0, cost/3; lib, common; watch.
% Gives: verdict/2, reserve/3, lose/1, free/0, phase/2; state hold/5.

/*  The reservation of the robot: hold(Ref, Owner, Need, Contact, Phase), at
    most one.
*/

:- dynamic hold/5.

%!  verdict(+Need, -Verdict) is det.
%
%   Verdict is the answer to a request of Need in the current state.

verdict(Need, refused(unfit)) :-
    \+ able(Need, _),
    !.
verdict(_, refused(failed)) :-
    failed,
    !.
verdict(Need, refused(Reason)) :-
    hold(_, _, Held, _, Phase),
    \+ yields(Held, Phase, Need),
    !,
    (   Phase == reserved
    ->  Reason = reserved
    ;   Reason = executing
    ).
verdict(Need, bid(Cost)) :-
    able(Need, Cost).

able(Need, Cost) :-
    Need = need(_, Requirements, _),
    findall(Property, property(Property), Properties),
    fit(Requirements, Properties),
    cost(Need, Properties, Cost),
    !.

yields(Held, reserved, Need) :-
    urgency(Held, Old),
    urgency(Need, New),
    New > Old.

urgency(need(_, _, Details), Priority) :-
    detail(priority, Details, 0, Priority).

%!  reserve(+Verdict, +Hold, -Answer) is det.
%
%   Hold, a hold/5, replaces the previous reservation, if Verdict is a bid.

reserve(bid(_), Hold, reserved) :-
    !,
    lose(preempted),
    assertz(Hold),
    Hold = hold(_, Owner, need(Task, _, _), _, _),
    here(Host),
    log(reserved(Host, Owner, Task)),
    parameter(watch, Seconds),
    remind(Seconds, ask).
reserve(Refusal, _, Refusal).

%!  lose(+Why) is det.
%
%   Ends the reservation, if there is one, and reports that to its contact.

lose(Why) :-
    hold(Ref, _, _, Contact, _),
    !,
    free,
    ignore(tell(Contact, lost(Ref, Why))).
lose(_).

%!  free is semidet.
%
%   Ends the reservation, and stops the execution.

free :-
    retract(hold(_, Owner, need(Task, _, _), _, Phase)),
    remind_nothing,
    stop(Phase),
    here(Host),
    log(released(Host, Owner, Task)).

stop(executing(Hand)) :-
    !,
    catch(typhon:agent_dispose(Hand), error(_, _), true).
stop(_).

%!  phase(+Ref, +Phase) is semidet.

phase(Ref, Phase) :-
    retract(hold(Ref, Owner, Need, Contact, _)),
    assertz(hold(Ref, Owner, Need, Contact, Phase)).
