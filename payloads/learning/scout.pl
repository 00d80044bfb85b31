:- payload(scout, [provides([plan/3, better/2, plans/1])]).

/*  A learning algorithm for the maze that explores: where greedy always takes
    the longest branch of the known tree, this one takes a random branch, so it
    searches where others do not.  Both use the same units, so their agents
    can share.

    The end of the branch is drawn, not the branch: of all vectors that can
    be reached and from which nothing is known, each is equally likely.  The
    plan is a path to it with the most links.
*/

%   The number of plans so far; it seeds the next one.

plans(0).

plan(Start, Units, Plan) :-
    retract(plans(Count0)),
    Count is Count0 + 1,
    assertz(plans(Count)),
    findall(Plan0, planned(Start, Units, Count, Plan0), [Plan]).

planned(Start, Units, Count, Plan) :-
    findall(Light-unit(Vector0, Actions, Vector),
            ( member(unit(Vector0, Actions, Vector)-_, Units),
              arg(1, Vector0, Light) ),
            Keyed),
    sort(1, @=<, Keyed, Rising),
    root(Start, Rising, Root),
    list_to_assoc([Root-way(0, [])], Ways0),
    ways(Rising, Ways0, Ways),
    findall(Vector-on, member(_-unit(Vector, _, _), Rising), Pairs),
    sort(Pairs, Onward0),
    list_to_assoc(Onward0, Onward),
    findall(Way, ( gen_assoc(Vector, Ways, way(_, Way)),
                   \+ get_assoc(Vector, Onward, on) ),
            Ends),
    typhon_prng:chance_hash(Count-Root-Ends, Seed),
    typhon_prng:chance_seed(Seed, Chance),
    typhon_prng:chance_member(Backwards, Ends, Chance, _),
    reverse(Backwards, Forwards),
    append(Forwards, Plan).

%   Executions begin at Start, if it is known, else at the vector with the
%   least light.

root(Start, Links, Start) :-
    memberchk(_-unit(Start, _, _), Links),
    !.
root(_, [_-unit(Vector, _, _)|_], Vector).

%   ways(+Links, +Ways0, -Ways): way(Length, Way) for each vector, Way is
%   the list of actions of its links, the last first.  Weights are positive, so
%   in order of increasing light all ways to a vector are known when its links
%   are processed.

ways([], Ways, Ways).
ways([_-unit(Vector0, Actions, Vector)|Links], Ways0, Ways) :-
    (   get_assoc(Vector0, Ways0, way(Length0, Way)),
        Length is Length0 + 1,
        \+ longer(Vector, Ways0, Length)
    ->  put_assoc(Vector, Ways0, way(Length, [Actions|Way]), Ways1)
    ;   Ways1 = Ways0
    ),
    ways(Links, Ways1, Ways).

longer(Vector, Ways, Length) :-
    get_assoc(Vector, Ways, way(Other, _)),
    Other >= Length.

%   True if Actions has fewer actions than Others.

better(Actions, Others) :-
    length(Actions, Length),
    length(Others, OthersLength),
    Length < OthersLength.
