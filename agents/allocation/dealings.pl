/*  How an allocator deals with robots: it negotiates with those on the spot,
    heeds what comes from others, and counts what it sends.  To be included.

    A message to or from a robot that is elsewhere counts once for each link
    of the way the allocator came from there, without detours.
*/

                /*******************************
                *          NEGOTIATION         *
                *******************************/

negotiate :-
    here(Host),
    \+ held(Host, _, _, _, _),
    sense(robot(Robot)),
    !,
    task(_, Teams, _),
    findall(Team, ( held(_, _, _, Team, _) ; achieved(Team) ), Taken),
    findall(Team-Requirements,
            open_team(Teams, Taken, Team, Requirements),
            Open),
    approach(Open, Robot).
negotiate.

%   A robot that is unfit for one team may do for another.

approach([], _).
approach([Team-Requirements|Open], Robot) :-
    task(Name, _, Details),
    Need = need(Name, Requirements, Details),
    self(Me),
    hops(Hops),
    backoffs(Backoffs),
    Ref = ref(Me, Backoffs, Hops, Team),
    ask(Robot, Ref, ask(Ref, Need), Answer),
    (   Answer == refused(unfit)
    ->  approach(Open, Robot)
    ;   negotiated(Answer, Robot, Ref, Need)
    ).

ask(Robot, Ref, Question, Answer) :-
    parameter(patience, Seconds),
    (   tell(Robot, Question),
        receive(Robot-answer(Ref, Answer0), Seconds)
    ->  Answer = Answer0
    ;   Answer = silence
    ).

negotiated(bid(Cost), Robot, Ref, Need) :-
    Need = need(_, _, Details),
    backoffs(Backoffs),
    agreed(Cost, Details, Backoffs),
    !,
    self(Me),
    ask(Robot, Ref, reserve(Ref, Me, Need), Answer),
    settle(Answer, Robot, Ref).
negotiated(refused(Reason), _, _, _) :-
    memberchk(Reason, [reserved, executing]),
    !,
    suffer.
negotiated(_, _, _, _).

settle(reserved, Robot, Ref) :-
    !,
    reserved(Before),
    here(Host),
    Ref = ref(_, _, _, Team),
    assertz(held(Host, Robot, Ref, Team, reserved)),
    gain(Before).
settle(refused(_), _, _) :-
    !,
    suffer.
settle(silence, Robot, Ref) :-
    ignore(tell(Robot, release(Ref))).

                /*******************************
                *            MESSAGES          *
                *******************************/

%   attend: heed all messages that have come, and the time.

attend :-
    (   receive(From-Message, 0)
    ->  heed(Message, From),
        attend
    ;   check_deadline
    ).

heed(still(Ref), Robot) :-
    held(Host, Robot, Ref, _, _),
    !,
    received(Host),
    ignore(post(Host, Robot, yes(Ref))).
heed(still(Ref), Robot) :-
    !,
    ignore(tell(Robot, no(Ref))).
heed(done(Ref), _) :-
    held(Host, _, Ref, _, _),
    !,
    received(Host),
    mark(Ref, done).
heed(lost(Ref, Why), _) :-
    held(Host, _, Ref, _, _),
    !,
    received(Host),
    give_up(Host, Ref, Why).
heed(answer(Ref, What), _) :-
    held(Host, _, Ref, _, _),
    !,
    received(Host),
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

%   What was done stays done.

give_up(Host, Ref, Why) :-
    retract(held(Host, Robot, Ref, Team, Phase)),
    log(lost(Host, Why)),
    (   Phase == done
    ->  assertz(achieved(Team))
    ;   true
    ),
    (   Why == silent
    ->  ignore(post(Host, Robot, release(Ref)))
    ;   true
    ).

post(Host, Robot, Message) :-
    received(Host),
    tell(Robot, Message).

received(Host) :-
    trail(Trail),
    links(Host, Trail, Links),
    count(message, Links).

                /*******************************
                *        COMMUNICATIONS        *
                *******************************/

count(_, 0) :-
    !.
count(Kind, Times) :-
    (   retract(sent(Kind, Count0))
    ->  true
    ;   Count0 = 0
    ),
    Count is Count0 + Times,
    assertz(sent(Kind, Count)).

report :-
    forall(retract(sent(Kind, Count)), log(communications(Kind, Count))).
