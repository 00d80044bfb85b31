:- module(layers_parts,
          [ parts_problem/1,            % -Problem
            is_part/1                   % +File
          ]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module('../../app/packaging/parts', [part/3, part_file/2]).
:- use_module(tree).

/** <module> What can be left out is used on demand

A file needs a part if it imports a file or a library of the part, but by
autoload/2, or if the product names a file of it.  The core needs no part, and a
part needs earlier parts alone, in the order of app/packaging/parts.pl.

*Threading*: the main thread.
*/

%!  parts_problem(-Problem) is nondet.

parts_problem(needs_part(File, Used, Part)) :-
    tree_file(File),
    \+ inside('prolog/typhon/kernel/base/index.pl', File),
    uses(File, Used),
    of_part(Used, Part),
    relative(File, Path),
    \+ may_need(Path, Part).
parts_problem(no_such_path(Part, Path)) :-
    part(Part, Libraries, Paths),
    ( member(Path, Libraries) ; member(Path, Paths) ),
    atom_concat(Path, *, Pattern0),
    inside(Pattern0, Pattern),
    expand_file_name(Pattern, []).

%!  is_part(+File) is semidet.
%
%   File, and not its folder, can be left out.

is_part(File) :-
    relative(File, Path),
    part(_, _, Paths),
    memberchk(Path, Paths),
    !.

uses(File, Path) :-
    ( import(File, Target, _) ; reexport(File, Target, _) ),
    atom(Target),
    \+ autoloads(File, Target),
    relative(Target, Path).
uses(File, Name) :-
    relative(File, Path),
    member(Product, ['prolog/', 'app/typhon', 'agents/', 'examples/']),
    sub_atom(Path, 0, _, _, Product),
    mentions(File, Name),
    blob(Name, text),
    sub_atom(Name, Before, _, After, /),
    Before > 0,
    After > 0.

of_part(Path, Part) :-
    part_file(Part, Path).
of_part(Path, Part) :-
    part(Part, Libraries, _),
    memberchk(Path, Libraries),
    !.

may_need(Path, Part) :-
    part(Part, Libraries, _),
    memberchk(Path, Libraries).
may_need(Path, Part) :-
    part_file(Own, Path),
    findall(P, part(P, _, _), Parts),
    nth1(O, Parts, Own),
    nth1(N, Parts, Part),
    !,
    N =< O.

relative(File, Path) :-
    inside('', Root),
    atom_concat(Root, Path, File).
