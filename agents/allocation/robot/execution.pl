% Expects: lib; reservation.
% Gives: start/3, finished/2.

/*  A clone of the robot, the hand, executes the task, so that the robot can
    answer messages meanwhile.
*/

%!  start(+Ref, +Goal, -Answer) is det.
%
%   Starts the hand.  Does not return in the hand.

start(Ref, Goal, Answer) :-
    hold(Ref, _, _, _, reserved),
    !,
    catch(clone(Branch), error(move_refused(_, Reason), _),
          Branch = refused(Reason)),
    begin(Branch, Ref, Goal, Answer).
start(Ref, _, Answer) :-
    (   hold(Ref, _, _, _, _)
    ->  Answer = started
    ;   Answer = refused(none)
    ).

begin(parent(Hand), Ref, _, started) :-
    phase(Ref, executing(Hand)).
begin(refused(Reason), _, _, refused(Reason)).
begin(clone(Robot), Ref, Goal, _) :-
    (   catch(Goal, Ball, true)
    ->  outcome(Ball, Outcome)
    ;   Outcome = failed
    ),
    send(Robot, finished(Ref, Outcome)),
    dispose.

outcome(Ball, Outcome) :-
    (   var(Ball)
    ->  Outcome = done
    ;   Ball = error(What, _)
    ->  Outcome = raised(What)
    ;   Outcome = raised(Ball)
    ).

%!  finished(+Outcome, +Ref) is det.
%
%   Handles the message of the hand.

finished(done, Ref) :-
    !,
    phase(Ref, done),
    hold(Ref, Owner, need(Task, _, _), Contact, _),
    here(Host),
    log(executed(Host, Owner, Task)),
    ignore(tell(Contact, done(Ref))).
finished(Outcome, _) :-
    lose(Outcome).
