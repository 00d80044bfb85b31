:- module(irrigation_fields,
          [ weather/4,                  % +Seed, +Hour, -Evaporation, -Rain
            field_new/3,                % +Seed, +Number, -Field
            field_hour/4,               % +Weather, +Opened, +Field0, -Field
            field_moisture/2,           % +Field, -Share
            field_stress/2,             % +Field, -Factor
            field_map/2                 % +Field, -Map
          ]).
:- use_module('../drawn', [drawn/3]).

/** <module> Fields, their water, and the weather

Water in the root zone of a field by FAO Irrigation and Drainage Paper 56
(Allen et al., 1998), once in an hour, in millimetres:

    D' = D - rain - irrigation + Ks Kc ET0              depletion, at least 0
    TAW = 1000 (FC - WP) Zr,  RAW = p TAW               eq. 82, 83
    Ks = (TAW - D)/((1 - p) TAW)  if D > RAW, else 1    eq. 84

Water above field capacity drains.  A term field(Number, Soil, D, Totals) is a
field; Soil = soil(FC, WP, Zr, Kc, Efficiency, Bias), Totals =
totals(Irrigated, Drained, Stressed), in mm, mm and hours.

Sources: FC - WP from loamy sand to silt loam and p = 0.5 (FAO-56, tables 19
and 22); of water from sprinklers 70 to 85 % reaches the roots.  Assumptions:
ET0 is 5 mm a day in the mean, by chance half as much more or less, between 6
and 18 o'clock; it rains on one of eight days, 8 mm in the mean, in one hour; a
crop takes 30 % more or less than its table says; valves give 5 mm/h; a sensor
is off by up to 0.01, and has noise of the same size (in the scene).

*Threading*: pure.
*/

%!  weather(+Seed, +Hour, -Evaporation, -Rain) is det.
%
%   ET0 and rain in Hour, counted from the start, in mm.

weather(Seed, Hour, Evaporation, Rain) :-
    Day is Hour // 24,
    Clock is Hour mod 24,
    drawn(Seed, et0(Day), Sunny),
    (   between(6, 17, Clock)
    ->  Evaporation is 5*(0.5+Sunny)*sin(pi*(Clock-5.5)/12)*pi/24
    ;   Evaporation = 0.0
    ),
    drawn(Seed, rain(Day), Wet),
    drawn(Seed, rain_hour(Day), Then),
    (   Wet < 1/8,
        Clock =:= truncate(24*Then)
    ->  drawn(Seed, rain_depth(Day), Share),
        Rain is -8*log(Share)
    ;   Rain = 0.0
    ).

%!  field_new(+Seed, +Number, -Field) is det.

field_new(Seed, Number, field(Number, Soil, Depletion, totals(0, 0, 0))) :-
    Soil = soil(FC, WP, Zr, Kc, Efficiency, Bias),
    uniform(Seed, wp(Number), 0.05, 0.12, WP),
    uniform(Seed, fc(Number), 0.10, 0.18, Holds),
    FC is WP+Holds,
    uniform(Seed, zr(Number), 0.4, 0.8, Zr),
    uniform(Seed, kc(Number), 0.7, 1.3, Kc),
    uniform(Seed, efficiency(Number), 0.70, 0.85, Efficiency),
    uniform(Seed, bias(Number), -0.01, 0.01, Bias),
    Depletion is 0.3*1000*Holds*Zr.

uniform(Seed, What, Least, Most, X) :-
    drawn(Seed, What, Share),
    X is Least + (Most-Least)*Share.

%!  field_hour(+Weather, +Opened, +Field0, -Field) is det.
%
%   Field0 after an hour with this Weather, ET0-Rain, while the valve gave
%   Opened mm.

field_hour(Evaporation-Rain, Opened, Field0, Field) :-
    Field0 = field(Number, Soil, D0, totals(Irrigated0, Drained0, Stressed0)),
    Soil = soil(_, _, _, Kc, Efficiency, _),
    field_stress(Field0, Ks),
    D1 is D0 - Rain - Efficiency*Opened + Ks*Kc*Evaporation,
    D is max(0, D1),
    Irrigated is Irrigated0+Opened,
    Drained is Drained0 + D - D1,
    ( Ks < 1 -> Stressed is Stressed0+1 ; Stressed = Stressed0 ),
    Field = field(Number, Soil, D, totals(Irrigated, Drained, Stressed)).

%!  field_stress(+Field, -Ks) is det.
%!  field_moisture(+Field, -Share) is det.
%!  field_map(+Field, -Map) is det.
%
%   Ks is the stress factor, Share water by volume.  Map is a survey of the
%   soil, map(FC, WP, Zr), without the need of the crop.

field_stress(field(_, soil(FC, WP, Zr, _, _, _), D, _), Ks) :-
    TAW is 1000*(FC-WP)*Zr,
    Ks is max(0, min(1, (TAW-D)/(0.5*TAW))).

field_moisture(field(_, soil(FC, _, Zr, _, _, _), D, _), Share) :-
    Share is FC - D/(1000*Zr).

field_map(field(_, soil(FC, WP, Zr, _, _, _), _, _), map(FC, WP, Zr)).
