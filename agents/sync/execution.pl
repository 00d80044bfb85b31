% Expects: nothing.
% Gives: executed/3.

%!  executed(+Sequence, +Task, +Goal) is nondet.
%
%   Runs Goal, the code of Task, and logs its start and its exceptions.  An
%   exception makes it fail.

executed(Sequence, Task, Goal) :-
    log(executing(Sequence, Task)),
    catch(Goal, Ball, raised(Sequence, Task, Ball)).

raised(Sequence, Task, Ball) :-
    (   Ball = error(What, _)
    ->  true
    ;   What = Ball
    ),
    log(raised(Sequence, Task, What)),
    fail.
