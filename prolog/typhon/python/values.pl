:- module(typhon_python_values,
          [ python_value/1              % +Term
          ]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(error), [instantiation_error/1, type_error/2]).
:- use_module(library(pairs), [pairs_values/2]).

/** <module> What Python understands

Numbers, strings, lists and dicts are what they are there; the atoms `null`,
`true` and `false` are None, True and False, other atoms strings.  What comes
from Python is made of the same, its strings being strings.

*Threading*: pure.
*/

%!  python_value(+Term) is det.
%
%   @error instantiation_error, type_error(python_value, Culprit)

python_value(Term) :-
    var(Term),
    !,
    instantiation_error(Term).
python_value(Term) :-
    number(Term),
    !,
    (   ( integer(Term) ; float(Term), finite(Term) )
    ->  true
    ;   type_error(python_value, Term)
    ).
python_value(Term) :-
    ( atom(Term) ; string(Term) ; Term == [] ),
    !.
python_value(Term) :-
    is_list(Term),
    !,
    maplist(python_value, Term).
python_value(Term) :-
    is_dict(Term),
    !,
    dict_pairs(Term, _, Pairs),
    pairs_values(Pairs, Values),
    maplist(python_value, Values).
python_value(Term) :-
    type_error(python_value, Term).

finite(Float) :-
    float_class(Float, Class),
    \+ memberchk(Class, [infinite,nan]).
