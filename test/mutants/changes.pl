:- module(test_changes,
          [ file_changes/2,             % +File, -Changes
            file_rules/2,               % +File, -Rules
            changed_text/3,             % +Text, +Change, -Changed
            change_text/2,              % +Change, -Line
            change_words/3,             % +Change, -Old, -New
            plain_head/2                % +Head, -Plain
          ]).

/** <module> Small changes to a program, each of which takes something away

A change is `change(File, Start, End, New, Kind, Predicate, Line)`: in File the
characters from Start up to End are replaced by the string New. Kind is one of

| goal       | a goal is left out                                     |
| clause     | a clause is left out                                   |
| comparison | a comparison is turned round                           |
| bound      | an integer, or the right side of a comparison, is one more |
| constants  | two constants of a clause are exchanged                |
| test       | the condition of an if-then-else, or a guard, is negated |
| cut        | a cut is left out                                      |
| order      | two clauses of a predicate that follow one another are exchanged |

Directives and what follows :- end of file stay as they are. Changes keep the
number of lines, so messages name the lines of the original.

*Threading*: any thread.
*/

:- use_module('../lib/common', [project_file/2]).
:- use_module(library(apply), [exclude/3, maplist/2, maplist/3]).
:- use_module(library(lists), [append/3, member/2, nextto/3]).
:- use_module(library(prolog_source),
              [ prolog_open_source/2, prolog_close_source/1,
                prolog_read_source_term/4
              ]).
:- use_module(library(readutil), [read_file_to_string/3]).

%!  file_changes(+File:atom, -Changes:list) is det.
%
%   All changes of the program File.

file_changes(File, Changes) :-
    read_file_to_string(File, Text, [encoding(utf8)]),
    file_clauses(File, Clauses),
    findall(Change, clause_change(File, Text, Clauses, Change), Changes).

%!  file_rules(+File:atom, -Rules) is semidet.
%
%   Rules is rules(End, Bodies): End is where the declaration of the module
%   ends; of each rule there is body(Predicate, Kind, Start, End), Kind being
%   `rule` or `dcg`. Fails if File is no module of Prolog.

file_rules(File, rules(End, Bodies)) :-
    file_name_extension(_, pl, File),
    file_clauses(File, [module(End)|Clauses]),
    findall(body(Predicate, Kind, Start, Stop),
            ( member(clause(Term, Positions, _), Clauses),
              rule(Term, Kind),
              clause_predicate(Term, Predicate),
              body(Positions, BodyPositions),
              extent(BodyPositions, Start, Stop)
            ),
            Bodies).

rule((_ :- _), rule).
rule((_ => _), rule).
rule((_ --> _), dcg).

%   clause(Term, Positions, Line), and module(End) first.

file_clauses(File, Clauses) :-
    setup_call_cleanup(
        prolog_open_source(File, In),
        read_clauses(In, Clauses),
        prolog_close_source(In)).

read_clauses(In, Clauses) :-
    prolog_read_source_term(In, Term, _,
                            [ subterm_positions(Positions),
                              term_position(Position)
                            ]),
    (   Term == end_of_file
    ->  Clauses = []
    ;   stream_position_data(line_count, Position, Line),
        (   Term = (:- module(_, _))
        ->  extent(Positions, _, End0),
            End is End0+1,
            Clauses = [module(End)|Rest]
        ;   is_clause(Term)
        ->  Clauses = [clause(Term, Positions, Line)|Rest]
        ;   Clauses = Rest
        ),
        read_clauses(In, Rest)
    ).

is_clause(Term) :-
    nonvar(Term),
    Term \= (:- _),
    Term \= (?- _).

clause_predicate((Head :- _), Predicate) :-
    !,
    head_predicate(Head, Predicate).
clause_predicate((Head0 => _), Predicate) :-
    !,
    plain_head(Head0, Head),
    head_predicate(Head, Predicate).
clause_predicate((Head0 --> _), Predicate) :-
    !,
    plain_head(Head0, Head),
    head_predicate(Head, Name/Arity0),
    Arity is Arity0+2,
    Predicate = Name/Arity.
