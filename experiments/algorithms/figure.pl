:- module(algorithms_figure,
          [ draw_algorithms/4           % +Figure, +Directory, +Options,
                                        % +CaseRuns
          ]).
:- use_module('../lib/chart', [draw_chart/3]).
:- use_module(cases, [case_name/2, figure/2]).
:- use_module(metrics, [measure/3]).
:- use_module(library(lists), [member/2, nth1/3, numlist/3]).
:- use_module(library(option), [option/2]).

/** <module> Cases beside each other

*Threading*: no state; any thread.
*/

%!  draw_algorithms(+Figure, +Directory, +Options, +CaseRuns) is det.
%
%   Write Directory/algorithms-Figure.svg and .png.  CaseRuns are pairs
%   Case-Runs, Runs pairs Seed-Result.

draw_algorithms(Figure, Directory, Options, CaseRuns) :-
    figure(Figure, Title),
    length(CaseRuns, Count),
    numlist(1, Count, Ticks),
    findall(panel(Text, Unit, Series),
            ( panel(Figure, What, Text, Unit),
              series(What, CaseRuns, Series) ),
            Panels),
    option(runs(Runs), Options),
    option(clock(Clock), Options),
    format(atom(Subtitle), '10 hosts, ~w runs of each, clock ~w',
           [Runs, Clock]),
    atom_concat('algorithms-', Figure, Name),
    draw_chart(Directory, Name,
               [ title(Title), subtitle(Subtitle), x('case'),
                 panels(Panels), ticks(Ticks) ]).

panel(settings, pages, 'Pages printed until the last agent has reached the \c
goal', pages).
panel(settings, mean, 'Executions of an agent', executions).
panel(islands, pages, 'Pages printed until the last agent has reached the \c
goal', pages).
panel(islands, mean, 'Executions of an agent', executions).
panel(mixed, reached, 'Agents that have reached the goal', percent).
panel(mixed, executions, 'Executions of all agents', executions).
panel(exchange, reached, 'Agents that have reached the goal', percent).
panel(exchange, executions, 'Executions of all agents', executions).
panel(cloning, mean, 'Executions of an agent of the first ones', executions).
panel(cloning, executions, 'Executions of all agents', executions).
panel(cloning, most, 'Agents at most', agents).

%   A measure that no run of a case has leaves its place empty.

series(What, CaseRuns, Series) :-
    findall(series(Name, Index, [X-Values], none),
            ( nth1(X, CaseRuns, Case-Runs),
              case_name(Case, Name),
              findall(Value, ( member(_-Result, Runs),
                               measure(What, Result, Value) ),
                      Values),
              Values \== [],
              Index is X - 1 ),
            Series).
