:- module(fire_scene,
          [ scene_network/3,            % +Options, -Topology, -NetworkOptions
            scene_step/1,               % -Seconds
            scene_start/2,              % +Network, +Options
            scene_counts/3,             % -Out, -Caught, -Inside
            scene_alarms/1,             % -Text
            scene_picture/1,            % -Svg
            scene_stop/0
          ]).
:- use_module('../../../prolog/typhon',
              [ agent_create/3, agent_send/2, network_at/3,
                remote/2 ]).
:- use_module('../drawn', [drawn/3]).
:- use_module(building).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth0/3]).
:- use_module(library(option), [option/2, option/3]).

/** <module> The building, its hosts, and the connection between them

Each cell is a host.  Once in a second the world advances, leaves
the readings of detectors in the tuple spaces of hosts, and people read signs
and alarms there.  A fire of 500 kW destroys the device in its cell: its agent
sends nothing any more.

Detectors read with a noise of 0.002 per metre.  Assumptions: some detectors
are dead; dust or steam makes others read up to 0.5 per metre more, for half a
minute on average; an alarm without a fire is reset after two minutes.

*Threading*: the world is one fact, replaced in one step; any thread reads it.
A mutex prevents that the scene ends during a step.
*/

:- dynamic
    scene/1,                    % world(Time, Smoke, Fires, People)
    setting/1,                  % Options
    box/2,                      % Cell, Agent
    puff/4,                     % Cell, From, To, PerMetre
    sounding/1.                 % start of an alarm without a fire

%!  scene_network(+Options, -Topology, -NetworkOptions) is det.

scene_network(_, edges(Doors), []) :-
    findall(A-B, ( door(A, B), A @< B ), Doors).

%!  scene_step(-Seconds) is det.

scene_step(1).

%!  scene_start(+Network, +Options) is det.
%
%   Options: seed(S); people(N), delay(Least-Most): see building_new/2;
%   fire(Time), when one of the rooms begins to burn; growth(G), kW/s2, default
%   0.0469, fast; puffs(N): faulty readings of a detector in an hour; dead(P):
%   share of detectors that read nothing; rule(R) and signs(S), see room.pl.

scene_start(Network, Options) :-
    scene_stop,
    building_new(Options, World),
    assertz(setting(Options)),
    assertz(scene(World)),
    puffs_draw(Options),
    forall(cell(Cell, _, _, _), box_make(Cell, Options)),
    forall(box(Cell, Agent), acquaint(Cell, Agent)),
    network_at(Network, 1, fire_scene:pass(Network, 1)).

box_make(Cell, Options) :-
    option(rule(Rule), Options, gossip),
    option(signs(Signs), Options, gradient),
    module_property(fire_scene, file(Here)),
    absolute_file_name(room, Program,
                       [relative_to(Here), extensions([pl]), access(read)]),
    findall(exit, exit(Cell), Exit),
    agent_create(Program, Agent,
                 [ host(Cell), name(Cell),
                   facts([cell(Cell), rule(Rule), signs(Signs)|Exit]) ]),
    assertz(box(Cell, Agent)).

acquaint(Cell, Agent) :-
    findall(Other-Peer, ( door(Cell, Other), box(Other, Peer) ), Peers),
    agent_send(Agent, peers(Peers)).

scene_stop :-
    with_mutex(fire_scene, forget).

forget :-
    maplist(retractall, [ scene(_), setting(_), box(_, _), puff(_, _, _, _),
                          sounding(_) ]).

                /*******************************
                *             TIME             *
                *******************************/

:- public pass/2.               % called by network_at/3

pass(Network, Time) :-
    with_mutex(fire_scene, passed(Network, Time)).

passed(_, _) :-
    \+ scene(_),
    !.
