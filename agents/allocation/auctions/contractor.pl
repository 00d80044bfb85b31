% Expects: lib, common; agenda, memory; tell_owner/2, offer_bids/3.
% Gives: to_robot/1, answered/3, from_robot/2, contract_due/1, is_over/2.

/*  The contractor: the part of a node that acts for the robot of its host.
    It bids in one auction at a time, and in another one only when the first
    is over, or less urgent.  The winner has a contract, which ends unless
    the auctioneer renews it: so no robot stays reserved for an auctioneer
    that has ended.

        hold(Job, Round, Offer, Until)
                                the auction for which it has bid
        asked(Job, Round, Left, Bids)
                                the robot has not answered all questions yet
        contract(Job, Round, Ref, Details, Phase, Until)
                                Phase is `reserving`, `reserved`,
                                `executing` or `done`
        over(Job, Round)        messages of rounds up to Round are ignored
*/

:- dynamic hold/4, asked/4, contract/6, over/2.

%!  to_robot(+Body) is semidet.
%
%   Handles a message of an auctioneer to the contractor of this host.

to_robot(announce(Job, Round, Offer)) :-
    invited(Job, Round, Offer).
to_robot(award(Job, Round, Winners)) :-
    awarded(Job, Round, Winners).
to_robot(start(Job)) :-
    start(Job).
to_robot(renew(Job, Phase)) :-
    renewed(Job, Phase).
to_robot(release(Job, Round, Hosts)) :-
    released(Job, Round, Hosts).

%!  contract_due(+What) is semidet.
%
%   Handles an item that the contractor has put on the agenda.

contract_due(lapse(Job)) :-
    lapse(Job).

                /*******************************
                *             BIDS             *
                *******************************/

%   invited(+Job, +Round, +Offer): Offer is offer(Task, Owner, Places,
%   Details, Close), Places a list of (Number-Requirements)-Count.

invited(Job, Round, Offer) :-
    sense(robot(Robot)),
    \+ contract(Job, _, _, _, _, _),
    \+ is_over(Job, Round),
    now(Now),
    \+ engaged(Offer, Now),
    !,
    Offer = offer(Task, _, Places, Details, Close),
    parameter(answer, Answer),
    Until is Close + Answer,
    retractall(hold(_, _, _, _)),
    assertz(hold(Job, Round, Offer, Until)),
    length(Places, Count),
    retractall(asked(_, _, _, _)),
    assertz(asked(Job, Round, Count, [])),
    forall(member((Number-Requirements)-_, Places),
           send(Robot, ask(ref(Job, Round, Number),
                           need(Task, Requirements, Details)))).
invited(_, _, _).

engaged(offer(_, _, _, Details, _), Now) :-
    hold(_, _, offer(_, _, _, Held, _), Until),
    Now < Until,
    detail(priority, Details, 0, New),
    detail(priority, Held, 0, Old),
    New =< Old.

%!  answered(+Answer, +Ref, +Robot) is semidet.
%
%   Handles the answer of the robot.

answered(bid(Cost), ref(Job, Round, Number), _) :-
    !,
    bid_known([Number-Cost], Job, Round).
answered(reserved, Ref, Robot) :-
    !,
    reserved(Ref, Robot).
answered(refused(_), Ref, _) :-
    !,
    refused(Ref).
answered(_, _, _).

bid_known(Bid, Job, Round) :-
    retract(asked(Job, Round, Left0, Bids0)),
    !,
    append(Bid, Bids0, Bids),
    Left is Left0 - 1,
    (   Left > 0
    ->  assertz(asked(Job, Round, Left, Bids))
    ;   Bids == []
    ->  retractall(hold(Job, Round, _, _))
    ;   offer_bids(Job, Round, Bids)
    ).
bid_known(_, _, _).

                /*******************************
                *           CONTRACT           *
                *******************************/

%   awarded(+Job, +Round, +Winners): a list of Host-Number.

awarded(Job, Round, Winners) :-
    here(Here),
    (   memberchk(Here-Number, Winners)
    ->  take_on(Job, Round, Number)
    ;   retractall(hold(Job, Round, _, _))
    ).

