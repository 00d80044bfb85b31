:- module(typhon_trees,
          [ is_tree/2,                  % +Term, +Most
            is_in_itself/1              % +Term
          ]).
:- use_module(library(lists), [member/2]).

/** <module> Terms that are larger than they look, or without end

*Threading*: pure.
*/

%!  is_tree(+Term, +Most) is semidet.
%
%   Term is acyclic, and has Most parts at the most when what is shared in it
%   is written out: forty cells may be a term of 2^40 parts.

is_tree(Term, _) :-
    atomic(Term),
    !.
is_tree(Term, Most) :-
    acyclic_term(Term),
    (   term_size(Term, Cells),
        Cells =< 48,                    % at most 2^16 parts
        Most >= 65 536
    ->  true
    ;   tree(Term, Most, _)
    ).

tree(Term, N0, N) :-
    N1 is N0-1,
    N1 >= 0,
    (   compound(Term)
    ->  compound_name_arity(Term, _, Arity),
        arguments(1, Arity, Term, N1, N)
    ;   N = N1
    ).

arguments(I, Arity, Term, N0, N) :-
    (   I < Arity
    ->  arg(I, Term, Arg),
        tree(Arg, N0, N1),
        I1 is I+1,
        arguments(I1, Arity, Term, N1, N)
    ;   I =:= Arity
    ->  arg(I, Term, Arg),
        tree(Arg, N0, N)
    ;   N = N0
    ).

%!  is_in_itself(+Term) is semidet.
%
%   Term is a part of one of its own arguments, which is more than to have a
%   part that is: a mark in place of one argument is then found below those
%   that Term has had.

is_in_itself(Term) :-
    cyclic_term(Term),
    \+ \+ ( compound_name_arguments(Term, _, Args),
            setarg(1, Term, Mark),
            term_variables(Args, Variables),
            member(Variable, Variables),
            Variable == Mark ).
