%   Figures 4.9, 4.10, 4.12, 4.13: comparison of networks, and sharing over
%   time.
%
%   Expects: ground, and the parameters `network` and `density`, which vary.

:- use_module('../engine/gnuplot', [colour/2]).
:- use_module('../engine/numbers', [spread/4]).
:- use_module(metrics, [bins/4, duration/2, shared_times/2, trend/3]).
:- use_module(library(apply), [include/3, maplist/3]).
:- use_module(library(lists), [list_to_set/2, member/2, min_list/2, nth0/3]).
:- use_module(library(pairs), [group_pairs_by_key/2]).

label(trend, "Trend of sharing events (%)").
label(early_trend, "Trend until the first agent has converged (%)").
label(obstacle, "50 hosts, obstacle").
label(N, Text) :-
    vary(network, Networks),
    member(N, Networks),
    integer(N),
    format(string(Text), "~d hosts", [N]).

%   The change of the linear trend of sharing events, relative to their mean, in
%   30 equal parts of the run; and of the time in which all agents are active:
%   agents that have converged do not share any more.

measure(trend, View, Percent) :-
    duration(View.learners, End),
    change(View.learners, End, Percent).
measure(early_trend, View, Percent) :-
    findall(T, member(learner(_, _, converged(T, _, _)), View.learners), Ts),
    min_list(Ts, First),
    change(View.learners, First, Percent).

change(Learners, End, Percent) :-
    shared_times(Learners, Times0),
    include(>=(End), Times0, Times),
    length(Times, Count),
    Count > 0,
    trend_line(Times, End, Level, Last),
    Percent is 100*(Last - Level)/(Count/30).

trend_line(Times, End, Level, Last) :-
    bins(Times, End, 30, Points),
    trend(Points, Slope, Level),
    Last is Level + Slope*End.

%   each_network(+Said, -Network, -Text): for claims of every network.

each_network(Said, Network, Text) :-
    vary(network, Networks),
    member(Network, Networks),
    label(Network, Name),
    format(string(Text), "~w, ~w", [Said, Name]).

%   first_drop(+Measure, -Test): the largest drop is from D 0.1 to 0.2.

first_drop(Measure, at([density=0.1], (First > A, First > B, First > C))) :-
    drop(Measure, 0.1, 0.2, First),
    drop(Measure, 0.2, 0.3, A),
    drop(Measure, 0.3, 0.4, B),
    drop(Measure, 0.4, 0.5, C).

drop(Measure, D1, D2,
     at([density=D1], Measure) - at([density=D2], Measure)).

                /*******************************
                *           PICTURES           *
                *******************************/

%   sets(+Name, +Measure, -Picture): a set of points for each network, one
%   for each density.

sets(Name, Measure,
     script('sets.gp',
            [ Medians-set_rows(Measure, medians),
              All-set_rows(Measure, each),
              Printed-set_rows(Measure, printed) ],
            [size(1100, 480), variables(sets_drawn(Measure))])) :-
    maplist(atom_concat(Name), ['-medians', '-runs', '-printed'],
            [Medians, All, Printed]).

%   Rows have a block for each network.

set_rows(Measure, What, Runs, Rows) :-
    drawn(Runs, Networks),
    findall(Row,
            ( nth0(I, Networks, Network),
              findall(Row0, point(What, I, Network, Measure, Runs, Row0),
                      Rows0),
              ( member(Row, Rows0)
              ; Rows0 == [], Row = ['NaN', 'NaN', 'NaN', 'NaN']
              ; member(Row, [gap, gap]) ) ),
            Rows).

drawn(Runs, Networks) :-
    findall(Network, ( member(run(Case, _, _), Runs),
                       get_dict(network, Case, Network) ), All),
    list_to_set(All, Networks).

point(What, I, Network, Measure, Runs, [X|Ys]) :-
    findall(D-Value,
            ( member(run(Case, _, Measures), Runs),
              get_dict(network, Case, Network),
              get_dict(density, Case, D),
              get_dict(Measure, Measures, Value) ),
            Pairs),
    keysort(Pairs, Sorted),
    group_pairs_by_key(Sorted, Groups),
    member(D-Values, Groups),
    X is 6*I + 10*D,
    ordinates(What, Network, D, Measure, Values, Ys).

ordinates(medians, _, _, _, Values, [Median, Least, Most]) :-
    spread(Values, Least, Median, Most).
ordinates(each, _, _, _, Values, [Value]) :-
    member(Value, Values).
ordinates(printed, Network, D, Measure, _, [Value]) :-
    printed(Measure, [network=Network, density=D], Value).

sets_drawn(Measure, Runs,
           [ 'LABEL'-Label, 'RUNS'-Count, sets-Sets, 'Set'-Names,
             'Colour'-Colours ]) :-
    label(Measure, Label),
    drawn(Runs, Networks),
    length(Networks, Sets),
    findall(Name, ( member(N, Networks), label(N, Name) ), Names),
    findall(Colour, ( nth0(I, Networks, _), C is I mod 6, colour(C, Colour) ),
            Colours),
    findall(Seed, member(run(_, Seed, _), Runs), Seeds),
    list_to_set(Seeds, Distinct),
    length(Distinct, Count).

%   The times of the first run that has stored them.

kept(Runs, Seed, Times, End) :-
    member(run(_, Seed, Measures), Runs),
    get_dict(times, Measures, Times),
    get_dict(duration, Measures, End),
    !.

times_rows(Runs, Rows) :-
    kept(Runs, _, Times, End),
    bins(Times, End, 30, Points),
    findall([X, Y], member(X-Y, Points), Rows).

trend_rows(Runs, [[0, Level], [End, Last]]) :-
    kept(Runs, _, Times, End),
    trend_line(Times, End, Level, Last).

times_drawn(Runs, ['SEED'-Seed, 'END'-End]) :-
    kept(Runs, Seed, _, End).
