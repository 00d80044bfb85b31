:- module(rooms, []).

/** <module> The house, looked at as a whole

    swipl doc/rooms.pl -- check
    swipl doc/rooms.pl -- picture | tred | dot -Tsvg > doc/img/rooms.svg
    swipl doc/rooms.pl -- figures

`check` says what is not in order, and fails if anything is:

  - an import that is not used, in any file of the tree;
  - an export of a room, or of a door, that nobody uses;
  - an import against the layers: a room takes from its own folder, from
    base, and from the doors of lower layers;
  - a call past a door: Module:Goal into another room;
  - rooms that import each other in a circle.

`picture` draws who imports whom (tred leaves out what follows from other
arrows), `figures` counts rooms, lines and lines per predicate.

A name is taken to be used where it occurs at all: what is found is unused,
what is not found may be.

*Threading*: the main thread.
*/

:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(filesex),
              [directory_file_path/3, directory_member/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(main), [main/0]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(prolog_source),
              [ prolog_close_source/1, prolog_open_source/2,
                prolog_read_source_term/4 ]).
:- use_module(library(readutil), [read_file_to_string/3]).

:- initialization(main, main).

:- public main/1.

:- dynamic
    root/1,                     % Directory of the tree
    module_of/2,                % File, Module
    export/2,                   % File, PI
    import/3,                   % File, Target, all or List; a file, if ours
    reexport/3,                 % as import/3
    mentions/2,                 % File, Name: in clauses and directives
    reaches/3,                  % File, Module, PI: Module:Goal in a clause
    size/4.                     % File, PI, first and last line

:- prolog_load_context(directory, Dir),
   file_directory_name(Dir, Root),
   retractall(root(_)),
   assertz(root(Root)).

%   From below: who stands higher imports from who stands lower.

layers([ base, program, wire, host, agent, travel, lifecycle, language,
         network, people ]).

main([check]) :-
    read_tree,
    findall(Problem, problem(Problem), Problems0),
    sort(Problems0, Problems),
    forall(member(Problem, Problems), report(Problem)),
    (   Problems == []
    ->  true
    ;   halt(1)
    ).
main([picture]) :-
    read_tree,
    picture.
main([figures]) :-
    read_tree,
    figures.

                /*******************************
                *            READING           *
                *******************************/

read_tree :-
    style_check(-singleton),
    forall(tree_file(File), read_source(File)).

tree_file(File) :-
    root(Root),
    member(Top, [prolog, app, agents, payloads, experiments, test, bench,
                 doc]),
    directory_file_path(Root, Top, Dir),
    directory_member(Dir, File, [recursive(true), extensions([pl])]).

read_source(File) :-
    setup_call_cleanup(
        prolog_open_source(File, In),
        read_terms(In, File),
        prolog_close_source(In)).

read_terms(In, File) :-
    repeat,
    prolog_read_source_term(In, Term, _, [term_position(Position)]),
    (   Term == end_of_file
    ->  !
    ;   stream_position_data(line_count, Position, First),
        line_count(In, Last),
        note(Term, File, First, Last),
        fail
    ).

note((:- Directive), File, _, _) :-
    !,
    note_directive(Directive, File).
note(Clause, File, First, Last) :-
    note_names(Clause, File),
    (   clause_head(Clause, Head)
    ->  functor(Head, Name, Arity),
        assertz(size(File, Name/Arity, First, Last))
    ;   true
    ).

clause_head((Head-->_), Head) :- !, callable(Head).
clause_head((Head:-_), Head) :- !, callable(Head).
clause_head((Head=>_), Head) :- !, callable(Head).
clause_head(Head, Head) :- callable(Head).

note_directive(module(Module, Exports), File) :-
    !,
    assertz(module_of(File, Module)),
    forall(member(PI, Exports), assertz(export(File, PI))).
note_directive(use_module(Spec), File) :-
    !,
    note_import(import, File, Spec, all).
note_directive(use_module(Spec, List), File) :-
    !,
    note_import(import, File, Spec, List).
