:- module(solar_scene,
          [ scene_network/3,            % +Options, -Topology, -NetworkOptions
            scene_step/1,               % -Seconds
            scene_start/2,              % +Network, +Options
            scene_totals/2,             % -Battery, -Totals
            scene_picture/1,            % -Svg
            scene_stop/0
          ]).
:- use_module('../../../prolog/typhon',
              [agent_create/3, network_at/3, remote/2]).
:- use_module('../drawn', [drawn/3]).
:- use_module(street).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(option), [option/3]).

/** <module> The street, its hosts, and the connection between them

Ten houses and the battery are hosts in a ring.  Once in a period the world
leaves meter readings in the tuple spaces of houses, and the limits of the
battery in its own; it reads the grants at the end of the period.

*Threading*: the world is one fact, replaced in one step; any thread reads it.
A mutex prevents that the scene ends during a step.
*/

:- dynamic
    scene/2,                    % Street, list of House-flow(Produced, Load, Grant)
    setting/1.                  % Options

house(Number, Host) :-
    between(1, 10, Number),
    atom_concat(house, Number, Host).

scene_step(900).

scene_network(_, edges([battery-house1, house10-battery|Links]), []) :-
    findall(A-B, ( house(N, A), Next is N+1, house(Next, B) ), Links).

%!  scene_start(+Network, +Options) is det.
%
%   Options: seed(S); capacity(C) of the battery in kWh, default 30;
%   strategy(S):
%
%     - none: nothing is shared
%     - first: each house asks the battery for energy, and for its boiler as
%       soon as that is cold, once in a period, at a random moment that is the
%       same in each period
%     - drawn: the same, at another random moment in each period
%     - waiting: the same, but for its boiler only when that would be late
%     - auction: the default

scene_start(Network, Options) :-
    scene_stop,
    option(seed(Seed), Options, 1),
    option(capacity(Capacity), Options, 30),
    street_new(Seed, Capacity, Street),
    assertz(setting(Options)),
    assertz(scene(Street, [])),
    metered(Street, []),
    option(strategy(Strategy), Options, auction),
    agents(Strategy, Seed),
    network_at(Network, 900, solar_scene:pass(Network, 1)).

agents(none, _) :-
    !.
agents(auction, _) :-
    !,
    agent(auctioneer, battery, [], _),
    forall(house(_, Host), agent(house, Host, [], _)).
agents(Strategy, Seed) :-
    agent(keeper, battery, [], Keeper),
    forall(house(Number, Host),
           ( drawn(Seed, moment(Number), Share),
             asking(Strategy, Share, Moment, Least),
             agent(house, Host,
                   [keeper(Keeper), house(Number), moment(Moment), least(Least)],
                   _) )).

asking(first, Share, Share, 0).
asking(drawn, _, drawn, 0).
asking(waiting, _, drawn, 30).

agent(Name, Host, Facts, Agent) :-
    module_property(solar_scene, file(Here)),
    absolute_file_name(Name, Program,
                       [relative_to(Here), extensions([pl]), access(read)]),
    agent_create(Program, Agent, [host(Host), facts(Facts)]).

scene_stop :-
    with_mutex(solar_scene, forget).

forget :-
    maplist(retractall, [scene(_, _), setting(_)]).

                /*******************************
                *             TIME             *
                *******************************/

:- public pass/2.               % called by network_at/3

pass(Network, Period) :-
    with_mutex(solar_scene, passed(Network, Period)).

passed(_, _) :-
    \+ scene(_, _),
    !.
passed(Network, Period) :-
    scene(Street0, _),
    Street0 = street(_, _, Houses),
    setting(Options),
    option(seed(Seed), Options, 1),
    findall(flow(Produced, Load, Grant),
            ( member(House, Houses),
              street_input(Seed, Period, House, Produced-Load),
              granted(House, Grant) ),
            Flows),
    street_period(Flows, Street0, Street),
    transaction(( retractall(scene(_, _)), assertz(scene(Street, Flows)) )),
    metered(Street, Flows),
    Next is Period+1,
    Time is 900*Next,
    network_at(Network, Time, solar_scene:pass(Network, Next)).

