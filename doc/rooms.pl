:- module(rooms, []).

/** <module> The house, looked at as a whole

    swipl doc/rooms.pl -- check
    swipl doc/rooms.pl -- picture | tred | dot -Tsvg > doc/img/rooms.svg
    swipl doc/rooms.pl -- figures
    swipl doc/rooms.pl -- exceptions

`check` says what is not in order, and fails if anything is:

  - an import that is not used, in any file of the tree;
  - an export of a room, or of a door, that nobody uses;
  - an import against the layers: a room takes from its own folder, from
    base, and from the doors of lower layers;
  - a call past a door: Module:Goal into another room;
  - rooms that import each other in a circle;
  - a file of the kernel that names an option, and is not in the list of
    exceptions, doc/rooms/exceptions.pl, which may only shrink
    (`exceptions` rewrites it without those that are no longer needed);
  - a hook that its module does not declare, or that no module defines.

`picture` draws which module imports which (tred leaves out what follows from
other arrows), `figures` counts modules, lines and lines per predicate, and
prints what the kernel and the tests hold beside the most that is wanted.

*Threading*: the main thread.
*/

:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(rooms/check).
:- use_module(rooms/figures).
:- use_module(rooms/picture).
:- use_module(rooms/seams, [shrink_exceptions/0]).
:- use_module(rooms/tree, [read_tree/0]).

:- initialization(main, main).

:- public main/1.

main([check]) :-
    read_tree,
    findall(Problem, problem(Problem), Problems0),
    sort(Problems0, Problems),
    forall(member(Problem, Problems), report(Problem)),
    (   Problems == []
    ->  true
    ;   halt(1)
    ).
main([exceptions]) :-
    read_tree,
    shrink_exceptions.
main([picture]) :-
    read_tree,
    picture.
main([figures]) :-
    read_tree,
    figures.
