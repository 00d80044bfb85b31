:- module(fire_building,
          [ cell/4,                     % ?Cell, ?Kind, ?Row, ?Column
            door/2,                     % ?Cell, ?Other
            exit/1,                     % ?Cell
            building_new/2,             % +Options, -World
            building_step/4,            % +Ignited, +Guide, +World0, -World
            smoke_in/3,                 % +World, +Cell, -PerMetre
            heat_in/3                   % +World, +Cell, -Kilowatts
          ]).
:- use_module('../drawn', [drawn/3]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [foldl/5]).
:- use_module(library(assoc), [get_assoc/3, list_to_assoc/2]).
:- use_module(library(lists), [append/3, member/2, memberchk/2, sum_list/2]).
:- use_module(library(option), [option/3]).

/** <module> A floor of a building on fire, and the people in it

Forty cells of 5 m: rooms with doors to two corridors, which are joined at both
ends; two exits.  A world is a term; a step of one second computes the next
world.  Units are metres, seconds, kilowatts and grams.

Sources: t-squared fires and their growth (NFPA 72); Thomas' flashover of a
room of 5 x 5 x 3 m with a door, 1.8 MW; a plume entrains 0.071 Qc^(1/3)
z^(5/3) kg/s (Zukoski), here z = 2 m; flaming smoke takes 8.7 m2/g of light
(Mulholland and Croarkin); people see reflecting signs 3/K metres far (Jin),
turn back where that is 3 m, and walk slower in smoke (Frantzich and Nilsson).

Assumptions: air in a cell is mixed; of the fuel, 20 kJ/g, 5 % become soot;
doors are ajar (0.15 m3/s), and corridors exchange 1.25 m3/s; fire passes a
door a minute after flashover, and a corridor has little to burn (500 kW, slow
growth); an exit passes one person in a second; people leave some time after an
alarm, or after they see smoke, but at once where it burns; they do not enter
rooms in search of a way.

*Threading*: pure.
*/

:- dynamic cell/4, door/2.

a_cell(Cell, Kind, Row, Column) :-
    between(1, 5, Row),
    between(1, 8, Column),
    ( corridor(Row, Column) -> Kind = corridor ; Kind = room ),
    format(atom(Cell), 'r~dc~d', [Row, Column]).

corridor(2, _).
corridor(4, _).
corridor(3, 1).
corridor(3, 8).

opening(A, B) :-
    cell(A, corridor, Row, Column),
    (   Right is Column+1,
        cell(B, corridor, Row, Right)
    ;   Below is Row+1,
        cell(B, corridor, Below, Column)
    ).
opening(A, B) :-
    member(Row-Corridor, [1-2, 3-2, 5-4]),
    cell(A, room, Row, Column),
    cell(B, corridor, Corridor, Column).

:- forall(a_cell(Cell, Kind, Row, Column),
          assertz(cell(Cell, Kind, Row, Column))),
   forall(opening(A, B), ( assertz(door(A, B)), assertz(door(B, A)) )),
   compile_predicates([cell/4, door/2]).

exit(r2c1).
exit(r4c8).

%!  building_new(+Options, -World) is det.
%
%   World is world(Time, Smoke, Fires, People): Smoke are pairs Cell-Grams in an
%   assoc, Fires terms fire(Cell, Since, Growth, Most), People terms
%   person(Id, Speed, Delay, State, Visited, Breathed).  Options: seed(S);
%   people(N) in each room, default 3; delay(Least-Most), default 15-75.

building_new(Options, world(0, Smoke, [], People)) :-
    option(seed(Seed), Options, 1),
    option(people(Number), Options, 3),
    option(delay(Least-Most), Options, 15-75),
    findall(Cell-0.0, cell(Cell, _, _, _), Pairs),
    list_to_assoc(Pairs, Smoke),
    findall(person(Cell/N, Speed, Delay, rest(Cell), [Cell], 0.0),
            ( cell(Cell, room, _, _),
              between(1, Number, N),
              drawn(Seed, speed(Cell, N), Fast),
              drawn(Seed, delay(Cell, N), Late),
              Speed is 0.95 + 0.6*Fast,
              Delay is Least + (Most-Least)*Late ),
            People).

