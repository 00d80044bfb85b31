:- module(rooms_figures, [figures/0]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(tree).

/** <module> Rooms, lines and lines per predicate, counted

*Threading*: the main thread.
*/

figures :-
    forall(member(Top, ['prolog/typhon', agents, payloads, experiments, app,
                        test, bench]),
           figures(Top)).

figures(Top) :-
    inside(Top, Dir),
    atom_concat(Dir, /, Start),
    findall(Lines, predicate_lines(Start, Lines), All0),
    msort(All0, All),
    length(All, Count),
    findall(N, ( tree_file(File), atom_concat(Start, _, File),
                 file_lines(File, N) ), Files),
    length(Files, Rooms),
    sum(Files, Total),
    quantile(0.5, All, Count, Median),
    quantile(0.9, All, Count, Most),
    quantile(1, All, Count, Longest),
    format('~w~t~16|~d files ~D lines ~D predicates; lines of each: \c
            median ~d, 90 % ~d, longest ~d~n',
           [Top, Rooms, Total, Count, Median, Most, Longest]).

predicate_lines(Start, Lines) :-
    aggregate_all(bag(File-PI), ( size(File, PI, _, _),
                                  atom_concat(Start, _, File) ), Bag),
    sort(Bag, Set),
    member(File-PI, Set),
    aggregate_all(sum(L-F+1), size(File, PI, F, L), Lines).

file_lines(File, N) :-
    read_file_to_string(File, Text, []),
    split_string(Text, "\n", "", Lines),
    length(Lines, N0),
    N is N0-1.

sum(List, Sum) :-
    aggregate_all(sum(X), member(X, List), Sum).

quantile(Q, Sorted, Count, X) :-
    Index is max(1, ceiling(Q*Count)),
    nth1(Index, Sorted, X).
