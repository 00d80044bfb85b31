:- module(learning_pictures,
          [ draw_learning/4             % +Figure, +Directory, +Options,
                                        % +CaseRuns
          ]).
:- use_module('../../prolog/typhon', [log_events/2]).
:- use_module('../lib/chart', [draw_chart/3]).
:- use_module('../lib/plot', [colour/2]).
:- use_module(cases, [case_agents/2, figure/2]).
:- use_module(maze, [maze_path/3]).
:- use_module(mazes, [moves_panel/4, paths_panel/3]).
:- use_module(metrics,
              [bins/4, executions/2, overlap/2, sharing/2, slope/3]).
:- use_module(sheet, [draw_sheet/4]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists),
              [list_to_set/2, member/2, memberchk/2, nth0/3, nth1/3]).
:- use_module(library(option), [option/2]).

/** <module> The pictures of thesis chapter 4

*Threading*: any thread; no state.
*/

%!  draw_learning(+Figure, +Directory, +Options, +CaseRuns) is det.
%
%   Write Directory/figure-Figure.svg and .png, and their data.  CaseRuns
%   are pairs Case-Runs; Runs are terms run(Directory, Result).  Figures of
%   one run show the first one.

draw_learning(Figure, Directory, Options, CaseRuns) :-
    make_directory_path(Directory),
    figure(Figure, Text),
    atom_concat('figure-', Figure, Name),
    format(atom(Title), 'Figure ~w: ~w', [Figure, Text]),
    draw(Figure, Directory, Name, Title, Options, CaseRuns).

draw('4.7', Directory, Name, Title, Options, CaseRuns) :-
    first_run(Options, Subtitle),
    findall(Panel,
            ( nth0(I, CaseRuns, Case-[run(_, Result)|_]),
              paths_title(I, Case, Result, Text),
              paths_panel(Text, Result, Panel) ),
            Panels),
    draw_sheet(Directory, Name,
               [title(Title), subtitle(Subtitle), box(560-560)], Panels).
draw('4.8', Directory, Name, Title, Options, CaseRuns) :-
    first_run(Options, Subtitle),
    findall(panel(Text, Settings, Layers),
            ( nth0(I, CaseRuns, Case-[run(_, Result)|_]),
              lengths_title(I, Case, Result, Text),
              lengths_settings(CaseRuns, Settings),
              findall(Layer, lengths_layer(Result, Layer), Layers) ),
            Panels),
    draw_sheet(Directory, Name,
               [title(Title), subtitle(Subtitle), box(560-420)], Panels).
draw('4.11', Directory, Name, Title, Options, CaseRuns) :-
    first_run(Options, Subtitle),
    findall(Panel,
            ( nth0(I, CaseRuns, Case-[run(Run, Result)|_]),
              paths_title(I, Case, Result, Text),
              tried(Run, Tried),
              moves_panel(Text, Result, Tried, Panel) ),
            Panels),
    draw_sheet(Directory, Name,
               [title(Title), subtitle(Subtitle), box(560-560)], Panels).
draw('4.12', Directory, Name, Title, Options, [_-[run(_, Result)|_]]) :-
    first_run(Options, Subtitle),
    sharing_panel(Result, Panel),
    draw_sheet(Directory, Name,
               [title(Title), subtitle(Subtitle), box(900-380)], [Panel]).
draw(Figure, Directory, Name, Title, Options, CaseRuns) :-
    chart(Figure, Measures),
    option(runs(Runs), Options),
    how(Options, How),
    format(atom(Subtitle), 'runs of each: ~d, small dots; ~w',
           [Runs, How]),
    maplist(panel(CaseRuns), Measures, Panels),
    draw_chart(Directory, Name,
               [ title(Title), subtitle(Subtitle),
                 x('agents by hosts, D'), panels(Panels) ]).

first_run(Options, Subtitle) :-
    option(seed(Seed), Options),
    how(Options, How),
    format(atom(Subtitle), 'seed ~w; ~w', [Seed, How]).

how(Options, How) :-
    option(hop_time(HopTime), Options),
    option(clock(Clock), Options),
    (   HopTime == none
    ->  Hops = 'hops as fast as they are'
    ;   HopTime = Min-Max,
        format(atom(Hops), 'hop ~w–~w s', [Min, Max])
    ),
    clock_text(Clock, Text),
    format(atom(How), '~w, host clock ~w', [Hops, Text]).

clock_text(pace(Stays, Most), Text) :-
    !,
    format(atom(Text), '×~w by the number of agents, at most ×~w',
           [Stays, Most]).
clock_text(Rate, Text) :-
    format(atom(Text), '×~w', [Rate]).

kind_text(alone, 'without sharing').
kind_text(sharing, 'with sharing').
kind_text(obstacle, 'with an obstacle').
kind_text(dynamic, 'dynamic').

                /*******************************
                *             MAZES            *
                *******************************/

letter(I, Letter) :-
    Code is 0'a + I,
    char_code(Letter, Code).

paths_title(I, Case, Result, Text) :-
    letter(I, Letter),
    Case = case(Kind, N, _),
    kind_text(Kind, What),
    case_agents(Case, Agents),
    memberchk(settings(Settings), Result),
    memberchk(learners(Learners), Result),
    findall(Cells,
            ( member(learner(_, _, converged(_, _, Actions)), Learners),
              maze_path(Settings, Actions, Cells) ),
            Paths),
    overlap(Paths, Overlap),
    format(atom(Text), '{/:Bold ~w}  ~w: ~d agents, ~d hosts; overlap ~2f',
           [Letter, What, Agents, N, Overlap]).

%   tried(+Directory, -Tried): as the trainers have told.  Agents are
%   numbered as in the result, by their first execution.

