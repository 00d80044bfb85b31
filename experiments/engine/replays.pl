:- module(study_replays,
          [ replay_runs/3,              % +Plans, +Options, -Runs
            replays_save/3              % +Plans, +Options, +Out
          ]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(option), [option/2]).
:- use_module('../../prolog/typhon/tools/page', [page_export/3]).
:- use_module(plan, [planned_seed/2, runs_directory/2]).
:- use_module(store, [log_file/2, run_directory/3]).
:- use_module(studies, [study_says/2, study_title/3]).

/** <module> Replays of runs

A run is repeated for its replay, because other logs have no hops.

*Threading*: the main thread.
*/

:- multifile
    prolog:message//1.

%!  replay_runs(+Plans, +Options, -Runs) is det.
%!  replays_save(+Plans, +Options, +Out) is det.
%
%   With replays(true) in Options, Runs are the runs to repeat: of the first study
%   of each folder with a network, its first case with the first seed.  Those that
%   were made are written as replay.html into the directory of the study.

replay_runs(Plans, Options, Runs) :-
    (   option(replays(true), Options),
        once(planned_seed(Options, Seed))
    ->  first_of_folders(Plans, [], Seed, Runs)
    ;   Runs = []
    ).

first_of_folders([], _, _, []).
first_of_folders([plan(Study, _, [Case|_])|Plans], Done, Seed, Runs) :-
    file_directory_name(Study, Folder),
    \+ memberchk(Folder, Done),
    study_says(Study, network/3),
    !,
    Runs = [run(Study, Case, replay(Seed))|More],
    first_of_folders(Plans, [Folder|Done], Seed, More).
first_of_folders([_|Plans], Done, Seed, Runs) :-
    first_of_folders(Plans, Done, Seed, Runs).

replays_save(Plans, Options, Out) :-
    replay_runs(Plans, Options, Runs),
    runs_directory(Options, Root),
    forall(( member(Run, Runs),
             run_directory(Root, Run, Directory),
             log_file(Directory, Log),
             exists_file(Log) ),
           replay_save(Run, Log, Out)).

replay_save(run(Study, _, _), Log, Out) :-
    study_title(Study, Name, Title),
    atomic_list_concat([Out, Name, 'replay.html'], /, Page),
    catch(page_export(Log, Page, [title(Title), overlays([Study])]),
          error(Formal, Context),
          print_message(warning, study_replay(Name, error(Formal, Context)))).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(study_replay(Name, error(Formal, Context))) -->
    [ 'No replay of ~w: '-[Name] ],
    '$messages':translate_message(error(Formal, Context)).
