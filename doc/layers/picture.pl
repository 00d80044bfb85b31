:- module(layers_picture, [picture/0]).
:- use_module(library(lists), [member/2]).
:- use_module(tree).

/** <module> Which module imports which, for dot(1)

*Threading*: the main thread.
*/

picture :-
    format('digraph typhon {~n'),
    format('  rankdir=TB; nodesep=0.15; ranksep=0.35; compound=true;~n'),
    format('  node [shape=box, style="filled,rounded", fontname=Helvetica, \c
            fontsize=11, height=0.3, color="#888888"];~n'),
    format('  edge [color="#777777", arrowsize=0.6];~n'),
    forall(node(Name, Colour),
           format('  "~w" [fillcolor="~w"];~n', [Name, Colour])),
    forall(arrow(From, To),
           format('  "~w" -> "~w";~n', [From, To])),
    format('}~n').

colour('kernel/base',      '#f4f4f4').
colour('kernel/program',   '#d6e4f5').
colour('options/journal',   '#dce6f0').
colour('kernel/wire',      '#e6dcf0').
colour('kernel/host',      '#dcedc8').
colour('kernel/agent',     '#fdf3c8').
colour('kernel/travel',    '#f9e2ae').
colour('kernel/lifecycle', '#fbd9b5').
colour('kernel/vocabulary',  '#f6cfc7').
colour(language,   '#c3d7ee').
colour('language/chunks',   '#c3d7ee').
colour(network,   '#fbe3d0').
colour(tools,    '#eeeeee').

node(Name, Colour) :-
    setof(N-C, File^Layer^( layer_module(File, Layer, N), colour(Layer, C) ),
          Nodes),
    member(Name-Colour, Nodes).

%   An import from an interface is one from the modules behind it.

arrow(From, To) :-
    setof(F-T, pair(F, T), Pairs),
    member(From-To, Pairs).

pair(From, To) :-
    layer_module(File, Layer, From),
    colour(Layer, _),
    import(File, Target, List),
    behind(Target, List, Module),
    layer_module(Module, Layer2, To),
    colour(Layer2, _),
    From \== To.

behind(Module, _, Module) :-
    layer_module(Module, _, _).
behind(Interface, List, Module) :-
    interface(Interface, _),
    is_list(List),
    member(PI, List),
    reexport(Interface, Module0, Offered),
    offered(Module0, Offered, PI),
    owner(Module0, PI, Module).

owner(Module, PI, Owner) :-
    (   export(Module, PI)
    ->  Owner = Module
    ;   reexport(Module, Deeper, List),
        offered(Deeper, List, PI)
    ->  owner(Deeper, PI, Owner)
    ).