clause_predicate(Head, Predicate) :-
    head_predicate(Head, Predicate).

%!  plain_head(+Head, -Plain) is det.
%
%   Plain is Head without its guard, or its pushback list.

plain_head(Head, Plain) :-
    nonvar(Head),
    Head = (Plain, _),
    !.
plain_head(Head, Head).

head_predicate(Module:Head, Predicate) :-
    !,
    head_predicate(Head, Predicate0),
    Predicate = Predicate0,
    atom(Module).
head_predicate(Head, Name/Arity) :-
    callable(Head),
    functor(Head, Name, Arity).

                /*******************************
                *           CHANGES            *
                *******************************/

clause_change(File, Text, Clauses,
              change(File, Start, End, New, Kind, Predicate, Line)) :-
    member(clause(Term, Positions, ClauseLine), Clauses),
    clause_predicate(Term, Predicate),
    part_change(Term, Positions, Text, Start, End, New, Kind),
    line_of(Text, ClauseLine, Positions, Start, Line).
clause_change(File, Text, Clauses,
              change(File, Start, End, New, order, Predicate, Line)) :-
    nextto(clause(T1, P1, Line), clause(T2, P2, _), Clauses),
    clause_predicate(T1, Predicate),
    clause_predicate(T2, Predicate),
    extent(P1, Start, E1),
    extent(P2, S2, End),
    Length is S2-E1,
    sub_string(Text, E1, Length, _, Between),
    piece(Text, P1, First),
    piece(Text, P2, Second),
    string_concat(Second, Between, New0),
    string_concat(New0, First, New).

line_of(Text, ClauseLine, Positions, Start, Line) :-
    extent(Positions, From, _),
    Length is Start-From,
    sub_string(Text, From, Length, _, Before),
    newlines(Before, Count),
    Line is ClauseLine+Count.

newlines(String, Count) :-
    split_string(String, "\n", "", Parts),
    length(Parts, N),
    Count is N-1.

%   part_change(+Clause, +Positions, +Text, -Start, -End, -New, -Kind)

part_change(_, Positions, Text, Start, End, New, clause) :-
    extent(Positions, Start, End0),
    full_stop(Text, End0, End),
    Length is End-Start,
    sub_string(Text, Start, Length, _, Old),
    newlines(Old, Count),
    length(Lines, Count),
    maplist(=('\n'), Lines),
    atomics_to_string(Lines, New).
part_change(Term, Positions, Text, Start, End, New, Kind) :-
    goals(Term, Positions, Goals, GoalsPositions),
    goal_change(Goals, GoalsPositions, Text, Start, End, New, Kind).
part_change(Term, Positions, Text, Start, End, New, test) :-
    guard(Term, Positions, Guard, GuardPositions),
    negated(Guard, GuardPositions, Text, Start, End, New).
part_change(Term, Positions, Text, Start, End, New, constants) :-
    clause_constants(Term, Positions, Constants),
    append(_, [C1-p(S1, E1)|Rest], Constants),
    once(( member(C2-p(S2, E2), Rest), C1 \== C2, S2 >= E1 )),
    Start = S1, End = E2,
    string_part(Text, S1, E1, Text1),
    string_part(Text, E1, S2, Between),
    string_part(Text, S2, E2, Text2),
    atomics_to_string([Text2, Between, Text1], New).
part_change(Term, Positions, Text, Start, End, New, bound) :-
    clause_constants(Term, Positions, Constants),
    member(N-p(Start, End), Constants),
    integer(N),
    string_part(Text, Start, End, Old),
    number_string(N, Old),
    N1 is N+1,
    number_string(N1, New).

full_stop(Text, End0, End) :-
    sub_string(Text, End0, 1, _, Char),
    End1 is End0+1,
    (   Char == "."
    ->  End = End1
    ;   full_stop(Text, End1, End)
    ).

goals((_ :- Body), Positions, Body, BodyPositions) :-
    body(Positions, BodyPositions).
