:- module(typhon_picture,
          [ picture/3                   % +LogFile, +SvgFile, +Options
          ]).
:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [member/2, nth0/3, nth1/3]).
:- use_module(library(option), [option/3]).
:- use_module('../../prolog/typhon', [log_events/2]).
:- use_module('../../prolog/typhon/kernel/base/private', [output_file/2]).
:- use_module('../../prolog/typhon/tools/event_text', [short_name/2]).
:- use_module(colours, [colours/3]).
:- use_module(spacetime, [spacetime/2]).
:- use_module(svg,
              [ box/7, clipped/5, cross/3, dot/5, line/7, svg/4, text/4 ]).
:- use_module(view,
              [ colour_of/3, view/6, view_frame/5, x/3, y/5, y_from/4 ]).

/** <module> A picture of a log: space and time

Time runs from left to right, each host has a row, each agent a line: horizontal
while it stays on a host, steep while it hops.  Messages are thin arrows.  The
picture is SVG with lines and text only.

*Threading*: any thread.
*/

%!  picture(+LogFile, +SvgFile, +Options) is semidet.
%
%   Options are from(Time) and to(Time), the part of the log, in its times.
%   Fails if that part has no events.

picture(LogFile, SvgFile, Options) :-
    output_file(picture, SvgFile),
    log_events(LogFile, Events),
    spacetime(Events, world(All, Hosts, Agents, Stays, Hops, Letters, Marks)),
    part(All, Options, Span),
    colours(Agents, Colours, Keys),
    view(Span, Hosts, Stays, Colours, View, Rows),
    view_frame(View, _, Top, _, High),
    legend_height(Keys, Legend),
    Height is Top+High+56+Legend,
    setup_call_cleanup(
        open(SvgFile, write, Out, [encoding(utf8)]),
        svg(Out, 1000, Height,
            draw(Span, Rows, Keys, world(Stays, Hops, Letters, Marks), View)),
        close(Out)).

part(First-Last, Options, From-To) :-
    option(from(From0), Options, First),
    option(to(To0), Options, Last),
    From is max(From0, First),
    To1 is min(To0, Last),
    (   To1 > From
    ->  To = To1
    ;   First =:= Last                  % all at one time
    ->  To is From+1
    ).

draw(Span, Rows, Keys, World, View) :-
    World = world(_, Hops, Letters, Marks),
    view_frame(View, Left, Top, Wide, High),
    forall(nth1(I, Rows, Row), band(I, Row, Left, Wide)),
    axis(Span, View),
    X is Left-5,
    Width is Wide+10,
    clipped(X, Top, Width, High, lines(World, View)),
    legend(View, Keys, Hops, Letters, Marks).

lines(world(Stays, Hops, Letters, Marks), View) :-
    forall(member(Letter, Letters), ignore(letter(Letter, Stays, View))),
    forall(member(Hop, Hops), ignore(hop(Hop, View))),
    forall(member(Stay, Stays), ignore(stay(Stay, View))),
    forall(member(Mark, Marks), ignore(mark(Mark, View))).

                /*******************************
                *            FRAME             *
                *******************************/

band(I, Host-(Top-Bottom), Left, Wide) :-
    High is Bottom-Top,
    Middle is (Top+Bottom)/2+4,
    TextX is Left-8,
    (   I mod 2 =:= 1
    ->  Fill = '#f3f4f6'
    ;   Fill = '#fafafa'
    ),
    box(Left, Top, Wide, High, Fill, none, 0),
    short_name(Host, Name),
    text(TextX, Middle, end, Name).

%   axis(+Span, +View): times under the rows; times of day count from the first
%   event.

axis(First-Last, View) :-
    view_frame(View, _, Top, _, High),
    Bottom is Top+High,
    (   First > 100 000 000
    ->  Zero = First,
        Title = 'seconds since the first event'
    ;   Zero = 0,
        Title = 'host time in seconds'
    ),
    step(Last-First, Step),
    Begin is ceiling((First-Zero)/Step),
    End is floor((Last-Zero)/Step),
    forall(between(Begin, End, I), tick(I, Step, Zero, Top-Bottom, View)),
    x(Last, View, X),
    Y is Bottom+34,
    text(X, Y, end, Title).

tick(I, Step, Zero, Top-Bottom, View) :-
    Time is I*Step,
    At is Time+Zero,
    x(At, View, X),
    line(X, Top, X, Bottom, '#ffffff', 1, ''),
    Y is Bottom+14,
    decimals(Step, Digits),
    format(atom(Text), '~*f', [Digits, Time]),
    text(X, Y, middle, Text).

step(Span, Step) :-
    Rough is Span/8,
    Power is 10.0**floor(log10(Rough)),
    member(Factor, [1, 2, 5, 10]),
    Step is Factor*Power,
    Step >= Rough,
    !.

decimals(Step, Digits) :-
    Digits is max(0, ceiling(-log10(Step)-1.0e-9)).

                /*******************************
                *        WHAT HAPPENED         *
                *******************************/

