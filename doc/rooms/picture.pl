:- module(rooms_picture, [picture/0]).
:- use_module(library(lists), [member/2]).
:- use_module(tree).

/** <module> Who imports whom, for dot(1)

*Threading*: the main thread.
*/

picture :-
    format('digraph typhon {~n'),
    format('  rankdir=TB; nodesep=0.15; ranksep=0.35; compound=true;~n'),
    format('  node [shape=box, style="filled,rounded", fontname=Helvetica, \c
            fontsize=11, height=0.3, color="#888888"];~n'),
    format('  edge [color="#777777", arrowsize=0.6];~n'),
    forall(( room(_, Layer, Name), colour(Layer, Colour) ),
           format('  "~w" [fillcolor="~w"];~n', [Name, Colour])),
    forall(arrow(From, To),
           format('  "~w" -> "~w";~n', [From, To])),
    format('}~n').

colour(base,      '#f4f4f4').
colour(program,   '#d6e4f5').
colour(journal,   '#dce6f0').
colour(wire,      '#e6dcf0').
colour(host,      '#dcedc8').
colour(agent,     '#fdf3c8').
colour(travel,    '#f9e2ae').
colour(lifecycle, '#fbd9b5').
colour(language,  '#f6cfc7').
colour(network,   '#fbe3d0').
colour(people,    '#eeeeee').

%   Through doors one sees the rooms behind them.

arrow(From, To) :-
    setof(F-T, pair(F, T), Pairs),
    member(From-To, Pairs).

pair(From, To) :-
    room(File, Layer, From),
    colour(Layer, _),
    import(File, Target, List),
    behind(Target, List, Room),
    room(Room, Layer2, To),
    colour(Layer2, _),
    From \== To.

behind(Room, _, Room) :-
    room(Room, _, _).
behind(Door, List, Room) :-
    door(Door, _),
    is_list(List),
    member(PI, List),
    reexport(Door, Room0, Offered),
    offered(Room0, Offered, PI),
    owner(Room0, PI, Room).

owner(Room, PI, Owner) :-
    (   export(Room, PI)
    ->  Owner = Room
    ;   reexport(Room, Deeper, List),
        offered(Deeper, List, PI)
    ->  owner(Deeper, PI, Owner)
    ).
