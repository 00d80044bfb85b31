:- module(typhon_refusing,
          [ refuse/1,                   % +Culprit
            must_be_tree/1,             % +Term
            clause_cells/1              % -Max
          ]).
:- use_module(library(error), [permission_error/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/trees', [is_tree/2]).

/** <module> Reasons of refusals

*Threading*: pure.
*/

:- setting(clause_cells, positive_integer, 200 000,
           "Clauses that strangers add have at most so many parts").

%!  must_be_tree(+Term) is det.
%
%   Term is acyclic, and not larger than clauses may be when what is shared in
%   it is written out.
%
%   @error resource_error(clause_cells)

must_be_tree(Term) :-
    clause_cells(Max),
    (   is_tree(Term, Max)
    ->  true
    ;   throw(error(resource_error(clause_cells), _))
    ).

%!  clause_cells(-Max:integer) is det.

clause_cells(Max) :-
    setting(clause_cells, Max).

%!  refuse(+Culprit)
%
%   A large term is reported by its name.
%
%   @error permission_error(call, sandboxed, Culprit)

refuse(Culprit) :-
    (   \+ is_tree(Culprit, 1000),
        callable(Culprit)
    ->  functor(Culprit, Name, Arity),
        permission_error(call, sandboxed, Name/Arity)
    ;   permission_error(call, sandboxed, Culprit)
    ).
