:- module(robots_pole,
          [ pole_figure/2               % +Options, -Claims
          ]).
:- use_module('../lib/report',
              [print_claims/2, print_table/3, save_csv/3]).
:- use_module('../sync/figure', [draw_figure/3]).
:- use_module('../sync/metrics', [idle_time/2, overlaps/2]).
:- use_module(pole_claims, [pole_claims/3]).
:- use_module(pole_metrics, [carried/2, max_tilt/2, mingled/2]).
:- use_module(pole_picture, [draw_pole/4]).
:- use_module(pole_run, [pole_run/4]).
:- use_module(series,
              [ series_directory/4, series_end/2, series_save/3,
                series_seeds/2 ]).
:- use_module(library(apply), [maplist/3, maplist/4]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists),
              [append/2, list_to_set/2, member/2, memberchk/2]).
:- use_module(library(option), [option/2]).

/** <module> Carrying a pole: thesis section 5.7 and Figure 5.14

*Threading*: one at a time; see robots_pole_run.
*/

%!  pole_figure(+Options, -Claims) is det.
%
%   Makes the runs, with and without synchronisation, of all seeds, prints
%   what came of them, and writes tables and pictures.  All of these Options
%   are required: those of pole_run/4, and
%
%     - seed(First), runs(Count): the seeds
%     - out(Directory): it gets a directory `pole`, which has, with several
%       runs, one for each seed.
%
%   Claims is a list of claim(Text, Held, Found), those of all runs.

pole_figure(Options, Claims) :-
    option(out(Out), Options),
    directory_file_path(Out, pole, Directory),
    series_seeds(Options, Seeds),
    how(Options, How),
    format('Carrying a pole: 4 robots, 4 tasks~n~w~n', [How]),
    maplist(seed_run(Options, Directory), Seeds, RowLists, ClaimLists),
    append(RowLists, Rows),
    header(Header),
    nl,
    print_table(user_output, Header, Rows),
    directory_file_path(Directory, 'runs.csv', File),
    save_csv(File, Header, Rows),
    all_claims(ClaimLists, Claims),
    nl,
    print_claims(user_output, Claims),
    series_end(Directory, Claims).

how(Options, How) :-
    option(agents(Agents), Options),
    option(delta(Delta), Options),
    option(hop_time(Min-Max), Options),
    option(clock(Rate), Options),
    format(atom(How),
           '~d agents, δ = ~w, hop ~w–~w s, host clock ×~w',
           [Agents, Delta, Min, Max, Rate]).

%   seed_run(+Options, +Directory, +Seed, -Rows, -Claims)

seed_run(Options0, Directory0, Seed, Rows, Claims) :-
    Options = [seed(Seed)|Options0],
    series_directory(Options, Directory0, Seed, Directory),
    Cases = [synchronised, alone],
    maplist(run(Options, Directory), Cases, Results),
    Results = [Synchronised, Alone],
    pole_claims(Synchronised, Alone, Claims),
    maplist(row(Seed), Results, Rows),
    draw(Options, Directory, Synchronised, Alone),
    series_save(Directory, Options, Claims).

run(Options, Directory, Case, Result) :-
    directory_file_path(Directory, Case, Part),
    pole_run(Case, Options, Part, Result),
    save_executions(Part, Result).

save_executions(Directory, Result) :-
    memberchk(executions(Executions), Result),
    findall([Task, Host, Start, End],
            member(execution(Task, Host, Start, End), Executions), Rows),
    directory_file_path(Directory, 'executions.csv', File),
    save_csv(File, [task, host, start, end], Rows).

draw(Options, Directory, Synchronised, Alone) :-
    how(Options, How0),
    option(seed(Seed), Options),
    format(atom(How), '~w, seed ~w', [How0, Seed]),
    directory_file_path(Directory, synchronised, Part),
    draw_figure(Part, 'figure-5.14',
                [ title('Tasks executed by four robots that carry a pole \c
(Figure 5.14)'), subtitle(How) | Synchronised ]),
    draw_pole(Directory, pole, How,
              [synchronised-Synchronised, alone-Alone]).

                /*******************************
                *            TABLES            *
                *******************************/

header([ seed, case, 'T1', 'T2', 'T3', 'T4', end, idle, early, overlaps,
         tilt, carried ]).

%   When the first robot began each task; `-` if none did.

row(Seed, Result, Row) :-
    memberchk(case(Case), Result),
    memberchk(rows(Rows), Result),
    memberchk(executions(Executions), Result),
    memberchk(states(States), Result),
    memberchk(end(End), Result),
    maplist(begun(Rows), [1, 2, 3, 4], Begun),
    idle_time(Rows, Idle),
    mingled(Executions, Mingled),
    length(Mingled, Early),
    overlaps(Executions, Overlapping),
    length(Overlapping, Overlaps),
    max_tilt(States, Tilt),
    carried(States, Metres),
    append([[Seed, Case], Begun, [End, Idle, Early, Overlaps, Tilt, Metres]],
           Row).

begun(Rows, Task, First) :-
    memberchk(task(Task, First, _, _, _, _), Rows),
    !.
begun(_, _, -).

                /*******************************
                *            CLAIMS            *
                *******************************/

%   all_claims(+Lists, -Claims): of several runs, a claim held if it did so
%   in each.

all_claims([Claims], Claims) :-
    !.
all_claims(Lists, Claims) :-
    append(Lists, All),
    findall(Text, member(claim(Text, _, _), All), Texts0),
    list_to_set(Texts0, Texts),
    maplist(over_runs(All), Texts, Claims).

over_runs(All, Text, claim(Text, Held, Found)) :-
    findall(H, member(claim(Text, H, _), All), Helds),
    findall(F, member(claim(Text, _, F), All), Founds),
    (   memberchk(false, Helds)
    ->  Held = false
    ;   Held = true
    ),
    findall(true, member(true, Helds), Trues),
    length(Trues, Count),
    length(Helds, Runs),
    atomic_list_concat(Founds, '; ', Text1),
    format(atom(Found), 'in ~d of ~d runs: ~w', [Count, Runs, Text1]).
