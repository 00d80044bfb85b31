:- module(sync_pictures,
          [ draw_picture/5              % +Figure, +Dir, +Data, +First, +Options
          ]).
:- use_module('../lib/chart', [draw_chart/3]).
:- use_module(figure, [draw_figure/3]).
:- use_module(gallery, [draw_gallery/4]).
:- use_module(potentials, [draw_potentials/4]).
:- use_module(scenarios, [figure/2, topology/4]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2, memberchk/2, nth0/3]).
:- use_module(library(option), [option/2]).

/** <module> The pictures of thesis chapter 5

*Threading*: no state; any thread.
*/

%!  draw_picture(+Figure, +Directory, +Data, +First, +Options) is det.
%
%   Write the picture of Figure, `figure-` and its number, as .svg and .png
%   in Directory.  Data is as in statements/3.  First is a list of
%   Key-Result: the run with the first seed, for figures that show a run.
%   Options are those that all runs share.

draw_picture('5.2', Directory, Curves, _, _) :-
    !,
    names('5.2', Name, Title),
    draw_potentials(Directory, Name, Title, Curves).
draw_picture(Figure, Directory, Data, First, Options) :-
    item_titles(Figure, Titles),
    !,
    names(Figure, Name, Title),
    subtitle(Options, '', Common),
    option(seed(Seed), Options),
    what_it_shows(Figure, Shows),
    format(atom(Subtitle), '~w; ~w, seed ~w', [Shows, Common, Seed]),
    findall(item(Key, Text, Result),
            ( member(Key-Text0, Titles),
              memberchk(Key-Result, First),
              memberchk(Key-[Run|_], Data),
              came_of_it(Run, Outcome),
              format(atom(Text), '{/:Bold ~w}   ~w', [Text0, Outcome])
            ),
            Items),
    draw_gallery(Directory, Name, [title(Title), subtitle(Subtitle)], Items).
draw_picture('5.8', Directory, _, [_-Result], Options) :-
    !,
    names('5.8', Name, Title),
    option(clock(Rate), Options),
    option(hop_time(Min-Max), Options),
    option(seed(Seed), Options),
    format(atom(Subtitle), 'Grid of 60 hosts, 10 agents, δ = 0.5, tasks \c
as in Table 5.2 (T1 0.5–1.4 s … T6 6–8 s), hop ~w–~w s, \c
host clock ×~w, seed ~w', [Min, Max, Rate, Seed]),
    draw_figure(Directory, Name, [title(Title), subtitle(Subtitle)|Result]).
draw_picture(Figure, Directory, Data, _, Options) :-
    names(Figure, Name, Title),
    chart(Figure, X, What, Measures),
    option(runs(Runs), Options),
    format(atom(Before), '~w~d runs of each; ', [What, Runs]),
    subtitle(Options, Before, Subtitle),
    lines(Figure, Lines),
    maplist(panel(Data, Lines), Measures, Panels),
    draw_chart(Directory, Name, [ title(Title), subtitle(Subtitle), x(X),
                                  panels(Panels) ]).

names(Figure, Name, Title) :-
    figure(Figure, Text),
    atom_concat('figure-', Figure, Name),
    format(atom(Title), 'Figure ~w: ~w', [Figure, Text]).

subtitle(Options, What, Text) :-
    option(hop_time(Min-Max), Options),
    option(task_time(Time), Options),
    option(clock(Rate), Options),
    format(atom(Text), '~whop ~w–~w s, tasks ~w s, host clock ×~w',
           [What, Min, Max, Time, Rate]).

                /*******************************
                *             RUNS             *
                *******************************/

item_titles('5.5', Titles) :-
    letters(['a, b', 'c, d', 'e, f', 'g, h'], Titles).
item_titles('5.11', Titles) :-
    letters([a, b, c, d], Titles).
item_titles('5.12', [ grid-'a  Grid (δ = 0.5)',
                      dynamic_2-'b  Dynamic II (δ = 0.2)' ]).

letters(Letters, Titles) :-
    findall(Name-Text,
            ( nth0(I, Letters, Letter),
              nth0(I, [star_bus, ring, tree, grid], Name),
              topology(Name, Title, _, Delta),
              format(atom(Text), '~w  ~w (δ = ~w)', [Letter, Title, Delta])
            ),
            Titles).

%   came_of_it(+Run, -Text): what is worth saying of a run in its title.

came_of_it(Run, Text) :-
    memberchk(failed_at(From), Run),
    !,
    memberchk(healed_at(To), Run),
    memberchk(lost(Lost), Run),
    memberchk(redone(Redone), Run),
    memberchk(healing_tau(Tau), Run),
    Seconds is To - From,
    format(atom(Text), '~d of ~d lost executions done again in ~1f s, \c
{/:Italic τ} = ~d meanwhile', [Redone, Lost, Seconds, Tau]).
came_of_it(Run, Text) :-
    memberchk(idle(Idle), Run),
    memberchk(overlaps(Overlaps), Run),
    memberchk(tau(Tau), Run),
    format(atom(Text), '~1f s idle, ~d overlapped executions, \c
{/:Italic τ} at most ~d', [Idle, Overlaps, Tau]).

what_it_shows('5.5', 'Left: executions switched on in each second; right: \c
required (light) and executed (full colour)').
what_it_shows('5.11', '20 hosts lose T2 when T5 begins (dashed); left: \c
executions switched on; right: required and executed').
what_it_shows('5.12', 'All hosts lose T2 and later tasks when T5 begins \c
(dashed); left: switched on; right: required and executed').

                /*******************************
                *            CHARTS            *
                *******************************/

%   chart(?Figure, -XLabel, -What, -Measures)

chart('5.6', 'penalty bias δ',
      '10 agents, 60 hosts; circles: best δ of the thesis; ',
      [idle, overlaps]).
chart('5.7a', 'agents', '60 hosts, best δ of the thesis for each topology; ',
      [idle, overlaps]).
chart('5.7b', 'hosts', '10 agents, best δ of the thesis for each topology; ',
      [idle, overlaps]).
chart('5.9', 'agents', '60 hosts, δ = 0.2; ', [idle, overlaps]).
chart('5.10', 'agents', '60 hosts, δ = 0.2; ', [total]).

%   lines(+Figure, -Lines): line(Key, Label, Marked).

lines('5.6', Lines) :-
    !,
    findall(line(Name, Title, Delta), topology(Name, Title, _, Delta), Lines).
lines(Figure, Lines) :-
    memberchk(Figure, ['5.9', '5.10']),
    !,
    Lines = [ line(dynamic_1, 'Dynamic I', none),
              line(dynamic_2, 'Dynamic II', none) ].
lines(_, Lines) :-
    findall(line(Name, Title, none), topology(Name, Title, _, _), Lines).

panel(Data, Lines, Measure, panel(Title, YLabel, Series)) :-
    measure(Measure, Title, YLabel),
    Term =.. [Measure, Value],
    findall(series(Label, I, Points, Marked),
            ( nth0(I, Lines, line(Key, Label, Marked)),
              findall(X-Values,
                      ( member(Key-X-Runs, Data),
                        findall(Value,
                                ( member(Run, Runs), memberchk(Term, Run) ),
                                Values) ),
                      Points)
            ),
            Series).

measure(idle, 'Idle time between the tasks, in all \c
(line: median, bars: least and greatest run)', 'host seconds').
measure(overlaps, 'Overlapped executions', 'executions').
measure(total, 'Time until all tasks are completed everywhere \c
(line: median, bars: least and greatest run)', 'host seconds').