%!  building_step(+Ignited:list, +Guide, +World0, -World) is det.
%
%   One second.  Ignited are terms fire(Cell, Growth), kW/s2, for cells that
%   begin to burn now; Guide is guide(Alarms, Signs): the cells with an alarm,
%   and pairs Cell-To for the exit signs.

building_step(Ignited, Guide, World0, world(Time, Smoke, Fires, People)) :-
    World0 = world(Time0, _, Fires0, People0),
    Time is Time0+1,
    findall(fire(Cell, Time, Growth, 2500), member(fire(Cell, Growth), Ignited),
            New),
    append(Fires0, New, Burning),
    spread(Time, Burning, Fires),
    mixed(World0, Smoke),
    Air = world(Time, Smoke, Fires, People0),
    foldl(person_step(Air, Guide), People0, People, [], _).

                /*******************************
                *        FIRE AND SMOKE        *
                *******************************/

%!  heat_in(+World, +Cell, -Kilowatts) is det.
%!  smoke_in(+World, +Cell, -PerMetre) is det.
%
%   The extinction coefficient of the air: 1 per metre leaves 37 % of light
%   after a metre.

heat_in(world(Time, _, Fires, _), Cell, Heat) :-
    (   memberchk(fire(Cell, Since, Growth, Most), Fires)
    ->  Heat is min(Most, Growth*(Time-Since)**2)
    ;   Heat = 0
    ).

smoke_in(world(_, Smoke, _, _), Cell, PerMetre) :-
    density(Smoke, Cell, Density),
    PerMetre is 8.7*Density.

density(Smoke, Cell, Density) :-
    get_assoc(Cell, Smoke, Grams),
    volume(Cell, Volume),
    Density is Grams/Volume.

volume(Cell, Volume) :-
    cell(Cell, Kind, _, _),
    ( Kind == room -> Volume = 75 ; Volume = 37.5 ).

spread(Time, Fires0, Fires) :-
    findall(fire(To, Time, 0.003, 500),
            ( member(fire(From, Since, Growth, 2500), Fires0),
              Time =:= Since + ceiling(sqrt(1800/Growth)) + 60,
              door(From, To),
              \+ memberchk(fire(To, _, _, _), Fires0) ),
            New),
    append(Fires0, New, Fires).

mixed(world(_, Smoke, [], _), Smoke) :-
    !.
mixed(World, Smoke) :-
    findall(Cell-Grams, ( cell(Cell, _, _, _), mixed(World, Cell, Grams) ),
            Pairs),
    list_to_assoc(Pairs, Smoke).

mixed(World, Cell, Grams) :-
    World = world(_, Smoke, _, _),
    heat_in(World, Cell, Heat),
    density(Smoke, Cell, Here),
    findall(Gain,
            ( door(Cell, Other),
              flow(World, Cell, Other, Flow),
              density(Smoke, Other, There),
              Gain is Flow*(There-Here) ),
            Gains),
    get_assoc(Cell, Smoke, Grams0),
    sum_list([Grams0|Gains], Grams1),
    Grams is max(0.0, Grams1 + 0.05*Heat/20).

%   The plume of a fire in either of two cells drives the air through the door.

flow(World, A, B, Flow) :-
    cell(A, KindA, _, _),
    cell(B, KindB, _, _),
    (   KindA == corridor,
        KindB == corridor
    ->  Flow = 1.25
    ;   heat_in(World, A, HeatA),
        heat_in(World, B, HeatB),
        Flow is max(0.15, 0.188*(0.7*max(HeatA, HeatB))**(1/3))
    ).

                /*******************************
                *            PEOPLE            *
                *******************************/