note_directive(reexport(Spec), File) :-
    !,
    note_import(reexport, File, Spec, all).
note_directive(reexport(Spec, List), File) :-
    !,
    note_import(reexport, File, Spec, List).
note_directive(include(Spec), File) :-
    !,
    note_import(import, File, Spec, include).
note_directive(Directive, File) :-
    note_names(Directive, File).

note_import(Kind, File, Spec, List) :-
    target(Spec, File, Target),
    Fact =.. [Kind, File, Target, List],
    assertz(Fact).

%   target(+Spec, +File, -Target): a file of the tree, else Spec.

target(Spec, File, Target) :-
    root(Root),
    (   Spec = library(Path)
    ->  format(atom(Relative), 'prolog/~w', [Path]),
        directory_file_path(Root, Relative, Base)
    ;   ( atomic(Spec) ; Spec = _/_ )
    ->  file_directory_name(File, Dir),
        format(atom(Path), '~w', [Spec]),
        directory_file_path(Dir, Path, Base)
    ),
    member(Extension, ['.pl', '']),
    atom_concat(Base, Extension, Full),
    exists_file(Full),
    !,
    absolute_file_name(Full, Target).
target(Spec, _, Spec).

note_names(Term, File) :-
    forall(( sub_term(Part, Term), name_in(Part, Name) ),
           ( mentions(File, Name) -> true ; assertz(mentions(File, Name)) )),
    forall(( sub_term(Part, Term), reach(Part, Module, PI) ),
           assertz(reaches(File, Module, PI))).

name_in(Part, Part) :-
    atom(Part).
name_in(Part, Name) :-
    compound(Part),
    compound_name_arity(Part, Name, _).
name_in(Part, Name) :-                  % in strings that are run elsewhere
    string(Part),
    split_string(Part, " \n\t()[]{},:;.'|", "", Words),
    member(Word, Words),
    Word \== "",
    atom_string(Name, Word).

reach(Part, Module, Name/Arity) :-
    nonvar(Part),
    Part = Module:Goal,
    atom(Module),
    atom_concat(typhon_, _, Module),
    callable(Goal),
    \+ Goal = _/_,
    functor(Goal, Name, Arity).

                /*******************************
                *           PROBLEMS           *
                *******************************/

problem(unused_import(File, Target, PI)) :-
    import(File, Target, List),
    \+ inside('prolog/typhon/language/vocabulary.pl', File),   % for agents
    is_list(List),
    member(Import, List),
    imported_as(Import, PI, Name),
    \+ mentions_too(File, Name).
problem(unused_export(File, PI)) :-
    room(File, _, _),
    export(File, PI),
    \+ used(File, PI).
problem(unused_at_door(Door, PI)) :-
    door(Door, _),
    reexport(Door, Room, List),
    offered(Room, List, PI),
    \+ used(Door, PI).
problem(against_layers(File, Target)) :-
    room(File, Layer, _),
    ( import(File, Target, _) ; reexport(File, Target, _) ),
    \+ may_import(Layer, Target).
problem(past_door(File, Module, PI)) :-
    reaches(File, Module, PI),
    PI \= _/0,                          % settings are named like this
    room(File, _, _),
    \+ module_of(File, Module),
    module_of(Room, Module),
    room(Room, _, _),
    \+ hook(Room, PI).
problem(circle(File)) :-
    room(File, _, _),
    reaches_by_import(File, File).

%   What a file includes is a part of it.

mentions_too(File, Name) :-
    mentions(File, Name),
    !.
mentions_too(File, Name) :-
    import(File, Part, include),
    mentions_too(Part, Name),
    !.

