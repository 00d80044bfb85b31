:- module(solar_street,
          [ street_new/3,               % +Seed, +Capacity, -Street
            street_period/3,            % +Flows, +Street0, -Street
            street_input/4,             % +Seed, +Period, +House, -Input
            battery_limits/3            % +Battery, -In, -Out
          ]).
:- use_module('../drawn', [drawn/3]).
:- use_module(library(apply), [maplist/4]).
:- use_module(library(lists), [member/2, sum_list/2]).

/** <module> A street of houses with solar panels, and its battery

One period is a quarter of an hour; period T ends T quarters after midnight.
Energy is in kWh, money in ct.  A term street(T, Battery, Houses) is a street:

  - battery(Level, Capacity, Lost)
  - house(Number, plant(Peak, Daily, Heat), Water, Totals): Peak in kWp; Daily,
    its use in a day without hot water; Heat, the use of its boiler in a day;
    Water, the energy the boiler still needs until 18:00.  Totals =
    totals(Produced, Used, Bought, Wasted, Taken, Sold, Paid): Bought is from
    the grid, Taken and Sold are exchanged with the street.

A house uses its production for its load, then for its boiler (2 kW).  A grant
limits how much of the rest it gives to the street, or how much of its lack it
takes from there; the battery takes or gives the difference.  If it cannot, all
givers, or all takers, share the limit in proportion.  The rest is wasted, or
bought.  A boiler that would be late takes its energy from the grid.

Sources: irradiance (910 sin(elevation) - 30) (1 - 0.75 N^3.4) W/m2 with cloud
cover N (Kasten and Czeplak, Solar Energy 24, 1980); declination (Cooper,
1969).  Assumptions: mid-April at 50 degrees north; horizontal panels that give
80 % of their rated power; cover differs from day to day, drifts, and single
clouds pass; a battery has an efficiency of 92 % in each direction, and is
charged in two hours; the grid takes nothing; 6 to 14 kWh a day, 40 % of it
evenly, 20 % around 7:30 and 40 % around 19:30, in a period by half more or
less; 2 to 6 kWh of hot water.

*Threading*: pure.  Without floats in its arguments street_period/3 is exact,
where the Prolog flag `prefer_rationals` is true.
*/

efficiency(23r25).
heater(1r2).                    % kWh in a period

%!  street_new(+Seed, +Capacity, -Street) is det.
%
%   Ten houses at midnight, and a battery that is empty.

street_new(Seed, Capacity, street(0, battery(0.0, Full, 0.0), Houses)) :-
    Full is float(Capacity),
    findall(house(Number, plant(Peak, Daily, Heat), Heat,
                  totals(0, 0, 0, 0, 0, 0, 0)),
            ( between(1, 10, Number),
              uniform(Seed, peak(Number), 2, 8, Peak),
              uniform(Seed, daily(Number), 6, 14, Daily),
              uniform(Seed, heat(Number), 2, 6, Heat) ),
            Houses).

uniform(Seed, What, Least, Most, X) :-
    drawn(Seed, What, Share),
    X is Least + (Most-Least)*Share.

                /*******************************
                *        SUN AND LOADS         *
                *******************************/

%!  street_input(+Seed, +Period, +House, -Input) is det.
%
%   Input is Produced-Load of House in Period.

street_input(Seed, Period, house(Number, plant(Peak, Daily, _), _, _),
             Produced-Load) :-
    Hour is (Period-0.5)/4,
    irradiance(Hour, Clear),
    cover(Seed, Period, Number, Cover),
    Produced is Peak*0.8*Clear/1000*(1 - 0.75*Cover**3.4)/4,
    uniform(Seed, habit(Number), -1, 1, Shift),
    uniform(Seed, load(Number, Period), 0.5, 1.5, More),
    Clock is Hour - 24*floor(Hour/24) - Shift,
    peak(Clock, 7.5, 1, Morning),
    peak(Clock, 19.5, 2, Evening),
    Load is More*Daily/4*(0.4/24 + 0.2*Morning + 0.4*Evening).

peak(Hour, Centre, Width, PerHour) :-
    PerHour is exp(((Hour-Centre)/Width)**2 / -2)/(Width*sqrt(2*pi)).

irradiance(Hour, Clear) :-
    Latitude is 50*pi/180,
    Declination is 23.45*pi/180*sin(2*pi*(284+105)/365),
    Elevation is sin(Latitude)*sin(Declination)
                 + cos(Latitude)*cos(Declination)*cos(pi*(Hour-12)/12),
    Clear is max(0, 910*Elevation - 30).

