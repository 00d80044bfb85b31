:- module(study_replays,
          [ replays_save/3              % +Plans, +Options, +Out
          ]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(option), [option/2]).
:- use_module('../../prolog/typhon/tools/page', [page_export/3]).
:- use_module(plan, [planned_seed/2]).
:- use_module(run, [run_again/4]).
:- use_module(studies, [study_title/3]).

/** <module> Replays of runs

The run is repeated for its replay, because other logs have no hops.

*Threading*: the main thread.
*/

:- multifile
    prolog:message//1.

%!  replays_save(+Plans, +Options, +Out) is det.
%
%   With replays(true) in Options, writes replay.html into the directory of the
%   first study of each folder with a network: its first case, with the first
%   seed.  Failures are reported.

replays_save(Plans, Options, Out) :-
    (   option(replays(true), Options),
        once(planned_seed(Options, Seed))
    ->  replays_of(Plans, [], Seed, Out)
    ;   true
    ).

replays_of([], _, _, _).
replays_of([plan(Study, _, [Case|_])|Plans], Done, Seed, Out) :-
    file_directory_name(Study, Folder),
    \+ memberchk(Folder, Done),
    study_title(Study, Name, Title),
    directory_file_path(Out, Name, Directory),
    catch(replay_save(Study, Case, Seed, Title, Directory),
          error(Formal, Context),
          ( print_message(warning,
                          study_replay(Name, error(Formal, Context))),
            fail )),
    !,
    replays_of(Plans, [Folder|Done], Seed, Out).
replays_of([_|Plans], Done, Seed, Out) :-
    replays_of(Plans, Done, Seed, Out).

replay_save(Study, Case, Seed, Title, Directory) :-
    directory_file_path(Directory, 'replay.log', Log),
    directory_file_path(Directory, 'replay.html', Page),
    run_again(Study, Case, Seed, Log),
    page_export(Log, Page, [title(Title), overlays([Study])]),
    delete_file(Log).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(study_replay(Name, error(Formal, Context))) -->
    [ 'No replay of ~w: '-[Name] ],
    '$messages':translate_message(error(Formal, Context)).