passed(Network, Time) :-
    scene(World0),
    setting(Options),
    ignited(Time, Options, Ignited),
    guide(Guide),
    building_step(Ignited, Guide, World0, World),
    transaction(( retractall(scene(_)), assertz(scene(World)) )),
    forall(cell(Cell, _, _, _), detect(World, Options, Cell)),
    log_changes(World0, World),
    reset(World, Guide),
    Next is Time+1,
    network_at(Network, Next, fire_scene:pass(Network, Next)).

ignited(Time, Options, [fire(Cell, Growth)]) :-
    option(fire(Time), Options),
    !,
    option(seed(Seed), Options, 1),
    findall(Room, cell(Room, room, _, _), Rooms),
    length(Rooms, Count),
    drawn(Seed, room, Where),
    N is truncate(Where*Count),
    nth0(N, Rooms, Cell),
    option(growth(Growth), Options, 0.0469),
    remote(Cell, log(fire(Cell, Growth))).
ignited(_, _, []).

guide(guide(Alarms, Signs)) :-
    findall(Cell, ( box(Cell, _), remote(Cell, sense(alarm)) ), Alarms),
    findall(Cell-To, ( box(Cell, _), remote(Cell, sense(sign(To))) ), Signs).

%   log_change(+World0, +World): people that got out, or were caught by the
%   fire.

log_changes(world(_, _, _, People0), world(_, _, _, People)) :-
    maplist(log_change, People0, People).

log_change(person(Id, _, _, State0, _, _),
           person(Id, _, _, State, [Cell|_], Breathed)) :-
    (   State0 \== State,
        memberchk(State, [out(_), caught(_)])
    ->  functor(State, What, 1),
        Event =.. [What, Id, Breathed],
        remote(Cell, log(Event))
    ;   true
    ).

%   An alarm without a fire is reset.

reset(world(Time, _, [], _), guide([_|_], _)) :-
    !,
    (   sounding(Since)
    ->  true
    ;   Since = Time,
        assertz(sounding(Time))
    ),
    (   Time-Since >= 120
    ->  retractall(sounding(_)),
        forall(box(_, Agent), agent_send(Agent, reset))
    ;   true
    ).
reset(_, _).

                /*******************************
                *          DETECTORS           *
                *******************************/

%   puffs_draw(+Options): draws for each half minute of two hours whether a
%   detector misreads; the duration is exponentially distributed with a mean of
%   half a minute.

puffs_draw(Options) :-
    option(seed(Seed), Options, 1),
    option(puffs(Hourly), Options, 0),
    forall(( Hourly > 0,
             cell(Cell, _, _, _),
             between(0, 239, N),
             drawn(Seed, puff(Cell, N), Chance),
             Chance < Hourly/120 ),
           ( drawn(Seed, puff_length(Cell, N), Length),
             drawn(Seed, puff_height(Cell, N), Height),
             From is 30*N,
             To is From - 30*log(Length),
             More is 0.05 + 0.45*Height,
             assertz(puff(Cell, From, To, More)) )).

detect(World, _, Cell) :-
    heat_in(World, Cell, Heat),
    Heat > 500,
    !,
    ( retract(box(Cell, Agent)) -> agent_send(Agent, burnt) ; true ).
detect(World, Options, Cell) :-
    World = world(Time, _, _, _),
    option(seed(Seed), Options, 1),
    option(dead(Share), Options, 0),
    drawn(Seed, dead(Cell), Fate),
    (   Fate < Share
    ->  Reading = 0
    ;   smoke_in(World, Cell, Smoke),
        drawn(Seed, noise(Cell, Time), Noise),
        puffs_at(Cell, Time, More),
        Reading is max(0, Smoke + 0.008*(Noise-0.5) + More)
    ),
    remote(Cell, ( ignore(take(smoke(_))), leave(smoke(Reading)) )).

puffs_at(Cell, Time, More) :-
    aggregate_all(sum(M), ( puff(Cell, From, To, M), From =< Time, Time < To ),
                  More).

                /*******************************
                *            PICTURE           *
                *******************************/

%!  scene_counts(-Out, -Caught, -Inside) is semidet.