tried(Directory, Tried) :-
    directory_file_path(Directory, 'events.pl', File),
    log_events(File, Events),
    findall(Agent, member(event(_, _, Agent, executed(1, _, _, _)), Events),
            Agents),
    findall(Index-Actions,
            ( member(event(_, _, _, tried(Agent, Actions)), Events),
              nth0(Index, Agents, Agent) ),
            Tried).

                /*******************************
                *             LINES            *
                *******************************/

lengths_title(I, case(Kind, _, _), Result, Text) :-
    letter(I, Letter),
    kind_text(Kind, What),
    executions([Result], Mean),
    format(atom(Text), '{/:Bold ~w}  ~w: ~1f executions per agent',
           [Letter, What, Mean]).

%   The same axes for all, so that they can be compared.

lengths_settings(CaseRuns,
                 [ 'unset key; set grid ytics lc rgb "#e4e4e4" lt 1 lw 1',
                   'set xlabel "executions"',
                   'set ylabel "actions" offset 1,0', Range ]) :-
    findall(Learner,
            ( member(_-[run(_, Result)|_], CaseRuns),
              memberchk(learners(Learners), Result),
              member(Learner, Learners) ),
            All),
    findall(Point,
            ( member(Learner, All), learner_rows(Learner, Rows, Ends),
              ( member(Point, Rows) ; member(Point, Ends) ) ),
            Points),
    foldl(wider, Points, [1, 1], [X, Y]),
    format(atom(Range), 'set xrange [0:~w]; set yrange [0:~w]', [X, Y]).

wider([X, Y], [X0, Y0], [X1, Y1]) :-
    X1 is max(X, X0),
    Y1 is max(Y, Y0).

learner_rows(learner(Lengths, _, End), Rows, Ends) :-
    findall([I, Length], nth1(I, Lengths, Length), Rows),
    (   End = converged(_, _, Actions)
    ->  length(Lengths, Count),
        length(Actions, Final),
        Ends = [[Count, Final]]
    ;   Ends = []
    ).

lengths_layer(Result, layer(Some, Style)) :-
    memberchk(learners(Learners), Result),
    nth0(Index, Learners, Learner),
    learner_rows(Learner, Rows, Ends),
    I is Index mod 6,
    colour(I, Colour),
    (   Some = Rows,
        With = 'lines lw 1.6'
    ;   Some = Ends,
        With = 'points pt 6 ps 1.6 lw 2'
    ),
    format(atom(Style), 'using 1:2 with ~w lc rgb "#~|~`0t~16r~6+"',
           [With, Colour]).

                /*******************************
                *             TIME             *
                *******************************/

sharing_panel(Result, panel(Text, Settings, [layer(Bars, BarStyle),
                                             layer(Trend, TrendStyle)])) :-
    memberchk(learners(Learners), Result),
    memberchk(duration(End), Result),
    findall(T, ( member(learner(_, Times, _), Learners), member(T, Times) ),
            All),
    bins(All, End, 30, Points),
    findall([X, Y], member(X-Y, Points), Bars),
    trend(Points, End, Trend),
    length(Learners, Agents),
    memberchk(nodes(N), Result),
    Seconds is End/30,
    format(atom(Text), '~d agents, ~d hosts; events in ~0f s each, and \c
their linear trend', [Agents, N, Seconds]),
    format(atom(Range), 'set xrange [0:~w]; set yrange [0:*]', [End]),
    Settings = [ 'unset key; set grid ytics lc rgb "#e4e4e4" lt 1 lw 1',
                 'set xlabel "host seconds"',
                 'set ylabel "sharing events" offset 1,0',
                 Range ],
    Width is Seconds*0.85,
    colour(0, Blue),
    colour(1, Red),
    format(atom(BarStyle), 'using 1:2:(~4f) with boxes fill solid 0.6 \c
noborder lc rgb "#~|~`0t~16r~6+"', [Width, Blue]),
    format(atom(TrendStyle), 'using 1:2 with lines lw 2.5 \c
lc rgb "#~|~`0t~16r~6+"', [Red]).

trend(Points, End, Rows) :-
    (   slope(Points, Slope, Level)
    ->  Y is max(0, Level + Slope*End),
        Rows = [[0, Level], [End, Y]]
    ;   Rows = []
    ).

                /*******************************
                *            CHARTS            *
                *******************************/

chart('4.9', [executions]).
chart('4.10', [sharing]).
chart('4.13', [executions, sharing]).

panel(CaseRuns, Measure, panel(Title, YLabel, Series)) :-
    measure(Measure, Title, YLabel),
    findall(Kind-N, member(case(Kind, N, _)-_, CaseRuns), Keys0),
    list_to_set(Keys0, Keys),
    findall(series(Label, I, Points, none),
            ( nth0(I, Keys, Kind-N),
              series_label(Kind, N, Label),
              findall(X-at(Mean, Values),
                      ( member(case(Kind, N, D)-Runs, CaseRuns),
                        X is D/10,
                        middle(Measure, Runs, Mean, Values) ),
                      Points) ),
            Series).

measure(executions, 'Executions per agent until all have converged (line: \c
mean)', executions).
measure(sharing, 'Sharing events per execution (line: ratio of averages)',
        events).

%   Short ones, so that all are in one line.

series_label(obstacle, _, obstacle) :-
    !.
series_label(_, N, Label) :-
    format(atom(Label), '~d hosts', [N]).

middle(Measure, Runs, Mean, Values) :-
    findall(Result, member(run(_, Result), Runs), Results),
    call(Measure, Results, Mean),
    maplist(single(Measure), Results, Values).

single(Measure, Result, Value) :-
    call(Measure, [Result], Value).
