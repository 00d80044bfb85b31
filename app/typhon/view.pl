:- module(typhon_view,
          [ view/6,                     % +Span, +Hosts, +Stays, +Colours,
                                        % -View, -Rows
            view_frame/5,               % +View, -Left, -Top, -Width, -Height
            x/3,                        % +Time, +View, -X
            y/5,                        % +Agent, +Host, +Time, +View, -Y
            y_from/4,                   % +Agent, +Time, +View, -Y
            colour_of/3                 % +Agent, +View, -Colour
          ]).
:- use_module(library(apply), [foldl/4, include/3]).
:- use_module(library(dcg/basics), [digits/3]).
:- use_module(library(lists), [max_list/2, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module('../../prolog/typhon/tools/event_text', [short_name/2]).

/** <module> Layout of the picture of a log

A view is view(Scale, Rows, Lanes, Colours, Bottom), in pixels: Scale is
scale(First, Left, PerSecond), Rows a list of row(Host, Top, Lanes, Height),
Lanes a list of lane(Agent, Host, From, Lane), and Bottom where the last row
ends.

*Threading*: pure.
*/

width(1000).
right(24).
top(28).

%!  view(+Span, +Hosts, +Stays, +Colours, -View, -Rows) is det.
%
%   Span is First-Last, Colours are the result of colours/3.  Rows are
%   Host-(Top-Bottom), from top to bottom.

view(First-Last, Hosts0, Stays, Colours,
     view(scale(First, Left, PerSecond), Rows, Lanes, Colours, Bottom),
     Bounds) :-
    by_name(Hosts0, Hosts),
    left(Hosts, Left),
    width(Width),
    right(Right),
    PerSecond is (Width-Left-Right)/(Last-First),
    lanes(Stays, Lanes),
    top(Top),
    foldl(row(Lanes), Hosts, Rows-Top, []-Bottom),
    findall(Host-(RowTop-RowBottom),
            ( member(Row, Rows),
              Row = row(Host, _, _, _),
              row_bounds(Row, RowTop, RowBottom) ),
            Bounds).

%!  view_frame(+View, -Left, -Top, -Width, -Height) is det.
%
%   The rectangle inside the axes.

view_frame(view(scale(_, Left, _), _, _, _, Bottom), Left, Top, Wide, High) :-
    width(Width),
    right(Right),
    top(Top),
    Wide is Width-Left-Right,
    High is Bottom-Top.

left(Hosts, Left) :-
    findall(Length,
            ( member(Host, Hosts),
              short_name(Host, Short),
              atom_length(Short, Length) ),
            Lengths),
    max_list(Lengths, Longest),
    Left is max(40, min(160, 24+7*Longest)).

%   Sorts n2 before n10.

by_name(Hosts0, Hosts) :-
    findall(Key-Host,
            ( member(Host, Hosts0),
              short_name(Host, Name),
              atom_codes(Name, Codes),
              phrase(name_key(Key), Codes) ),
            Keyed),
    keysort(Keyed, Sorted),
    pairs_values(Sorted, Hosts).

name_key([Number|Key]) -->
    digits([Digit|Digits]),
    { number_codes(Number, [Digit|Digits]) },
    !,
    name_key(Key).
name_key([Char|Key]) -->
    [Code],
    { char_code(Char, Code) },
    !,
    name_key(Key).
name_key([]) --> [].

%   lanes(+Stays, -Lanes): agents on a host at the same time have different
%   lanes, each the first free one.

lanes(Stays, Lanes) :-
    findall(From-stay(Agent, Host, From, To),
            member(stay(Agent, Host, From, To), Stays),
            Keyed),
    keysort(Keyed, Sorted),
    foldl(lane, Sorted, []-[], _-Lanes).

lane(From-stay(Agent, Host, From, To), Busy0-Lanes,
     [busy(Host, Lane, To)|Busy]-[lane(Agent, Host, From, Lane)|Lanes]) :-
    include(busy_at(From), Busy0, Busy),
    between(0, inf, Lane),
    \+ memberchk(busy(Host, Lane, _), Busy),
    !.

busy_at(Time, busy(_, _, To)) :-
    To >= Time.

%   row(+Lanes, +Host, ...): a row at Top, the next one below it.

row(Lanes, Host, [row(Host, Top, Count, Height)|Rows]-Top, Rows-Next) :-
    findall(Lane, member(lane(_, Host, _, Lane), Lanes), Used),
    max_list([0|Used], Most),
    Count is Most+1,
    lane_height(Count, Height),
    Next is Top+max(26, Count*Height+14)+4.

lane_height(Count, Height) :-
    Height is max(2, min(9, 120/Count)).

row_bounds(row(_, Top, Count, Height), Top, Bottom) :-
    Bottom is Top+max(26, Count*Height+14).

                /*******************************
                *          COORDINATES         *
                *******************************/

%!  x(+Time, +View, -X) is det.
%!  y(+Agent, +Host, +Time, +View, -Y) is semidet.
%!  y_from(+Agent, +Time, +View, -Y) is semidet.
%
%   Y is the position of an agent on Host, or of its first stay at about Time;
%   the middle of the host if the log does not have the agent there.

x(Time, view(scale(First, Left, PerSecond), _, _, _, _), X) :-
    X is Left+(Time-First)*PerSecond.

y(Agent, Host, Time, view(_, Rows, Lanes, _, _), Y) :-
    Row = row(Host, _, Count, Height),
    memberchk(Row, Rows),
    row_bounds(Row, Top, Bottom),
    Middle is (Top+Bottom)/2,
    (   lane_at(Lanes, Agent, Host, Time, Lane)
    ->  Y is Middle+(Lane-(Count-1)/2)*Height
    ;   Y = Middle
    ).

%   The lanes are in order of time, the latest first.

lane_at(Lanes, Agent, Host, Time, Lane) :-
    member(lane(Agent, Host, From, Lane), Lanes),
    From =< Time,
    !.

y_from(Agent, Time, View, Y) :-
    View = view(_, _, Lanes, _, _),
    member(lane(Agent, Host, From, _), Lanes),
    abs(From-Time) =< 0.5,
    !,
    y(Agent, Host, From, View, Y).

%!  colour_of(+Agent, +View, -Colour) is semidet.

colour_of(Agent, view(_, _, _, Colours, _), Colour) :-
    memberchk(Agent-Colour, Colours).
