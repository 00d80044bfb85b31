:- module(test_fire, []).

% The application with a fire alarm: its world, its agents, its command.

:- use_module('../../examples/applications/fire/building').
:- use_module('../../examples/applications/fire/scene').
:- use_module('../lib/common').
:- use_module('../lib/networks').
:- use_module('../lib/fixtures').
:- use_module(library(assoc), [assoc_to_values/2, list_to_assoc/2]).
:- use_module(library(debug), [assertion/1]).
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module(library(plunit)).
:- use_module(library(sgml), [load_structure/3]).
:- use_module(library(typhon)).

                /*******************************
                *            WORLD             *
                *******************************/

%   after(+Seconds, +Ignited, +Guide, +World0, -World)

after(0, _, _, World, World) :- !.
after(Seconds, Ignited, Guide, World0, World) :-
    building_step(Ignited, Guide, World0, World1),
    Left is Seconds-1,
    after(Left, [], Guide, World1, World).

smoky(Cell, Grams, world(0, Smoke, [fire(r5c8, 0, 0, 500)], People)) :-
    building_new([people(1)], world(0, _, [], People)),
    findall(Other-There,
            ( cell(Other, _, _, _),
              ( Other == Cell -> There = Grams ; There = 0.0 ) ),
            Pairs),
    list_to_assoc(Pairs, Smoke).

:- begin_tests(fire_world).

test(heat_grows_with_the_square_of_time, Heat =:= 0.0469*100**2) :-
    building_new([people(0)], World0),
    after(101, [fire(r1c1, 0.0469)], guide([], []), World0, World),
    heat_in(World, r1c1, Heat).

test(smoke_is_conserved_without_heat) :-
    smoky(r2c4, 10.0, World0),
    after(100, [], guide([], []), World0, world(_, Smoke, _, _)),
    assoc_to_values(Smoke, Grams),
    sum_list(Grams, Sum),
    assertion(abs(Sum-10) < 1.0e-6).

test(smoke_passes_doors) :-
    smoky(r1c4, 10.0, World0),
    after(30, [], guide([], []), World0, World),
    smoke_in(World, r1c4, There),
    smoke_in(World, r2c4, Near),
    smoke_in(World, r4c4, Far),
    assertion(There > Near),
    assertion(Near > Far).

test(without_an_alarm_people_stay, States == [rest]) :-
    building_new([], World0),
    after(100, [], guide([], []), World0, world(_, _, _, People)),
    setof(Name, state(People, Name), States).

test(people_follow_signs) :-
    building_new([people(1)], World0),
    after(100, [], guide([r1c2], [r1c2-r2c2, r2c2-r2c1]), World0,
          world(_, _, _, People)),
    findall(Id, member(person(Id, _, _, out(_), _, _), People), Out),
    assertion(Out == [r1c2/1]).

test(people_leave_a_burning_compartment_at_once) :-
    building_new([people(1), delay(900-900)], World0),
    after(300, [fire(r1c2, 0.0469)], guide([], []), World0,
          world(_, _, _, People)),
    findall(Id, member(person(Id, _, _, caught(_), _, _), People), Caught),
    assertion(\+ memberchk(r1c2/1, Caught)).

state(People, Name) :-
    member(person(_, _, _, State, _, _), People),
    functor(State, Name, _).

:- end_tests(fire_world).

                /*******************************
                *            AGENTS            *
                *******************************/

%   A corridor of three cells, w and e with exits, m between.

:- meta_predicate corridor(+, -, 0).

corridor(Facts, Network, Goal) :-
    with_network(edges([w-m, m-e]),
                 [clock(virtual), seed(1), log('/dev/null')], Network,
        ( project_file('examples/applications/fire/room.pl', Room),
          room(Room, w, [exit|Facts], W),
          room(Room, m, Facts, M),
          room(Room, e, [exit|Facts], E),
          agent_send(W, peers([m-M])),
          agent_send(M, peers([w-W, e-E])),
          agent_send(E, peers([m-M])),
          network_advance(Network, 10),
          once(Goal) )).

room(Room, Cell, Facts, Agent) :-
    agent_create(Room, Agent,
                 [host(Cell), name(Cell), facts([cell(Cell)|Facts])]).

reads(Network, Cell, Smoke) :-
    remote(Cell, ( ignore(take(smoke(_))), leave(smoke(Smoke)) )),
    network_advance(Network, 10).

alarm(Cell) :-
    remote(Cell, sense(alarm)).

sign(Cell, To) :-
    remote(Cell, sense(sign(To))).

:- begin_tests(fire_agents).

test(one_faulty_detector_is_no_alarm) :-
    corridor([rule(gossip), signs(gradient)], Network,
             ( reads(Network, m, 0.3),
               assertion(\+ alarm(m)),
               assertion(sign(w, out)),
               reads(Network, e, 0.02),
               assertion(alarm(m)),
               assertion(alarm(w)) )).

test(single_faulty_detector_alarms_without_verification) :-
    corridor([rule(single), signs(fixed)], Network,
             ( reads(Network, m, 0.3),
               assertion(alarm(w)) )).

test(verification_takes_time) :-
    corridor([rule(verified), signs(fixed)], Network,
             ( reads(Network, m, 0.3),
               assertion(\+ alarm(m)),
               network_advance(Network, 25),
               assertion(alarm(m)) )).

test(signs_lead_away_from_smoke) :-
    corridor([rule(gossip), signs(gradient)], Network,
             ( sign(m, First),
               ( First == w -> Other = e ; Other = w ),
               remote(m, leave(smoke(0.1))),
               reads(Network, First, 0.8),
               assertion(sign(m, Other)) )).

test(signs_lead_away_from_silent_boxes) :-
    corridor([rule(gossip), signs(gradient)], Network,
             ( sign(m, First),
               ( First == w -> Other = e ; Other = w ),
               agent_send(First, burnt),
               network_advance(Network, 20),
               assertion(sign(m, Other)) )).

test(reset) :-
    corridor([rule(single), signs(fixed)], Network,
             ( reads(Network, m, 0.3),
               reads(Network, m, 0),
               forall(member(Cell, [w, m, e]), agent_send(Cell, reset)),
               network_advance(Network, 10),
               assertion(\+ alarm(m)) )).

:- end_tests(fire_agents).

                /*******************************
                *          APPLICATION         *
                *******************************/

:- begin_tests(fire_application).

test(picture, Root == svg) :-
    setup_call_cleanup(
        ( scene_network([], Topology, _),
          network_start(Topology, Network,
                        [clock(virtual), seed(1), log('/dev/null')]) ),
        ( scene_start(Network, [fire(1)]),
          network_advance(Network, 90),
          scene_picture(Svg),
          scene_alarms(Alarms) ),
        ( scene_stop,
          network_stop(Network) )),
    assertion(Alarms == alarm),
    load_structure(string(Svg), [element(Name, _, _)], [dialect(xmlns)]),
    Name = _:Root.

:- end_tests(fire_application).
