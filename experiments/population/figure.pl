:- module(population_figure,
          [ draw_population/4           % +Directory, +Name, +Titles, +Results
          ]).
:- use_module('../lib/plot', [colour/2, plot/4, save_columns/2]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [append/3, max_list/2, member/2, memberchk/2,
                               nth0/3, nth1/3, reverse/2]).

/** <module> The pictures of populations: thesis Figures 6.3 and 6.4

Three panels over one time axis: on how many hosts each task was switched
on, second by second, in the first of several runs; how many agents of each
kind there were in it, and how many in all in the other runs; and from
when to when each task was executed in each of the runs.

*Threading*: no state; any thread.
*/

%!  draw_population(+Directory, +Name, +Titles, +Results) is det.
%
%   Write Directory/Name.svg and .png, and their data, of Results, runs of
%   population_run/3.  Titles is Title-Subtitle.

draw_population(Directory, Name, Titles, Results) :-
    Results = [Result|_],
    save_starts(Directory, Name, Result),
    save_steps(Directory, Name, Results),
    save_spans(Directory, Name, Results),
    plot(Directory, Name, 1200-1000, script(Name, Titles, Results)).

                /*******************************
                *             DATA             *
                *******************************/

%   Name-starts.dat: for each second a stack of bars, one for each task:
%   middle, count, left, right, bottom, top, colour.

save_starts(Directory, Name, Result) :-
    memberchk(executions(Executions), Result),
    memberchk(again(Again), Result),
    append(Executions, Again, All),
    findall(Second-Task,
            ( member(execution(Task, _, Start, _), All),
              Second is floor(Start)
            ),
            Starts0),
    msort(Starts0, Starts),
    sort(Starts, Distinct),
    findall(Start-Count,
            ( member(Start, Distinct),
              aggregate_all(count, member(Start, Starts), Count)
            ),
            Counts),
    foldl(stack(Result), Counts, rows([], none, 0), rows(Rows, _, _)),
    save(Directory, Name, starts, Rows).

stack(Result, (Second-Task)-Count, rows(Rows0, Second0, Top0),
      rows([Row|Rows0], Second, Top)) :-
    (   Second == Second0
    ->  Bottom = Top0
    ;   Bottom = 0
    ),
    Top is Bottom + Count,
    Middle is Second + 0.5,
    Right is Second + 1,
    shade(Result, Task, Colour),
    Row = [Middle, Top, Second, Right, Bottom, Top, Colour].

shade(Result, Task, Colour) :-
    memberchk(tasks(Tasks), Result),
    nth0(Index, Tasks, Task),
    !,
    task_colour(Index, Colour).

task_colour(Index, Colour) :-
    Place is Index mod 6,
    colour(Place, Colour).

%   Name-run<I>.dat: time, agents of each kind, and in all.

save_steps(Directory, Name, Results) :-
    forall(nth1(I, Results, Result),
           ( findall(Row, step_row(Result, Row), Rows),
             atom_concat(run, I, Part),
             save(Directory, Name, Part, Rows) )).

step_row(Result, Row) :-
    memberchk(steps(Steps), Result),
    member(step(Time, Counts, Total), Steps),
    append([Time|Counts], [Total], Row).

%   Name-spans.dat: from the first start to the last end of each task, a
%   line for each run.

save_spans(Directory, Name, Results) :-
    findall([Middle, Run, First, End, Low, High, Colour],
            ( nth1(Run, Results, Result),
              memberchk(rows(Rows), Result),
              member(task(Task, First, _, End, _, _), Rows),
              Middle is (First + End)/2,
              Low is Run - 0.3,
              High is Run + 0.3,
              shade(Result, Task, Colour)
            ),
            Rows),
    save(Directory, Name, spans, Rows).

save(Directory, Name, Part, Rows) :-
    data_name(Name, Part, Base),
    directory_file_path(Directory, Base, File),
    save_columns(File, Rows).

data_name(Name, Part, File) :-
    format(atom(File), '~w-~w.dat', [Name, Part]).

                /*******************************
                *            SCRIPT            *
                *******************************/

