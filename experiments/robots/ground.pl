%   Robots: hosts in processes of their own, each of which drives a brick over
%   a serial line.  The bricks are simulated, in real time, and so are the
%   runs.  The arena where they are leaves `arena.pl`, its log, and
%   `arena.svg`, a moving picture.
%
%   Expects of the study that includes this: the parameters `processes`, and
%   `every`, arena seconds from one state of its log to the next.  Gives: the
%   options of the network, and what the two worlds have in common.

:- use_module('../../prolog/typhon', [remote/2]).
:- use_module(arena,
              [arena_ask/3, arena_start/4, arena_stop/1, scene_file/2]).
:- use_module(crew, [crew_services/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(readutil), [read_file_to_terms/3]).

text("The robots are simulated in real time: where a computer has much else to \c
do, they are late, and a slower clock helps.").

fixed(clock, 5, assumed("bricks and the way to them take real time; at this \c
rate nobody is late on an idle computer")).
fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(limit, 90, assumed("real seconds to wait for what is to come")).

robot_options(Case, [ hop_time(uniform(Min, Max)),
                      hosts([services(Services)]) ]) :-
    Min-Max = Case.hop_time,
    crew_services(Services).

%   in_arena(+Case, +Scene, :Goal): call(Goal, Arena, Bricks) while the arena
%   is there.

in_arena(Case, Scene, Goal) :-
    scene_file(Scene, File),
    directory_file_path(Case.directory, 'arena.pl', Log),
    directory_file_path(Case.directory, 'arena.svg', Picture),
    setup_call_cleanup(
        arena_start(File,
                    [ clock(Case.clock), seed(Case.seed), log(Log),
                      every(Case.every), picture(Picture) ],
                    Arena, Bricks),
        call(Goal, Arena, Bricks),
        arena_stop(Arena)).

arena_terms(Log, Terms) :-
    directory_file_path(Log.case.directory, 'arena.pl', File),
    read_file_to_terms(File, Terms, [encoding(utf8)]).

%   Both clocks go to the log together: on a busy computer that of the arena
%   falls behind.

note_clocks(Arena, Host) :-
    arena_ask(Arena, time, time(Time)),
    remote(Host, log(arena_time(Time))).

about(Case, Seed, Text) :-
    Min-Max = Case.hop_time,
    format(atom(Text), 'hop ~w–~w s, host clock ×~w, seed ~w',
           [Min, Max, Case.clock, Seed]).
