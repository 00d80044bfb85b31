%   Robots: hosts, each of which drives a brick over a serial line.  The bricks
%   are simulated.  Their arena writes `arena.pl`, its log, and `arena.svg`, an
%   animated picture.
%
%   Time is virtual: the arena advances with the clock of the hosts, so that no
%   robot is late however busy the computer is.  With a number as clock the
%   hosts are in processes of their own, and all time is real.
%
%   Expects of the study that includes this: the parameter `every`, arena
%   seconds from one state of its log to the next.  Gives: the options of the
%   network, and the common predicates of the two studies.

:- use_module('../../prolog/typhon', [network_at/3, remote/2]).
:- use_module('../../prolog/typhon/kernel/base/own_thread', [in_own_thread/1]).
:- use_module(arena,
              [arena_ask/3, arena_start/4, arena_stop/1, scene_file/2]).
:- use_module(crew, [crew_leave/0, crew_services/1]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(readutil), [read_file_to_terms/3]).

text("The bricks are simulated, and move with the clock of the hosts. Their \c
serial lines and telegrams are real. With `--real`, or a clock that is a \c
number, time is real, too: then robots are late if the computer is busy.").

fixed(hop_time, 0.27-0.53, assumed("as in chapter 5")).
fixed(telegram, 0.005, assumed("seconds that a telegram takes in virtual time; \c
a step of the simulation")).
fixed(limit, 450, assumed("host seconds to wait for each step")).

robot_options(Case, [ hop_time(uniform(Min, Max)),
                      hosts([services(Services)]) ]) :-
    Min-Max = Case.hop_time,
    crew_services(Services).

%   in_arena(+Case, +Network, +Scene, :Goal): starts the arena, runs call(Goal,
%   Arena, Bricks), and stops the arena.

in_arena(Case, Network, Scene, Goal) :-
    scene_file(Scene, File),
    directory_file_path(Case.directory, 'arena.pl', Log),
    directory_file_path(Case.directory, 'arena.svg', Picture),
    arena_clock(Case.clock, Case, Clock),
    setup_call_cleanup(
        arena_start(File,
                    [ seed(Case.seed), log(Log), every(Case.every),
                      picture(Picture) | Clock ],
                    Arena, Bricks),
        ( keep_pace(Case.clock, Network, Arena),
          call(Goal, Arena, Bricks) ),
        ( in_own_thread(crew_leave),
          arena_stop(Arena) )).

arena_clock(virtual, Case, [clock(0), telegram(Case.telegram)]) :- !.
arena_clock(Rate, _, [clock(Rate)]).

%   In virtual time the arena advances twenty times in a host second.

keep_pace(virtual, Network, Arena) :-
    !,
    move_on(Network, Arena, 0).
keep_pace(_, _, _).

move_on(Network, Arena, Time) :-
    arena_ask(Arena, 'until ~3f'-[Time], ok),
    Next is Time + 0.05,
    network_at(Network, Next, move_on(Network, Arena, Next)).

%   host_rate(+Case, -Rate): host seconds in a second of agent_join/3.

host_rate(Case, Rate) :-
    ( Case.clock == virtual -> Rate = 1 ; Rate = Case.clock ).

arena_terms(Log, Terms) :-
    directory_file_path(Log.case.directory, 'arena.pl', File),
    read_file_to_terms(File, Terms, [encoding(utf8)]).

%   Both clocks are logged together: the clock of the arena may be behind, if
%   the computer is busy, or ahead by some telegrams.

note_clocks(Arena, Host) :-
    arena_ask(Arena, time, time(Time)),
    remote(Host, log(arena_time(Time))).

about(Case, Seed, Text) :-
    Min-Max = Case.hop_time,
    (   Case.clock == virtual
    ->  Clock = 'virtual time'
    ;   format(atom(Clock), 'host clock ×~w', [Case.clock])
    ),
    format(atom(Text), 'hop ~w–~w s, ~w, seed ~w', [Min, Max, Clock, Seed]).
