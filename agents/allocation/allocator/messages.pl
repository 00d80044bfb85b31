% Expects: lib, common; trail.
% Gives: ask/4, post/3, count_message/1.

/*  Between an allocator and robots.  A message to or from one that is
    elsewhere counts once for each link of the way the allocator came from
    there, without detours.
*/

%!  ask(+Robot, +Ref, +Question, -Answer) is det.
%
%   Of a robot on the spot.  Answer is `silence` if there is none.

ask(Robot, Ref, Question, Answer) :-
    parameter(patience, Seconds),
    (   tell(Robot, Question),
        receive(Robot-answer(Ref, Answer0), Seconds)
    ->  Answer = Answer0
    ;   Answer = silence
    ).

%!  post(+Host, +Robot, +Message) is semidet.
%
%   To the robot at Host.  Fails as tell/2.

post(Host, Robot, Message) :-
    count_message(Host),
    tell(Robot, Message).

%!  count_message(+Host) is det.
%
%   To or from the robot at Host.

count_message(Host) :-
    trail(Trail),
    links(Host, Trail, Links),
    count(message, Links).
