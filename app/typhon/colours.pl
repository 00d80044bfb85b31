:- module(typhon_colours,
          [ colours/3                   % +Agents, -Colours, -Keys
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, nth0/3]).
:- use_module('../../prolog/typhon/tools/event_text', [short_name/2]).

/** <module> The colours of agents in a picture

*Threading*: pure.
*/

%!  colours(+Agents, -Colours, -Keys) is det.
%
%   Colours and Keys are lists of Name-Colour, for each agent and for the
%   legend.  At most eight agents get a colour each; of more agents, those whose
%   ids begin with the same name get shades of one colour.

colours(Agents, Colours, Colours) :-
    length(Agents, Count),
    Count =< 8,
    !,
    numbered(Agents, Colours).
colours(Agents, Colours, Keys) :-
    maplist(agent_kind, Agents, Kinds0),
    sort(Kinds0, Kinds),
    numbered(Kinds, Keys),
    findall(Agent-Colour,
            ( member(Kind-Base, Keys),
              findall(A, ( member(A, Agents), agent_kind(A, Kind) ), Alike),
              nth0(I, Alike, Agent),
              shade(I, Base, Colour) ),
            Colours).

numbered(Names, Colours) :-
    findall(Name-Colour,
            ( nth0(I, Names, Name),
              J is I mod 8,
              colour(J, Colour) ),
            Colours).

%   shade(+I, +Base, -Colour): lighter and darker in turn.

shade(I, Base, Colour) :-
    atom_concat('#', Hex, Base),
    atom_concat('0x', Hex, Text),
    atom_number(Text, RGB),
    J is I mod 4,
    nth0(J, [0, 0.35, -0.35, 0.6], By),
    maplist(shaded(RGB, By), [16, 8, 0], [R, G, B]),
    format(atom(Colour), '#~|~`0t~16r~2+~`0t~16r~2+~`0t~16r~2+', [R, G, B]).

shaded(RGB, By, Shift, Part) :-
    Part0 is (RGB>>Shift) /\ 255,
    (   By < 0
    ->  Part is round(Part0*(1+By))
    ;   Part is round(Part0+(255-Part0)*By)
    ).

agent_kind(Agent, Kind) :-
    short_name(Agent, Short),
    sub_atom(Short, Before, _, _, '.'),
    !,
    sub_atom(Short, 0, Before, _, Kind).
agent_kind(Agent, Agent).

%   Colour-blind people can distinguish these colours.

colour(0, '#0072b2').
colour(1, '#d55e00').
colour(2, '#009e73').
colour(3, '#cc79a7').
colour(4, '#e69f00').
colour(5, '#56b4e9').
colour(6, '#7a5195').
colour(7, '#8c6d31').