scene_counts(Out, Caught, Inside) :-
    scene(world(_, _, _, People)),
    count(People, out(_), Out),
    count(People, caught(_), Caught),
    length(People, All),
    Inside is All-Out-Caught.

count(People, State, Count) :-
    aggregate_all(count, member(person(_, _, _, State, _, _), People), Count).

%!  scene_alarms(-Text) is det.

scene_alarms(Text) :-
    guide(guide(Alarms, _)),
    ( Alarms == [] -> Text = 'no alarm' ; Text = alarm ).

%!  scene_picture(-Svg) is det.
%
%   Svg shows the floor: smoke is dark, fire red, alarms have a red frame, signs
%   are arrows, people dots.

scene_picture(Svg) :-
    scene(World),
    guide(guide(Alarms, Signs)),
    with_output_to(string(Svg), draw(World, Alarms, Signs)).

draw(World, Alarms, Signs) :-
    World = world(Time, _, _, People),
    format('<svg xmlns="http://www.w3.org/2000/svg" viewBox="-10 -24 820 550" \c
            font-family="sans-serif"><text y="-6">~d s</text>', [Time]),
    forall(cell(Cell, _, _, _), draw_cell(World, Alarms, Cell)),
    forall(member(Cell-To, Signs), draw_sign(Cell, To)),
    forall(nth0(N, People, person(_, _, _, State, _, _)), draw_person(N, State)),
    format('</svg>').

draw_cell(World, Alarms, Cell) :-
    corner(Cell, X, Y),
    cell(Cell, Kind, _, _),
    smoke_in(World, Cell, Smoke),
    heat_in(World, Cell, Heat),
    ( Kind == corridor -> Clear = 100 ; Clear = 92 ),
    Light is Clear - round(70*(1-exp(-Smoke))),
    ( Heat > 0 -> Red is min(1, 0.3+Heat/2000) ; Red = 0 ),
    ( memberchk(Cell, Alarms) -> Frame = '#c00' ; Frame = '#999' ),
    ( exit(Cell) -> Name = exit ; Name = Cell ),
    format('<rect x="~w" y="~w" width="96" height="96" fill="hsl(0,0%,~w%)" \c
            stroke="~w" stroke-width="2"/>', [X, Y, Light, Frame]),
    format('<rect x="~w" y="~w" width="96" height="96" fill="#e30" \c
            opacity="~2f"/>', [X, Y, Red]),
    format('<text x="~w" y="~w" font-size="11" dx="4" dy="14" \c
            fill="#36c">~w</text>', [X, Y, Name]).

corner(Cell, X, Y) :-
    cell(Cell, _, Row, Column),
    X is 100*(Column-1),
    Y is 100*(Row-1).

draw_sign(Cell, To) :-
    corner(Cell, X, Y),
    (   corner(To, X1, Y1)
    ->  Turn is round(atan2(Y1-Y, X1-X)*180/pi),
        format('<path d="M-12,0 H8 M2,-6 L10,0 L2,6" fill="none" stroke="#082" \c
                stroke-width="4" transform="translate(~w,~w) translate(48,80) \c
                rotate(~w)"/>', [X, Y, Turn])
    ;   format('<text x="~w" y="~w" dx="32" dy="88" fill="#082" \c
                font-size="14">~w</text>', [X, Y, To])
    ).

draw_person(N, State) :-
    (   place_of(State, X, Y)
    ->  Cx is X+16+16*(N mod 5),
        Cy is Y+30+14*(N mod 3),
        format('<circle cx="~1f" cy="~1f" r="5" fill="#25c"/>', [Cx, Cy])
    ;   true
    ).

place_of(walk(From, To, Metres), X, Y) :-
    corner(From, X0, Y0),
    corner(To, X1, Y1),
    X is X0 + (X1-X0)*Metres/5,
    Y is Y0 + (Y1-Y0)*Metres/5.
place_of(State, X, Y) :-
    State =.. [Name, Cell|_],
    memberchk(Name, [rest, leaving, at]),
    corner(Cell, X, Y).
