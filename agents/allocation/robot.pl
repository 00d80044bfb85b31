:- agent(robot, [state([property/1, setting/2, failed/0])]).
:- include('../lib/parameters').
:- include('../lib/tell').
:- include('common/requirements').
:- include('robot/watch').
:- include('robot/reservation').
:- include('robot/execution').

/*  The static agent of a robot: reports what the robot can do and what that
    would cost, and holds one task at a time (thesis sections 7.3, 7.4).
    Mobile allocators and the nodes of auctions send it the same messages; no
    other agent changes its reservation.

    Facts: property(Property), its capabilities and states; its payload
    defines cost(+Need, +Properties, -Cost), which fails if the robot refuses
    the task.  The program that starts the robot leaves the tuple robot(Id)
    on its host; other agents find the robot by it.  In events the address of
    the host names the robot.

    A reservation is known by its Ref, a term that the requesting agent chose.
    It is stored as hold(Ref, Owner, Need, Contact, Phase): Owner is the agent
    that owns the task, Contact the agent that reserved the robot and gets the
    notices below; Phase is `reserved`, executing(Hand) or `done`.

    Requests of other agents, and What in the answer, answer(Ref, What):

        ask(Ref, Need)              bid(Cost) or refused(Reason)
        reserve(Ref, Owner, Need)   reserved or refused(Reason)
        start(Ref, Goal)            started or refused(Reason)
        status(Ref)                 status(Phase), `none` if not held
        release(Ref)                released

    A Need is need(Task, Requirements, Details).  A robot refuses needs for
    which it is `unfit`, all needs while it is `failed`, and all others while
    it is `reserved` or `executing` for another agent.  But a robot that is
    reserved and not executing accepts a more urgent task.

    The contact gets done(Ref) after the execution, lost(Ref, Why) if the
    reservation has ended otherwise, and periodically still(Ref), which it
    answers by yes(Ref) or no(Ref).  Without an answer the reservation ends,
    so an agent that has died does not keep the robot.
*/

default(watch, 60, [inf, range(1, 600, 0.5)],
        "seconds between two messages still(Ref)").
default(patience, 20, range(1, 200, 0.5), "seconds to wait for the answer").

main :-
    next(Event),
    handle(Event),
    main.

handle(overdue(What)) :-
    !,
    overdue(What).
handle(From-start(Ref, Goal)) :-
    !,
    start(Ref, Goal, Answer),
    ignore(tell(From, answer(Ref, Answer))).
handle(From-Message) :-
    answer(Message, From, Ref, Answer),
    !,
    ignore(tell(From, answer(Ref, Answer))).
handle(From-Message) :-
    heed(Message, From),
    !.
handle(_).

                /*******************************
                *           QUESTIONS          *
                *******************************/

answer(ask(Ref, Need), _, Ref, Answer) :-
    verdict(Need, Answer).
answer(reserve(Ref, _, _), _, Ref, Answer) :-
    hold(Ref, _, _, _, _),
    !,
    Answer = reserved.
answer(reserve(Ref, Owner, Need), From, Ref, Answer) :-
    verdict(Need, Verdict),
    reserve(Verdict, hold(Ref, Owner, Need, From, reserved), Answer).
answer(status(Ref), _, Ref, status(Status)) :-
    (   hold(Ref, _, _, _, Phase)
    ->  functor(Phase, Status, _)
    ;   Status = none
    ).
answer(release(Ref), _, Ref, released) :-
    (   hold(Ref, _, _, _, _)
    ->  free
    ;   true
    ).

                /*******************************
                *            NOTICES           *
                *******************************/

heed(finished(Ref, Outcome), Hand) :-
    hold(Ref, _, _, _, executing(Hand)),
    finished(Outcome, Ref).
heed(yes(Ref), _) :-
    hold(Ref, _, _, _, _),
    parameter(watch, Seconds),
    remind(Seconds, ask).
heed(no(Ref), _) :-
    hold(Ref, _, _, _, _),
    free.
heed(state(Name=Value), _) :-
    retractall(property(Name=_)),
    assertz(property(Name=Value)).
heed(fail, _) :-
    \+ failed,
    assertz(failed),
    log(robot(failed)),
    lose(failed).
heed(repair, _) :-
    retract(failed),
    log(robot(repaired)).

%   It is time to ask the contact, or the contact has not answered in time.

overdue(ask) :-
    hold(Ref, _, _, Contact, _),
    parameter(patience, Seconds),
    remind(Seconds, answer),
    ignore(tell(Contact, still(Ref))).
overdue(answer) :-
    lose(lapsed).
