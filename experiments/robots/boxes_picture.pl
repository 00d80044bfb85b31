:- module(robots_boxes_picture,
          [ draw_boxes/4                % +Directory, +Name, +Subtitle,
                                        % +Result
          ]).
:- use_module('../lib/plot',
              [colour/2, lighten/2, plot/4, save_columns/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth0/3, nth1/3]).

/** <module> Who did what when: the timeline of robots and boxes

A row for each robot: pale while it is reserved, in full colour while it
executes the job of that colour.  Below it a row for each box: from when
its allocator is released until the box has been pushed and its robots are
back; grey while the allocator rests.

*Threading*: no state; any thread.
*/

%!  draw_boxes(+Directory, +Name, +Subtitle, +Result) is det.
%
%   Write Directory/Name.svg and .png, and their data.  Result is a list of
%   hosts(List), holdings(List), jobs(List), joined(List), as of
%   robots_boxes_metrics, and end(Time).

draw_boxes(Directory, Name, Subtitle, Result) :-
    save(Directory, 'robots.dat', robot_row(Result)),
    save(Directory, 'jobs.dat', job_row(Result)),
    plot(Directory, Name, 1200-760, script(Subtitle, Result)).

:- meta_predicate save(+, +, 1).

save(Directory, Name, Row) :-
    findall(Columns, call(Row, Columns), Rows),
    directory_file_path(Directory, Name, File),
    save_columns(File, Rows).

                /*******************************
                *             DATA             *
                *******************************/

%   Rows: middle, row, left, right, low, high, colour.  What is drawn later
%   covers what was drawn before.

robot_row(Result, Row) :-
    memberchk(joined(Joined), Result),
    memberchk(end(End), Result),
    member(Robot-Time, Joined),
    number_of(Result, Robot, I),
    bar(I, Time, End, 0.08, 0xbbbbbb, Row).
robot_row(Result, Row) :-
    holding(Result, I, From, _, To, Colour),
    lighten(Colour, Light),
    bar(I, From, To, 0.4, Light, Row).
robot_row(Result, Row) :-
    holding(Result, I, _, Start, To, Colour),
    number(Start),
    bar(I, Start, To, 0.4, Colour, Row).

holding(Result, I, From, Start, To, Colour) :-
    memberchk(holdings(Holdings), Result),
    memberchk(end(End), Result),
    member(holding(Robot, Task, From, Start, To0), Holdings),
    until(To0, End, To),
    number_of(Result, Robot, I),
    job_colour(Result, Task, Colour).

number_of(Result, Robot, I) :-
    memberchk(hosts(Hosts), Result),
    nth1(I, Hosts, Robot),
    !.

until(none, End, End) :-
    !.
until(To, _, To).

job_row(Result, Row) :-
    memberchk(jobs(Jobs), Result),
    memberchk(end(End), Result),
    nth1(I, Jobs, job(Task, Begun, Allocated, Completed0, _, Rests)),
    until(Completed0, End, Completed),
    job_colour(Result, Task, Colour),
    (   lighten(Colour, Light),
        until(Allocated, Completed, To),
        bar(I, Begun, To, 0.4, Light, Row)
    ;   number(Allocated),
        bar(I, Allocated, Completed, 0.4, Colour, Row)
    ;   member(From-Seconds, Rests),
        To is From + Seconds,
        bar(I, From, To, 0.25, 0x999999, Row)
    ).

bar(I, From, To, Half, Colour,
    [Middle, I, From, To, Low, High, Colour]) :-
    Middle is (From + To)/2,
    Low is I - Half,
    High is I + Half.

job_colour(Result, Task, Colour) :-
    memberchk(jobs(Jobs), Result),
    nth0(I, Jobs, job(Task, _, _, _, _, _)),
    !,
    N is I mod 6,
    colour(N, Colour).

                /*******************************
                *            SCRIPT            *
                *******************************/

script(Subtitle, Result, Out) :-
    memberchk(end(End), Result),
    memberchk(hosts(Hosts), Result),
    memberchk(jobs(Jobs), Result),
    Right is End * 1.01,
    format(Out, 'set multiplot~n\c
set label 1 "{/:Bold=16 Robots push boxes}" at screen 0.085,0.962~n\c
set label 2 "~w" at screen 0.085,0.922 tc rgb "#555555"~n\c
set xrange [0:~4f]; unset key~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set lmargin at screen 0.085; set rmargin at screen 0.985~n\c
set style fill solid noborder; set format x ""~n', [Subtitle, Right]),
    findall(Name, ( member(Host, Hosts), host_name(Host, Name) ), Names),
    panel(Out, 0.84-0.45, 'Robots: reserved (pale), executing (full colour)',
          Names, 'robots.dat'),
    findall(Text, ( member(Job, Jobs), job_text(Job, Text) ), Texts),
    format(Out, 'set format x "%g"; \c
set xlabel "time (host seconds)" offset 0,0.4~n', []),
    panel(Out, 0.36-0.09, 'Allocators: searching (pale), resting (grey), \c
robots executing (full colour)', Texts, 'jobs.dat'),
    format(Out, 'unset multiplot~n', []).

host_name(Host, Name) :-
    sub_atom(Host, Before, _, _, @),
    !,
    sub_atom(Host, 0, Before, _, Name).
host_name(Host, Host).

job_text(job(Task, _, _, _, Robots, _), Text) :-
    length(Robots, Count),
    format(atom(Text), '~w (~d)', [Task, Count]).

panel(Out, Top-Bottom, Title, Names, File) :-
    length(Names, Count),
    Last is Count + 0.6,
    findall(Tick,
            ( nth1(I, Names, Name), format(atom(Tick), '"~w" ~d', [Name, I]) ),
            Ticks),
    atomic_list_concat(Ticks, ', ', Tics),
    Above is Top + 0.025,
    format(Out, 'set tmargin at screen ~3f; set bmargin at screen ~3f~n\c
set label 3 "~w" at screen 0.085,~3f~n\c
set yrange [~1f:0.4]; set ytics (~w)~n\c
plot "~w" using 1:2:3:4:5:6:7 with boxxyerror lc rgb variable~n\c
unset label~n',
           [Top, Bottom, Title, Above, Last, Tics, File]).
