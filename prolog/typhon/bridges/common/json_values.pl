:- module(typhon_json_values,
          [ json_value/1              % +Term
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [instantiation_error/1, type_error/2]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> What can be said in JSON

Numbers, strings, lists and dicts are what they are there, the atoms `null`,
`true` and `false`, too, which are None, True and False to Python; other atoms
are strings.  What comes in is made of the same, strings being strings.

*Threading*: pure.
*/

%!  json_value(+Term) is det.
%
%   @error instantiation_error, type_error(json_value, Culprit)

json_value(Term) :-
    var(Term),
    !,
    instantiation_error(Term).
json_value(Term) :-
    number(Term),
    !,
    (   ( integer(Term) ; float(Term), finite(Term) )
    ->  true
    ;   type_error(json_value, Term)
    ).
json_value(Term) :-
    ( atom(Term) ; string(Term) ; Term == [] ),
    !.
json_value(Term) :-
    is_list(Term),
    !,
    maplist(json_value, Term).
json_value(Term) :-
    is_dict(Term),
    !,
    dict_pairs(Term, _, Pairs),
    pairs_values(Pairs, Values),
    maplist(json_value, Values).
json_value(Term) :-
    type_error(json_value, Term).

finite(Float) :-
    float_class(Float, Class),
    \+ memberchk(Class, [infinite,nan]).
