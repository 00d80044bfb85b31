:- module(sync_gallery,
          [ draw_gallery/4              % +Directory, +Name, +Headings, +Items
          ]).
:- use_module(figure, [save_run_data/2, task_colour/4]).
:- use_module('../lib/plot', [plot/4]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2, nth1/3]).

/** <module> Several runs below each other: thesis Figures 5.5, 5.11, 5.12

A row for each run: on the left on how many hosts each task was switched
on, second by second; on the right what each host required, and when it
executed it.  All rows have the same time axis.

*Threading*: no state; any thread.
*/

%!  draw_gallery(+Directory, +Name, +Headings, +Items) is det.
%
%   Write Directory/Name.svg and .png, and the data of each item in a
%   directory below.  Headings are title(Text), subtitle(Text).  Items are
%   terms item(Key, Title, Result): Key names the directory, Result is as
%   for draw_figure/3.

draw_gallery(Directory, Name, Headings, Items) :-
    forall(member(item(Key, _, Result), Items),
           ( directory_file_path(Directory, Key, Below),
             make_directory_path(Below),
             save_run_data(Below, Result) )),
    length(Items, Count),
    Height is 105 + 290*Count,
    plot(Directory, Name, 1400-Height, script(Headings, Items, Height)).

script(Headings, Items, Height, Out) :-
    heading(Out, Headings, Height),
    findall(End, ( member(item(_, _, Result), Items),
                   memberchk(end(End), Result) ), Ends),
    max_list(Ends, End),
    Right is End * 1.01,
    length(Items, Count),
    format(Out, 'set xrange [0:~4f]~n\c
unset key~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set style fill solid noborder~n', [Right]),
    forall(nth1(I, Items, Item), row(Out, Item, I, Count, Height)),
    format(Out, 'unset multiplot~n', []).

heading(Out, Headings, Height) :-
    memberchk(title(Title), Headings),
    memberchk(subtitle(Subtitle), Headings),
    Y1 is 1 - 26/Height,
    Y2 is 1 - 54/Height,
    format(Out, 'set multiplot~n\c
set label 1 "{/:Bold=15 ~w}" at screen 0.045,~4f~n\c
set label 2 "{/*0.9 ~w}" at screen 0.045,~4f tc rgb "#555555"~n',
           [Title, Y1, Subtitle, Y2]).

row(Out, item(Key, Title, Result), I, Count, Height) :-
    Top is 1 - (70 + 290*(I - 1) + 52)/Height,
    Bottom is 1 - (70 + 290*I - 30)/Height,
    TitleY is Top + 30/Height,
    format(Out, 'set tmargin at screen ~4f; set bmargin at screen ~4f~n',
           [Top, Bottom]),
    (   I =:= Count
    ->  format(Out, 'set xlabel "time (host seconds)" offset 0,0.4~n', [])
    ;   true
    ),
    format(Out, 'set label 3 "~w" at screen 0.045,~4f~n',
           [Title, TitleY]),
    starts(Out, Key, Result),
    hosts(Out, Key, Result).

starts(Out, Key, Result) :-
    format(Out, 'set lmargin at screen 0.045; set rmargin at screen 0.49~n\c
set yrange [0:*]; set ylabel "hosts" offset 1.2,0 tc rgb "#333333"~n', []),
    memberchk(rows(Rows), Result),
    forall(nth1(I, Rows, task(Task, First, _, _, _, _)),
           ( Tag is 10 + I,
             task_colour(Result, Task, Colour, _),
             label_height(Rows, I, Y),
             format(Out, 'set label ~d "{/:Bold T~w}" at first ~4f,\c
graph ~2f offset 0.3,0 tc rgb "#~|~`0t~16r~6+"~n',
                    [Tag, Task, First, Y, Colour]) )),
    mark_failure(Out, Result),
    format(Out, 'plot "~w/starts.dat" using 1:2:3:4:5:6:7 \c
with boxxyerror lc rgb variable~nunset label~nunset arrow~n', [Key]).

hosts(Out, Key, Result) :-
    memberchk(hosts(Hosts), Result),
    length(Hosts, Count),
    Low is Count + 0.5,
    format(Out, 'set lmargin at screen 0.545; set rmargin at screen 0.99~n\c
set yrange [~1f:0.5]; set ylabel "host"~n', [Low]),
    mark_failure(Out, Result),
    format(Out, 'plot "~w/hosts.dat" using 1:2:3:4:5:6:7 \c
with boxxyerror lc rgb variable~nunset label~nunset arrow~n', [Key]).

%   Tasks that begin again are named below the others.

label_height(Rows, I, Y) :-
    nth1(I, Rows, task(Task, _, _, _, _, _)),
    (   nth1(Again, Rows, task(Earlier, _, _, _, _, none)),
        Again < I,
        Earlier >= Task
    ->  Y = 0.92
    ;   Y = 1.04
    ).

%   A line where something was lost.

mark_failure(Out, Result) :-
    memberchk(healing(Healing), Result),
    memberchk(failed_at(Time), Healing),
    !,
    format(Out, 'set arrow 1 from first ~4f,graph 0 to first ~4f,graph 1 \c
nohead dt 2 lw 1.2 lc rgb "#333333" front~n', [Time, Time]).
mark_failure(_, _).
