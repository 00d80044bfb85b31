% Expects: nothing.
% Gives: count/2, log_communications/0; state sent/2.

/*  Counts of messages and moves of an agent, as facts sent(Kind, Count): the
    inter-node communications of thesis section 7.6.
*/

:- dynamic sent/2.

%!  count(+Kind, +Times) is det.
%
%   Adds Times to the count of Kind.

count(_, 0) :-
    !.
count(Kind, Times) :-
    (   retract(sent(Kind, Count0))
    ->  true
    ;   Count0 = 0
    ),
    Count is Count0 + Times,
    assertz(sent(Kind, Count)).

%!  log_communications is det.
%
%   Logs the counts since the last call.

log_communications :-
    forall(retract(sent(Kind, Count)), log(communications(Kind, Count))).