goals((_ => Body), Positions, Body, BodyPositions) :-
    body(Positions, BodyPositions).
goals(Term, Positions, Guard, GuardPositions) :-
    guard(Term, Positions, Guard, GuardPositions).

body(Positions, Body) :-
    operands(Positions, _, Body).

guard((_, Guard => _), Positions, Guard, GuardPositions) :-
    operands(Positions, Head, _),
    operands(Head, _, GuardPositions).

operands(Positions, Left, Right) :-
    unwrapped(Positions, term_position(_, _, _, _, [Left, Right])).

%   Goals: only those of control structures are looked into.

goal_change(Goal, Positions, _, _, _, _, _) :-
    ( var(Goal) ; var(Positions) ),
    !,
    fail.
goal_change(Goal, parentheses_term_position(_, _, Inner), Text, S, E, N, K) :-
    !,
    goal_change(Goal, Inner, Text, S, E, N, K).
goal_change(Goal, term_position(_, _, _, _, Args), Text, S, E, N, K) :-
    control(Goal),
    !,
    control_change(Goal, Args, Text, S, E, N, K).
goal_change(!, Positions, _, S, E, "true", cut) :-
    !,
    extent(Positions, S, E).
goal_change(Goal, Positions, _, S, E, "true", goal) :-
    Goal \== true,
    extent(Positions, S, E).
goal_change(Goal, term_position(_, _, FS, FE, [_, Right]), Text, S, E, N, K) :-
    Goal =.. [Op, _, _],
    comparison(Op, Other),
    (   K = comparison,
        S = FS, E = FE, N = Other
    ;   K = bound,
        shifted(Op),
        extent(Right, S, E),
        string_part(Text, S, E, Old),
        format(string(N), "((~s)+1)", [Old])
    ).
goal_change(Goal, term_position(_, _, _, _, Args), Text, S, E, N, K) :-
    meta(Goal, Numbers),
    member(Number, Numbers),
    arg(Number, Goal, Inner),
    position_of(Number, Args, Positions),
    goal_change(Inner, Positions, Text, S, E, N, K).

control_change((If->_), [Positions, _], Text, S, E, N, test) :-
    negated(If, Positions, Text, S, E, N).
control_change((If*->_), [Positions, _], Text, S, E, N, test) :-
    negated(If, Positions, Text, S, E, N).
control_change(\+ _, [Positions], Text, S, E, N, test) :-
    extent(Positions, S0, E),
    S is S0, string_part(Text, S, E, Old),
    format(string(N), "(\\+ (~s))", [Old]).
control_change(Goal, Args, Text, S, E, N, K) :-
    arg(Number, Goal, Inner),
    position_of(Number, Args, Positions),
    goal_change(Inner, Positions, Text, S, E, N, K).

negated(If, Positions, Text, S, E, N) :-
    nonvar(If),
    extent(Positions, S, E),
    string_part(Text, S, E, Old),
    format(string(N), "\\+ (~s)", [Old]).

control((_,_)).
control((_;_)).
control((_->_)).
control((_*->_)).
control(\+ _).

meta(forall(_, _), [1, 2]).
meta(once(_), [1]).
meta(ignore(_), [1]).
meta(catch(_, _, _), [1, 3]).
meta(findall(_, _, _), [2]).
meta(aggregate_all(_, _, _), [2]).
meta(setup_call_cleanup(_, _, _), [1, 2, 3]).
meta(call_cleanup(_, _), [1, 2]).
meta(with_mutex(_, _), [2]).
meta(setup_lock(_, _), [2]).

comparison(<, ">=").
comparison(>, "=<").
comparison(=<, ">").
comparison(>=, "<").
comparison(=:=, "=\\=").
comparison(=\=, "=:=").
comparison(==, "\\==").
comparison(\==, "==").
comparison(=, "\\=").
comparison(\=, "=").
comparison(@<, "@>=").
comparison(@>, "@=<").
comparison(@=<, "@>").
comparison(@>=, "@<").

shifted(<).
shifted(>).
shifted(=<).
shifted(>=).

