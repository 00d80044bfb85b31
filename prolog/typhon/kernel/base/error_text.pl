:- module(typhon_error_text,
          [ error_lines/3,              % +Error, -Lines, ?Rest
            print_error/2,              % +Kind, +Error
            term_lines/3,               % +Term, -Lines, ?Rest
            large_text/2,               % +Term, -Text
            is_remark/1,                % @Text
            is_abort/1,                 % @Ball
            abridged/3,                 % +Term, +Longest, -Text
            is_tree/2,                  % +Term, +Most
            is_in_itself/1              % +Term
          ]).

/** <module> Errors from elsewhere as text

An error that an agent raises, or that another process answers, is untrusted
data.  print_message/2 would run parts of it: it prints format(Format, Args)
with these arguments, and ~@ calls one of them.  So typhon_error_lines converts
an error to text.  It is loaded at once, since errors are also printed where a
mutex is held.  No hook for printing (portray/1, attributes) sees a part of a
term, and a large term is not written.

*Threading*: pure.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2]).

:- multifile
    lines//1,                           % +Error: the lines of its message
    prolog:message//1.

%!  print_error(+Kind, +Error) is det.
%
%   Print an exception of any origin.

print_error(Kind, Error) :-
    print_message(Kind, typhon(raised(Error))).

prolog:message(typhon(raised(Error))) -->
    error_lines(Error).

%!  is_abort(@Ball) is semidet.
%
%   Ball is the exception of an abort: it ends the thread that catches it.

is_abort(Ball) :-
    nonvar(Ball),
    ends_thread(Ball).

ends_thread('$aborted').
ends_thread(unwind(_)).                 % SWI-Prolog 9.3 and later

%!  error_lines(+Error, -Lines, ?Rest) is det.
%
%   Lines are the message, as of prolog:message//1.

error_lines(Error) -->
    lines(Error),
    !.
error_lines(Error) -->                  % no loaded code translates it
    term_lines(Error).

%!  large_text(+Term, -Text) is det.
%
%   Text is there in place of Term, which is too large.

large_text(Term, Text) :-
    (   callable(Term)
    ->  functor(Term, Name, Arity),
        format(string(Text), 'a large term, ~q', [Name/Arity])
    ;   Text = "a large term"
    ).

%!  term_lines(+Term, -Lines, ?Rest) is det.
%
%   Lines print Term as data: no hook is called.

term_lines(Term) -->
    { is_tree(Term, 200 000) },
    !,
    [ '~W'-[Term, [quoted(true), numbervars(true), portray(false)]] ].
term_lines(Term) -->
    { large_text(Term, Text) },
    [ '~w'-[Text] ].

%!  is_remark(@Text) is semidet.
%
%   Text is a remark that may be in the context of an error.

is_remark(Text) :-
    ( atom(Text) ; string(Text) ),
    !,
    Text \== '',
    Text \== "".

                /*******************************
                *           ABRIDGED           *
                *******************************/

%!  abridged(+Term, +Longest:integer, -Text:string) is det.
%
%   Text is Term as written in a program: a variable that occurs once as `_`,
%   the others as letters.  Text longer than Longest characters is cut off, and
%   ends with three dots.  Deep and cyclic terms are cut off during the
%   traversal, so that a large term costs no more than its text.

abridged(Term, Longest, Text) :-
    copy_term(Term, Copy, _),
    named(Copy),
    Depth is max(10, Longest),
    format(string(Whole), '~W',
           [ Copy, [ quoted(true), numbervars(true), portray(false),
                     max_depth(Depth), cycles(true) ] ]),
    (   sub_string(Whole, 0, Longest, After, Begin),
        After > 3
    ->  string_concat(Begin, "...", Text)
    ;   Text = Whole
    ).

named(Term) :-
    cyclic_term(Term),
    !.
named(Term) :-
    term_singletons(Term, Singletons),
    maplist(=('$VAR'('_')), Singletons),
    numbervars(Term, 0, _).

                /*******************************
                *    CYCLIC AND DEEP TERMS     *
                *******************************/

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
