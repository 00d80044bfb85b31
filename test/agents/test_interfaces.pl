:- module(test_interfaces, []).

%   The first two lines of a file that agents include are correct (a line may
%   be continued):
%
%   % Expects: predicates that it calls and another file defines
%   % Gives: predicates that others may call
%
%   Expected are folders (`lib` and `common` stand for all of theirs), files,
%   or predicates, which the program itself, a payload or a file that includes
%   this one defines. Other files may read the state that a file declares.
%
%   And the steps that doc/allocation.md names are in the files that it names.

:- use_module('../lib/common').
:- use_module('../lib/texts', [file_lines/2]).
:- use_module(library(filesex), [directory_member/3]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(plunit)).
:- use_module(library(solution_sequences), [distinct/2]).
:- use_module(library(readutil),
              [read_file_to_terms/3]).

:- dynamic
    file_term/2,                % File, Term
    defines/2,                  % File, PI
    state/2,                    % File, PI
    include/2,                  % File, Included
    crossing/4.                 % Program, File, Other, PI: see below

load :-
    file_term(_, _),
    !.
load :-
    project_file(agents, Directory),
    forall(directory_member(Directory, File,
                            [extensions([pl]), recursive(true)]),
           ( read_file_to_terms(File, Terms, []),
             forall(member(Term, Terms), assertz(file_term(File, Term))),
             forall(distinct(PI, defined(File, PI)),
                    assertz(defines(File, PI))),
             forall(declared(File, PI), assertz(state(File, PI))),
             forall(includes(File, Included),
                    assertz(include(File, Included))) )),
    forall(crosses(Program, File, Other, PI),
           assertz(crossing(Program, File, Other, PI))).

program(File) :-
    load,
    file_term(File, (:- agent(_, _))).

includes(File, Included) :-
    file_term(File, (:- include(Spec))),
    absolute_file_name(Spec, Included,
                       [ relative_to(File), extensions([pl]),
                         access(read) ]).

%   part(+Program, -File): Program itself, or a file that it includes.

part(File, File).
part(File, Part) :-
    include(File, Included),
    part(Included, Part).

included(File) :-
    load,
    distinct(File, include(_, File)).

                /*******************************
                *            HEADERS           *
                *******************************/

header(File, Expects, Gives) :-
    file_lines(File, Lines),
    line("% Expects: ", Expects, Lines, Lines1),
    line("% Gives: ", Gives, Lines1, _).

%   line(+Key, -Line, +Lines0, -Lines): a list that does not fit into a line
%   continues in the next one.

line(Key, Line, [First|Lines0], Lines) :-
    string_concat(Key, Begin, First),
    continued(Lines0, Begin, Line, Lines).

continued([Next|Lines0], Line0, Line, Lines) :-
    string_concat("%   ", More, Next),
    !,
    atomics_to_string([Line0, " ", More], Line1),
    continued(Lines0, Line1, Line, Lines).
continued(Lines, Line, Line, Lines).

words(Line, Words) :-
    split_string(Line, " ,;", " ,;.", Words).

%   names(+Line, +PI): Line has the word PI.

names(Line, PI) :-
    words(Line, Words),
    format(string(Word), "~w", [PI]),
    memberchk(Word, Words).

mentions(Line, File) :-
    words(Line, Words),
    file_directory_name(File, Directory),
    file_base_name(Directory, Folder),
    file_base_name(File, Base),
    file_name_extension(Name, _, Base),
    (   memberchk(Folder, [lib, common]),
        atom_string(Folder, Word)
    ;   atom_string(Name, Word)
    ),
    memberchk(Word, Words),
    !.

                /*******************************
                *             CALLS            *
                *******************************/

defined(File, PI) :-
    file_term(File, Term),
    Term \= (:- _),
    ( Term = (Head :- _) -> true ; Head = Term ),
    functor(Head, Name, Arity),
    PI = Name/Arity.

declared(File, PI) :-
    file_term(File, (:- dynamic(PIs))),
    in_list(PIs, PI).

in_list((A,B), PI) :-
    !,
    ( in_list(A, PI) ; in_list(B, PI) ).
in_list(PI, PI).

calls(File, PI) :-
    file_term(File, (_ :- Body)),
    goal(Body, Goal),
    functor(Goal, Name, Arity),
    PI = Name/Arity.

goal(Body, _) :-
    var(Body),
    !,
    fail.
goal(Body, Goal) :-
    findall(Part, part_of(Body, Part), Parts),
    Parts = [_|_],
    !,
    member(Part, Parts),
    goal(Part, Goal).