%   clause_constants(+Clause, +Positions, -Constants): atomic arguments of its
%   goals and terms, in order, with their places.

clause_constants(Term, Positions, Constants) :-
    findall(Constant-p(S, E), constant(Term, Positions, Constant, S, E),
            Constants).

constant(Term, Positions, Constant, S, E) :-
    nonvar(Positions),
    (   Positions = parentheses_term_position(_, _, Inner)
    ->  constant(Term, Inner, Constant, S, E)
    ;   compound(Term)
    ->  argument(Term, Positions, Arg, ArgPositions),
        (   ArgPositions = S-E,
            ( atom(Arg), Arg \== [], Arg \== !, Arg \== true ; number(Arg) )
        ->  Constant = Arg
        ;   constant(Arg, ArgPositions, Constant, S, E)
        )
    ;   fail
    ).

argument(Term, term_position(_, _, _, _, Args), Arg, Positions) :-
    arg(Number, Term, Arg),
    position_of(Number, Args, Positions).
argument(Term, list_position(_, _, Elements, _), Arg, Positions) :-
    is_list_start(Term, Elements, Arg, Positions).
argument(Term, brace_term_position(_, _, Positions), Arg, Positions) :-
    arg(1, Term, Arg).

is_list_start([Arg|_], [Positions|_], Arg, Positions).
is_list_start([_|Rest], [_|Positions], Arg, ArgPositions) :-
    nonvar(Rest),
    is_list_start(Rest, Positions, Arg, ArgPositions).

position_of(Number, Args, Positions) :-
    nth(Number, Args, Positions),
    nonvar(Positions).

nth(1, [Arg|_], Arg) :-
    !.
nth(N, [_|Args], Arg) :-
    N1 is N-1,
    nth(N1, Args, Arg).

unwrapped(parentheses_term_position(_, _, P0), P) :-
    !,
    unwrapped(P0, P).
unwrapped(P, P).

extent(Start-End, Start, End) :-
    !.
extent(Positions, Start, End) :-
    arg(1, Positions, Start),
    arg(2, Positions, End).

piece(Text, Positions, Piece) :-
    extent(Positions, Start, End),
    string_part(Text, Start, End, Piece).

string_part(Text, Start, End, Part) :-
    Length is End-Start,
    sub_string(Text, Start, Length, _, Part).

atomics_to_string(Parts, String) :-
    atomic_list_concat(Parts, Atom),
    atom_string(Atom, String).

                /*******************************
                *             TEXT             *
                *******************************/

%!  changed_text(+Text:string, +Change, -Changed:string) is det.

changed_text(Text, change(_, Start, End, New, _, _, _), Changed) :-
    sub_string(Text, 0, Start, _, Before),
    sub_string(Text, End, _, 0, After),
    atomics_to_string([Before, New, After], Changed).

%!  change_text(+Change, -Line:string) is det.
%
%   What is changed, for reports.

change_text(Change, Line) :-
    Change = change(File, _, _, _, Kind, Predicate, Number),
    change_words(Change, Old, New),
    short(Old, ShortOld),
    short(New, ShortNew),
    format(string(Line), "~w:~d: ~w ~q: ~s -> ~s",
           [File, Number, Kind, Predicate, ShortOld, ShortNew]).

%!  change_words(+Change, -Old:string, -New:string) is det.
%
%   The text before and after, with one space between words.

change_words(change(File, Start, End, New0, _, _, _), Old, New) :-
    project_file(File, Path),
    read_file_to_string(Path, Text, [encoding(utf8)]),
    string_part(Text, Start, End, Old0),
    words(Old0, Old),
    words(New0, New).

words(Text, Words) :-
    split_string(Text, "\n ", "\n ", Parts0),
    exclude(==(""), Parts0, Parts),
    atomic_list_concat(Parts, ' ', Atom),
    atom_string(Atom, Words).

short(String, Short) :-
    string_length(String, Length),
    (   Length > 100
    ->  sub_string(String, 0, 97, _, Start),
        string_concat(Start, "...", Short)
    ;   Short = String
    ).
