:- module(experiment_plot,
          [ plot/3,                     % +Directory, +Name, :Script
            plot/4,                     % +Directory, +Name, +Size, :Script
            colour/2,                   % +Index, -Colour
            lighten/2,                  % +Colour, -Light
            save_columns/2              % +File, +Rows
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3]).

/** <module> Figures by gnuplot

A figure is a gnuplot script and its data files in one directory.  It is
drawn twice, as SVG and as PNG.  The script stays beside the pictures, so
that a figure can be changed without running the experiment again.

*Threading*: no state; any thread.
*/

:- meta_predicate
    plot(+, +, 1),
    plot(+, +, +, 1).

%!  plot(+Directory, +Name, :Script) is det.
%!  plot(+Directory, +Name, +Size, :Script) is det.
%
%   Draw Directory/Name.svg and Directory/Name.png by the script that
%   call(Script, Stream) writes.  Size is Width-Height in pixels, default
%   1200-1000.  The script names its data files relative
%   to Directory, and sets no terminal and no output.  Where gnuplot is
%   missing or fails, this is printed, and the script remains.

plot(Directory, Name, Script) :-
    plot(Directory, Name, 1200-1000, Script).

plot(Directory, Name, Size, Script) :-
    file_name_extension(Name, gnuplot, ScriptName),
    directory_file_path(Directory, ScriptName, ScriptFile),
    setup_call_cleanup(
        open(ScriptFile, write, Out, [encoding(utf8)]),
        call(Script, Out),
        close(Out)),
    catch(forall(member(Format, [svg, png]),
                 draw(Format, Size, Directory, Name, ScriptName)),
          error(Formal, _),
          print_message(warning, experiment_plot(Formal))).

draw(Format, Size, Directory, Name, ScriptName) :-
    file_name_extension(Name, Format, Picture),
    terminal(Format, Size, Terminal),
    format(atom(Commands),
           'set terminal ~w; set output "~w"; load "~w"; unset output',
           [Terminal, Picture, ScriptName]),
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
%   Colours 0 to 5, as numbers 0xRRGGBB.  They can be told apart by people
%   who see colours differently.

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

%!  save_columns(+File, +Rows) is det.
%
%   Write rows of numbers as a data file of gnuplot.  An atom `gap` instead
%   of a row is an empty line.

save_columns(File, Rows) :-
    setup_call_cleanup(
        open(File, write, Out),
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
    (   float(Number)
    ->  format(atom(Text), '~4f', [Number])
    ;   Text = Number
    ).

                /*******************************
                *           MESSAGES           *
                *******************************/

:- multifile prolog:message//1.

prolog:message(experiment_plot(Formal)) -->
    [ 'No picture was drawn by gnuplot: ~p'-[Formal], nl,
      'The data and the script of the figure are there; \c
       try: apt-get install gnuplot-nox'-[] ].
