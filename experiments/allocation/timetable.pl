:- module(allocation_timetable,
          [ draw_timetable/3,           % +Directory, +Subtitle, +Result
            save_executions/2,          % +Directory, +Runs
            print_sequences/2           % +Stream, +Runs
          ]).
:- use_module('../lib/plot', [colour/2, plot/4, save_columns/2]).
:- use_module('../lib/report', [print_table/3, save_csv/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [max_list/2, member/2, memberchk/2, nth1/3]).

/** <module> Who was allocated to which sequence, and executed it when

Of results of integrated_run/3.

*Threading*: no state; any thread.
*/

%!  draw_timetable(+Directory, +Subtitle, +Result) is det.
%
%   Write Directory/allocation-integrated.svg and .png: a line for each
%   robot, on which it is allocated to a sequence for some time (a pale
%   bar) and executes its tasks (dark bars, a colour for each task).

draw_timetable(Directory, Subtitle, Result) :-
    memberchk(sequences(Sequences), Result),
    robots(Sequences, Robots),
    findall([Middle, Row, Start, End, Low, High, 0xdddddd],
            ( member(sequence(_, Its, times(_, Start, End), _), Sequences),
              member(Robot, Its),
              bar(Robots, Robot, Start, End, 0.4, Middle, Row, Low, High) ),
            Held),
    findall([Middle, Row, Start, End, Low, High, Colour],
            ( member(sequence(_, _, _, Executions), Sequences),
              member(execution(Task, Robot, Start, End), Executions),
              bar(Robots, Robot, Start, End, 0.4, Middle, Row, Low, High),
              Index is (Task - 1) mod 6,
              colour(Index, Colour) ),
            Executed),
    save(Directory, held, Held),
    save(Directory, executed, Executed),
    length(Robots, Count),
    findall(End, member(sequence(_, _, times(_, _, End), _), Sequences),
            Ends),
    max_list([1|Ends], Last),
    plot(Directory, 'allocation-integrated', 1000-600,
         script(Subtitle, Count, Last)).

robots(Sequences, Robots) :-
    findall(Robot,
            ( member(sequence(_, Its, _, _), Sequences),
              member(Robot, Its) ),
            All),
    sort(All, Robots).

bar(Robots, Robot, Start, End, Half, Middle, Row, Low, High) :-
    nth1(Row, Robots, Robot),
    Middle is (Start + End)/2,
    Low is Row - Half,
    High is Row + Half.

save(Directory, Part, Rows) :-
    data_name(Part, Name),
    directory_file_path(Directory, Name, File),
    save_columns(File, Rows).

data_name(Part, Name) :-
    atomic_list_concat(['allocation-integrated-', Part, '.dat'], Name).

script(Subtitle, Count, Last, Out) :-
    Right is Last*1.01,
    Top is Count + 1,
    data_name(held, Held),
    data_name(executed, Executed),
    format(Out, 'set label 1 "{/:Bold=15 ~w}" at screen 0.085,0.955~n\c
set label 2 "{/*0.9 ~w}" at screen 0.085,0.91 tc rgb "#555555"~n\c
set xrange [0:~4f]; set yrange [0:~d]~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set ytics 1; set style fill solid 1.0 noborder; unset key~n\c
set lmargin at screen 0.085; set rmargin at screen 0.975~n\c
set tmargin at screen 0.87~n\c
set xlabel "host seconds" tc rgb "#333333"~n\c
set ylabel "robot" tc rgb "#333333"~n\c
plot "~w" using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable, \c
"~w" using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable~n',
           ['Two sequences of tasks on the robots that were found for them',
            Subtitle, Right, Top, Held, Executed]).

%!  save_executions(+Directory, +Runs) is det.
%
%   Write Directory/allocation-integrated.csv, of all Runs, pairs
%   Seed-Result.

save_executions(Directory, Runs) :-
    findall([Seed, Name, Task, Robot, Start, End],
            ( member(Seed-Result, Runs),
              memberchk(sequences(Sequences), Result),
              member(sequence(Name, _, _, Executions), Sequences),
              member(execution(Task, Robot, Start, End), Executions) ),
            Rows),
    directory_file_path(Directory, 'allocation-integrated.csv', File),
    save_csv(File, [seed, sequence, task, robot, start, end], Rows).

%!  print_sequences(+Stream, +Runs) is det.
%
%   A line for each sequence of each run.

print_sequences(Stream, Runs) :-
    findall([Seed, Name, Robots, Found, First, Completed],
            ( member(Seed-Result, Runs),
              memberchk(sequences(Sequences), Result),
              member(sequence(Name, Its, times(_, Found, Completed),
                              Executions), Sequences),
              length(Its, Robots),
              aggregate_all(min(Start),
                            member(execution(_, _, Start, _), Executions),
                            First) ),
            Rows),
    print_table(Stream, [ seed, sequence, robots, 'allocated at',
                          'first task at', 'completed at' ], Rows).
