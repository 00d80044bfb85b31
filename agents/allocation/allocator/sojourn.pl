% Expects: lib.
% Gives: begin_sojourn/0, note/1, visited/1, discovered/1, frequency/3; its
%   state.

/*  What an allocator has counted: UR, VR, Lambda, and the frequencies mu of
    thesis section 7.4.1.

        sojourn(Visited, Hops, Rewards, Penalties)
                                since the search began or restarted
        found(Host)             the distinct robots ever discovered
*/

:- dynamic sojourn/4, found/1.

%!  begin_sojourn is det.

begin_sojourn :-
    keep(sojourn(0, 0, 0, 0)).

%!  note(+What) is det.
%
%   Increments the count of What in sojourn/4.

note(What) :-
    sojourn(Visited, Hops, Rewards, Penalties),
    noted(What, sojourn(Visited, Hops, Rewards, Penalties), Sojourn),
    keep(Sojourn).

noted(visit, sojourn(V0, H, R, P), sojourn(V, H, R, P)) :-
    V is V0 + 1.
noted(hop, sojourn(V, H0, R, P), sojourn(V, H, R, P)) :-
    H is H0 + 1.
noted(reward, sojourn(V, H, R0, P), sojourn(V, H, R, P)) :-
    R is R0 + 1.
noted(penalty, sojourn(V, H, R, P0), sojourn(V, H, R, P)) :-
    P is P0 + 1.

%!  visited(+Host) is det.

visited(Host) :-
    note(visit),
    (   found(Host)
    ->  true
    ;   assertz(found(Host))
    ).

%!  discovered(-Found) is det.
%
%   UR: Count is the number of distinct robots found.

discovered(Count) :-
    aggregate_all(count, found(_), Count).

%!  frequency(+What, -Times, -Frequency) is det.
%
%   Times is the number of rewards or penalties, Frequency that number per
%   hop: mu.  On its first host the agent has not hopped, so the divisor is
%   at least 1.

frequency(reward, Rewards, Frequency) :-
    sojourn(_, Hops, Rewards, _),
    Frequency is Rewards/max(1, Hops).
frequency(penalty, Penalties, Frequency) :-
    sojourn(_, Hops, _, Penalties),
    Frequency is Penalties/max(1, Hops).
