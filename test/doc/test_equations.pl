:- module(test_equations, []).
:- use_module('../lib/common', [project_file/2]).
:- use_module('../lib/texts', [file_lines/2]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [member/2, memberchk/2]).
:- use_module(library(plunit)).

/** <module> doc/equations.md: each number of the thesis, its predicate, its test

Files are read, not loaded.
*/

%   numbered(?Number): the numbers of equations, algorithms and tables in
%   chapters 3 to 7 of the thesis.

numbered(Number) :-
    member(Chapter-Last, [3-6, 4-7, 5-2, 6-10, 7-7]),
    between(1, Last, N),
    format(string(Number), "~d.~d", [Chapter, N]).
numbered("Algorithm 1").
numbered("Algorithm 2").
numbered("Table 5.1").
numbered("Table 5.2").
numbered("Table 6.1").

%   row(-Number, -Predicate, -Test): of the table, without code marks.

row(Number, Predicate, Test) :-
    project_file('doc/equations.md', File),
    file_lines(File, Lines),
    member(Line, Lines),
    split_string(Line, "|", " `", ["", Number, _, Predicate, Test, ""]),
    split_string(Predicate, ":", "", [_, _]).

%   clause_of(+File, -Head)

clause_of(File, Head) :-
    setup_call_cleanup(
        open(File, read, In, [encoding(utf8)]),
        findall(Term, term_in(In, Term), Terms),
        close(In)),
    member(Term, Terms),
    (   Term = (Head0 :- _)
    ->  Head = Head0
    ;   Head = Term
    ).

term_in(In, Term) :-
    repeat,
    read_term(In, Read, [module(test_equations)]),
    (   Read == end_of_file
    ->  !,
        fail
    ;   Term = Read
    ).

%   Files below agents/ are named without that folder.

defined(Predicate) :-
    split_string(Predicate, ":", "", [Path, Indicator]),
    split_string(Indicator, "/", "", [NameText, ArityText]),
    atom_string(Name, NameText),
    number_string(Arity, ArityText),
    functor(Head, Name, Arity),
    member(Folder, ['', 'agents/']),
    atom_concat(Folder, Path, Relative),
    project_file(Relative, File),
    exists_file(File),
    clause_of(File, Head),
    !.

%   A test, or a case of a table, has the name as its first argument.

tested(Test) :-
    split_string(Test, ":", "", [Suite, NameText]),
    atom_string(Name, NameText),
    format(atom(Base), 'test_~w.pl', [Suite]),
    project_file(test, Tests),
    directory_member(Tests, File, [recursive(true), matches(Base)]),
    clause_of(File, Head),
    compound(Head),
    arg(1, Head, Name0),
    Name0 == Name,
    !.

:- begin_tests(equations).

test(every_equation_has_a_row, Missing == []) :-
    findall(Number, row(Number, _, _), Rows),
    findall(Number, ( numbered(Number), \+ memberchk(Number, Rows) ), Missing).
test(predicates_exist, Missing == []) :-
    findall(Predicate, ( row(_, Predicate, _), \+ defined(Predicate) ),
            Missing).
test(tests_exist, Missing == []) :-
    findall(Test, ( row(_, _, Test), \+ tested(Test) ), Missing).
test(tests_are_named_after_the_number, Wrong == []) :-
    findall(Number-Test,
            ( row(Number, _, Test), \+ named_after(Number, Test) ),
            Wrong).

%   `6.10` in equation_6_9_and_6_10, `Table 5.1` in table_5_1.

named_after(Number, Test) :-
    string_lower(Number, Lower),
    split_string(Lower, " .,", " ", Parts0),
    findall(Part, ( member(Part, Parts0), Part \== "" ), Parts),
    atomic_list_concat(Parts, '_', Name),
    sub_atom(Test, _, _, _, Name).

:- end_tests(equations).
