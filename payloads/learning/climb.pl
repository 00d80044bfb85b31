:- payload(climb, [provides([plan/3, better/2])]).
:- include(confirm).

/*  A learning algorithm for noisy measurements unit(Source, Settings, Value):
    hill climbing from the best known settings to the most promising ones
    near them.

    A linear model estimates the effect of each level in each place on the
    value.  It is fitted to all measurements, weighted by their nearness to
    the best settings, so that it is right there, although places depend on
    each other.  The estimate for settings combines their own measurements with
    the model, which counts as one more measurement, because the error of a
    single measurement may be large. The constant offset of a source that
    measures higher than others is removed first.

    The plan tries the most promising settings that differ from the best ones
    in one place or two, then uses the best ones and measures them again.
    Levels that were seldom tried get a bonus on their estimate.
*/

plan(_, Units, Plan) :-
    samples(Units, Samples),
    summary(Samples, Summary),
    promising(Summary, First),
    model(Summary, First, Model),
    best(Summary, Model, Best),
    findall(Promise-Settings,
            ( near(Best, Model, Settings),
              \+ memberchk(Settings-_, Summary),
              promise(Settings, Model, Promise) ),
            Promises),
    sort(1, @>=, Promises, Sorted),
    findall(use(Settings), limit(3, member(_-Settings, Sorted)), Trials),
    repeated(Best, Again),
    append(Trials, Again, Plan).

                /*******************************
                *          THE MEANS           *
                *******************************/

%   samples(+Units, -Samples): Settings-Value, without the offsets of the
%   printers from their average.

samples(Units, Samples) :-
    findall(Settings-Value, member(unit(_, Settings, Value)-_, Units), Raw),
    summary(Raw, Summary),
    list_to_assoc(Summary, Means),
    findall(Source-Difference,
            ( member(unit(Source, Settings, Value)-_, Units),
              get_assoc(Settings, Means, mean(_, Mean)),
              Difference is Value - Mean ),
            Differences),
    grouped(Differences, Groups),
    findall(Source-Level,
            ( member(Source-Values, Groups),
              mean(Values, _, Level) ),
            Levels),
    findall(Settings-Value,
            ( member(unit(Source, Settings, Value0)-_, Units),
              memberchk(Source-Level, Levels),
              Value is Value0 - Level ),
            Samples).

%   summary(+Samples, -Summary): Settings-mean(Count, Mean).

summary(Samples, Summary) :-
    grouped(Samples, Groups),
    findall(Settings-mean(Count, Mean),
            ( member(Settings-Values, Groups), mean(Values, Count, Mean) ),
            Summary).

grouped(Pairs, Groups) :-
    keysort(Pairs, Sorted),
    group_pairs_by_key(Sorted, Groups).

mean(Values, Count, Mean) :-
    sum_list(Values, Sum),
    length(Values, Count),
    Mean is Sum/Count.

overall(Summary, Overall) :-
    findall(Mean, member(_-mean(_, Mean), Summary), Means),
    mean(Means, _, Overall).

promising(Summary, Settings) :-
    overall(Summary, Overall),
    findall(Value-Known,
            ( member(Known-mean(Count, Mean), Summary),
              Value is (Count*Mean + Overall)/(Count + 1) ),
            Valued),
    max_member(_-Settings, Valued).

                /*******************************
                *           THE MODEL          *
                *******************************/

%   Model is model(Base, Effects), Effects an assoc of Place-Level to
%   effect(Added, Weight): Added is the effect on the value, Weight the weight
%   of its measurements.

model(Summary, Around, model(Base, Effects)) :-
    findall(row(Levels, Weight, Mean),
            ( member(Settings-mean(Count, Mean), Summary),
              differing(Settings, Around, 0, Distance),
              Weight is Count*exp(-0.7*Distance),
              findall(Place-Level, nth1(Place, Settings, Level), Levels) ),
            Rows),
    findall(W, member(row(_, W, _), Rows), Ws),
    sum_list(Ws, All),
    findall(WY, ( member(row(_, W, Y), Rows), WY is W*Y ), WYs),
    sum_list(WYs, Sum),
    Base is Sum/All,
    findall(Key, ( member(row(Levels, _, _), Rows), member(Key, Levels) ),
            Keys0),
    sort(Keys0, Keys),
    findall(Key-effect(0.0, 0.0), member(Key, Keys), Pairs),
    list_to_assoc(Pairs, Effects0),
    length(Around, Places),
    numlist(1, Places, Numbers),
    fitted(4, Numbers, Rows, Base, Effects0, Effects).

