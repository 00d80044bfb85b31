:- module(sync_potentials,
          [ potential_steps/3,          % +Delta, +Rewards, -Steps
            draw_potentials/4           % +Directory, +Name, +Title, +Curves
          ]).
:- include('../../agents/sync/potential').
:- use_module('../lib/plot', [colour/2, plot/4, save_columns/2]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(filesex), [directory_file_path/3]).

/** <module> How a potential falls: thesis Figure 5.2

What one agent's drive for one task does, step by step, by the very
predicates that the agents have.  No network is started.

*Threading*: no state; any thread.
*/

%!  potential_steps(+Delta, +Rewards, -Steps) is det.
%
%   Steps is a list of step(N, Potential, Theta), N from 0: the drive that
%   an agent is left with after its N-th visit, and the reward or penalty
%   that it got there.  Visits whose numbers are in Rewards are rewarded,
%   all others penalised with Delta, until the potential is zero.  As in
%   the thesis, a potential begins with 100, a history with 15, and the
%   window holds 15.

potential_steps(Delta, Rewards, [step(0, 100, 15)|Steps]) :-
    steps(1, drive(100, [15]), Delta, Rewards, Steps).

steps(_, drive(Potential, _), _, _, []) :-
    Potential =:= 0,
    !.
steps(N, Drive0, Delta, Rewards, [step(N, Potential, Theta)|Steps]) :-
    (   memberchk(N, Rewards)
    ->  rewarded(Drive0, 100, 15, Theta, Drive)
    ;   penalised(Drive0, 100, 15, Delta, Theta, Drive)
    ),
    Drive = drive(Potential, _),
    N1 is N + 1,
    steps(N1, Drive, Delta, Rewards, Steps).

%!  draw_potentials(+Directory, +Name, +Title, +Curves) is det.
%
%   Write Directory/Name.svg and .png of Curves, a list of
%   curve(Delta, Rewards, Steps).  Where the first one was rewarded is
%   marked.

draw_potentials(Directory, Name, Title, Curves) :-
    forall(nth0(I, Curves, curve(_, _, Steps)),
           save_curve(Directory, Name, I, Steps)),
    plot(Directory, Name, 1000-870, script(Name, Title, Curves)).

save_curve(Directory, Name, I, Steps) :-
    data_name(Name, I, File0),
    directory_file_path(Directory, File0, File),
    maplist([step(N, P, Theta), [N, P, Theta]]>>true, Steps, Rows),
    save_columns(File, Rows).

data_name(Name, I, File) :-
    format(atom(File), '~w-~d.dat', [Name, I]).

script(Name, Title, Curves, Out) :-
    Curves = [curve(_, Rewards, _)|_],
    heading(Out, Title, Rewards),
    forall(nth1(I, Rewards, Step), mark_reward(Out, I, Step)),
    panel(Out, Name, Curves, 0.865-0.535, 2, '0:110',
          'a  Potential of a task', potential),
    format(Out, 'unset key; set xlabel "visits" tc rgb "#333333"~n', []),
    panel(Out, Name, Curves, 0.440-0.085, 3, '0:*',
          'b  Size of the reward or penalty', 'θ'),
    format(Out, 'unset multiplot~n', []).

heading(Out, Title, Rewards) :-
    atomic_list_concat(Rewards, ', ', Text),
    format(Out, 'set multiplot~n\c
set label 1 "{/:Bold=15 ~w}" at screen 0.085,0.968~n\c
set label 2 "{/*0.9 Calculated: θ(0) = 15, ω = 15, P_{max} = 100; \c
rewards at the visits ~w (grey), penalties at all others}" \c
at screen 0.085,0.935 tc rgb "#555555"~n', [Title, Text]),
    format(Out, 'set border 3 lc rgb "#888888"~n\c
set tics nomirror out scale 0.6 tc rgb "#333333"~n\c
set grid ytics lc rgb "#e4e4e4" lt 1 lw 1~n\c
set lmargin at screen 0.085; set rmargin at screen 0.975~n\c
set xrange [0:*]~n', []).

mark_reward(Out, I, Step) :-
    format(Out, 'set arrow ~d from ~w,graph 0 to ~w,graph 1 \c
nohead lw 3 lc rgb "#dddddd" back~n', [I, Step, Step]).

panel(Out, Name, Curves, Top-Bottom, Column, Range, Title, Label) :-
    TitleY is Top + 0.025,
    format(Out, 'set tmargin at screen ~3f; set bmargin at screen ~3f~n\c
set label 3 "~w" at screen 0.085,~3f~n\c
set ylabel "~w" offset 0.5,0 tc rgb "#333333"~n\c
set yrange [~w]~n', [Top, Bottom, Title, TitleY, Label, Range]),
    findall(Part, part(Name, Curves, Column, Part), Parts),
    atomic_list_concat(Parts, ', ', Plot),
    format(Out, 'plot ~w~nunset label~n', [Plot]).

part(Name, Curves, Column, Part) :-
    nth0(I, Curves, curve(Delta, _, Steps)),
    data_name(Name, I, File),
    colour(I, Colour),
    last(Steps, step(Last, _, _)),
    format(atom(Part), '"~w" using 1:~d with lines lw 2 \c
lc rgb "#~|~`0t~16r~6+" title "δ = ~w (0 after ~d)"',
           [File, Column, Colour, Delta, Last]).
