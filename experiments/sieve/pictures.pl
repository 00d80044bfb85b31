:- module(sieve_pictures,
          [ median_rows/2,              % +Panels, -Rows
            dot_rows/2,                 % +Panels, -Rows
            panel_variables/2,          % +Panels, -Pairs
            curve_points/3              % +Name, +MeasuresList, -Points
          ]).
:- use_module('../engine/numbers', [spread/4]).
:- use_module(library(lists),
              [append/2, max_list/2, member/2]).

/** <module> Data of rounds.gp: values of several runs, round by round

A panel is panel(Title, Series), Series a list of series(Label, Points), and
Points are pairs Round-Values, a value for each run.  No panel has more series
than the first one.

*Threading*: pure.
*/

%!  median_rows(+Panels, -Rows) is det.
%!  dot_rows(+Panels, -Rows) is det.
%
%   A block for each series of each panel.  Rows are round, median, least and
%   greatest value; or round and value.

median_rows(Panels, Rows) :-
    blocks(Panels, median_row, Rows).

median_row(Points, [Round, Median, Least, Most]) :-
    member(Round-Values, Points),
    spread(Values, Least, Median, Most).

dot_rows(Panels, Rows) :-
    blocks(Panels, dot_row, Rows).

dot_row(Points, [Round, Value]) :-
    member(Round-Values, Points),
    member(Value, Values).

:- meta_predicate blocks(+, 2, -).

blocks(Panels, Row, Rows) :-
    findall([Block, [gap, gap]],
            ( member(panel(_, Series), Panels),
              member(series(_, Points), Series),
              findall(R, call(Row, Points, R), Block) ),
            Nested0),
    append(Nested0, Nested),
    append(Nested, Rows).

%!  panel_variables(+Panels, -Pairs) is det.
%
%   Variables for gnuplot: titles, labels, the number of series of each panel,
%   and the last round.

panel_variables(Panels, [ panels-Count, 'Panel'-Titles, 'Series'-Labels,
                          'Size'-Sizes, rounds-Last ]) :-
    length(Panels, Count),
    findall(Title, member(panel(Title, _), Panels), Titles),
    findall(Label, ( member(panel(_, Series), Panels),
                     member(series(Label, _), Series) ), Labels),
    findall(Size, ( member(panel(_, Series), Panels), length(Series, Size) ),
            Sizes),
    findall(Round, ( member(panel(_, Series), Panels),
                     member(series(_, Points), Series),
                     member(Round-_, Points) ), Rounds),
    max_list(Rounds, Last).

%!  curve_points(+Name, +MeasuresList, -Points) is det.
%
%   Points of a measure that is a list of pairs Round-Value.

curve_points(Name, All, Points) :-
    findall(Round, ( member(Ms, All), get_dict(Name, Ms, Curve),
                     member(Round-_, Curve) ), Rounds0),
    sort(Rounds0, Rounds),
    findall(Round-Values,
            ( member(Round, Rounds),
              findall(Value, ( member(Ms, All), get_dict(Name, Ms, Curve),
                               member(Round-Value, Curve) ), Values) ),
            Points).