differing([], [], Distance, Distance).
differing([X|Xs], [Y|Ys], Distance0, Distance) :-
    apart(X, Y, Apart),
    Distance1 is Distance0 + Apart,
    differing(Xs, Ys, Distance1, Distance).

apart(X, X, 0) :-
    !.
apart(X, Y, Apart) :-
    number(X),
    number(Y),
    !,
    Apart is min(1, abs(X - Y)/3).
apart(_, _, 1).

%   Fits one place after the other to the residuals of the others.

fitted(0, _, _, _, Effects, Effects) :-
    !.
fitted(Rounds, Places, Rows, Base, Effects0, Effects) :-
    foldl(fit(Rows, Base), Places, Effects0, Effects1),
    Left is Rounds - 1,
    fitted(Left, Places, Rows, Base, Effects1, Effects).

fit(Rows, Base, Place, Effects0, Effects) :-
    findall(Level-(Weight*Rest),
            ( member(row(Levels, Weight, Value), Rows),
              explained(Levels, Place, Effects0, Base, Explained),
              Rest is Value - Explained,
              memberchk(Place-Level, Levels) ),
            Rests),
    grouped(Rests, Groups),
    foldl(effect(Place), Groups, Effects0, Effects).

explained([], _, _, Sum, Sum).
explained([Place-_|Levels], Place, Effects, Sum0, Sum) :-
    !,
    explained(Levels, Place, Effects, Sum0, Sum).
explained([Key|Levels], Place, Effects, Sum0, Sum) :-
    get_assoc(Key, Effects, effect(Added, _)),
    Sum1 is Sum0 + Added,
    explained(Levels, Place, Effects, Sum1, Sum).

%   Half a measurement with the effect 0 regularizes the mean.

effect(Place, Level-Rests, Effects0, Effects) :-
    weighed(Rests, 0, Sum, 0, Weight),
    Added is Sum/(Weight + 0.5),
    put_assoc(Place-Level, Effects0, effect(Added, Weight), Effects).

weighed([], Sum, Sum, Weight, Weight).
weighed([W*Rest|Rests], Sum0, Sum, Weight0, Weight) :-
    Sum1 is Sum0 + W*Rest,
    Weight1 is Weight0 + W,
    weighed(Rests, Sum1, Sum, Weight1, Weight).

                /*******************************
                *          CANDIDATES          *
                *******************************/

best(Summary, Model, Best) :-
    findall(Value-Settings,
            ( member(Settings-mean(Count, Mean), Summary),
              predicted(Settings, Model, Predicted, _),
              Value is (Count*Mean + Predicted)/(Count + 1) ),
            Valued),
    max_member(_-Best, Valued).

promise(Settings, Model, Promise) :-
    predicted(Settings, Model, Predicted, Doubt),
    Promise is Predicted + 0.05*Doubt.

%   Doubt is great where levels were seldom tried.

predicted(Settings, model(Base, Effects), Predicted, Doubt) :-
    predicted(Settings, 1, Effects, Base, Predicted, 0, Doubt).

predicted([], _, _, Value, Value, Doubt, Doubt).
predicted([Level|Levels], Place, Effects, Value0, Value, Doubt0, Doubt) :-
    get_assoc(Place-Level, Effects, effect(Added, Weight)),
    Value1 is Value0 + Added,
    Doubt1 is Doubt0 + 1/sqrt(1 + Weight),
    Next is Place + 1,
    predicted(Levels, Next, Effects, Value1, Value, Doubt1, Doubt).

%   Levels are those of random trials.

near(Settings, model(_, Effects), Near) :-
    assoc_to_keys(Effects, Keys),
    member(Place1-Level1, Keys),
    replaced(Place1, Settings, Level1, Near1),
    (   Near = Near1
    ;   member(Place2-Level2, Keys),
        Place2 > Place1,
        replaced(Place2, Near1, Level2, Near)
    ).

replaced(Place, Settings0, Level, Settings) :-
    nth1(Place, Settings0, Old, Rest),
    Level \== Old,
    nth1(Place, Settings, Level, Rest).
