% Expects: lib, common; trail.
% Gives: ask/4, post/3, count_message/1.

/*  Messages between an allocator and robots. A message to or from a robot on
    another host counts once for each link of the allocator's trail from that
    host, without detours.
*/

%!  ask(+Robot, +Ref, +Question, -Answer) is det.
%
%   Asks a robot on this host.  Answer is `silence` if none arrives in time.

ask(Robot, Ref, Question, Answer) :-
    parameter(patience, Seconds),
    (   tell(Robot, Question),
        receive(Robot-answer(Ref, Answer0), Seconds)
    ->  Answer = Answer0
    ;   Answer = silence
    ).

%!  post(+Host, +Robot, +Message) is semidet.
%
%   Sends Message to the robot at Host.  Fails like tell/2.

post(Host, Robot, Message) :-
    count_message(Host),
    tell(Robot, Message).

%!  count_message(+Host) is det.
%
%   Counts a message to or from the robot at Host.

count_message(Host) :-
    trail(Trail),
    links(Host, Trail, Links),
    count(message, Links).