%   States: rest(Cell), leaving(Cell, When), at(Cell), walk(From, To, Metres),
%   out(Time), caught(Time).  Used are the exits taken in this second.

person_step(_, _, Person, Person, Used, Used) :-
    arg(4, Person, State),
    ( State = out(_) ; State = caught(_) ),
    !.
person_step(World, Guide, Person0, Person, Used0, Used) :-
    Person0 = person(Id, Speed, Delay, State0, Seen0, Breathed0),
    World = world(Time, _, _, _),
    place(State0, Cell),
    smoke_in(World, Cell, Smoke),
    Breathed is Breathed0 + Smoke/60,
    Pace is Speed*max(0.1, 1 - 0.057/0.706*Smoke),
    heat_in(World, Cell, Heat),
    (   Heat > 500
    ->  Person = person(Id, Speed, Delay, caught(Time), Seen0, Breathed),
        Used = Used0
    ;   state_step(State0, World, Guide, Delay-Pace, Seen0, State, Used0, Used),
        ( State = walk(_, To, M), M =:= 0 -> Seen = [To|Seen0] ; Seen = Seen0 ),
        Person = person(Id, Speed, Delay, State, Seen, Breathed)
    ).

place(rest(Cell), Cell).
place(leaving(Cell, _), Cell).
place(at(Cell), Cell).
place(walk(From, To, Metres), Cell) :-
    ( Metres < 2.5 -> Cell = From ; Cell = To ).

state_step(State0, World, _, _, _, at(Cell), Used, Used) :-
    ( State0 = rest(Cell) ; State0 = leaving(Cell, _) ),
    heat_in(World, Cell, Heat),
    Heat > 20,
    !.
state_step(rest(Cell), World, guide(Alarms, _), Delay-_, _, State, Used, Used) :-
    World = world(Time, _, _, _),
    smoke_in(World, Cell, Smoke),
    (   ( memberchk(Cell, Alarms) ; Smoke > 0.3 )
    ->  When is Time+Delay,
        State = leaving(Cell, When)
    ;   State = rest(Cell)
    ).
state_step(leaving(Cell, When), world(Time, _, _, _), _, _, _, State, Used,
           Used) :-
    ( Time >= When -> State = at(Cell) ; State = leaving(Cell, When) ).
state_step(walk(From, To, Metres0), _, _, _-Pace, _, State, Used, Used) :-
    Metres is Metres0+Pace,
    ( Metres >= 5 -> State = at(To) ; State = walk(From, To, Metres) ).
state_step(at(Cell), world(Time, _, _, _), _, _, _, State, Used, [Cell|Used]) :-
    exit(Cell),
    \+ memberchk(Cell, Used),
    !,
    State = out(Time).
state_step(at(Cell), World, guide(_, Signs), _, Seen, State, Used, Used) :-
    (   \+ exit(Cell),
        chosen(World, Signs, Seen, Cell, To)
    ->  State = walk(Cell, To, 0)
    ;   State = at(Cell)
    ).

%   People follow a sign, but not a third time to one place, nor into fire, nor
%   from clearer air into smoke in which they see 3 m.  Otherwise they search.

chosen(World, Signs, Seen, Cell, To) :-
    memberchk(Cell-To, Signs),
    passable(World, Cell, To),
    visits(Seen, To, Count),
    Count < 2,
    !.
chosen(World, _, Seen, Cell, To) :-
    findall(Count-Next,
            ( door(Cell, Next),
              cell(Next, corridor, _, _),
              passable(World, Cell, Next),
              visits(Seen, Next, Count) ),
            Found),
    msort(Found, [_-To|_]).

visits(Seen, Cell, Count) :-
    aggregate_all(count, member(Cell, Seen), Count).

passable(World, From, To) :-
    heat_in(World, To, Heat),
    Heat < 100,
    smoke_in(World, From, Here),
    smoke_in(World, To, There),
    There =< max(1, Here).
