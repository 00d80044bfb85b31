% Common part of all agents under attack.
%
% An agent counts its actions in its state, tick/1, and writes them to the
% ledger of its process: the sequence of ticks reveals an agent that was lost,
% duplicated or reset to an older state.

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

% Moves to another host, or stays. After an error the journey is not repeated.

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
