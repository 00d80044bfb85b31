%   Final paths and plans of single runs: measures and pictures.
%
%   Expects: ground, and the parameters `network` and `sharing`.

:- use_module('../engine/gnuplot', [colour/2]).
:- use_module(maze, [maze_path/3, maze_walls/2]).
:- use_module(metrics, [first_executions/2, mean/2, overlap/2, spread/2]).
:- use_module(ways, [distance/3, nearer/4, random_ways/3]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists),
              [append/3, member/2, memberchk/2, nth0/3, nth1/3]).

label(distinct, "Distinct final paths").
label(overlap, "Overlap of final paths").
label(spread, "Deviation of the lengths of plans, relative to their mean").
label(aside, "Final paths: mean distance from diagonal, or wall").
label(nearer, "Shortest paths that are nearer (%)").

measure(agents, View, Count) :-
    length(View.learners, Count).
measure(distinct, View, Count) :-
    ways(View, Ways0),
    maplist(sort, Ways0, Ways),
    sort(Ways, Set),
    length(Set, Count).
measure(overlap, View, Overlap) :-
    ways(View, Ways),
    overlap(Ways, Overlap).
measure(spread, View, Share) :-
    spread(View.learners, Share).
measure(aside, View, Mean) :-
    aside(View, _, Mean).
measure(nearer, View, Percent) :-
    aside(View, Line, Mean),
    settings(View.case, Settings),
    random_ways(Settings, 200, Ways),
    nearer(Line, Ways, Mean, Share),
    Percent is 100*Share.
measure(detour, View, Moves) :-
    ways(View, Ways),
    findall(More, ( member(Way, Ways), length(Way, Cells),
                    More is Cells - 1 - 2*View.case.size ), All),
    mean(All, Moves).
measure(final, View, Ways) :-
    ways(View, Ways).
measure(moves, View, Moves) :-
    settings(View.case, Settings),
    first_executions(View.events, Agents),
    findall(Set,
            ( member(Agent, Agents),
              findall(Move, tried(View.events, Settings, Agent, Move), All),
              sort(All, Set) ),
            Moves).
measure(plans, View, Plans) :-
    findall(Lengths-Final,
            ( member(learner(Lengths, _, converged(_, _, Actions)),
                     View.learners),
              length(Actions, Final) ),
            Plans).

ways(View, Ways) :-
    settings(View.case, Settings),
    findall(Way,
            ( member(learner(_, _, converged(_, _, Actions)), View.learners),
              maze_path(Settings, Actions, Way) ),
            Ways).

aside(View, Line, Mean) :-
    line(View.case, Line),
    ways(View, Ways),
    findall(D, ( member(Way, Ways), distance(Line, Way, D) ), Ds),
    mean(Ds, Mean).

line(Case, Line) :-
    (   Case.network == obstacle
    ->  settings(Case, Settings),
        memberchk(obstacles-[(X,_)-(X,Top)], Settings),
        Line = wall(X, Top)
    ;   Line = diagonal(Case.size)
    ).

%   A move between two cells counts once in either direction.

tried(Events, Settings, Agent, Move) :-
    member(event(_, _, _, tried(Agent, Actions)), Events),
    maze_path(Settings, Actions, Cells),
    append(_, [A, B|_], Cells),
    msort([A, B], Move).

                /*******************************
                *           PICTURES           *
                *******************************/

%   mazes(+Cases, -Picture), lengths(+Cases, -Picture): Cases, drawn side by
%   side, are pairs Title-Where; Moves is `moves` or `none`.

mazes(Name, Cases, Moves,
      script('mazes.gp',
             [ Final-rows(final, Cases), All-rows(Moves, Cases),
               Walls-walls(Cases) ],
             [ seed(first), size(1270, 720),
               variables(panels(Cases)) ])) :-
    maplist(atom_concat(Name), ['-final', '-moves', '-walls'],
            [Final, All, Walls]).

lengths(Name, Cases,
        script('lengths.gp',
               [Plans-rows(plans, Cases), Ends-rows(ends, Cases)],
               [ seed(first), size(1270, 580),
                 variables(panels(Cases)) ])) :-
    maplist(atom_concat(Name), ['-plans', '-ends'], [Plans, Ends]).

%   rows(+What, +Cases, +Runs, -Rows): a block for each agent of each case.

rows(What, Cases, Runs, Rows) :-
    findall(Block,
            ( member(_-Where, Cases),
              case_run(Where, Runs, Case, Measures),
              agents(Case, Count),
              nth_agent(Count, Index),
              block(What, Index, Count, Measures, Block) ),
            Blocks),
    blocks(Blocks, Rows).

blocks(Blocks, Rows) :-
    findall(Row,
            ( member(Block, Blocks),
              ( member(Row, Block)
              ; Block == [], Row = ['NaN', 'NaN', 'NaN', 'NaN']
              ; member(Row, [gap, gap]) ) ),
            Rows).

case_run(Where, Runs, Case, Measures) :-
    member(run(Case, _, Measures), Runs),
    forall(member(Name=Value, Where), get_dict(Name, Case, Value)),
    !.

nth_agent(Count, Index) :-
    Last is Count - 1,
    between(0, Last, Index).

%   Lines of different agents are shifted a little, so that agents on the same
%   path remain visible.

block(none, _, _, _, []).
block(final, Index, Count, Measures, Rows) :-
    nth0(Index, Measures.final, Way),
    shift(Index, Count, Shift),
    findall([X, Y], ( member(X0-Y0, Way), X is X0 + Shift, Y is Y0 + Shift ),
            Rows).
block(moves, Index, Count, Measures, Rows) :-
    nth0(Index, Measures.moves, Moves),
    shift(Index, Count, Shift),
    findall([X, Y, DX, DY],
            ( member([X1-Y1, X2-Y2], Moves),
              X is X1 + Shift, Y is Y1 + Shift, DX is X2 - X1, DY is Y2 - Y1 ),
            Rows).
block(plans, Index, _, Measures, Rows) :-
    nth0(Index, Measures.plans, Lengths-_),
    findall([I, Length], nth1(I, Lengths, Length), Rows).
block(ends, Index, _, Measures, [[Count, Final]]) :-
    nth0(Index, Measures.plans, Lengths-Final),
    length(Lengths, Count).

shift(Index, Count, Shift) :-
    Shift is (Index - (Count - 1)/2) * 0.7/Count.

walls(Cases, Runs, Rows) :-
    findall(Block,
            ( member(_-Where, Cases),
              case_run(Where, Runs, Case, _),
              settings(Case, Settings),
              maze_walls(Settings, Cells),
              findall([X, Y], member(X-Y, Cells), Block) ),
            Blocks),
    blocks(Blocks, Rows).

panels(Cases, Runs, [ 'SEED'-Seed, 'SIZE'-Size, agents-Agents,
                      panels-Panels, 'Panel'-Titles, 'Colour'-Colours ]) :-
    Runs = [run(Case, Seed, _)|_],
    get_dict(size, Case, Size),
    agents(Case, Agents),
    length(Cases, Panels),
    findall(Text,
            ( member(Title-Where, Cases),
              case_run(Where, Runs, _, Measures),
              format(atom(Text), '~w: overlap ~2f, ~1f executions per agent',
                     [Title, Measures.overlap, Measures.executions]) ),
            Titles),
    findall(Colour, ( nth_agent(Agents, I), N is I mod 6, colour(N, Colour) ),
            Colours).
