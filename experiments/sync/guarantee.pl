:- module(sync_guarantee,
          [ penalties_at_least/4,       % +Maximum, +Theta, +Delta, -Count
            moves_to_all/2,             % +Links, -Moves
            potential_required/5        % +Links, +Hops, +Theta, +Delta,
                                        % -Maximum
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [domain_error/2, must_be/2]).
:- use_module(library(lists),
              [append/3, max_list/2, member/2, memberchk/2]).
:- use_module(library(ugraphs),
              [neighbours/3, vertices/2, vertices_edges_to_ugraph/3]).

/** <module> Potentials with which no executions overlap

Conditions under which no agent of chapter 5 leaves a task before all hosts have
completed it, proved in doc/analysis.md.  They are sufficient, not necessary:
the agents of the thesis need much lower potentials.

*Threading*: pure.
*/

%!  penalties_at_least(+Maximum, +Theta, +Delta, -Count) is det.
%
%   By equations 5.1 and 5.2, a potential of Maximum is not exhausted by fewer
%   than Count penalties, however many rewards an agent receives meanwhile.
%   Theta is the initial value of a history of any length, Delta the penalty
%   bias.
%
%   @error type_error(number, X), domain_error(positive_number, X)

penalties_at_least(Maximum, Theta, Delta, Count) :-
    maplist(positive, [Maximum, Theta, Delta]),
    maplist(share(Maximum), [Theta, Delta], [Share, Bias]),
    penalties(1.0, Share, Bias, 0, Count).

positive(X) :-
    must_be(number, X),
    (   X > 0
    ->  true
    ;   domain_error(positive_number, X)
    ).

share(Maximum, Value, Share) :-
    Share is float(Value/Maximum).

%   Left is a share of the maximum.  Each penalty adds at most Delta to the
%   greatest value of the history, and a reward adds nothing.

penalties(Left, _, _, Count, Count) :-
    Left =< 0,
    !.
penalties(Left0, Theta0, Delta, Count0, Count) :-
    Left is Left0*max(0, 1 - Theta0) - Delta,
    Theta is Theta0 + Delta,
    Count1 is Count0 + 1,
    penalties(Left, Theta, Delta, Count1, Count).

%!  moves_to_all(+Links:list(pair), -Moves) is det.
%
%   In any Moves consecutive moves a conscientious agent arrives at each host of
%   the connected network with Links.  Moves grows exponentially with the
%   diameter, and with the square of the hosts if all are linked.

moves_to_all(Links, Moves) :-
    must_be(list(pair), Links),
    findall(Edge, ( member(A-B, Links), member(Edge, [A-B, B-A]) ), Edges),
    vertices_edges_to_ugraph([], Edges, Graph),
    vertices(Graph, Hosts),
    findall(N, ( member(Host, Hosts), moves_to(Host, Graph, N) ), Ns),
    max_list(Ns, Moves).

%   As long as an agent does not arrive at Host, it departs from each other host
%   less often than the number that least_counts/4 gives it, and once from Host
%   if it begins there.

moves_to(Host, Graph, Moves) :-
    least_counts([0-Host], Graph, [], Counts),
    aggregate_all(sum(Count - 1), ( member(Count, Counts), Count > 0 ), Sum),
    Moves is Sum + 2.

%   least_counts(+Open, +Graph, +Done, -Counts): the count of a host is its
%   degree, times one more than the least count of its neighbours. Open has
%   Count-Host, the least first.

least_counts([], _, _, []).
least_counts([_-Host|Open], Graph, Done, Counts) :-
    memberchk(Host, Done),
    !,
    least_counts(Open, Graph, Done, Counts).
least_counts([Count-Host|Open0], Graph, Done, [Count|Counts]) :-
    neighbours(Host, Graph, Next),
    findall(More-Other,
            ( member(Other, Next), \+ memberchk(Other, Done),
              neighbours(Other, Graph, Others), length(Others, Degree),
              More is Degree*(Count + 1) ),
            Found),
    append(Open0, Found, Open1),
    sort(Open1, Open),
    least_counts(Open, Graph, [Host|Done], Counts).

%!  potential_required(+Links:list(pair), +Hops, +Theta, +Delta, -Maximum) is det.
%
%   Maximum is the least whole potential with which no executions overlap, of
%   any number of conscientious agents, if no execution takes longer than Hops
%   migrations, no host refuses an agent, links do not change and no execution
%   fails.  Takes time in proportion to the moves, so these are limited.
%
%   @error type_error(Type, X), type_error(between(1, 1000000), Penalties)

potential_required(Links, Hops, Theta, Delta, Maximum) :-
    must_be(nonneg, Hops),
    moves_to_all(Links, Moves),
    Penalties is Moves + Hops + 1,
    must_be(between(1, 1_000_000), Penalties),
    above(1, Penalties, Theta, Delta, Low, High),
    between_bounds(Low, High, Penalties, Theta, Delta, Maximum).

%   High suffices, and Low, half of it, does not, or is 0.

above(High, Penalties, Theta, Delta, Low, High) :-
    suffices(High, Penalties, Theta, Delta),
    !,
    Low is High // 2.
above(Low, Penalties, Theta, Delta, Least, High) :-
    Next is 2*Low,
    above(Next, Penalties, Theta, Delta, Least, High).

between_bounds(Low, High, _, _, _, High) :-
    High =:= Low + 1,
    !.
between_bounds(Low, High, Penalties, Theta, Delta, Maximum) :-
    Middle is (Low + High) // 2,
    (   suffices(Middle, Penalties, Theta, Delta)
    ->  between_bounds(Low, Middle, Penalties, Theta, Delta, Maximum)
    ;   between_bounds(Middle, High, Penalties, Theta, Delta, Maximum)
    ).

suffices(Maximum, Penalties, Theta, Delta) :-
    penalties_at_least(Maximum, Theta, Delta, Count),
    Count >= Penalties.
