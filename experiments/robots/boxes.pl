:- module(robots_boxes,
          [ boxes_figure/2,             % +Options, -Claims
            boxes_result/2              % +Run, -Result
          ]).
:- use_module('../../agents/allocation/reservations', [reservation_faults/2]).
:- use_module('../allocation/metrics', [from_first/2]).
:- use_module('../lib/report',
              [print_claims/2, print_table/3, save_csv/3]).
:- use_module(boxes_claims, [boxes_claims/3]).
:- use_module(boxes_metrics,
              [from_dock/2, holdings/2, jobs/2, joined/2, pushed/2]).
:- use_module(boxes_picture, [draw_boxes/4]).
:- use_module(boxes_run, [boxes_run/4]).
:- use_module(boxes_script, [thesis_script/1]).
:- use_module(series,
              [ series_directory/4, series_end/2, series_save/3,
                series_seeds/2 ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(lists),
              [append/2, last/2, member/2, memberchk/2, sum_list/2]).
:- use_module(library(option), [option/2]).

/** <module> Pushing boxes: thesis section 7.7

*Threading*: one at a time; see robots_boxes_run.
*/

:- multifile
    prolog:error_message//1.

%!  boxes_figure(+Options, -Claims) is det.
%
%   Plays the script of the thesis with each seed, prints what came of it,
%   and writes logs, tables, the timeline boxes.svg and .png, and the moving
%   picture arena.svg.  All of these Options are required: those of
%   boxes_run/4, and
%
%     - seed(First), runs(Count): the seeds
%     - out(Directory): it gets a directory `boxes`, which has, with several
%       runs, one for each seed.
%
%   Claims is a list of claim(Text, Held, Found), those of all runs.
%
%   @error robot_reservations(Faults) if a robot was reserved by two tasks at
%   a time, or is left reserved

boxes_figure(Options, Claims) :-
    option(out(Out), Options),
    directory_file_path(Out, boxes, Directory),
    thesis_script(Script),
    how(Options, How),
    format('Pushing boxes: up to 7 robots, 6 boxes~n~w~n', [How]),
    flush_output,
    series_seeds(Options, Seeds),
    findall(Some,
            ( member(Seed, Seeds),
              series_directory(Options, Directory, Seed, Part),
              seed_run(Script, [seed(Seed)|Options], Part, Some) ),
            Lists),
    append(Lists, Claims),
    series_end(Directory, Claims).

how(Options, How) :-
    option(hop_time(Min-Max), Options),
    option(clock(Rate), Options),
    format(atom(How), 'hop ~w–~w s, host clock ×~w', [Min, Max, Rate]).

seed_run(Script, Options, Directory, Claims) :-
    make_directory_path(Directory),
    boxes_run(Script, Options, Directory, Run),
    boxes_result(Run, Result),
    boxes_claims(Script, Result, Claims),
    table(Result, Header, Rows),
    nl,
    print_table(user_output, Header, Rows),
    memberchk(wall(Wall), Result),
    format('~1f real seconds~n~n', [Wall]),
    print_claims(user_output, Claims),
    save(Directory, Options, Result, Header-Rows, Claims),
    how(Options, How),
    option(seed(Seed), Options),
    format(atom(Subtitle), '~w, seed ~w', [How, Seed]),
    draw_boxes(Directory, boxes, Subtitle, Result).

save(Directory, Options, Result, Header-Rows, Claims) :-
    directory_file_path(Directory, 'jobs.csv', Jobs),
    save_csv(Jobs, Header, Rows),
    memberchk(holdings(Holdings), Result),
    findall([Robot, Task, From, Start, To],
            member(holding(Robot, Task, From, Start, To), Holdings), Held),
    directory_file_path(Directory, 'reservations.csv', Reservations),
    save_csv(Reservations, [robot, task, reserved, started, released], Held),
    series_save(Directory, Options, Claims).

                /*******************************
                *            RESULT            *
                *******************************/

%!  boxes_result(+Run, -Result) is det.
%
%   What the logs of a Run say, see boxes_run/4: a list of
%   hosts(List), joined(List), jobs(List), holdings(List), pushed(Boxes),
%   from_dock(Metres), wall(Seconds), end(Time), see robots_boxes_metrics.
%   The time begins when the first allocator begins.
%
%   @error robot_reservations(Faults)

boxes_result(Run,
             [ hosts(Hosts), joined(Joined), jobs(Jobs), holdings(Holdings),
               pushed(Pushed), from_dock(Metres), wall(Wall), end(End) ]) :-
    memberchk(hosts(Hosts), Run),
    memberchk(wall(Wall), Run),
    memberchk(arena(Terms), Run),
    memberchk(events(Events0), Run),
    reservation_faults(Events0, Faults),
    (   Faults == []
    ->  true
    ;   throw(error(robot_reservations(Faults), _))
    ),
    from_first(Events0, Events),
    holdings(Events, Holdings),
    jobs(Events, Jobs),
    joined(Events, Joined),
    pushed(Terms, Pushed),
    from_dock(Terms, Metres),
    last_release(Holdings, End).

last_release(Holdings, End) :-
    findall(To, member(holding(_, _, _, _, To), Holdings), Times0),
    msort([0|Times0], Times),
    last(Times, End).

                /*******************************
                *             TABLE            *
                *******************************/

table(Result, [box, robots, begun, allocated, completed, 'back-offs',
               rested, who], Rows) :-
    memberchk(jobs(Jobs), Result),
    findall([Task, Count, Begun, Allocated, Completed, Backoffs, Rested,
             Who],
            ( member(job(Task, Begun, Allocated, Completed, Robots, Rests),
                     Jobs),
              length(Robots, Count),
              length(Rests, Backoffs),
              findall(Seconds, member(_-Seconds, Rests), Times),
              sum_list(Times, Rested),
              maplist(short, Robots, Names0),
              msort(Names0, Names),
              atomic_list_concat(Names, ' ', Who) ),
            Rows).

short(Host, Name) :-
    atomic_list_concat([Name|_], @, Host).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(robot_reservations(Faults)) -->
    [ 'Robots were reserved twice, or left reserved: ~p'-[Faults] ].