goal(Goal, Goal).

part_of((A,B), G) :- ( G = A ; G = B ).
part_of((A;B), G) :- ( G = A ; G = B ).
part_of((A->B), G) :- ( G = A ; G = B ).
part_of(\+ G, G).
part_of(once(G), G).
part_of(ignore(G), G).
part_of(forall(A, B), G) :- ( G = A ; G = B ).
part_of(findall(_, G, _), G).
part_of(aggregate_all(_, G, _), G).
part_of(catch(A, _, B), G) :- ( G = A ; G = B ).

%   crosses(-Program, -File, -Other, -PI): in Program, File calls PI, which is
%   defined in Other and not in File.

crosses(Program, File, Other, PI) :-
    file_term(Program, (:- agent(_, _))),
    findall(Part, part(Program, Part), Parts),
    member(File, Parts),
    distinct(PI, calls(File, PI)),
    \+ defines(File, PI),
    \+ state(File, PI),
    member(Other, Parts),
    once(( defines(Other, PI) ; state(Other, PI) )).

                /*******************************
                *             STEPS            *
                *******************************/

%   step(-PIs, -Files): a row of the table in doc/allocation.md.

step(PIs, Files) :-
    project_file('doc/allocation.md', Document),
    file_lines(Document, Lines),
    append(_, ["## The steps of the thesis"|More], Lines),
    append(Section, ["## Costs and negotiations"|_], More),
    !,
    member(Line, Section),
    split_string(Line, "`", "", Parts),
    findall(Name/Arity,
            ( member(Part, Parts),
              split_string(Part, "/", "", [Name0, Digits]),
              catch(number_string(Arity, Digits), error(_, _), fail),
              atom_string(Name, Name0) ),
            PIs),
    PIs = [_|_],
    findall(File,
            ( member(Part, Parts),
              sub_string(Part, _, _, 0, ".pl"),
              string_concat('agents/allocation/', Part, Relative),
              project_file(Relative, File) ),
            Files).

:- begin_tests(interfaces).

test(each_file_has_its_two_interface_lines,
     [forall(included(File)), true(File-Given == File-true)]) :-
    (   header(File, _, _)
    ->  Given = true
    ;   Given = false
    ).
test(a_file_is_included_once,
     [forall(program(Program)), true(Program-Sorted == Program-Files)]) :-
    findall(File, part(Program, File), Files0),
    msort(Files0, Files),
    sort(Files0, Sorted).
test(provided_predicates_are_defined, Missing == []) :-
    findall(File-PI,
            ( included(File),
              header(File, _, Gives),
              words(Gives, Words),
              member(Word, Words),
              atom_string(Atom, Word),
              catch(term_to_atom(PI, Atom), error(_, _), fail),
              PI = Name/Arity,
              atom(Name), integer(Arity),
              \+ ( part(File, Part),
                   ( defines(Part, PI) ; state(Part, PI) ) ) ),
            Missing).
test(called_predicates_are_provided, Hidden == []) :-
    findall(File-Other-PI,
            ( crossing(_, File, Other, PI),
              included(Other),
              \+ state(Other, PI),
              \+ ( header(Other, _, Gives), names(Gives, PI) ),
              \+ ( header(File, Expects, _), names(Expects, PI) ) ),
            Hidden0),
    sort(Hidden0, Hidden).
test(called_predicates_are_expected, Unsaid == []) :-
    findall(File-Other-PI,
            ( crossing(_, File, Other, PI),
              included(File),
              header(File, Expects, _),
              \+ ( part(File, Part), Part == Other ),
              \+ mentions(Expects, Other),
              \+ names(Expects, PI) ),
            Unsaid0),
    sort(Unsaid0, Unsaid).
test(steps_of_the_allocator_are_in_order, Later == []) :-
    project_file('agents/allocation/allocator.pl', Program),
    findall(File, part(Program, File), [_|Files]),
    findall(File-Other-PI,
            ( crossing(Program, File, Other, PI),
              append(_, [File|Rest], Files),
              memberchk(Other, Rest) ),
            Later).

test(steps_are_documented_at_the_right_place, Missing-Some == []-true) :-
    findall(PIs, step(PIs, _), Steps),
    length(Steps, Count),
    ( Count > 10 -> Some = true ; Some = Count ),
    load,
    findall(PI,
            ( step(PIs, Files), member(PI, PIs),
              \+ ( member(File, Files),
                   ( defines(File, PI) ; state(File, PI) ) ) ),
            Missing).

:- end_tests(interfaces).