stay(stay(Agent, Host, From, To), View) :-
    y(Agent, Host, From, View, Y),
    x(From, View, X1),
    x(To, View, X2),
    X3 is max(X2, X1+1),
    colour_of(Agent, View, Colour),
    line(X1, Y, X3, Y, Colour, 2.2, '').

hop(hop(Agent, FromHost, From, ToHost, To, How), View) :-
    y(Agent, FromHost, From, View, Y1),
    y(Agent, ToHost, To, View, Y2),
    x(From, View, X1),
    x(To, View, X2),
    colour_of(Agent, View, Colour),
    (   How == seen
    ->  Dashes = ''
    ;   Dashes = ' stroke-dasharray="4,3"'
    ),
    line(X1, Y1, X2, Y2, Colour, 1.4, Dashes).

letter(letter(A, From, B, To), Stays, View) :-
    stood(Stays, A, From, HostA),
    stood(Stays, B, To, HostB),
    y(A, HostA, From, View, Y1),
    y(B, HostB, To, View, Y2),
    x(From, View, X1),
    x(To, View, X2),
    line(X1, Y1, X2, Y2, '#555', 0.8, ' marker-end="url(#tip)"').

stood(Stays, Agent, Time, Host) :-
    member(stay(Agent, Host, From, To), Stays),
    From =< Time,
    Time =< To,
    !.

mark(mark(Kind, Agent, Host, Time), View) :-
    y(Agent, Host, Time, View, Y),
    x(Time, View, X),
    colour_of(Agent, View, Colour),
    sign(Kind, X, Y, Colour, View, Time).

sign(begins, X, Y, Colour, _, _) :-
    dot(X, Y, 3.6, Colour, none).
sign(ends, X, Y, Colour, _, _) :-
    X1 is X-3,
    Y1 is Y-3,
    box(X1, Y1, 6, 6, white, Colour, 1.6).
sign(fails, X, Y, _, _, _) :-
    cross(X, Y, '#c00000').
sign(logs, X, Y, Colour, _, _) :-
    dot(X, Y, 2, white, Colour).
sign(clone(Clone), X, Y, Colour, View, Time) :-
    y_from(Clone, Time, View, Y2),
    line(X, Y, X, Y2, Colour, 1, ' stroke-dasharray="1.5,2"').

                /*******************************
                *            LEGEND            *
                *******************************/

legend_height(Keys, Height) :-
    length(Keys, Count),
    Height is 24*(ceiling(Count/4)+1).

legend(View, Keys, Hops, Letters, Marks) :-
    view_frame(View, Left, FrameTop, _, High),
    Top is FrameTop+High+58,
    forall(nth0(I, Keys, Name-Colour),
           key(I, Name, Colour, Left, Top)),
    length(Keys, Count),
    Y is Top+24*ceiling(Count/4),
    findall(Sign, shown_sign(Hops, Letters, Marks, Sign), Signs),
    foldl(sign_key(Y), Signs, Left, _).

key(I, Name, Colour, Left, Top) :-
    X is Left+(I mod 4)*235,
    Y is Top+24*(I//4),
    X2 is X+22,
    line(X, Y, X2, Y, Colour, 2.2, ''),
    short_name(Name, Short),
    TextX is X2+6,
    TextY is Y+4,
    text(TextX, TextY, start, Short).

shown_sign(_, _, Marks, Kind-Kind) :-
    member(Kind, [begins, ends, fails]),
    memberchk(mark(Kind, _, _, _), Marks).
shown_sign(_, _, Marks, logs-'logs something') :-
    memberchk(mark(logs, _, _, _), Marks).
shown_sign(_, _, Marks, clones-'has a clone') :-
    memberchk(mark(clone(_), _, _, _), Marks).
shown_sign(Hops, _, _, seen-hop) :-
    memberchk(hop(_, _, _, _, _, seen), Hops).
shown_sign(Hops, _, _, guessed-'was elsewhere later') :-
    memberchk(hop(_, _, _, _, _, guessed), Hops).
shown_sign(_, [_|_], _, letter-message).

sign_key(Y, Sign-Text, X, Next) :-
    sample(Sign, X, Y),
    TextX is X+26,
    TextY is Y+4,
    text(TextX, TextY, start, Text),
    atom_length(Text, Length),
    Next is TextX+7.2*Length+18.

sample(seen, X, Y) :-
    !,
    line(X, Y+5, X+20, Y-5, '#444', 1.4, '').
sample(guessed, X, Y) :-
    !,
    line(X, Y+5, X+20, Y-5, '#444', 1.4, ' stroke-dasharray="4,3"').
sample(letter, X, Y) :-
    !,
    line(X, Y+4, X+20, Y-4, '#555', 0.8, ' marker-end="url(#tip)"').
sample(clones, X, Y) :-
    !,
    line(X+10, Y-7, X+10, Y+7, '#444', 1, ' stroke-dasharray="1.5,2"').
sample(Sign, X, Y) :-
    line(X, Y, X+20, Y, '#444', 2.2, ''),
    At is X+10,
    sign(Sign, At, Y, '#444', none, 0).
