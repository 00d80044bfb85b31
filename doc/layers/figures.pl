:- module(layers_figures, [figures/0]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(readutil), [read_file_to_string/3]).
:- use_module(seams, [kernel_file/1, seam_problem/1]).
:- use_module(tree).

/** <module> Modules, lines and lines per predicate, counted beside the budgets

*Threading*: the main thread.
*/

%   figures is semidet: fails, after all are printed, if a budget is exceeded.

figures :-
    forall(member(Top, ['prolog/typhon', agents, payloads, experiments, app,
                        test, bench]),
           figures(Top)),
    findall(Count-Most, budget_printed(Count, Most), Budgets),
    forall(member(Count-Most, Budgets), Count =< Most).

budget_printed(Count, Most) :-
    budget(Name, Count, Most),
    (   Count > Most
    ->  Note = ' exceeded'
    ;   Note = ''
    ),
    format('~w~t~48|~t~D~9+~t~D~12+~w~n', [Name, Count, Most, Note]).

%   budget(-Name, -Count, -Most): what is counted, and how much is wanted.

budget('lines of the kernel', Count, 20 000) :-
    aggregate_all(sum(N), ( kernel_file(File), file_lines(File, N) ), Count).
budget('files of the kernel', Count, 70) :-
    aggregate_all(count, kernel_file(_), Count).
budget('term nodes of the kernel', Count, 52 000) :-
    aggregate_all(sum(N), ( kernel_file(File), nodes(File, N) ), Count).
budget('files that break the rules of seams', Count, 0) :-
    aggregate_all(count, seam_problem(_), Count).
budget('lines of prolog/, all languages', Count, 68 000) :-
    aggregate_all(sum(N), ( product_file(File), file_lines(File, N) ), Count).
budget('files of prolog/, all languages', Count, 310) :-
    aggregate_all(count, product_file(_), Count).
budget('files of wire/', Count, 16) :-
    aggregate_all(count, layer_module(_, 'kernel/wire', _), Count).
budget('suites that import or call what is internal', Count, 10) :-
    aggregate_all(count, uses_internals(_), Count).
budget('pauses of the processes of tests', Count, 20) :-
    inside('test/', Tests),
    aggregate_all(sum(N), ( pauses(File, N), atom_concat(Tests, _, File) ),
                  Count).

%   Written by us: what npm brings is left out.

product_file(File) :-
    inside(prolog, Dir),
    directory_member(Dir, File, [ recursive(true),
                                  extensions([pl, js, css, html]) ]),
    \+ sub_atom(File, _, _, _, '.min.').

%   A module of a layer, but for its interface, is internal. kernel/base has
%   no interface: the modules there are tools, which are tested one by one. So
%   may be modules that hold no state: their exports are functions. What a
%   module does not export is internal, unless it is a hook.

uses_internals(Suite) :-
    inside('test/', Tests),
    tree_file(Suite),
    atom_concat(Tests, _, Suite),
    file_base_name(Suite, Base),
    atom_concat(test_, _, Base),
    once(( imports_internal(Suite) ; calls_internal(Suite) )).

imports_internal(Suite) :-
    import(Suite, File, _),
    layer_module(File, Layer, _),
    Layer \== 'kernel/base',
    holds_state(File).

calls_internal(Suite) :-
    reaches(Suite, Module, Name/Arity),
    Arity > 0,                          % settings are named like predicates
    Name \== '[|]',                     % Module:List
    module_of(File, Module),
    inside('prolog/', Product),
    atom_concat(Product, _, File),
    \+ declares(_, Module:Name/Arity),
    \+ ( offered(File, all, Name/More), More >= Arity ).

holds_state(File) :-
    (   stores(File, _)
    ;   member(Name, [ nb_setval, b_setval, flag, with_mutex,
                       message_queue_create, thread_create ]),
        mentions(File, Name)
    ),
    !.

figures(Top) :-
    inside(Top, Dir),
    atom_concat(Dir, /, Start),
    findall(Lines, predicate_lines(Start, Lines), All0),
    msort(All0, All),
    length(All, Count),
    findall(N, ( tree_file(File), atom_concat(Start, _, File),
                 file_lines(File, N) ), Files),
    length(Files, Modules),
    sum(Files, Total),
    quantile(0.5, All, Count, Median),
    quantile(0.9, All, Count, Most),
    quantile(1, All, Count, Longest),
    format('~w~t~16|~d files ~D lines ~D predicates; lines of each: \c
            median ~d, 90 % ~d, longest ~d~n',
           [Top, Modules, Total, Count, Median, Most, Longest]).

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
