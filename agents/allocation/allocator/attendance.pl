% Expects: lib; deadline, messages, held_robots.
% Gives: attend/0, heed/2.

/*  What an allocator does about messages that come from robots elsewhere,
    whatever it is doing.
*/

%!  attend is det.
%
%   Heeds all messages that have come, and the time.
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

%   What a robot said that was told to start, or asked how it is.

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
