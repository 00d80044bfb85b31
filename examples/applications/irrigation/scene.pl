:- module(irrigation_scene,
          [ scene_network/3,            % +Options, -Topology, -NetworkOptions
            scene_step/1,               % -Seconds
            scene_start/2,              % +Network, +Options
            scene_totals/2,             % -Days, -Totals
            scene_picture/1,            % -Svg
            scene_stop/0
          ]).
:- use_module('../../../prolog/typhon',
              [ agent_create/3, agent_send/2, link/2, mqtt_start/3,
                network_at/3, remote/2, unlink/2 ]).
:- use_module('../drawn', [drawn/3]).
:- use_module(fields).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, sum_list/2]).
:- use_module(library(option), [option/2, option/3]).

/** <module> Fields, their hosts, and the connection between them

Six fields, each with a host, a moisture sensor and a valve, and the office,
whose links to them break now and then.  Sensors and valves use MQTT: with a
broker the world publishes sensor readings at the office, and receives orders
to valves there; without, facts in the tuple spaces of fields replace MQTT.  A
step is an hour.

Assumption: a link is down for a day on average.

*Threading*: the world is one fact, replaced in one step; any thread reads it.
A mutex prevents that the scene ends during a step.
*/

:- dynamic
    scene/2,                    % Hour, list of Field-Pending, mm to be given
    setting/1.                  % Options

parcel(Number) :-
    between(1, 6, Number).

host(Number, Host) :-
    atom_concat(field, Number, Host).

scene_step(3600).

scene_network(_, edges(Links), []) :-
    findall(office-Host, ( parcel(Number), host(Number, Host) ), Links).

%!  scene_start(+Network, +Options) is det.
%
%   Options: seed(S); strategy(S), as in gardener.pl; down(P), the share of
%   time in which a link is down, default 0.3, with 0 links do not change;
%   broker(URL), default none.

scene_start(Network, Options) :-
    scene_stop,
    option(seed(Seed), Options, 1),
    findall(Field-0, ( parcel(Number), field_new(Seed, Number, Field) ), Fields),
    assertz(setting(Options)),
    assertz(scene(0, Fields)),
    option(broker(Broker), Options, none),
    wires(Broker),
    option(strategy(Strategy), Options, carried),
    forall(member(Field-_, Fields),
           ( gardener(Strategy, Field),
             link_begins(Seed, Options, Field) )),
    network_at(Network, 3600, irrigation_scene:pass(Network, 1)).

wires(none) :-
    !,
    forall(( parcel(Number), host(Number, Host) ),
           remote(Host, ( assertz(subscribe(_, _)),
                          assertz((publish(Topic, Payload) :-
                                       leave(published(Topic, Payload)))) ))).
wires(URL) :-
    forall(( Host = office ; parcel(Number), host(Number, Host) ),
           mqtt_start(Host, URL, [])),
    remote(office, subscribe('field/+/valve', [as(fact)])).

file(Name, File) :-
    module_property(irrigation_scene, file(Here)),
    absolute_file_name(Name, File,
                       [relative_to(Here), extensions([pl]), access(read)]).

gardener(Strategy, Field) :-
    Field = field(Number, _, _, _),
    host(Number, Host),
    remote(office, here(Office)),
    remote(Host, here(Address)),
    field_map(Field, Map),
    file(gardener, Program),
    agent_create(Program, Agent,
                 [ host(office),
                   facts([field(Address, Number), Map, strategy(Strategy)]) ]),
    (   Strategy == central
    ->  file(gateway, Gate),
        agent_create(Gate, Gateway,
                     [ host(Host),
                       facts([field(Address, Number), centre(Office, Agent)]) ]),
        agent_send(Agent, gateway(Gateway))
    ;   true
    ).

scene_stop :-
    with_mutex(irrigation_scene, forget).

forget :-
    maplist(retractall, [scene(_, _), setting(_)]).

                /*******************************
                *             TIME             *
                *******************************/

:- public pass/2.               % called by network_at/3

pass(Network, Hour) :-
    with_mutex(irrigation_scene, passed(Network, Hour)).

passed(_, _) :-
    \+ scene(_, _),
    !.
passed(Network, Hour) :-
    scene(_, Fields0),
    setting(Options),
    option(seed(Seed), Options, 1),
    weather(Seed, Hour, Evaporation, Rain),
    maplist(field_passed(Evaporation-Rain, Options), Fields0, Fields),
    transaction(( retractall(scene(_, _)), assertz(scene(Hour, Fields)) )),
    forall(member(Field-_, Fields),
           ( reading(Seed, Hour, Evaporation-Rain, Field, Reading),
             send_reading(Options, Field, Reading),
             link_passed(Seed, Options, Hour, Field) )),
    Next is Hour+1,
    Time is 3600*Next,
    network_at(Network, Time, irrigation_scene:pass(Network, Next)).

field_passed(Weather, Options, Field0-Pending0, Field-Pending) :-
    arg(1, Field0, Number),
    orders(Options, Number, Orders),
    sum_list([Pending0|Orders], Due),
    Opened is min(5, Due),
    Pending is Due-Opened,
    field_hour(Weather, Opened, Field0, Field).

