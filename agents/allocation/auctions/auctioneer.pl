% Expects: lib, common; agenda, memory, contractor, jobs, awards; publish/1,
%   tell_robots/3.
% Gives: post/1, to_owner/2, auction_due/1.

/*  The auctioneer: the part of a node that auctions tasks.  It announces
    the task, takes bids for some time, and awards contracts to the cheapest
    bidders, to all robots that the task needs at once.  When all winners
    have answered, it starts them, renews their contracts, and releases them
    when all are done.  If there are too few bids, it releases its robots and
    backs off (thesis equations 7.5 and 7.7); if a robot is lost, it auctions
    that place again.
*/

%!  to_owner(+Job, +Body) is semidet.
%
%   Handles a message from another node to the auctioneer of this node.

to_owner(Job, bids(Round, List)) :-
    bids(Job, Round, List).
to_owner(Job, report(Round, Host, Phase)) :-
    report(Phase, Job, Round, Host).

%!  auction_due(+What) is semidet.
%
%   Handles an item that the auctioneer has put on the agenda.

auction_due(close(Job, Round)) :-
    close_auction(Job, Round).
auction_due(settle(Job, Round)) :-
    settle(Job, Round).
auction_due(again(Job, Round)) :-
    again(Job, Round).
auction_due(renew(Job, Since)) :-
    renew(Job, Since).
auction_due(deadline(Job)) :-
    deadline(Job).

                /*******************************
                *            ROUNDS            *
                *******************************/

%!  post(+Task) is det.
%
%   Starts to auction Task.

post(Task) :-
    Task = task(Name, _, Details),
    new_id(Number),
    here(Here),
    Job = job(Here, Number),
    assertz(job(Job, Task, 0, waiting, 0, 0)),
    log(begun(Name)),
    (   memberchk(deadline(Seconds), Details)
    ->  after(Seconds, deadline(Job))
    ;   true
    ),
    open_auction(Job).

open_auction(Job) :-
    retract(job(Job, Task, Round0, _, Tries, Backoffs)),
    Round is Round0 + 1,
    assertz(job(Job, Task, Round, bidding, Tries, Backoffs)),
    open_places(Job, Task, Places),
    parameter(window, Window),
    now(Now),
    Close is Now + Window,
    self(Me),
    Task = task(Name, _, Details),
    at(Close, close(Job, Round)),
    publish(announce(Job, Round, offer(Name, Me, Places, Details, Close))).

%   bids(+Job, +Round, +List): List of Host-Bids; late bids are dropped.

bids(Job, Round, List) :-
    job(Job, _, Round, bidding, _, _),
    !,
    forall(( member(Host-Bids, List), \+ bid(Job, Round, Host, _) ),
           assertz(bid(Job, Round, Host, Bids))).
bids(_, _, _).

close_auction(Job, Round) :-
    job(Job, Task, Round, bidding, _, _),
    open_places(Job, Task, Places),
    findall(Host-Bids, bid(Job, Round, Host, Bids), Bids),
    (   winners(Places, Bids, Winners)
    ->  award(Job, Round, Winners)
    ;   back_off(Job)
    ).

award(Job, Round, Winners) :-
    phase_of(Job, awarding),
    now(Now),
    forall(member(Host-Number, Winners),
           assertz(member(Job, Host, Number, Round, awarded, Now))),
    parameter(answer, Seconds),
    after(Seconds, settle(Job, Round)),
    (   renewal(Job, _)
    ->  true
    ;   assertz(renewal(Job, Round)),
        renew_later(Job, Round)
    ),
    findall(Host, member(Host-_, Winners), Hosts),
    tell_robots(Job, Hosts, award(Job, Round, Winners)).

                /*******************************
                *           REPORTS            *
                *******************************/

%   report(+Phase, +Job, +Round, +Host): the result of an award.

report(Phase, Job, Round, Host) :-
    retract(member(Job, Host, Number, Round, Before, _)),
    !,
    now(Now),
    (   becomes(Before, Phase, After)
    ->  assertz(member(Job, Host, Number, Round, After, Now))
    ;   true                            % refused, or lost
    ),
    proceed(Job).
report(Phase, Job, Round, Host) :-
    later_phase(awarded, Phase, _),
    \+ is_over(Job, Round),
    !,                                  % the auctioneer gave it up before
    tell_robots(Job, [Host], release(Job, Round, [Host])).
report(_, _, _, _).

proceed(Job) :-
    job(Job, Task, _, Phase, _, _),
    open_places(Job, Task, Places),
    findall(At, member(Job, _, _, _, At, _), Ats),
    proceed(Phase, Places, Ats, Job).