take_on(Job, Round, Number) :-
    retract(hold(Job, Round, offer(Task, Owner, Places, Details, _), _)),
    \+ is_over(Job, Round),
    sense(robot(Robot)),
    !,
    memberchk((Number-Requirements)-_, Places),
    Ref = ref(Job, Round, Number),
    until(Until),
    assertz(contract(Job, Round, Ref, Details, reserving, Until)),
    at(Until, lapse(Job)),
    send(Robot, reserve(Ref, Owner, need(Task, Requirements, Details))).
take_on(Job, Round, _) :-
    inform(Job, Round, refused).

until(Until) :-
    parameter(contract, Seconds),
    now(Now),
    Until is Now + Seconds.

inform(Job, Round, Phase) :-
    here(Here),
    tell_owner(Job, report(Round, Here, Phase)).

phase(Job, Phase) :-
    retract(contract(Job, Round, Ref, Details, _, Until)),
    assertz(contract(Job, Round, Ref, Details, Phase, Until)),
    inform(Job, Round, Phase).

%   The robot has answered reserve/3.  The contract may have ended meanwhile.

reserved(Ref, _) :-
    contract(Job, _, Ref, _, reserving, _),
    !,
    phase(Job, reserved).
reserved(Ref, Robot) :-
    (   contract(_, _, Ref, _, _, _)
    ->  true
    ;   send(Robot, release(Ref))
    ).

refused(Ref) :-
    retract(contract(Job, Round, Ref, _, _, _)),
    !,
    inform(Job, Round, refused).
refused(ref(Job, Round, _)) :-
    bid_known([], Job, Round).

                /*******************************
                *           EXECUTION          *
                *******************************/

start(Job) :-
    contract(Job, _, Ref, Details, reserved, _),
    sense(robot(Robot)),
    !,
    task_goal(Details, Goal),
    phase_quietly(Job, executing),
    send(Robot, start(Ref, Goal)).
start(_).

phase_quietly(Job, Phase) :-
    retract(contract(Job, Round, Ref, Details, _, Until)),
    assertz(contract(Job, Round, Ref, Details, Phase, Until)).

%!  from_robot(+Message, +Robot) is semidet.
%
%   The contractor answers still(Ref) itself, without asking the auctioneer:
%   the auctioneer renews contracts that it needs.

from_robot(done(Ref), _) :-
    contract(Job, _, Ref, _, _, _),
    phase(Job, done).
from_robot(lost(Ref, Why), _) :-
    retract(contract(Job, Round, Ref, _, _, _)),
    inform(Job, Round, lost(Why)).
from_robot(still(Ref), Robot) :-
    (   contract(_, _, Ref, _, _, _)
    ->  send(Robot, yes(Ref))
    ;   send(Robot, no(Ref))
    ).

%   renewed(+Job, +Phase): if Phase is `executing` and this robot is not
%   executing, it has missed the start.

renewed(Job, Phase) :-
    retract(contract(Job, Round, Ref, Details, Now, _)),
    !,
    until(Until),
    assertz(contract(Job, Round, Ref, Details, Now, Until)),
    (   Phase == executing
    ->  start(Job)
    ;   true
    ),
    contract(Job, _, _, _, Then, _),
    inform(Job, Round, Then).
renewed(_, _).

                /*******************************
                *            RELEASE           *
                *******************************/

released(Job, Round, Hosts) :-
    here(Here),
    (   Hosts == all
    ->  true
    ;   memberchk(Here, Hosts)
    ),
    !,
    parameter(jobs, Most),
    make_room(over(_, _), Most),
    assertz(over(Job, Round)),
    (   hold(Job, Held, _, _),
        Held =< Round
    ->  retractall(hold(_, _, _, _))
    ;   true
    ),
    give_up(Job, Round).
released(_, _, _).

give_up(Job, Round) :-
    contract(Job, Held, Ref, _, _, _),
    Held =< Round,
    !,
    retractall(contract(Job, _, _, _, _, _)),
    forall(sense(robot(Robot)), send(Robot, release(Ref))).
give_up(_, _).

%!  is_over(+Job, +Round) is semidet.

is_over(Job, Round) :-
    over(Job, Last),
    Round =< Last,
    !.

%   The auctioneer has not renewed the contract in time.

lapse(Job) :-
    contract(Job, Round, _, _, _, Until),
    now(Now),
    (   Until =< Now
    ->  give_up(Job, Round),
        inform(Job, Round, lost(lapsed))
    ;   at(Until, lapse(Job))
    ).
