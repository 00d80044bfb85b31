:- module(sync_figure,
          [ draw_figure/3,              % +Directory, +Name, +Result
            save_run_data/2,            % +Directory, +Result
            task_colour/4               % +Result, +Task, -Colour, -Light
          ]).
:- use_module('../lib/plot',
              [colour/2, lighten/2, plot/3, save_columns/2]).
:- use_module(library(apply), [foldl/6]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [max_list/2, member/2, memberchk/2, nth0/3, nth1/3]).
:- use_module(library(pairs), [pairs_keys_values/3]).

/** <module> The picture of one run: thesis Figure 5.5 g and h

Three panels over one time axis: on how many hosts each task was switched
on, second by second; what every host required, and when it executed; and
the number of distinct tasks required in the whole network.

*Threading*: no state; any thread.
*/

%!  draw_figure(+Directory, +Name, +Result) is det.
%
%   Write the data files and the pictures Name.svg and .png of Result, a
%   list of
%
%     - title(Text), subtitle(Text)
%     - hosts(List), tasks(List): in order
%     - executions(List), rows(List), segments(List), steps(List): see
%       sync_metrics
%     - end(Time): when the last execution ended

draw_figure(Directory, Name, Result) :-
    save_run_data(Directory, Result),
    plot(Directory, Name, script(Result)).

%!  save_run_data(+Directory, +Result) is det.
%
%   Write what the pictures are drawn from: starts.dat, hosts.dat, tau.dat.

save_run_data(Directory, Result) :-
    save_starts(Directory, Result),
    save_hosts(Directory, Result),
    save_tau(Directory, Result).

                /*******************************
                *             DATA             *
                *******************************/

%   starts.dat: for each second a stack of bars, one for each task that
%   was switched on: middle, count, left, right, bottom, top, colour.

save_starts(Directory, Result) :-
    memberchk(executions(Executions), Result),
    findall(Second-Task,
            ( member(execution(Task, _, Start, _), Executions),
              Second is floor(Start)
            ),
            Starts0),
    msort(Starts0, Starts),
    counts(Starts, Counts),
    foldl(stack(Result), Counts, Rows, none-0, _),
    save(Directory, 'starts.dat', Rows).

counts([], []).
counts([Start|Starts], [Start-Count|Counts]) :-
    same(Starts, Start, 1, Count, Rest),
    counts(Rest, Counts).

same([Start|Starts], Start, N0, N, Rest) :-
    !,
    N1 is N0 + 1,
    same(Starts, Start, N1, N, Rest).
same(Starts, _, N, N, Starts).

stack(Result, (Second-Task)-Count, Row, Second0-Top0, Second-Top) :-
    (   Second == Second0
    ->  Bottom = Top0
    ;   Bottom = 0
    ),
    Top is Bottom + Count,
    Middle is Second + 0.5,
    Right is Second + 1,
    task_colour(Result, Task, Colour, _),
    Row = [Middle, Top, Second, Right, Bottom, Top, Colour].

%   hosts.dat: what is required in a light colour and, drawn over it, what
%   is executed in the full colour of the task.

save_hosts(Directory, Result) :-
    findall(Row, host_row(Result, Row), Rows),
    save(Directory, 'hosts.dat', Rows).

host_row(Result, Row) :-
    memberchk(segments(Segments), Result),
    member(segment(Host, Task, From, To), Segments),
    task_colour(Result, Task, _, Light),
    bar(Result, Host, From, To, Light, Row).
host_row(Result, Row) :-
    memberchk(executions(Executions), Result),
    member(execution(Task, Host, Start, End), Executions),
    task_colour(Result, Task, Colour, _),
    bar(Result, Host, Start, End, Colour, Row).

bar(Result, Host, From, To, Colour, Row) :-
    memberchk(hosts(Hosts), Result),
    nth1(Index, Hosts, Host),
    !,
    Middle is (From + To)/2,
    Low is Index - 0.5,
    High is Index + 0.5,
    Row = [Middle, Index, From, To, Low, High, Colour].

save_tau(Directory, Result) :-
    memberchk(steps(Steps), Result),
    pairs_keys_values(Steps, Times, Taus),
    findall([Time, Tau], ( nth1(I, Times, Time), nth1(I, Taus, Tau) ), Rows),
    save(Directory, 'tau.dat', Rows).

save(Directory, Name, Rows) :-
    directory_file_path(Directory, Name, File),
    save_columns(File, Rows).

