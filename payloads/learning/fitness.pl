/*  The fitness of settings, from measurements unit(Source, Settings, Value).
    Included in learning algorithms.
*/

%!  ranked(+Units, -Ranked) is det.
%
%   Ranked are Fitness-Settings, the fittest first.  The error of a single
%   measurement may be large: fitness is the mean of all measurements of the
%   settings and of the overall average, which counts as one measurement.

ranked(Units, Ranked) :-
    findall(Settings-Value, member(unit(_, Settings, Value)-_, Units), Pairs),
    pairs_values(Pairs, Values),
    sum_list(Values, Sum),
    length(Values, Measured),
    Average is Sum/Measured,
    keysort(Pairs, Sorted),
    group_pairs_by_key(Sorted, Groups),
    findall(Fitness-Settings,
            ( member(Settings-Found, Groups),
              fitness(Found, Average, Fitness) ),
            All),
    sort(1, @>=, All, Ranked).

fitness(Values, Average, Fitness) :-
    sum_list(Values, Sum),
    length(Values, Count),
    Fitness is (Sum + Average)/(Count + 1).

%!  known_levels(+Units, -Levels) is det.
%
%   Levels has, for each place of settings, the ordered set of levels known
%   there.

known_levels(Units, Levels) :-
    findall(Settings, member(unit(_, Settings, _)-_, Units), All),
    by_place(All, Levels).

by_place([[]|_], Levels) :-
    !,
    Levels = [].
by_place(All, [Known|Levels]) :-
    maplist(first, All, Firsts, Rests),
    sort(Firsts, Known),
    by_place(Rests, Levels).

first([First|Rest], First, Rest).