reading(Seed, Hour, Evaporation-Rain, Field, Reading) :-
    Field = field(Number, Soil, _, _),
    field_moisture(Field, Share),
    arg(6, Soil, Bias),
    drawn(Seed, noise(Number, Hour), U),
    Moisture is Share + Bias + 0.034*(U-0.5),           % deviation 0.01
    Reading = _{hour:Hour, moisture:Moisture, et0:Evaporation, rain:Rain}.

link_begins(Seed, Options, field(Number, _, _, _)) :-
    option(down(Share), Options, 0.3),
    drawn(Seed, link(Number, 0), U),
    (   U < Share
    ->  host(Number, Host),
        unlink(office, Host)
    ;   true
    ).

link_passed(Seed, Options, Hour, field(Number, _, _, _)) :-
    option(down(Share), Options, 0.3),
    host(Number, Host),
    drawn(Seed, link(Number, Hour), U),
    remote(Host, neighbours(Links)),
    (   Share =:= 0
    ->  true
    ;   Links == [],
        U < 1/24
    ->  link(office, Host)
    ;   Links = [_|_],
        U < Share/(1-Share)/24
    ->  unlink(office, Host)
    ;   true
    ).

                /*******************************
                *      SENSORS AND VALVES      *
                *******************************/

topic(Number, Name, Topic) :-
    format(atom(Topic), 'field/~w/~w', [Number, Name]).

send_reading(Options, Field, Reading) :-
    arg(1, Field, Number),
    topic(Number, moisture, Topic),
    (   option(broker(URL), Options),
        URL \== none
    ->  remote(office, publish(Topic, Reading))
    ;   host(Number, Host),
        remote(Host, ( ignore(take(mqtt-message(Topic, _, _))),
                       leave(mqtt-message(Topic, Reading, [])) ))
    ).

%   orders(+Options, +Number, -Orders): Orders are the amounts, in mm, ordered
%   from the valve of field Number.

orders(Options, Number, Orders) :-
    topic(Number, valve, Topic),
    (   option(broker(URL), Options),
        URL \== none
    ->  Host = office,
        Order = mqtt-message(Topic, Payload, _)
    ;   host(Number, Host),
        Order = published(Topic, Payload)
    ),
    taken(Host, Order, Payload, Orders).

taken(Host, Order, Payload, [Mm|Orders]) :-
    copy_term(Order-Payload, One-Taken),
    remote(Host, take(One)),
    !,
    Mm = Taken.mm,
    taken(Host, Order, Payload, Orders).
taken(_, _, _, []).

                /*******************************
                *            PICTURE           *
                *******************************/

%!  scene_totals(-Days, -Totals) is semidet.
%
%   Totals has Number-totals(Irrigated, Drained, Stressed) for each field: mm,
%   mm and hours, see fields.pl.

scene_totals(Days, Totals) :-
    scene(Hour, Fields),
    Days is Hour/24,
    findall(Number-Sums, member(field(Number, _, _, Sums)-_, Fields), Totals).

%!  scene_picture(-Svg) is det.
%
%   Svg shows each field with the water of its root zone, from wilting to field
%   capacity, red where the crop has stress; a drop where the valve is open; its
%   link, if there is one.

scene_picture(Svg) :-
    scene(Hour, Fields),
    with_output_to(string(Svg), draw(Hour, Fields)).

draw(Hour, Fields) :-
    Day is Hour//24,
    Clock is Hour mod 24,
    format('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 330" \c
            font-family="sans-serif" font-size="14"><text x="10" y="20">day ~d, \c
            ~d:00</text><rect x="340" y="285" width="80" height="34" fill="#ddd" \c
            stroke="#555"/><text x="358" y="307">office</text>', [Day, Clock]),
    forall(member(Field-Pending, Fields), draw_field(Field, Pending)),
    format('</svg>').

draw_field(Field, Pending) :-
    Field = field(Number, soil(FC, WP, Zr, _, _, _), D, totals(Mm, _, Hours)),
    X is 125*(Number-1)+10,
    Height is 150*max(0, 1 - D/(1000*(FC-WP)*Zr)),
    Top is 200-Height,
    field_stress(Field, Ks),
    ( Ks < 1 -> Colour = '#c63' ; Colour = '#48c' ),
    format('<rect x="~w" y="50" width="110" height="150" fill="#e8dcc0" \c
            stroke="#864"/>', [X]),
    format('<rect x="~w" y="~1f" width="110" height="~1f" fill="~w"/>',
           [X, Top, Height, Colour]),
    ( Pending > 0 -> Valve = 'valve open' ; Valve = '' ),
    TextX is X+5,
    format('<text x="~w" y="66">field ~w</text><text x="~w" y="84" \c
            fill="#06c">~w</text>', [TextX, Number, TextX, Valve]),
    format('<text x="~w" y="218">~0f mm given</text><text x="~w" y="236">\c
            ~d h of stress</text>', [TextX, Mm, TextX, Hours]),
    draw_link(Number, X).

draw_link(Number, X) :-
    host(Number, Host),
    (   remote(Host, neighbours([_|_]))
    ->  From is X+55,
        format('<path d="M~w,244 L380,285" stroke="#393" stroke-width="2"/>',
               [From])
    ;   true
    ).