proceed(awarding, Places, Ats, Job) :-
    \+ memberchk(awarded, Ats),
    !,
    (   Places == []
    ->  begin_execution(Job)
    ;   try_again(Job)
    ).
proceed(executing, [_|_], _, Job) :-
    !,
    try_again(Job).
proceed(executing, [], Ats, Job) :-
    \+ ( member(At, Ats), At \== done ),
    !,
    job(Job, task(Name, _, _), _, _, _, _),
    log(completed(Name)),
    conclude(Job).
proceed(_, _, _, _).

settle(Job, Round) :-
    job(Job, _, Round, awarding, _, _),
    findall(Host, retract(member(Job, Host, _, Round, awarded, _)), Silent),
    give_back(Job, Round, Silent),
    proceed(Job).

give_back(_, _, []) :-
    !.
give_back(Job, Round, Hosts) :-
    tell_robots(Job, Hosts, release(Job, Round, Hosts)).

begin_execution(Job) :-
    phase_of(Job, executing),
    members(Job, Hosts),
    (   allocated(Job)
    ->  true                            % a robot had to be replaced
    ;   assertz(allocated(Job)),
        job(Job, task(Name, _, _), _, _, _, _),
        log(allocated(Name, Hosts))
    ),
    tell_robots(Job, Hosts, start(Job)).

                /*******************************
                *           BACK-OFF           *
                *******************************/

try_again(Job) :-
    retract(job(Job, Task, Round, Phase, Tries0, Backoffs)),
    Tries is Tries0 + 1,
    assertz(job(Job, Task, Round, Phase, Tries, Backoffs)),
    parameter(tries, Most),
    (   Tries < Most
    ->  open_auction(Job)
    ;   back_off(Job)
    ).

back_off(Job) :-
    release_all(Job, Bids),
    retract(job(Job, Task, Round, _, _, Backoffs0)),
    Backoffs is Backoffs0 + 1,
    assertz(job(Job, Task, Round, waiting, 0, Backoffs)),
    parameter(bi_min, Minimum),
    parameter(bi_max, Maximum),
    bid_time(Bids, Minimum, Theta),
    Turn is random_float,
    parameter(beta, First),
    Beta is First + Backoffs0,
    interval(Theta, Beta, Maximum, Turn, Seconds),
    log(backoff(Seconds)),
    after(Seconds, again(Job, Round)).

again(Job, Round) :-
    job(Job, _, Round, waiting, _, _),
    open_auction(Job).

%   release_all(+Job, -Count): Count is the number of bids in this round.

release_all(Job, Count) :-
    job(Job, _, Round, _, _, _),
    findall(Host, retract(bid(Job, Round, Host, _)), Bidders),
    length(Bidders, Count),
    findall(Host, retract(member(Job, Host, _, _, _, _)), Members),
    retractall(bid(Job, _, _, _)),
    retractall(allocated(Job)),
    retractall(renewal(Job, _)),
    append(Members, Bidders, Hosts0),
    sort(Hosts0, Hosts),
    parameter(jobs, Most),
    make_room(over(_, _), Most),
    assertz(over(Job, Round)),
    (   Hosts == []
    ->  true
    ;   tell_robots(Job, Hosts, release(Job, Round, all))
    ).

                /*******************************
                *       RENEWALS, THE END      *
                *******************************/

renew_later(Job, Since) :-
    parameter(renew, Seconds),
    after(Seconds, renew(Job, Since)).

%   A contractor that has sent no message for a whole period is lost.

renew(Job, Since) :-
    renewal(Job, Since),
    job(Job, _, Round, _, _, _),
    renew_later(Job, Since),
    parameter(renew, Seconds),
    now(Now),
    findall(Host,
            ( member(Job, Host, _, _, Phase, Heard),
              Phase \== done,
              Now - Heard > 2*Seconds ),
            Lost),
    forall(member(Host, Lost), retract(member(Job, Host, _, _, _, _))),
    give_back(Job, Round, Lost),
    members(Job, Hosts),
    (   Hosts == []
    ->  true
    ;   wanted_phase(Job, Wanted),
        tell_robots(Job, Hosts, renew(Job, Wanted))
    ),
    (   Lost == []
    ->  true
    ;   proceed(Job)
    ).

deadline(Job) :-
    job(Job, task(Name, _, Details), _, _, _, _),
    memberchk(deadline(Seconds), Details),
    log(missed(Name, Seconds)),
    conclude(Job).

conclude(Job) :-
    release_all(Job, _),
    retractall(job(Job, _, _, _, _, _)).
