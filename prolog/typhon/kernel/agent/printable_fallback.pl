:- module(typhon_printable_fallback,
          [ in_words/2                  % +Term, -Portable
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/trees', [is_in_itself/1]).
:- use_module('../wire', [mobile_term/1]).

/** <module> Terms that can be told everywhere

An error or a goal may hold what cannot travel.  That stands in it in words,
so that it is still the same error, and one can see what was the matter.

*Threading*: pure.
*/

%!  in_words(+Term, -Portable) is det.
%
%   Portable is Term, with an atom in place of each part that cannot travel.

in_words(Term, Portable) :-
    catch(mobile_term(Term), error(_, _), fail),
    !,
    Portable = Term.
in_words(Term, 'a cyclic term') :-
    is_in_itself(Term),
    !.
in_words(Term, Words) :-
    attvar(Term),
    !,
    copy_term(Term, _, Goals),
    attributed(Goals, Words).
in_words(Term, Portable) :-
    compound(Term),
    !,
    compound_name_arguments(Term, Name, Args0),
    maplist(in_words, Args0, Args),
    compound_name_arguments(Portable, Name, Args).
in_words(Term, Words) :-
    blob(Term, Type),
    format(atom(Words), 'a ~w (~w)', [Type, Term]).

attributed(Goals, Words) :-
    member(Goal0, Goals),
    strip_module(Goal0, _, Goal),
    callable(Goal),
    !,
    functor(Goal, Name, Arity),
    format(atom(Words), 'an attributed variable (~q)', [Name/Arity]).
attributed(_, 'an attributed variable').
