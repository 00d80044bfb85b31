:- module(typhon_near,
          [ near_names/3                % +Name, +Names, -Near
          ]).

/** <module> Which name was meant

For error messages about names that do not exist.

*Threading*: any thread; nothing is stored.
*/

:- use_module(library(apply), [foldl/6]).
:- use_module(library(lists), [last/2, member/2, min_list/2, numlist/3]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(solution_sequences), [limit/2]).

%!  near_names(+Name, +Names:list(atom), -Near:list(atom)) is det.
%
%   Near are up to three of Names that a person may have meant by Name, the
%   nearest first.  An id or address also counts by what stands before the
%   first `.` or `@`, a path by its last part: `census` finds
%   'census.4f2a1@alpha@...', and 'survey/census'.

near_names(Name, Names, Near) :-
    findall(Distance-Candidate,
            ( member(Candidate, Names),
              distance(Name, Candidate, Distance)
            ),
            Pairs),
    keysort(Pairs, Sorted),
    pairs_values(Sorted, All),
    findall(One, limit(3, member(One, All)), Near).

distance(Name, Candidate, Distance) :-
    atom_string(Name, Text),
    atom_string(Candidate, Whole),
    short(Whole, Short),
    short(Text, Plain),
    edit_distance(Text, Whole, D1),
    edit_distance(Text, Short, D2),
    edit_distance(Plain, Short, D3),
    min_list([D1, D2, D3], Distance),
    string_length(Plain, Length),
    Distance =< 1 + Length//4.

short(Text, Short) :-
    split_string(Text, ".@", "", [Head|_]),
    split_string(Head, "/", "", Parts),
    last(Parts, Short).

%   Levenshtein's distance, row by row.

edit_distance(A, B, Distance) :-
    string_codes(A, As),
    string_codes(B, Bs),
    length(Bs, N),
    numlist(0, N, Row),
    distance_rows(As, Bs, Row, Distance).

distance_rows([], _, Row, Distance) :-
    last(Row, Distance).
distance_rows([A|As], Bs, [D|Ds], Distance) :-
    D1 is D+1,
    foldl(distance_step(A), Bs, Ds, Row, D-D1, _),
    distance_rows(As, Bs, [D1|Row], Distance).

distance_step(A, B, Up, New, Diagonal-Left, Up-New) :-
    (   A == B
    ->  Change = Diagonal
    ;   Change is Diagonal+1
    ),
    New is min(Change, min(Up, Left)+1).
