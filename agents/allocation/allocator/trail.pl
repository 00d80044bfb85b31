% Expects: nothing.
% Gives: stepped/5, links/3, nearer/6; state trail/1.

/*  The trail of an agent, trail(Hosts): the hosts that it has visited, the
    last one first. The predicates on trails are pure.

    A trail omits detours: when the agent arrives at a host on the trail, or
    at a neighbour of one, the hosts in between are removed, unless the agent
    must return to one of them.
*/

:- use_module(library(lists)).
:- dynamic trail/1.

%!  stepped(+Host, +Neighbours, +Wanted, +Trail0, -Trail) is det.
%
%   Trail is the trail of an agent that moved from the head of Trail0 to Host,
%   which has Neighbours.  It keeps the hosts Wanted, to which the agent may
%   have to return.

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
%   Count is the number of links along Trail from its head to Host; the
%   length of Trail if Host is not on it.

links(Host, Trail, Count) :-
    nth0(Count0, Trail, Host),
    !,
    Count = Count0.
links(_, Trail, Count) :-
    length(Trail, Count).

%!  nearer(+Trail, +Wanted, +Neighbours, +Distance0, -Host, -Distance)
%!      is semidet.
%
%   Host is the one of Neighbours that is nearest to one of the hosts Wanted;
%   Distance is counted in links along Trail.  Fails if Distance is not less
%   than Distance0: this keeps an agent from moving in circles where links
%   are missing.

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
