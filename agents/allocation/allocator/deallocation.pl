% Expects: task/3; lib, common; trail, messages, held_robots, news, migration.
% Gives: deallocate/1.

/*  De-allocation: child agents return along the trail of the allocator,
    release the robots, and die.

    A child follows the trail of its parent, with short cuts, to the nearest
    robot that it must release; where links are missing it searches
    conscientiously.  The lifetime of a child is limited: robots that no child
    has reached by then ask the allocator.  The allocator answers that they
    are free, or does not answer.
*/

%!  deallocate(+Phases:list) is det.
%
%   Releases the robots in one of Phases, now or as soon as a child arrives.

deallocate(Phases) :-
    tell_free(Phases),
    findall(Host-free(Robot, Ref),
            ( held(Host, Robot, Ref, _, Phase), memberchk(Phase, Phases) ),
            Robots),
    forall(( held(_, _, Ref, Team, done), memberchk(done, Phases) ),
           achieve(Team, Ref)),
    forall(member(_-free(_, Ref), Robots),
           retractall(held(_, _, Ref, _, _))),
    exchange,
    release_here(Robots, Elsewhere),
    parameter(children, Children),
    shares(Children, Elsewhere, Shares),
    spawn_children(Shares).

tell_free(_) :-
    parameter(sharing, none),
    !.
tell_free(Phases) :-
    task(_, Teams, _),
    forall(( held(Host, _, _, Team, Phase), memberchk(Phase, Phases) ),
           ( nth1(Team, Teams, _-Requirements),
             learn(Host, Requirements, free) )).

achieve(Team, Ref) :-
    retractall(held(_, _, Ref, _, _)),
    assertz(achieved(Team)).

release_here(Robots, Elsewhere) :-
    here(Host),
    selectchk(Host-free(Robot, Ref), Robots, Elsewhere),
    !,
    ask(Robot, Ref, release(Ref), _).
release_here(Robots, Robots).

%   shares(+Count, +List, -Shares): splits List into at most Count lists,
%   none of them empty.

shares(_, [], []) :-
    !.
shares(Count, List, [Share|Shares]) :-
    length(List, Length),
    Size is ceiling(Length/Count),
    length(Share, Size),
    append(Share, Rest, List),
    Count1 is max(1, Count - 1),
    shares(Count1, Rest, Shares).

%   If the host has no capacity for a child, the allocator sends messages to
%   the robots of that share.

spawn_children([]).
spawn_children([Share|Shares]) :-
    clone_if_room(Branch),
    spawned(Branch, Share),
    spawn_children(Shares).

spawned(parent(_), _).
spawned(refused, Share) :-
    forall(member(Host-free(Robot, Ref), Share),
           ignore(post(Host, Robot, release(Ref)))).
spawned(clone(_), Share) :-
    child(Share).

                /*******************************
                *            A CHILD           *
                *******************************/

%   A child that has released all its robots dies (apoptosis).

child(Share) :-
    retractall(held(_, _, _, _, _)),
    retractall(sent(_, _)),
    forget_visits,
    parameter(child_life, Life),
    now(Now),
    Until is Now + Life,
    release_all(Share, Until),
    log_communications,
    dispose.

release_all(Robots, Until) :-
    trail(Trail),
    length(Trail, Far),
    release_all(Robots, Far, Until).

%   release_all(+Robots, +Distance, +Until): Distance is the least distance
%   to one of Robots so far, in links along the trail.

release_all([], _, _) :-
    !.
release_all(Robots, _, Until) :-
    now(Now),
    Now >= Until,
    !,
    pairs_keys(Robots, Hosts),
    log(not_reached(Hosts)).
release_all(Robots, Distance0, Until) :-
    way_on(Robots, Distance0, Host, Distance),
    !,
    catch(move(Host), error(_, _), Arrived = false),
    arrived(Arrived, Host, Distance0-Distance, Distance1),
    release_here(Robots, Left),
    (   Left == Robots
    ->  release_all(Robots, Distance1, Until)
    ;   release_all(Left, Until)
    ).
release_all(Robots, Distance, Until) :-
    pause,
    release_all(Robots, Distance, Until).

way_on(Robots, Distance0, Host, Distance) :-
    trail(Trail),
    pairs_keys(Robots, Wanted),
    neighbours(Neighbours),
    nearer(Trail, Wanted, Neighbours, Distance0, Host, Distance),
    !.
way_on(_, Distance, Host, Distance) :-
    next_host(conscientious, Host).

%   The child removes a host that refuses it from the trail.

arrived(Arrived, _, _-Distance, Distance) :-
    var(Arrived),
    !,
    count(child, 1),
    exchange.
arrived(false, Host, Distance-_, Distance) :-
    count(refusal, 1),
    trail(Trail0),
    subtract(Trail0, [Host], Trail),
    keep(trail(Trail)),
    pause.