script(Name, Title-Subtitle, Results, Out) :-
    findall(End, ( member(Result, Results), memberchk(end(End), Result) ),
            Ends),
    max_list(Ends, End),
    Right is End * 1.01,
    format(Out, 'set multiplot~n\c
set label 1 "{/:Bold=16 ~w}" at screen 0.075,0.972~n\c
set label 2 "{/*0.9 ~w}" at screen 0.075,0.943 tc rgb "#555555"~n\c
set xrange [0:~4f]~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1~n\c
set lmargin at screen 0.075; set rmargin at screen 0.985~n\c
set style fill solid 1.0 noborder~n', [Title, Subtitle, Right]),
    starts_panel(Out, Name, Results),
    steps_panel(Out, Name, Results),
    spans_panel(Out, Name, Results),
    format(Out, 'unset multiplot~n', []).

panel(Out, Top, Bottom, Title, YLabel) :-
    TitleY is Top + 0.017,
    format(Out, 'set tmargin at screen ~4f; set bmargin at screen ~4f~n\c
set label 3 "~w" at screen 0.075,~4f~n\c
set ylabel "~w" offset 0.5,0 tc rgb "#333333"~n',
           [Top, Bottom, Title, TitleY, YLabel]).

starts_panel(Out, Name, Results) :-
    Results = [Result|_],
    panel(Out, 0.89, 0.66, 'Tasks switched on', 'hosts in a second'),
    crash_line(Out, Result),
    data_name(Name, starts, File),
    findall(Key, key_box(Result, Key), Keys),
    atomic_list_concat(Keys, ', ', KeyPlot),
    format(Out, 'set yrange [0:*]; set format x ""; unset xlabel~n\c
set key at screen 0.985,0.907 right center horizontal samplen 1 width 1~n\c
plot "~w" using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable notitle, ~w~n\c
unset label~n', [File, KeyPlot]).

key_box(Result, Key) :-
    memberchk(tasks(Tasks), Result),
    nth0(Index, Tasks, Task),
    task_colour(Index, Colour),
    format(atom(Key), 'NaN with boxes lc rgb "#~|~`0t~16r~6+" title "T~w"',
           [Colour, Task]).

%   When hosts lost their second task.

crash_line(Out, Result) :-
    memberchk(failures([Time-_|_]), Result),
    !,
    format(Out, 'set arrow 1 from ~4f,graph 0 to ~4f,graph 1 nohead dt 2 \c
lc rgb "#222222"~n\c
set label 4 " T2 lost" at ~4f,graph 0.92~n', [Time, Time, Time]).
crash_line(Out, _) :-
    format(Out, 'unset arrow 1~n', []).

steps_panel(Out, Name, Results) :-
    Results = [Result|_],
    panel(Out, 0.59, 0.28, 'Agents', 'agents'),
    findall(Part, total_part(Name, Results, Part), Totals0),
    reverse(Totals0, Totals),
    findall(Part, kind_part(Name, Result, Part), Kinds),
    append(Totals, Kinds, Parts),
    atomic_list_concat(Parts, ', ', Plot),
    format(Out, 'set key at screen 0.985,0.607 right center horizontal \c
samplen 1 width -1 maxrows 1~nplot ~w~nunset label~n', [Plot]).

total_part(Name, Results, Part) :-
    nth1(I, Results, Result),
    memberchk(tasks(Tasks), Result),
    length(Tasks, Count),
    Column is Count + 2,
    atom_concat(run, I, RunPart),
    data_name(Name, RunPart, File),
    total_style(I, Style),
    format(atom(Part), '"~w" using 1:~d with steps ~w',
           [File, Column, Style]).

total_style(1, 'lw 1.6 lc rgb "#333333" title "all"') :-
    !.
total_style(2, 'lw 1 lc rgb "#c4c4c4" title "other runs"') :-
    !.
total_style(_, 'lw 1 lc rgb "#c4c4c4" notitle').

kind_part(Name, Result, Part) :-
    memberchk(tasks(Tasks), Result),
    nth1(I, Tasks, Task),
    Index is I - 1,
    Column is I + 1,
    task_colour(Index, Colour),
    data_name(Name, run1, File),
    format(atom(Part), '"~w" using 1:~d with steps lw 2 \c
lc rgb "#~|~`0t~16r~6+" title "Agent-~w"', [File, Column, Colour, Task]).

spans_panel(Out, Name, Results) :-
    length(Results, Count),
    Top is Count + 0.5,
    findall(Tic, run_tic(Results, Tic), Tics),
    atomic_list_concat(Tics, ',', Ytics),
    panel(Out, 0.21, 0.075, 'Execution of the tasks, run by run', 'seed'),
    data_name(Name, spans, File),
    format(Out, 'unset key; unset arrow 1; unset grid~n\c
set yrange [0.5:~w]; set ytics (~w)~n\c
set format x; set xlabel "seconds" tc rgb "#333333"~n\c
plot "~w" using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable notitle~n',
           [Top, Ytics, File]).

run_tic(Results, Tic) :-
    nth1(Run, Results, Result),
    memberchk(seed(Seed), Result),
    format(atom(Tic), '"~w" ~d', [Seed, Run]).
