% Expects: nothing.
% Gives: stepped/5, links/3, nearer/6; state trail/1.

/*  The way back, trail(Hosts): the hosts that an agent has visited, the last
    one first. The predicates on trails are pure.

    A trail omits detours: when the agent comes to a host on the trail, or
    linked with one, the hosts in between are removed, unless the agent has to
    go back to one of them.
*/

:- use_module(library(lists)).
:- dynamic trail/1.

%!  stepped(+Host, +Neighbours, +Wanted, +Trail0, -Trail) is det.
%
%   The trail of an agent that was at the head of Trail0 and is at Host,
%   which has Neighbours, and may have to go back to Wanted.

stepped(Host, Neighbours, Wanted, Trail0, [Host|Trail]) :-
    append(Before, [Goal|Later], Trail0),
    memberchk(Goal, Wanted),
    !,
    reverse(Before, Nearer),
    detour([Goal|Nearer], Host, Neighbours, Later, Trail).
stepped(Host, Neighbours, _, Trail0, [Host|Trail]) :-
    reverse(Trail0, Hosts),
    detour(Hosts, Host, Neighbours, [], Trail).

detour([], _, _, Trail, Trail).
detour([Host|_], Host, _, Later, Trail) :-
    !,
    Trail = Later.
detour([Other|_], _, Neighbours, Later, [Other|Later]) :-
    memberchk(Other, Neighbours),
    !.
detour([Other|Others], Host, Neighbours, Later, Trail) :-
    detour(Others, Host, Neighbours, [Other|Later], Trail).

%!  links(+Host, +Trail, -Count) is det.
%
%   How many links there are on the way back from the head of Trail to
%   Host; as many as to the end if it is not on it.

links(Host, Trail, Count) :-
    nth0(Count0, Trail, Host),
    !,
    Count = Count0.
links(_, Trail, Count) :-
    length(Trail, Count).

%!  nearer(+Trail, +Wanted, +Neighbours, +Distance0, -Host, -Distance)
%!      is semidet.
%
%   Host is the one of Neighbours that is nearest to one of the hosts
%   Wanted, Distance along the Trail.  Fails if that is not nearer than
%   Distance0: where links have gone, an agent that goes only to hosts
%   nearer than it ever was does not go round in circles.

nearer(Trail, Wanted, Neighbours, Distance0, Host, Distance) :-
    findall(Goal,
            ( member(Robot, Wanted), nth0(Goal, Trail, Robot) ),
            Goals),
    findall(Apart-Near,
            ( member(Near, Neighbours), nth0(Place, Trail, Near),
              member(Goal, Goals), Apart is abs(Place - Goal) ),
            Pairs),
    keysort(Pairs, [Distance-Host|_]),
    Distance < Distance0.
