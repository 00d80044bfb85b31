:- payload(lottery, [provides([plan/3, better/2, plans/1])]).
:- include(confirm).

/*  Random search, for measurements unit(Source, Settings, Value): the
    baseline for all other learning algorithms.

    The plan is to try random settings, each level among those known in its
    place, then to use the settings with the best mean and to measure them
    again.
*/

%   The number of plans so far; it seeds the next one.

plans(0).

plan(_, Units, Plan) :-
    retract(plans(Count0)),
    Count is Count0 + 1,
    assertz(plans(Count)),
    planned(Units, Count, Plan).

planned(Units, Count, Plan) :-
    typhon_prng:chance_hash(Count-Units, Seed),
    typhon_prng:chance_seed(Seed, Chance),
    findall(Settings, member(unit(_, Settings, _)-_, Units), Known),
    levels(Known, Levels),
    draw(3, Levels, Trials, Chance),
    best(Units, Best),
    repeated(Best, Again),
    append(Trials, Again, Plan).

%   levels(+Known, -Levels): for each place the known levels.

levels([[]|_], Levels) :-
    !,
    Levels = [].
levels(Known, [Level|Levels]) :-
    maplist(first, Known, Firsts, Rests),
    sort(Firsts, Level),
    levels(Rests, Levels).

first([First|Rest], First, Rest).

draw(0, _, [], _) :-
    !.
draw(Count, Levels, [use(Settings)|Trials], Chance0) :-
    drawn(Levels, Settings, Chance0, Chance),
    Left is Count - 1,
    draw(Left, Levels, Trials, Chance).

drawn([], [], Chance, Chance).
drawn([Level|Levels], [One|Settings], Chance0, Chance) :-
    typhon_prng:chance_member(One, Level, Chance0, Chance1),
    drawn(Levels, Settings, Chance1, Chance).

best(Units, Best) :-
    findall(Settings-Value, member(unit(_, Settings, Value)-_, Units), Pairs),
    keysort(Pairs, Sorted),
    group_pairs_by_key(Sorted, Groups),
    findall(Value-Settings,
            ( member(Settings-Values, Groups),
              sum_list(Values, Sum),
              length(Values, Count),
              Value is Sum/(Count + 0.2) ),
            Valued),
    max_member(_-Best, Valued).
