/*  How an allocator lets its robots go: by children that go back the way it
    came, free them, and die.  To be included.

    A child goes by the trail of its parent, with short cuts, to the robot
    that is nearest; where links have gone it looks for the way
    conscientiously.  It has so much time: robots it has not reached by then
    ask the allocator, and are told that they are free, or get no answer.
*/

%   let_go(+Phases): of the robots in one of Phases.

let_go(Phases) :-
    findall(Host-free(Robot, Ref),
            ( held(Host, Robot, Ref, _, Phase), memberchk(Phase, Phases) ),
            Robots),
    forall(( held(_, _, Ref, Team, done), memberchk(done, Phases) ),
           achieve(Team, Ref)),
    forall(member(_-free(_, Ref), Robots),
           retractall(held(_, _, Ref, _, _))),
    free_here(Robots, Elsewhere),
    parameter(children, Children),
    shares(Children, Elsewhere, Shares),
    send_children(Shares).

achieve(Team, Ref) :-
    retractall(held(_, _, Ref, _, _)),
    assertz(achieved(Team)).

free_here(Robots, Elsewhere) :-
    here(Host),
    selectchk(Host-free(Robot, Ref), Robots, Elsewhere),
    !,
    ask(Robot, Ref, release(Ref), _).
free_here(Robots, Robots).

%   shares(+Count, +List, -Shares): Count lists or less, none empty.

shares(_, [], []) :-
    !.
shares(Count, List, [Share|Shares]) :-
    length(List, Length),
    Size is ceiling(Length/Count),
    length(Share, Size),
    append(Share, Rest, List),
    Count1 is max(1, Count - 1),
    shares(Count1, Rest, Shares).

%   Where there is no room for a child, robots are written to.

send_children([]).
send_children([Share|Shares]) :-
    catch(clone(Who), error(move_refused(_, _), _), Who = refused),
    sent_child(Who, Share),
    send_children(Shares).

sent_child(parent(_), _).
sent_child(refused, Share) :-
    forall(member(Host-free(Robot, Ref), Share),
           ignore(post(Host, Robot, release(Ref)))).
sent_child(clone(_), Share) :-
    retractall(held(_, _, _, _, _)),
    retractall(sent(_, _)),
    retractall('$memory'(_)),
    parameter(child_life, Life),
    now(Now),
    Until is Now + Life,
    deallocate(Share, Until),
    report,
    dispose.

                /*******************************
                *            A CHILD           *
                *******************************/

deallocate(Robots, Until) :-
    trail(Trail),
    length(Trail, Far),
    deallocate(Robots, Far, Until).

%   deallocate(+Robots, +Distance, +Until): it has been so near to one of
%   Robots, along the trail.

deallocate([], _, _) :-
    !.
deallocate(Robots, _, Until) :-
    now(Now),
    Now >= Until,
    !,
    pairs_keys(Robots, Hosts),
    log(not_reached(Hosts)).
deallocate(Robots, Distance0, Until) :-
    way_on(Robots, Distance0, Host, Distance),
    !,
    catch(move(Host), error(_, _), Arrived = false),
    arrived(Arrived, Host, Distance0-Distance, Distance1),
    free_here(Robots, Left),
    (   Left == Robots
    ->  deallocate(Robots, Distance1, Until)
    ;   deallocate(Left, Until)
    ).
deallocate(Robots, Distance, Until) :-
    pause,
    deallocate(Robots, Distance, Until).

way_on(Robots, Distance0, Host, Distance) :-
    trail(Trail),
    pairs_keys(Robots, Wanted),
    neighbours(Neighbours),
    nearer(Trail, Wanted, Neighbours, Distance0, Host, Distance),
    !.
way_on(_, Distance, Host, Distance) :-
    next_host(conscientious, Host).

%   A host that does not let it in is not on the way any more.

arrived(Arrived, _, _-Distance, Distance) :-
    var(Arrived),
    !,
    count(child, 1).
arrived(false, Host, Distance-_, Distance) :-
    count(refusal, 1),
    retract(trail(Trail0)),
    subtract(Trail0, [Host], Trail),
    assertz(trail(Trail)),
    pause.