granted(house(Number, _, _, _), Grant) :-
    house(Number, Host),
    Grant = grant(_, _),
    ( remote(Host, take(Grant)) -> true ; Grant = grant(0, 0) ).

metered(street(Period, Battery, Houses), Flows) :-
    forall(nth1(N, Houses, house(N, _, Water, _)),
           ( ( nth1(N, Flows, flow(Produced, Load, _)) -> true ; Produced-Load = 0-0 ),
             Own is Produced-Load,
             house(N, Host),
             replaced(Host, meter(_, _, _), meter(Period, Own, Water)) )),
    battery_limits(Battery, In, Out),
    Battery = battery(Level, Capacity, _),
    replaced(battery, battery(_, _, _, _, _),
             battery(Period, Level, Capacity, In, Out)).

replaced(Host, Old, New) :-
    remote(Host, ( ignore(take(Old)), leave(New) )).

                /*******************************
                *            PICTURE           *
                *******************************/

%!  scene_totals(-Battery, -Totals) is semidet.
%
%   The battery and, for each house, Number-Sums: see street.pl.

scene_totals(Battery, Totals) :-
    scene(street(_, Battery, Houses), _),
    findall(Number-Sums, member(house(Number, _, _, Sums), Houses), Totals).

%!  scene_picture(-Svg) is det.
%
%   Svg shows the last period: for each house the energy of its panel (yellow)
%   and its load (blue), the energy it has bought from the grid, and a line to
%   the battery: green if it gives, orange if it takes energy.

scene_picture(Svg) :-
    scene(Street, Flows),
    with_output_to(string(Svg), draw(Street, Flows)).

draw(street(Period, battery(Level, Capacity, _), Houses), Flows) :-
    Day is Period//96,
    Hour is Period mod 96 // 4,
    Minute is Period mod 4 * 15,
    Height is 80*Level/Capacity,
    Top is 320-Height,
    format('<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 350" \c
            font-family="sans-serif" font-size="13"><text x="10" y="20" \c
            font-size="14">day ~d, ~d:~|~`0t~d~2+</text>', [Day, Hour, Minute]),
    forall(nth1(N, Houses, House),
           ( nth1(N, Flows, Flow) -> draw_house(House, Flow) ; true )),
    format('<rect x="350" y="240" width="60" height="80" fill="#eee" \c
            stroke="#555"/><rect x="350" y="~1f" width="60" height="~1f" \c
            fill="#5a5"/><text x="330" y="338">~1f of ~0f kWh</text></svg>',
           [Top, Height, Level, Capacity]).

draw_house(house(N, _, _, Totals), flow(Produced, Load, grant(Kwh, Ct))) :-
    X is 75*(N-1)+8,
    arg(3, Totals, Bought),
    ( Kwh < 0 -> Colour = '#393' ; Colour = '#e80' ),
    Width is min(12, 16*abs(Kwh)),
    Middle is X+32,
    format('<path d="M~w,194 L380,240" stroke="~w" stroke-width="~1f"/>',
           [Middle, Colour, Width]),
    format('<rect x="~w" y="80" width="64" height="80" fill="#e8dcc0" \c
            stroke="#864"/><path d="M~w,80 l32,-30 l32,30 z" fill="#357"/>', [X, X]),
    bar(X, 8, Produced, '#fc3'),
    bar(X, 34, Load, '#48c'),
    Name is X+24,
    ( Kwh =:= 0 -> Price = '' ; format(string(Price), '~1f ct', [Ct]) ),
    format('<text x="~w" y="44">~w</text><text x="~w" y="176" font-size="11">\c
            grid ~1f</text><text x="~w" y="188" font-size="11">~w</text>',
           [Name, N, X, Bought, X, Price]).

bar(X, Right, Kwh, Colour) :-
    Left is X+Right,
    Height is min(76, 50*Kwh),
    Top is 159-Height,
    format('<rect x="~w" y="~1f" width="22" height="~1f" fill="~w"/>',
           [Left, Top, Height, Colour]).
