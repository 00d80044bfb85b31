:- module(experiment_chart,
          [ draw_chart/3,               % +Directory, +Name, +Chart
            median/2                    % +Numbers, -Median
          ]).
:- use_module(plot, [colour/2, plot/4, save_columns/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [ append/2, last/2, max_list/2, member/2, memberchk/2,
                min_list/2, nth0/3, nth1/3
              ]).
:- use_module(library(option), [option/3]).

/** <module> Measures of several runs against a parameter

Panels one below the other over one horizontal axis.  A line goes through
the medians of the runs; a bar stands from the least to the greatest, and
each single run is a small dot.

*Threading*: no state; any thread.
*/

%!  draw_chart(+Directory, +Name, +Chart) is det.
%
%   Write Directory/Name.svg and .png, and their data.  Chart is a list of
%
%     - title(Text), subtitle(Text), x(Text)
%     - panels(List): of panel(Title, YLabel, Series), from the top
%     - ticks(List): of the horizontal axis; default: where there are
%       points
%
%   Series are terms series(Label, Index, Points, Marked): drawn in colour
%   Index; Points are pairs X-Values, Values being a list of what the
%   single runs gave, or X-at(Y, Values): then the line goes through Y there.
%   The point at X = Marked gets a ring (`none`: none does).

draw_chart(Directory, Name, Chart) :-
    memberchk(panels(Panels), Chart),
    xs(Panels, Xs),
    forall(( nth1(P, Panels, panel(_, _, Series)),
             nth0(S, Series, One)
           ),
           save_series(Directory, Name, Xs, P, S, Series, One)),
    length(Panels, Count),
    Height is 110 + 330*Count,
    plot(Directory, Name, 1000-Height, script(Name, Chart, Xs, Height)).

xs(Panels, Xs) :-
    findall(X, ( member(panel(_, _, Series), Panels),
                 member(series(_, _, Points, _), Series),
                 member(X-_, Points) ),
            Xs0),
    sort(0, @<, Xs0, Xs).

%!  median(+Numbers:list(number), -Median:number) is semidet.
%
%   Median is the one in the middle, or the mean of the two in the middle.
%   Fails for an empty list.

median(Numbers, Median) :-
    msort(Numbers, Sorted),
    length(Sorted, Count),
    Count > 0,
    Low is (Count - 1) // 2,
    High is Count // 2,
    nth0(Low, Sorted, A),
    nth0(High, Sorted, B),
    (   Low =:= High
    ->  Median = A
    ;   Median is (A + B)/2
    ).

                /*******************************
                *             DATA             *
                *******************************/

%   Name-P-S.dat has X, median, least, greatest; a second block has the
%   single runs; a third one the marked point.  Series stand a little
%   beside each other, so that their bars can be told apart.

save_series(Directory, Name, Xs, P, S, Series, One) :-
    shift(Xs, S, Series, Shift),
    findall(Row, summary_row(One, Shift, Row), Summary),
    findall(Row, run_row(One, Shift, Row), Runs),
    findall(Row, marked_row(One, Shift, Row), Marked),
    data_name(Name, P, S, File0),
    directory_file_path(Directory, File0, File),
    append([Summary, [gap, gap], Runs, [gap, gap], Marked], Rows),
    save_columns(File, Rows).

summary_row(series(_, _, Points, _), Shift, [X, Middle, Least, Most]) :-
    member(X0-Point, Points),
    middle(Point, Middle, Values),
    min_list(Values, Least),
    max_list(Values, Most),
    X is X0 + Shift.

middle(at(Y, Values), Y, Values) :-
    !.
middle(Values, Median, Values) :-
    median(Values, Median).

run_row(series(_, _, Points, _), Shift, [X, Value, 0, 0]) :-
    member(X0-Point, Points),
    middle(Point, _, Values),
    member(Value, Values),
    X is X0 + Shift.

marked_row(series(_, _, Points, Mark), Shift, [X, Middle, 0, 0]) :-
    number(Mark),
    member(X0-Point, Points),
    X0 =:= Mark,
    middle(Point, Middle, _),
    X is X0 + Shift.

shift(Xs, S, Series, Shift) :-
    Xs = [First|_],
    last(Xs, Last),
    length(Series, Count),
    Shift is (S - (Count - 1)/2) * 0.008 * (Last - First).

data_name(Name, P, S, File) :-
    format(atom(File), '~w-~d-~d.dat', [Name, P, S]).

                /*******************************
                *            SCRIPT            *
                *******************************/

script(Name, Chart, Xs, Height, Out) :-
    memberchk(panels(Panels), Chart),
    length(Panels, Count),
    heading(Out, Chart, Height),
    axes(Out, Chart, Xs),
    forall(nth1(P, Panels, Panel),
           panel(Out, Name, Chart, P-Count, Height, Panel)),
    format(Out, 'unset multiplot~n', []).

heading(Out, Chart, Height) :-
    memberchk(title(Title), Chart),
    memberchk(subtitle(Subtitle), Chart),
    Y1 is 1 - 26/Height,
    Y2 is 1 - 54/Height,
    format(Out, 'set multiplot~n\c
set label 1 "{/:Bold=15 ~w}" at screen 0.085,~4f~n\c
set label 2 "{/*0.9 ~w}" at screen 0.085,~4f tc rgb "#555555"~n',
           [Title, Y1, Subtitle, Y2]).

axes(Out, Chart, Xs) :-
    Xs = [First|_],
    last(Xs, Last),
    Margin is max(0.05 * (Last - First), 0.01),
    Left is First - Margin,
    Right is Last + Margin,
    option(ticks(Ticks), Chart, Xs),
    maplist(tick, Ticks, Texts),
    atomic_list_concat(Texts, ',', Tics),
    format(Out, 'set xrange [~4f:~4f]; set xtics (~w)~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1~n\c
set lmargin at screen 0.085; set rmargin at screen 0.975~n',
           [Left, Right, Tics]).

tick(X, Text) :-
    format(atom(Text), '"~w" ~w', [X, X]).

%   The names of the lines are above the first panel, the name of the axis
%   below the last.

panel(Out, Name, Chart, P-Count, Height, panel(Title, YLabel, Series)) :-
    Top is 1 - (90 + 330*(P - 1) + 32)/Height,
    Bottom is 1 - (90 + 330*P - 45)/Height,
    TitleY is Top + 20/Height,
    format(Out, 'set tmargin at screen ~4f; set bmargin at screen ~4f~n\c
set label 3 "~w" at screen 0.085,~4f~n\c
set yrange [0:1<*]; set offsets 0,0,graph 0.06,0~n\c
set ylabel "~w" offset 0.5,0 tc rgb "#333333"~n',
           [Top, Bottom, Title, TitleY, YLabel]),
    key(Out, P, Height),
    x_label(Out, Chart, P, Count),
    findall(Part, plot_part(Name, P, Series, Part), Parts),
    atomic_list_concat(Parts, ', ', Plot),
    format(Out, 'plot ~w~nunset label~n', [Plot]).

key(Out, 1, Height) :-
    !,
    Y is 1 - 82/Height,
    format(Out, 'set key at screen 0.975,~4f right center horizontal \c
samplen 1.5 width 1~n', [Y]).
key(Out, _, _) :-
    format(Out, 'unset key~n', []).

x_label(Out, Chart, Count, Count) :-
    !,
    memberchk(x(Text), Chart),
    format(Out, 'set format x; set xlabel "~w" tc rgb "#333333"~n', [Text]).
x_label(Out, _, _, _) :-
    format(Out, 'unset xlabel~n', []).

plot_part(Name, P, Series, Part) :-
    nth0(S, Series, series(_, Index, _, _)),
    data_name(Name, P, S, File),
    colour(Index, Colour),
    member(Format,
           [ '"~w" index 1 using 1:2 with points pt 7 ps 0.45 \c
lc rgb "#a0~|~`0t~16r~6+" notitle',
             '"~w" index 0 using 1:2:3:4 with yerrorbars pt 7 ps 1.1 \c
lw 1.4 lc rgb "#~|~`0t~16r~6+" notitle' ]),
    format(atom(Part), Format, [File, Colour]).
plot_part(Name, P, Series, Part) :-
    nth0(S, Series, series(Label, Index, _, _)),
    data_name(Name, P, S, File),
    colour(Index, Colour),
    format(atom(Part), '"~w" index 0 using 1:2 with lines lw 2 \c
lc rgb "#~|~`0t~16r~6+" title "~w"', [File, Colour, Label]).
plot_part(Name, P, Series, Part) :-
    nth0(S, Series, series(_, Index, Points, Marked)),
    number(Marked),
    memberchk(Marked-_, Points),
    data_name(Name, P, S, File),
    colour(Index, Colour),
    format(atom(Part), '"~w" index 2 using 1:2 with points pt 6 ps 2.4 \c
lw 1.6 lc rgb "#~|~`0t~16r~6+" notitle', [File, Colour]).
