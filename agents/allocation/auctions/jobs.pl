% Expects: common.
% Gives: open_places/3, phase_of/2, members/2, wanted_phase/2; its state.

/*  The tasks that a node auctions.

        job(Job, Task, Round, Phase, Tries, Backoffs)
                                Phase is `bidding`, `awarding`, `executing`
                                or `waiting`
        bid(Job, Round, Host, Bids)
                                Bids are Number-Cost for each team
        member(Job, Host, Number, Round, Phase, Heard)
                                Phase is `awarded`, `reserved`, `executing`
                                or `done`, Heard the time of the last message
        allocated(Job)          true once all robots were reserved
        renewal(Job, Round)     the round since which contracts are renewed
*/

:- dynamic job/6, bid/4, member/6, allocated/1, renewal/2.

%!  open_places(+Job, +Task, -Places:list(pair)) is det.
%
%   Places are (Number-Requirements)-Count: the places that are not yet
%   awarded.

open_places(Job, task(_, Teams, _), Places) :-
    findall(Number, member(Job, _, Number, _, _, _), Taken),
    findall((Number-Requirements)-Count,
            ( open_team(Teams, Taken, Number, Requirements),
              nth1(Number, Teams, Wanted-_),
              aggregate_all(count, member(Number, Taken), Have),
              Count is Wanted - Have ),
            Places).

%!  phase_of(+Job, +Phase) is semidet.

phase_of(Job, Phase) :-
    retract(job(Job, Task, Round, _, Tries, Backoffs)),
    assertz(job(Job, Task, Round, Phase, Tries, Backoffs)).

%!  members(+Job, -Hosts) is det.

members(Job, Hosts) :-
    findall(Host, member(Job, Host, _, _, _, _), Hosts).

%!  wanted_phase(+Job, -Phase) is det.
%
%   Phase is the phase that the robots of Job should have.

wanted_phase(Job, Phase) :-
    (   allocated(Job)
    ->  Phase = executing
    ;   Phase = reserved
    ).
