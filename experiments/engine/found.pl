:- module(study_found,
          [ claim_found/4               % :Test, +Points, +Names, -Text
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists),
              [append/3, list_to_set/2, member/2, memberchk/2]).
:- use_module(library(terms), [mapargs/3]).
:- use_module(claims, [connective/2, leaf/4]).
:- use_module(expressions, [context/2, selected/3, value/4]).
:- use_module(numbers, [number_text/2]).

/** <module> The values that a claim compares, as text

*Threading*: pure.
*/

:- meta_predicate
    claim_found(:, +, +, -).

%!  claim_found(:Test, +Points, +Names:list(atom), -Text:atom) is det.
%
%   Text has the values of the expressions in Test, for Points, usually
%   medians; Names are the parameters that vary.  Of many values only some are
%   shown.

claim_found(M:Test, Points, Names, Text) :-
    context(M:Points, Context0),
    findall(Part,
            ( compared_expression(Test, Context0, E, Context),
              part(E, Context, Names, Part) ),
            Parts0),
    list_to_set(Parts0, Parts),
    atomic_list_concat(Parts, '; ', Text).

compared_expression(at(Where, Test), Context0, E, EContext) :-
    !,
    selected(Where, Context0, Context),
    compared_expression(Test, Context, E, EContext).
compared_expression(Test, Context, E, EContext) :-
    connective(Test, Tests),
    !,
    member(One, Tests),
    compared_expression(One, Context, E, EContext).
compared_expression(Test, Context, E, Context) :-
    leaf(Test, _, _, Es),
    member(E, Es),
    \+ number(E).

part(E, Context, Names, Part) :-
    Context = context(Points, _, _),
    findall(Case-Value,
            ( member(Case0-Measures, Points),
              value(E, Case0-Measures, Context, Value),
              number(Value),
              case_of(E, Case0, Case) ),
            Values0),
    list_to_set(Values0, Values),
    text(Values, Names, Text),
    plain(E, Name),
    format(atom(Part), '~w: ~w', [Name, Text]).

%   at/2 selects another case.

case_of(at(Where, _), Case0, Case) :-
    !,
    dict_create(Other, case, Where),
    Case = Case0.put(Other).
case_of(_, Case, Case).

%   plain(+Expression, -Plain): readable form; conditions of at/2 are shown by
%   their values alone.

plain(at(Where, E), Plain) :-
    !,
    where_text(Where, Said),
    plain(E, Of),
    format(atom(Plain), '~w ~w', [Said, Of]).
plain(E, Plain) :-
    compound(E),
    !,
    mapargs(plain, E, Plain).
plain(E, E).

where_text(Where, Text) :-
    maplist(condition, Where, Values),
    words(Values, Text).

%   A number or a truth value needs the name of its parameter.

condition(Name=Value, Name=Value) :-
    ( number(Value) ; memberchk(Value, [true, false]) ),
    !.
condition(_=Value, Value).

%   Parameters may be compound terms.

words(Terms, Text) :-
    maplist(word, Terms, Words),
    atomic_list_concat(Words, ' ', Text).

word(Term, Word) :-
    format(atom(Word), '~w', [Term]).

%   The last parameter that varies makes the values of a line; the other
%   parameters label the line.  Common values are written once.

text([], _, 'no value') :-
    !.
text(Values, _, Text) :-
    Values = [_-Value|_],
    \+ ( member(_-Other, Values), Other =\= Value ),
    !,
    number_text(Value, Text).
text(Values, Names, Text) :-
    findall(Name, ( member(Name, Names), differs(Name, Values) ), Varied),
    (   append(Naming, [_], Varied)
    ->  true
    ;   Naming = []
    ),
    findall(Key, ( member(Case-_, Values), key(Naming, Case, Key) ), Keys0),
    list_to_set(Keys0, Keys),
    findall(Line, ( member(Key, Keys), line(Key, Naming, Values, Line) ),
            Lines),
    atomic_list_concat(Lines, ', ', Text).

differs(Name, [Case0-_|Values]) :-
    get_dict(Name, Case0, First),
    member(Case-_, Values),
    \+ get_dict(Name, Case, First),
    !.

key(Names, Case, Key) :-
    findall(Value, ( member(Name, Names), get_dict(Name, Case, Value) ), Key).

line(Key, Naming, Values, Line) :-
    findall(Text, ( member(Case-Value, Values), key(Naming, Case, Key),
                    number_text(Value, Text) ),
            Texts),
    shortened(Texts, Shown),
    append(Key, Shown, Parts),
    words(Parts, Line).

shortened(Texts, Shown) :-
    length(Some, 11),
    append(Some, [_, _|_], Texts),
    !,
    append(Some, [...], Shown).
shortened(Texts, Texts).
