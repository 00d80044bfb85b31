% What all agents under attack have in common.
%
% Whatever an agent does it counts, tick/1, in its state, and notes in the
% ledger of the process it stands in: an agent that was lost, doubled or put
% back to an older state shows in the sequence of its ticks.

note(Event) :-
    retract(tick(N0)),
    !,
    N is N0+1,
    assertz(tick(N)),
    me(Me),
    chaos_note(Me, N, Event).

halted :-
    sense(halt),
    !.

% To another host, or not. An error is no reason to do the journey again.

journey :-
    another_host(Host),
    note(go(Host)),
    catch(( move(Host), Came = at(Host) ),
          error(Why, _),
          Came = stays(Why)),
    came(Came).

another_host(Host) :-
    hosts(Hosts),
    here(Here),
    subtract(Hosts, [Here], Others),
    random_member(Host, Others).

came(at(Host)) :-
    here(Host),
    retract(steps(N0)),
    !,
    N is N0+1,
    assertz(steps(N)),
    note(at(Host)).
came(stays(Why)) :-
    !,
    note(stays(Why)).
came(at(Host)) :-
    here(Here),
    note(astray(Host, Here)).