%!  task_colour(+Result, +Task, -Colour, -Light) is semidet.
%
%   The colours of Task, numbers 0xRRGGBB.

task_colour(Result, Task, Colour, Light) :-
    memberchk(tasks(Tasks), Result),
    nth0(I, Tasks, Task),
    !,
    N is I mod 6,
    colour(N, Colour),
    lighten(Colour, Light).

                /*******************************
                *            SCRIPT            *
                *******************************/

script(Result, Out) :-
    memberchk(end(End), Result),
    memberchk(hosts(Hosts), Result),
    memberchk(title(Title), Result),
    memberchk(subtitle(Subtitle), Result),
    length(Hosts, Count),
    format(Out, 'set multiplot~n', []),
    format(Out, 'set label 1 "{/:Bold=16 ~w}" at screen 0.075,0.972~n',
           [Title]),
    format(Out, 'set label 2 "~w" at screen 0.075,0.943 tc rgb "#555555"~n',
           [Subtitle]),
    common(Out, End),
    starts_panel(Out, Result),
    hosts_panel(Out, Count),
    tau_panel(Out, Result),
    format(Out, 'unset multiplot~n', []).

common(Out, End) :-
    Right is End * 1.01,
    format(Out, 'set xrange [0:~4f]~n', [Right]),
    format(Out, 'unset key~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set lmargin at screen 0.075; set rmargin at screen 0.985~n\c
set style fill solid noborder~n\c
set format x ""~n', []).

panel_title(Out, Top, Text) :-
    format(Out, 'set label 3 "~w" at screen 0.075,~3f front~n', [Text, Top]).

starts_panel(Out, Result) :-
    format(Out, 'set tmargin at screen 0.865; set bmargin at screen 0.645~n\c
set yrange [0:*]; set ylabel "hosts" offset 0.5,0 tc rgb "#333333"~n', []),
    panel_title(Out, 0.900, 'Executions switched on in each second \c
({/:Italic grey: idle time between two tasks, in seconds})'),
    memberchk(rows(Rows), Result),
    forall(nth1(I, Rows, Row), mark_task(Out, Result, I, Row)),
    format(Out, 'plot "starts.dat" using 1:2:3:4:5:6:7 \c
with boxxyerror lc rgb variable~n', []),
    format(Out, 'unset object~nunset label~n', []).

%   The name of a task above its bars; a grey band where all agents only
%   look on.

mark_task(Out, Result, I, task(Task, First, _, LastEnd, _, Idle)) :-
    task_colour(Result, Task, Colour, _),
    Label is 10 + 2*I,
    format(Out, 'set label ~d "{/:Bold T~w}" at first ~4f,graph 1.04 \c
tc rgb "#~|~`0t~16r~6+"~n', [Label, Task, First, Colour]),
    (   number(Idle),
        Idle > 0
    ->  To is LastEnd + Idle,
        Middle is LastEnd + Idle/2,
        Label1 is Label + 1,
        format(Out, 'set object ~d rect from ~4f,graph 0 to ~4f,graph 1 \c
fc rgb "#ececec" fs solid noborder behind~n', [I, LastEnd, To]),
        format(Out, 'set label ~d "{/*0.8 ~1f}" at first ~4f,graph 0.93 \c
center tc rgb "#666666"~n', [Label1, Idle, Middle])
    ;   true
    ).

hosts_panel(Out, Count) :-
    Top is Count + 0.5,
    format(Out, 'set tmargin at screen 0.590; set bmargin at screen 0.185~n\c
set yrange [~1f:0.5]; set ylabel "host"~n', [Top]),
    panel_title(Out, 0.610, 'Task required by each host \c
(light), and executed (full colour)'),
    format(Out, 'plot "hosts.dat" using 1:2:3:4:5:6:7 \c
with boxxyerror lc rgb variable~n', []).

tau_panel(Out, Result) :-
    memberchk(steps(Steps), Result),
    findall(Tau, member(_-Tau, Steps), Taus),
    max_list([3|Taus], Max),
    Top is Max + 0.4,
    format(Out, 'set tmargin at screen 0.135; set bmargin at screen 0.065~n\c
set yrange [0:~1f]; set ytics 1; set ylabel "{/:Italic τ}"~n\c
set format x "%g"; set xlabel "time (host seconds)" offset 0,0.4~n', [Top]),
    panel_title(Out, 0.155, 'Distinct tasks required in the network'),
    format(Out, 'plot 2 with lines lc rgb "#cccccc", \c
"tau.dat" with steps lw 1.5 lc rgb "#333333"~n', []).
