:- module(learning_sheet,
          [ draw_sheet/4                % +Directory, +Name, +Sheet, +Panels
          ]).
:- use_module('../lib/plot', [plot/4, save_columns/2]).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth1/3]).

/** <module> Panels side by side, each of several layers

*Threading*: no state; any thread.
*/

%!  draw_sheet(+Directory, +Name, +Sheet, +Panels) is det.
%
%   Write Directory/Name.svg and .png, and their data.  Sheet has
%   title(Text), subtitle(Text) and box(Width-Height), the size of a panel
%   in pixels.  Panels are, from the left, terms panel(Title, Settings,
%   Layers): Settings is a list of gnuplot commands, Layers of
%   layer(Rows, Style), Rows being numbers as for save_columns/2, and Style
%   what follows the name of the file in the command `plot`.  Layers
%   without rows are left out.

draw_sheet(Directory, Name, Sheet, Panels) :-
    forall(( nth1(P, Panels, panel(_, _, Layers)),
             nth1(L, Layers, layer(Rows, _)) ),
           ( data_name(Name, P, L, File0),
             directory_file_path(Directory, File0, File),
             save_columns(File, Rows) )),
    length(Panels, Count),
    memberchk(box(Width-Height), Sheet),
    W is 20 + Count*(Width + 75),
    H is Height + 160,
    plot(Directory, Name, W-H, script(Name, Sheet, Panels, W-H)).

data_name(Name, P, L, File) :-
    format(atom(File), '~w-~d-~d.dat', [Name, P, L]).

script(Name, Sheet, Panels, Size, Out) :-
    heading(Out, Sheet, Size),
    forall(nth1(P, Panels, Panel), panel(Out, Name, Sheet, Size, P, Panel)),
    format(Out, 'unset multiplot~n', []).

heading(Out, Sheet, W-H) :-
    memberchk(title(Title), Sheet),
    memberchk(subtitle(Subtitle), Sheet),
    X is 75/W,
    Y1 is 1 - 26/H,
    Y2 is 1 - 54/H,
    format(Out, 'set multiplot~n\c
set label 1 "{/:Bold=15 ~w}" at screen ~4f,~4f~n\c
set label 2 "{/*0.9 ~w}" at screen ~4f,~4f tc rgb "#555555"~n\c
set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n',
           [Title, X, Y1, Subtitle, X, Y2]).

panel(Out, Name, Sheet, W-H, P, panel(Title, Settings, Layers)) :-
    memberchk(box(Width-Height), Sheet),
    Left is (75 + (P - 1)*(Width + 75))/W,
    Right is Left + Width/W,
    Top is 1 - 100/H,
    Bottom is Top - Height/H,
    TitleY is Top + 14/H,
    format(Out, 'set lmargin at screen ~5f; set rmargin at screen ~5f~n\c
set tmargin at screen ~5f; set bmargin at screen ~5f~n\c
set label 3 "~w" at screen ~5f,~5f~n',
           [Left, Right, Top, Bottom, Title, Left, TitleY]),
    forall(member(Setting, Settings), format(Out, '~w~n', [Setting])),
    findall(Part, part(Name, P, Layers, Part), Parts),
    atomic_list_concat(Parts, ', ', Plot),
    format(Out, 'plot ~w~nunset label~n', [Plot]).

part(Name, P, Layers, Part) :-
    nth1(L, Layers, layer([_|_], Style)),
    data_name(Name, P, L, File),
    format(atom(Part), '"~w" ~w', [File, Style]).
