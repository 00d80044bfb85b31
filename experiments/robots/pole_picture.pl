:- module(robots_pole_picture,
          [ draw_pole/4                 % +Directory, +Name, +Subtitle, +Cases
          ]).
:- use_module('../lib/plot', [colour/2, plot/4, save_columns/2]).
:- use_module('../sync/figure', [save_run_data/2]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2, nth1/3]).

/** <module> The picture of a pole that is carried in two ways

The tilt of the pole over time in both cases, and below it, over the same
time, which robot executed what in each of them.

*Threading*: no state; any thread.
*/

%!  draw_pole(+Directory, +Name, +Subtitle, +Cases) is det.
%
%   Write Directory/Name.svg and .png.  Cases are pairs Case-Result with
%   results of pole_run/4; the data of each are put into Directory/Case.

draw_pole(Directory, Name, Subtitle, Cases) :-
    maplist(save_case(Directory), Cases),
    plot(Directory, Name, 1200-900, script(Subtitle, Cases)).

save_case(Directory, Case-Result) :-
    directory_file_path(Directory, Case, Part),
    make_directory_path(Part),
    save_run_data(Part, Result),
    memberchk(states(States), Result),
    findall([Time, Tilt],
            ( member(state(Time, Pole), States), arg(6, Pole, Tilt) ),
            Rows),
    directory_file_path(Part, 'tilt.dat', File),
    save_columns(File, Rows).

                /*******************************
                *            SCRIPT            *
                *******************************/

script(Subtitle, Cases, Out) :-
    maplist(end, Cases, Ends),
    max_list(Ends, End),
    Right is End * 1.01,
    format(Out, 'set multiplot~n\c
set label 1 "{/:Bold=16 Four robots carry a pole}" at screen 0.075,0.970~n\c
set label 2 "~w" at screen 0.075,0.938 tc rgb "#555555"~n\c
set xrange [0:~4f]~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set lmargin at screen 0.075; set rmargin at screen 0.985~n\c
set style fill solid noborder; set format x ""~n', [Subtitle, Right]),
    tilt_panel(Out, Cases),
    forall(nth1(I, Cases, Case), robots_panel(Out, I, Case)),
    format(Out, 'unset multiplot~n', []).

end(_-Result, End) :-
    memberchk(end(End), Result).

tilt_panel(Out, Cases) :-
    Cases = [_-Result|_],
    memberchk(tilt_limit(Limit), Result),
    findall(Part, tilt_part(Cases, Part), Parts),
    atomic_list_concat(Parts, ', ', Plot),
    format(Out, 'set tmargin at screen 0.86; set bmargin at screen 0.545~n\c
set label 3 "Tilt of the pole" at screen 0.075,0.885~n\c
set key at screen 0.985,0.885 right center horizontal samplen 1.5~n\c
set yrange [0:*]; set ylabel "degrees" offset 0.5,0 tc rgb "#333333"~n\c
plot ~w lw 1.5 dt 2 lc rgb "#333333" title "limit", ~w~n\c
unset label; unset key~n', [Limit, Plot]).

tilt_part(Cases, Part) :-
    nth1(I, Cases, Case-_),
    case(I, Case, Title, Index),
    colour(Index, Colour),
    format(atom(Part), '"~w/tilt.dat" with lines lw 2 \c
lc rgb "#~|~`0t~16r~6+" title "~w"', [Case, Colour, Title]).

%   case(?Place, ?Case, -Title, -Colour)

case(1, synchronised, 'synchronised', 0).
case(2, alone, 'each by itself', 1).

robots_panel(Out, I, Case-Result) :-
    memberchk(hosts(Hosts), Result),
    length(Hosts, Count),
    Bottom is Count + 0.5,
    case(I, Case, Title, _),
    Top is 0.455 - 0.225*(I - 1),
    Low is Top - 0.15,
    Label is Top + 0.036,
    format(Out, 'set tmargin at screen ~4f; set bmargin at screen ~4f~n\c
set yrange [~1f:0.5]; set ytics 1; set ylabel "robot"~n\c
set label 3 "Tasks, ~w: required (light), executed (full colour)" \c
at screen 0.075,~4f~n', [Top, Low, Bottom, Title, Label]),
    forall(member(Row, [1, 2, 3, 4]), task_label(Out, Result, Row)),
    x_axis(Out, I),
    format(Out, 'plot "~w/hosts.dat" using 1:2:3:4:5:6:7 \c
with boxxyerror lc rgb variable notitle~nunset label~n', [Case]).

task_label(Out, Result, Task) :-
    memberchk(rows(Rows), Result),
    (   memberchk(task(Task, First, _, _, _, _), Rows)
    ->  Index is Task - 1,
        colour(Index, Colour),
        Label is 10 + Task,
        format(Out, 'set label ~d "{/:Bold T~d}" at first ~4f,graph 1.05 \c
tc rgb "#~|~`0t~16r~6+"~n', [Label, Task, First, Colour])
    ;   true
    ).

x_axis(Out, 2) :-
    !,
    format(Out, 'set format x "%g"; set xlabel "time (host seconds)" \c
offset 0,0.4~n', []).
x_axis(_, _).
