:- module(layers, []).

/** <module> Checks, picture and figures of the layers

    swipl doc/layers.pl -- check
    swipl doc/layers.pl -- picture | tred | dot -Tsvg > doc/img/layers.svg
    swipl doc/layers.pl -- figures
    swipl doc/layers.pl -- index
    swipl doc/layers.pl -- kinds

`check` says what is not in order, and fails if anything is:

  - an import that is not used, in any file of the tree, or of a file that is
    not there;
  - an export of a module or of an interface that no module uses;
  - a file below prolog/typhon that belongs to no layer; `index` says so, too,
    since what it has on demand would not be found;
  - an import against the layers: a module imports from its own folder,
    from kernel/base, and from the interfaces of lower layers, but an option
    from no other;
  - a call Module:Goal of a predicate that Module does not export;
  - Module:Goal in a test, or another file that is not of the library, where
    Module has no such predicate;
  - modules that import each other in a circle;
  - a file of the kernel that names an option;
  - a hook that its module does not declare, or that no module defines;
  - a module that inherits from `user`, or calls what it does not import;
  - an index of what is loaded on demand that is not up to date (`index`
    writes it, prolog/typhon/kernel/base/index.pl);
  - a file that needs a part which may be left out (app/packaging/parts.pl);
  - a clause that handles what another process sends, which
    prolog/typhon/kernel/wire/kinds.pl does not declare, a declaration that no
    clause handles, or a table in doc/wire.md that is not up to date (`kinds`
    writes it).

`picture` draws which module imports which (tred leaves out what follows from
other arrows), `figures` counts modules, lines and lines per predicate, and
prints what the kernel and the tests hold beside their budgets; it exits with
status 1 if one is exceeded.

*Threading*: the main thread.
*/

:- use_module('../app/typhon/arguments', [arguments/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(main), [main/0]).
:- use_module(layers/check).
:- use_module(layers/figures).
:- use_module(layers/index, [layer_problem/1, write_index/0]).
:- use_module(layers/kinds, [write_kinds/0]).
:- use_module(layers/picture).
:- use_module(layers/tree, [read_library/0, read_tree/0]).

:- initialization(main, main).

:- public main/1.

main(Argv) :-
    arguments(Argv, [Word], []),
    do(Word).

do(check) :-
    read_tree,
    halt_on(problem).
do(index) :-
    read_tree,
    write_index,
    halt_on(layer_problem).
do(kinds) :-
    read_tree,
    write_kinds.
do(picture) :-
    read_library,
    picture.
do(figures) :-
    read_tree,
    (   figures
    ->  true
    ;   halt(1)
    ).

%   halt_on(:Problem): with status 1, after a report, if call(Problem, P).

halt_on(Of) :-
    findall(Problem, call(Of, Problem), Problems0),
    sort(Problems0, Problems),
    forall(member(Problem, Problems), report(Problem)),
    (   Problems == []
    ->  true
    ;   halt(1)
    ).
