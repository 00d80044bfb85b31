:- module(study_gnuplot,
          [ plot/3,                     % +Directory, +Name, +Size
            colour/2,                   % +Index, -Colour
            lighten/2,                  % +Colour, -Light
            plain_text/2,               % +Text, -Plain
            save_columns/2,             % +File, +Rows
            save_variables/2            % +File, +Pairs
          ]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- autoload(library(process), [process_create/3]).

/** <module> gnuplot

A figure is Name.gnuplot, a script, and its data files in one directory.
It is drawn twice, as SVG and as PNG.

*Threading*: no state; any thread.
*/

:- multifile prolog:message//1.

%!  plot(+Directory, +Name, +Size) is det.
%
%   Draws Directory/Name.svg and Directory/Name.png by Directory/Name.gnuplot.
%   Size is Width-Height in pixels.  If gnuplot is missing or fails, a warning
%   is printed, and the script remains.

plot(Directory, Name, Size) :-
    catch(forall(member(Format, [svg, png]),
                 draw(Format, Size, Directory, Name)),
          error(Formal, _),
          print_message(warning, study_plot(Formal))).

draw(Format, Size, Directory, Name) :-
    file_name_extension(Name, Format, Picture),
    file_name_extension(Name, gnuplot, Script),
    terminal(Format, Size, Terminal),
    format(atom(Commands),
           'set terminal ~w; set output "~w"; load "~w"; unset output',
           [Terminal, Picture, Script]),
    process_create(path(gnuplot), ['-e', Commands],
                   [cwd(Directory), stdin(null), stdout(null)]).

terminal(svg, W-H, Terminal) :-
    format(atom(Terminal), 'svg size ~d,~d enhanced \c
font "DejaVu Sans,15" background rgb "white"', [W, H]).
terminal(png, W-H, Terminal) :-
    format(atom(Terminal), 'pngcairo size ~d,~d enhanced \c
font "DejaVu Sans,12"', [W, H]).

%!  colour(+Index, -Colour) is semidet.
%
%   Colours 0 to 5, as numbers 0xRRGGBB, which colour-blind people can
%   distinguish, too.

colour(0, 0x4477aa).
colour(1, 0xee6677).
colour(2, 0x228833).
colour(3, 0xccbb44).
colour(4, 0x66ccee).
colour(5, 0xaa3377).

%!  lighten(+Colour, -Light) is det.
%
%   Light is a pale form of Colour.

lighten(Colour, Light) :-
    R is 255 - (255 - (Colour >> 16)) // 4,
    G is 255 - (255 - ((Colour >> 8) /\ 255)) // 4,
    B is 255 - (255 - (Colour /\ 255)) // 4,
    Light is R << 16 \/ G << 8 \/ B.

%!  plain_text(+Text, -Plain:atom) is det.
%
%   Plain is Text with an escape before characters that have a meaning in
%   gnuplot, such as `_` for a subscript.

plain_text(Text, Plain) :-
    format(codes(Codes), '~w', [Text]),
    foldl(plain_code, Codes, Escaped, []),
    atom_codes(Plain, Escaped).

plain_code(Code, [0'\\, Code|Codes], Codes) :-
    memberchk(Code, `\\_^{}@&~`),
    !.
plain_code(Code, [Code|Codes], Codes).

%!  save_columns(+File, +Rows) is det.
%
%   Writes rows of numbers and texts as a data file of gnuplot.  An atom
%   `gap` instead of a row is an empty line.

save_columns(File, Rows) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Row, Rows), save_row(Out, Row)),
        close(Out)).

save_row(Out, gap) :-
    !,
    nl(Out).
save_row(Out, Row) :-
    maplist(column, Row, Columns),
    atomic_list_concat(Columns, ' ', Line),
    format(Out, '~w~n', [Line]).

column(Number, Text) :-
    float(Number),
    !,
    format(atom(Text), '~10g', [Number]).
column(Value, Text) :-
    (   string(Value)
    ;   atom(Value),
        sub_atom(Value, _, _, _, ' ')
    ),
    !,
    format(atom(Text), '"~w"', [Value]).
column(Value, Value).

%!  save_variables(+File, +Pairs) is det.
%
%   Writes a script that sets gnuplot variables: numbers, texts, and lists of
%   these as arrays.  The pair load-Script ends it.

save_variables(File, Pairs) :-
    setup_call_cleanup(
        open(File, write, Out, [encoding(utf8)]),
        forall(member(Name-Value, Pairs), save_variable(Out, Name, Value)),
        close(Out)).

save_variable(Out, load, Script) :-
    !,
    format(Out, 'load "~w"~n', [Script]).
save_variable(Out, Name, Values) :-
    is_list(Values),
    !,
    length(Values, Count),
    maplist(literal, Values, Literals),
    atomic_list_concat(Literals, ', ', Text),
    format(Out, 'array ~w[~d] = [~w]~n', [Name, Count, Text]).
save_variable(Out, Name, Value) :-
    literal(Value, Literal),
    format(Out, '~w = ~w~n', [Name, Literal]).

literal(Value, Value) :-
    number(Value),
    !.
literal(Value, Literal) :-
    format(codes(Codes), '~w', [Value]),
    foldl(literal_code, Codes, Escaped, []),
    format(atom(Literal), '"~s"', [Escaped]).

literal_code(0'\n, [0'\\, 0'n|Codes], Codes) :-
    !.
literal_code(Code, [0'\\, Code|Codes], Codes) :-
    memberchk(Code, `\\"`),
    !.
literal_code(Code, [Code|Codes], Codes).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(study_plot(Formal)) -->
    [ 'No picture was drawn by gnuplot: ~p'-[Formal], nl,
      'The data and the script of the figure are saved; \c
try: apt-get install gnuplot-nox'-[] ].