%   A value for each two hours around the mean of the day, interpolated.

cover(Seed, Period, Number, Cover) :-
    Day is (Period-1)//96,
    Before is Period//8,
    After is Before+1,
    Share is (Period mod 8)/8,
    drawn(Seed, cover(Day), Mean),
    drawn(Seed, drift(Before), A),
    drawn(Seed, drift(After), B),
    drawn(Seed, cloud(Number, Period), C),
    Cover is max(0, min(1, Mean + 0.8*((1-Share)*A+Share*B-0.5) + 0.4*(C-0.5))).

                /*******************************
                *            ENERGY            *
                *******************************/

%!  street_period(+Flows, +Street0, -Street) is det.
%
%   Street0 after a period.  Flows has flow(Produced, Load, Grant) for each
%   house, Grant = grant(Kwh, Ct): the house may take Kwh from the street, or
%   give -Kwh if that is negative, at Ct per kWh.

street_period(Flows, street(T0, Battery0, Houses0),
              street(T, Battery, Houses)) :-
    T is T0+1,
    maplist(planned(T), Flows, Houses0, Plans),
    findall(Kwh, member(_-plan(_, _, _, _, Kwh, _), Plans), Gifts),
    findall(Kwh, member(_-plan(_, _, _, _, _, Kwh), Plans), Wants),
    sum_list(Gifts, In),
    sum_list(Wants, Out),
    balanced(In, Out, Battery0, Battery, Shares),
    maplist(settled(T, Shares), Plans, Houses0, Houses).

%   plan(Heated, Must, Spare, Lack, Gives, Takes): the boiler takes Heated from
%   the panel, and Must in total.

planned(T, Flow, House, Flow-plan(Heated, Must, Spare, Lack, Gives, Takes)) :-
    Flow = flow(Produced, Load, grant(Kwh, _)),
    House = house(_, _, Water, _),
    heater(Power),
    Left is (72-T) mod 96,
    Most is min(Power, Water),
    Must is max(0, Water - Power*Left),
    Own is Produced-Load,
    Heated is min(Most, max(0, Own)),
    Spare is max(0, Own) - Heated,
    Lack is max(0, -Own),
    Gives is min(Spare, max(0, -Kwh)),
    Takes is min(max(0, Kwh), Lack + Most - Heated).

%   balanced(+In, +Out, +Battery0, -Battery, -Shares): Shares are the possible
%   shares of In and of Out.

balanced(In, Out, Battery0, Battery, Given-Taken) :-
    Battery0 = battery(Level0, Capacity, Lost0),
    battery_limits(Battery0, Free, Stock),
    efficiency(Share),
    Charge is min(max(0, In-Out), Free),
    Discharge is min(max(0, Out-In), Stock),
    part(Out+Charge, In, Given),
    part(In+Discharge, Out, Taken),
    Level is Level0 + Share*Charge - Discharge/Share,
    Lost is Lost0 + (1-Share)*Charge + (1/Share-1)*Discharge,
    Battery = battery(Level, Capacity, Lost).

part(Possible, Wanted, Share) :-
    ( Wanted > 0 -> Share is min(1, (Possible)/Wanted) ; Share = 1 ).

%!  battery_limits(+Battery, -In, -Out) is det.
%
%   Energy that the battery can take and give in a period, at its terminals.

battery_limits(battery(Level, Capacity, _), In, Out) :-
    efficiency(Share),
    In is min(Capacity*1r8, (Capacity-Level)/Share),
    Out is min(Capacity*1r8, Share*Level).

settled(T, Given-Taken, Flow-Plan, house(Number, Plant, Water0, Totals0),
        house(Number, Plant, Water, totals(P, U, B, W, G, S, C))) :-
    Flow = flow(Produced, Load, grant(_, Ct)),
    Plan = plan(Heated, Must, Spare, Lack, Gives, Takes),
    Totals0 = totals(P0, U0, B0, W0, G0, S0, C0),
    Sells is Gives*Given,
    Gets is Takes*Taken,
    Warmer is max(0, Gets-Lack),
    Late is max(0, Must-Heated-Warmer),
    Heat is Heated + Warmer + Late,
    P is P0 + Produced,
    U is U0 + Load + Heat,
    B is B0 + max(0, Lack-Gets) + Late,
    W is W0 + Spare - Sells,
    G is G0 + Gets,
    S is S0 + Sells,
    C is C0 + Ct*(Gets-Sells),
    (   T mod 96 =:= 72
    ->  arg(3, Plant, Water)
    ;   Water is Water0-Heat
    ).
