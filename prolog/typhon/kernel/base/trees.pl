:- module(typhon_trees,
          [ is_tree/2,                  % +Term, +Most
            is_in_itself/1              % +Term
          ]).
:- use_module(library(lists), [member/2]).

/** <module> Large and cyclic terms

*Threading*: pure.
*/

%!  is_tree(+Term, +Most) is semidet.
%
%   Term is acyclic, and has at most Most parts when shared parts are written
%   out: forty cells may be a term of 2^40 parts.  Each eight characters of a
%   text, and each eight bytes of an integer, count as a part, too.

is_tree(Term, Most) :-
    acyclic_term(Term),
    tree(Term, Most, _).

tree(Term, N0, N) :-
    (   atom(Term)
    ->  atom_length(Term, Length),
        N is N0-1-Length//8
    ;   integer(Term),
        is_small(Term)
    ->  N is N0-1
    ;   nonvar(Term),
        Term = [Head|Tail]
    ->  N1 is N0-1,
        N1 >= 0,
        tree(Head, N1, N2),
        tree(Tail, N2, N)
    ;   compound(Term)
    ->  compound_name_arity(Term, Name, Arity),
        name_parts(Name, Parts),
        N1 is N0-Parts,
        N1 >= 0,
        arguments(1, Arity, Term, N1, N)
    ;   text_parts(Term, Parts),
        N is N0-Parts
    ),
    N >= 0.

%   The name of a dict is not an atom.

name_parts(Name, Parts) :-
    (   atom(Name)
    ->  atom_length(Name, Length),
        Parts is 1+Length//8
    ;   Parts = 1
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

%   Strings and integers may be long, too.

text_parts(Term, Parts) :-
    (   integer(Term)
    ->  Parts is 1+msb(abs(Term))//64
    ;   string(Term)
    ->  string_length(Term, Length),
        Parts is 1+Length//8
    ;   rational(Term, N, D)
    ->  Parts is 2+msb(abs(N)+1)//64+msb(D)//64
    ;   Parts = 1
    ).

is_small(Integer) :-
    Integer >= -0x7fff_ffff,
    Integer =< 0x7fff_ffff.

%!  is_in_itself(+Term) is semidet.
%
%   Term is a part of one of its own arguments.  This is a stronger condition
%   than being cyclic: a mark that replaces one argument is then found below
%   the former arguments of Term.

is_in_itself(Term) :-
    cyclic_term(Term),
    \+ \+ ( compound_name_arguments(Term, _, Args),
            setarg(1, Term, Mark),
            term_variables(Args, Variables),
            member(Variable, Variables),
            Variable == Mark ).
