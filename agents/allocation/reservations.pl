:- module(allocation_reservations,
          [ reservation_faults/2        % +Events, -Faults
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(assoc),
              [assoc_to_list/2, del_assoc/4, empty_assoc/1, get_assoc/3,
               put_assoc/4]).
:- use_module(library(lists), [append/3, member/2, reverse/2]).

/** <module> Check of a log for robots that were reserved twice

Reads the event log of an allocation by any mechanism.  Only events that the
robots logged count.

*Threading*: pure.
*/

%!  reservation_faults(+Events, -Faults:list) is det.
%
%   Events are event(Time, Host, Agent, What), in order.  Faults are
%
%     - twice(Robot, Owner1, Owner2, Time)
%       Owner2 reserved a robot that Owner1 had reserved
%     - stray(Robot, Owner, Event, Time)
%       Owner's robot was `released` or `executed`, but not reserved
%     - held(Robot, Owner, Task)
%       Still reserved at the end; includes robots whose host has ended
%
%   in order of time, `held` last.

reservation_faults(Events, Faults) :-
    empty_assoc(None),
    foldl(follow, Events, None-[], Holders-Faults0),
    assoc_to_list(Holders, Pairs),
    reverse(Faults0, Faults1),
    findall(held(Robot, Owner, Task),
            member(Robot-holder(Owner, Task), Pairs),
            Held),
    append(Faults1, Held, Faults).

follow(event(Time, _, _, What), State0, State) :-
    followed(What, Time, State0, State),
    !.
follow(_, State, State).

followed(reserved(Robot, Owner, Task), Time, Holders0-Faults0,
         Holders-Faults) :-
    (   get_assoc(Robot, Holders0, holder(Other, _))
    ->  Faults = [twice(Robot, Other, Owner, Time)|Faults0]
    ;   Faults = Faults0
    ),
    put_assoc(Robot, Holders0, holder(Owner, Task), Holders).
followed(released(Robot, Owner, Task), _, Holders0-Faults,
         Holders-Faults) :-
    del_assoc(Robot, Holders0, Holder, Holders),
    Holder == holder(Owner, Task),
    !.
followed(released(Robot, Owner, _), Time, Holders-Faults,
         Holders-[stray(Robot, Owner, released, Time)|Faults]).
followed(executed(Robot, Owner, Task), Time, Holders-Faults0,
         Holders-Faults) :-
    (   get_assoc(Robot, Holders, Holder),
        Holder == holder(Owner, Task)
    ->  Faults = Faults0
    ;   Faults = [stray(Robot, Owner, executed, Time)|Faults0]
    ).
