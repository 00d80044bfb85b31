:- module(typhon_svg,
          [ svg/4,                      % +Out, +Width, +Height, :Goal
            line/7,                     % +X1, +Y1, +X2, +Y2, +Colour, +Width,
                                        % +More
            text/4,                     % +X, +Y, +Anchor, +Text
            dot/5,                      % +X, +Y, +Radius, +Fill, +Stroke
            box/7,                      % +X, +Y, +Width, +Height, +Fill,
                                        % +Stroke, +StrokeWidth
            cross/3,                    % +X, +Y, +Colour
            clipped/5                   % +X, +Y, +Width, +Height, :Goal
          ]).

/** <module> Lines, dots and texts as SVG

*Threading*: what is drawn goes to the current output of the thread.
*/

:- meta_predicate
    svg(+, +, +, 0),
    clipped(+, +, +, +, 0).

%!  svg(+Out, +Width, +Height, :Goal) is det.
%
%   Writes a picture to Out, which Goal draws by the predicates below.

svg(Out, Width, Height, Goal) :-
    current_output(Old),
    setup_call_cleanup(
        set_output(Out),
        ( head(Width, Height),
          call(Goal),
          format('</svg>~n') ),
        set_output(Old)).

head(Width, Height) :-
    format('<svg xmlns="http://www.w3.org/2000/svg" \c
            width="~w" height="~1f" viewBox="0 0 ~w ~1f" \c
            font-family="DejaVu Sans, Helvetica, sans-serif" \c
            font-size="12" fill="#222">~n',
           [Width, Height, Width, Height]),
    format('<defs><marker id="tip" viewBox="0 0 6 6" refX="6" refY="3" \c
            markerWidth="6" markerHeight="6" orient="auto">\c
            <path d="M0,0.5 L6,3 L0,5.5" fill="none" stroke="#555"/>\c
            </marker></defs>~n'),
    format('<rect width="100%" height="100%" fill="white"/>~n').

%!  clipped(+X, +Y, +Width, +Height, :Goal) is det.
%
%   Clips the drawing of Goal to the rectangle.

clipped(X, Y, Width, Height, Goal) :-
    format('<clipPath id="inside"><rect x="~1f" y="~1f" width="~1f" \c
            height="~1f"/></clipPath>~n<g clip-path="url(#inside)">~n',
           [X, Y, Width, Height]),
    call(Goal),
    format('</g>~n').

%!  line(+X1, +Y1, +X2, +Y2, +Colour, +Width, +More) is det.
%!  text(+X, +Y, +Anchor, +Text) is det.
%!  dot(+X, +Y, +Radius, +Fill, +Stroke) is det.
%!  box(+X, +Y, +Width, +Height, +Fill, +Stroke, +StrokeWidth) is det.
%!  cross(+X, +Y, +Colour) is det.
%
%   @arg More are attributes as text, a blank before each
%   @arg Anchor is `start`, `middle` or `end`

line(X1, Y1, X2, Y2, Colour, Width, More) :-
    format('<line x1="~1f" y1="~1f" x2="~1f" y2="~1f" stroke="~w" \c
            stroke-width="~w" stroke-linecap="round"~w/>~n',
           [X1, Y1, X2, Y2, Colour, Width, More]).

dot(X, Y, Radius, Fill, Stroke) :-
    format('<circle cx="~1f" cy="~1f" r="~w" fill="~w" stroke="~w"/>~n',
           [X, Y, Radius, Fill, Stroke]).

box(X, Y, Width, Height, Fill, Stroke, StrokeWidth) :-
    format('<rect x="~1f" y="~1f" width="~1f" height="~1f" fill="~w" \c
            stroke="~w" stroke-width="~w"/>~n',
           [X, Y, Width, Height, Fill, Stroke, StrokeWidth]).

cross(X, Y, Colour) :-
    format('<path d="M~1f,~1f l8,8 m0,-8 l-8,8" stroke="~w" \c
            stroke-width="2" fill="none"/>~n', [X-4, Y-4, Colour]).

text(X, Y, Anchor, Text) :-
    escaped(Text, Escaped),
    format('<text x="~1f" y="~1f" text-anchor="~w">~w</text>~n',
           [X, Y, Anchor, Escaped]).

escaped(Text, Escaped) :-
    atom_codes(Text, Codes),
    phrase(escape(Codes), EscapedCodes),
    atom_codes(Escaped, EscapedCodes).

escape([]) --> [].
escape([0'<|Codes]) --> !, `&lt;`, escape(Codes).
escape([0'&|Codes]) --> !, `&amp;`, escape(Codes).
escape([Code|Codes]) --> [Code], escape(Codes).
