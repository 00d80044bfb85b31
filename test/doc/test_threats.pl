%   The tests, `suite:test`, and attempts that the table of threats in
%   doc/security.md names exist.

:- module(test_threats, []).
:- use_module('../lib/common').
:- use_module('../lib/texts', [file_lines/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).

:- begin_tests(threats).

test(each_threat_has_a_test, Rows == []) :-
    findall(Threat, ( threat(Threat, Tests), Tests == [] ), Rows).
test(named_tests_exist, Missing == []) :-
    findall(Suite:Test, ( named(Suite, Test, _), \+ is_test(Suite, Test) ),
            Missing).
test(named_attempts_exist, Missing == []) :-
    findall(Suite:Attempt,
            ( attempt(Suite, Attempt), \+ is_tried(Suite, Attempt) ), Missing).
test(sixty_attempts_are_named, true(Count >= 60)) :-
    setof(Suite:Attempt, attempt(Suite, Attempt), All),
    length(All, Count).

:- end_tests(threats).

%   threat(-Threat, -Tests) is nondet: Tests are Suite:Test-Attempts.

threat(Threat, Tests) :-
    project_file('doc/security.md', File),
    file_lines(File, Lines),
    append(_, ["| threat | what stops it | test: attempts | what remains |",_
              |Rows], Lines),
    append(Table, [""|_], Rows),
    !,
    member(Row, Table),
    split_string(Row, "|", " ", ["",Threat,_,Column,_,""]),
    split_string(Column, "`", "", Parts),
    tests(Parts, Tests).

tests([_,Name,Rest|Parts], [Suite:Test-Attempts|Tests]) :-
    !,
    split_string(Name, ":", "", [Suite0,Test0]),
    atom_string(Suite, Suite0),
    atom_string(Test, Test0),
    split_string(Rest, ";", ": ", Attempts0),
    findall(Attempt, ( member(Attempt, Attempts0), Attempt \== "" ), Attempts),
    tests([Rest|Parts], Tests).
tests(_, []).

named(Suite, Test, Attempts) :-
    threat(_, Tests),
    member(Suite:Test-Attempts, Tests).

attempt(Suite, Attempt) :-
    named(Suite, _, Attempts),
    member(Attempt, Attempts).

suite_file(Suite, File) :-
    format(atom(Relative), 'test/prolog/options/cell/test_~w.pl', [Suite]),
    project_file(Relative, File).

is_test(Suite, Test) :-
    suite_file(Suite, File),
    read_file_to_terms(File, Terms, []),
    member(Term, Terms),
    ( Term = (Head :- _) -> true ; Head = Term ),
    compound(Head),
    compound_name_arguments(Head, test, [Test|_]),
    !.

%   Attempts have names that are quoted atoms.

is_tried(Suite, Attempt) :-
    suite_file(Suite, File),
    read_file_to_string(File, Text, [encoding(utf8)]),
    format(string(Quoted), "'~w'", [Attempt]),
    sub_string(Text, _, _, _, Quoted),
    !.
