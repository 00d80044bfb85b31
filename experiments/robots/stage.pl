:- module(robots_stage,
          [ stage/6,                    % +Scene, +Options, +Directory,
                                        % :Goal, -Logs, -Wall
            scene_file/2                % +Scene, -File
          ]).
:- use_module('../../prolog/typhon', [log_events/2]).
:- use_module(arena, [arena_log/2, arena_start/4, arena_stop/1]).
:- use_module(library(filesex),
              [directory_file_path/3, make_directory_path/1]).
:- use_module(library(option), [option/2]).

/** <module> One run of robots in the arena

*Threading*: one run at a time, in the caller's thread.
*/

:- meta_predicate
    stage(+, +, +, 3, -, -).

:- dynamic
    scenes/1.                   % Directory

:- prolog_load_context(directory, Dir),
   directory_file_path(Dir, '../../bridges/nxt/scenes', Scenes),
   retractall(scenes(_)),
   assertz(scenes(Scenes)).

%!  scene_file(+Scene:atom, -File) is det.
%
%   The file of a scene that comes with the bricks.

scene_file(Scene, File) :-
    scenes(Dir),
    file_name_extension(Scene, json, Name),
    directory_file_path(Dir, Name, File).

%!  stage(+Scene, +Options, +Directory, :Goal, -Logs, -Wall) is det.
%
%   Calls Goal(Log, Arena, Bricks) while the arena of Scene is there; Log is
%   the file to which the hosts are to log.  In Directory are afterwards the
%   logs events.pl and arena.pl, and the moving picture arena.svg.  Logs are
%   logs(Events, Terms), what these two have, Wall is how many real seconds it
%   took.  Required Options: clock(Rate) and seed(S), those of the arena, and
%   every(Seconds), see arena_log/2.

stage(Scene, Options, Directory, Goal, logs(Events, Terms), Wall) :-
    make_directory_path(Directory),
    fresh(Directory, 'events.pl', Log),
    fresh(Directory, 'arena.pl', TermLog),
    fresh(Directory, 'arena.svg', Picture),
    get_time(T0),
    setup_call_cleanup(
        start(Scene, Options, TermLog, Picture, Arena, Bricks),
        call(Goal, Log, Arena, Bricks),
        arena_stop(Arena)),
    get_time(T1),
    Wall is T1 - T0,
    log_events(Log, Events),
    arena_log(TermLog, Terms).

fresh(Directory, Name, File) :-
    directory_file_path(Directory, Name, File),
    (   exists_file(File)
    ->  delete_file(File)
    ;   true
    ).

start(Scene, Options, Log, Picture, Arena, Bricks) :-
    scene_file(Scene, File),
    option(seed(Seed), Options),
    option(clock(Rate), Options),
    option(every(Seconds), Options),
    arena_start(File,
                [ clock(Rate), seed(Seed), log(Log), every(Seconds),
                  picture(Picture)
                ], Arena, Bricks).
