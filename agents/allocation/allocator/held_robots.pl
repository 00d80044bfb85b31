% Expects: task/3; common; messages.
% Gives: complete/0, needed/1, reserved/1, open_teams/1, mark/2, give_up/3,
%   avoided/1, avoid_none/0; its state.

/*  The robots of an allocator.

        held(Host, Robot, Ref, Team, Phase)
                                Phase is `reserved`, `started` or `done`
        achieved(Team)          for each robot that has done its part and
                                that the allocator does not hold any more
        avoided(Host)           where the allocator lost a robot that had
                                started, since it set out or last backed off

    The allocator does not ask the robot of an avoided host again before it
    has backed off.  Otherwise a robot on the current host whose execution
    fails at once would be reserved again, with another reward and without a
    hop, so that the mobility resource would grow without end.
*/

:- dynamic held/5, achieved/1, avoided/1.

%!  complete is semidet.
%
%   All robots that the task requires are reserved, or have done their part.

complete :-
    needed(Required),
    reserved(Required).

%!  needed(-Required) is det.
%!  reserved(-Count) is det.
%
%   NR and NQ of equations 7.1 and 7.2: how many robots the task requires, and
%   how many are reserved, or have done their part.

needed(Required) :-
    task(_, Teams, _),
    required(Teams, Required).

reserved(Count) :-
    aggregate_all(count, ( held(_, _, _, _, _) ; achieved(_) ), Count).

%!  open_teams(-Open:list(pair)) is det.
%
%   Team-Requirements for which robots are still needed.

open_teams(Open) :-
    task(_, Teams, _),
    findall(Team, ( held(_, _, _, Team, _) ; achieved(Team) ), Taken),
    findall(Team-Requirements,
            open_team(Teams, Taken, Team, Requirements),
            Open).

%!  mark(+Ref, +Phase) is det.

mark(Ref, Phase) :-
    (   retract(held(Host, Robot, Ref, Team, _))
    ->  assertz(held(Host, Robot, Ref, Team, Phase))
    ;   true
    ).

%!  give_up(+Host, +Ref, +Why) is semidet.
%
%   Removes the lost robot at Host and logs the loss.  A part that is done
%   still counts.

give_up(Host, Ref, Why) :-
    retract(held(Host, Robot, Ref, Team, Phase)),
    log(lost(Host, Why)),
    (   Phase == done
    ->  assertz(achieved(Team))
    ;   true
    ),
    (   Phase == started
    ->  assertz(avoided(Host))
    ;   true
    ),
    (   Why == silent
    ->  ignore(post(Host, Robot, release(Ref)))
    ;   true
    ).

%!  avoid_none is det.
%
%   The allocator may ask all robots again.

avoid_none :-
    retractall(avoided(_)).
