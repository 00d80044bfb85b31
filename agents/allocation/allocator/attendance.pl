% Expects: lib; deadline, messages, held_robots.
% Gives: attend/0, heed/2.

/*  How an allocator handles messages of robots on other hosts, in any of its
    stages.
*/

%!  attend is det.
%
%   Handles all messages that have arrived, and checks the deadline.
%
%   @throws missed

attend :-
    (   receive(From-Message, 0)
    ->  heed(Message, From),
        attend
    ;   check_deadline
    ).

%!  heed(+Message, +From) is det.

heed(still(Ref), Robot) :-
    held(Host, Robot, Ref, _, _),
    !,
    count_message(Host),
    ignore(post(Host, Robot, yes(Ref))).
heed(still(Ref), Robot) :-
    !,
    ignore(tell(Robot, no(Ref))).
heed(done(Ref), _) :-
    held(Host, _, Ref, _, _),
    !,
    count_message(Host),
    mark(Ref, done).
heed(lost(Ref, Why), _) :-
    held(Host, _, Ref, _, _),
    !,
    count_message(Host),
    give_up(Host, Ref, Why).
heed(answer(Ref, What), _) :-
    held(Host, _, Ref, _, _),
    !,
    count_message(Host),
    answered(What, Host, Ref).
heed(finish, _) :-
    !,
    forall(held(_, _, Ref, _, started), mark(Ref, done)).
heed(_, _).

%   The answer of a robot to a start or a status request.

answered(refused(Why), Host, Ref) :-
    !,
    give_up(Host, Ref, Why).
answered(status(none), Host, Ref) :-
    !,
    give_up(Host, Ref, none).
answered(status(done), _, Ref) :-
    !,
    mark(Ref, done).
answered(_, _, _).