imported_as((PI as New), PI, New) :- !.
imported_as(Name/Arity, Name/Arity, Name).
imported_as(Name//Arity, Name//Arity, Name).

%   used(+File, +PI): somebody who imports File mentions it, or it is
%   offered on. What only its own tests use is not used.

used(File, _) :-
    inside('prolog/typhon/language/words.pl', File),
    !.                                  % agents do
used(File, Name/_) :-
    import(User, File, List),
    User \== File,
    \+ is_test(User),
    (   List == all
    ->  mentions(User, Name)
    ;   is_list(List),
        member(Import, List),
        imported_as(Import, Name/_, _)
    ),
    !.
used(File, PI) :-
    reexport(User, File, List),
    offered(File, List, PI),
    used_at(User, PI),
    !.
used(File, Name/Arity) :-
    module_of(File, Module),
    reaches(_, Module, Name/Arity),
    !.
used(File, Name/_) :-                   % started from a shell
    module_of(File, Module),
    mentions(User, Module),
    User \== File,
    mentions(User, Name),
    !.

used_at(Face, _) :-
    face(Face),
    !.
used_at(Door, PI) :-
    used(Door, PI).

offered(Room, all, PI) :-
    export(Room, PI).
offered(Room, all, PI) :-
    reexport(Room, Deeper, List),
    offered(Deeper, List, PI).
offered(_, List, PI) :-
    is_list(List),
    member(PI, List).

is_test(File) :-
    inside('test/', Tests),
    atom_concat(Tests, _, File).

face(File) :- inside('prolog/typhon.pl', File).
face(File) :- inside('prolog/typhon/nxt.pl', File).

inside(Relative, File) :-
    root(Root),
    directory_file_path(Root, Relative, File).

%   room(?File, ?Layer, ?Name), door(?File, ?Layer)

room(File, Layer, Name) :-
    module_of(File, _),
    inside('prolog/typhon/', House),
    atom_concat(House, Relative, File),
    atomic_list_concat([Layer, Base], /, Relative),
    file_name_extension(Name, pl, Base).

door(File, Layer) :-
    layers(Layers),
    member(Layer, Layers),
    format(atom(Relative), 'prolog/typhon/~w.pl', [Layer]),
    inside(Relative, File).

may_import(_, Target) :-
    \+ module_of(Target, _),
    !.
may_import(Layer, Target) :-
    room(Target, Layer, _),
    !.
may_import(_, Target) :-
    room(Target, base, _),
    !.
may_import(Layer, Target) :-
    door(Target, Lower),
    layers(Layers),
    nth1(L, Layers, Lower),
    nth1(H, Layers, Layer),
    L < H.

%   A hook is declared multifile by the room that calls it.

hook(Room, Name/Arity) :-
    read_file_to_string(Room, Text, []),
    format(string(Declared), "~w/~w", [Name, Arity]),
    once(sub_string(Text, M, _, _, "multifile")),
    sub_string(Text, B, _, _, Declared),
    B > M,
    !.

reaches_by_import(From, To) :-
    reaches_by_import(From, To, [From]).

reaches_by_import(From, To, _) :-
    next_room(From, To).
reaches_by_import(From, To, Seen) :-
    next_room(From, Next),
    Next \== To,
    \+ memberchk(Next, Seen),
    reaches_by_import(Next, To, [Next|Seen]).

next_room(From, To) :-
    room(From, Layer, _),
    import(From, To, _),
    room(To, Layer, _).

report(Problem) :-
    says(Problem, Format, Args0),
    maplist(short, Args0, Args),
    format(user_error, Format, Args),
    nl(user_error).

says(unused_import(F, T, PI), '~w: ~w of ~w is imported, and not used',
     [F, PI, T]).
says(unused_export(F, PI), '~w: nobody uses its export ~w', [F, PI]).
says(unused_at_door(F, PI), '~w: nobody takes ~w from this door', [F, PI]).
says(against_layers(F, T), '~w: imports ~w, against the layers', [F, T]).
says(past_door(F, M, PI), '~w: reaches for ~w of ~w past the door',
     [F, PI, M]).
says(circle(F), '~w: imports itself, in a circle', [F]).

short(File, Short) :-
    root(Root),
    atom(File),
    atom_concat(Root, /, Start),
    atom_concat(Start, Short, File),
    !.
short(Term, Term).

                /*******************************
                *            PICTURE           *
                *******************************/

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

                /*******************************
                *            FIGURES           *
                *******************************/

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
