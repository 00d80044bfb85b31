:- module(typhon_fipa_sl,
          [ sl_text/2                   % ?Terms, ?Text
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [must_be/2, syntax_error/1, type_error/2]).
:- use_module(library(lists), [member/2]).
:- use_module(sexp,
              [ aid/1, aid_sexp/2, sexp_atom/2, sexp_text/2, sexp_word/1,
                text_sexp/2, utc_text/2 ]).

/** <module> The content language SL, as terms

A content is a list of expressions.  The managers of platforms use only SL0; the
rest of SL has the same form, and is read and written, too.

  | SL                                         | Prolog                 |
  | ------------------------------------------ | ---------------------- |
  | `word`                                     | an atom                |
  | `"text"`                                   | a string               |
  | `12`, `1.5`                                | a number               |
  | `20261122T081127162Z`                      | date(Stamp)            |
  | `?x`                                       | var(x)                 |
  | `(sequence a b)`                           | a list                 |
  | `(set a b)`                                | set(List)              |
  | `(agent-identifier :name n ...)`           | fipa(Name, Addresses)  |
  | `(f a b)`                                  | f(a, b)                |
  | `(f :k a :l b)`                            | f(k:a, l:b)            |

An atom that is no word of SL, as 'two words', is written in quotes and so is
read as a string.

*Threading*: pure.
*/

%!  sl_text(+Terms:list, -Text:string) is det.
%!  sl_text(-Terms, +Text) is det.
%
%   Text is the written form of the content Terms.
%
%   @error syntax_error(fipa_text), syntax_error(fipa_content)
%   @error type_error(fipa_term, Term)
%   @error resource_error(fipa_depth)

sl_text(Terms, Text) :-
    nonvar(Text),
    !,
    sexp_text(Sexp, Text),
    (   is_list(Sexp)
    ->  maplist(sl_term, Sexp, Terms)
    ;   syntax_error(fipa_content)
    ).
sl_text(Terms, Text) :-
    must_be(list, Terms),
    maplist(term_sexp, Terms, Sexps),
    sexp_text(Sexps, Text).

                /*******************************
                *            READING           *
                *******************************/

sl_term(string(String), Term) =>
    Term = String.
sl_term([], _) =>
    syntax_error(fipa_content).
sl_term([Head|Sexps], Term) =>
    read_compound(Head, Sexps, Term).
sl_term(Word, Term) =>
    read_word(Word, Term).

read_compound(Head, Sexps, Term) :-
    (   Head = [_|_]
    ->  syntax_error(fipa_content)
    ;   sexp_atom(Head, Name0),
        downcase_special(Name0, Name)
    ),
    read_special(Name, Sexps, Term),
    !.
read_compound(Head, Sexps, Term) :-
    sexp_atom(Head, Name),
    read_arguments(Sexps, Arguments),
    compound_name_arguments(Term, Name, Arguments).

downcase_special(Name0, Name) :-
    downcase_atom(Name0, Down),
    (   memberchk(Down, [sequence, set, 'agent-identifier'])
    ->  Name = Down
    ;   Name = Name0
    ).

read_special(sequence, Sexps, Terms) :-
    maplist(sl_term, Sexps, Terms).
read_special(set, Sexps, set(Terms)) :-
    maplist(sl_term, Sexps, Terms).
read_special('agent-identifier', Sexps, Aid) :-
    aid_sexp(Aid, ['agent-identifier'|Sexps]).

read_arguments([], []).
read_arguments([Sexp|Sexps], [Argument|Arguments]) :-
    (   parameter(Sexp, Name)
    ->  (   Sexps = [Value0|Rest]
        ->  sl_term(Value0, Value),
            Argument = Name:Value
        ;   syntax_error(fipa_content)
        )
    ;   sl_term(Sexp, Argument),
        Rest = Sexps
    ),
    read_arguments(Rest, Arguments).

parameter(Word, Name) :-
    atom(Word),
    atom_concat(:, Name, Word),
    Name \== ''.

read_word(Word, _) :-
    parameter(Word, _),
    !,
    syntax_error(fipa_content).
read_word(Word, Term) :-
    atom_concat(?, Name, Word),
    !,
    Term = var(Name).
read_word(Word, Term) :-
    utc_text(Stamp, Word),
    !,
    Term = date(Stamp).
read_word(Word, Term) :-
    numeral(Word),
    catch(atom_number(Word, Number), error(_, _), fail),
    !,
    Term = Number.
read_word(Word, Word).

%   Word may be a number, and is short enough to be parsed quickly.

numeral(Word) :-
    atom_length(Word, Length),
    Length =< 100,
    atom_codes(Word, Codes),
    (   Codes = [Sign|Digits],
        memberchk(Sign, `+-`)
    ->  true
    ;   Digits = Codes
    ),
    Digits = [First|_],
    code_type(First, digit),
    \+ ( member(Code, Digits),
         \+ memberchk(Code, `0123456789.eE+-xXabcdfABCDF`) ).

                /*******************************
                *            WRITING           *
                *******************************/

term_sexp(Term, _), var(Term) =>
    type_error(fipa_term, Term).
term_sexp(Term, Sexp), string(Term) =>
    Sexp = string(Term).
term_sexp(Term, Sexp), integer(Term) =>
    atom_number(Sexp, Term).
term_sexp(Term, Sexp), float(Term) =>
    float_sexp(Term, Sexp).
term_sexp(Term, Sexp), is_list(Term) =>
    maplist(term_sexp, Term, Sexps),
    Sexp = [sequence|Sexps].
term_sexp(Term, Sexp), atom(Term) =>
    text_sexp(Term, Sexp).
term_sexp(Term, Sexp), compound(Term) =>
    compound_sexp(Term, Sexp).
term_sexp(Term, _) =>
    type_error(fipa_term, Term).

float_sexp(Float, Sexp) :-
    float_class(Float, Class),
    (   memberchk(Class, [infinite, nan])
    ->  type_error(fipa_term, Float)
    ;   format(atom(Sexp), '~w', [Float])
    ).

compound_sexp(Term, Sexp), aid(Term) =>
    aid_sexp(Term, Sexp).
compound_sexp(set(List), Sexp), is_list(List) =>
    maplist(term_sexp, List, Sexps),
    Sexp = [set|Sexps].
compound_sexp(date(Stamp), Sexp), number(Stamp) =>
    utc_text(Stamp, Sexp).
compound_sexp(var(Name), Sexp), atom(Name) =>
    atom_concat(?, Name, Sexp).
compound_sexp(_:_, _) =>
    syntax_error(fipa_content).
compound_sexp([_|_], _) =>
    type_error(list, partial).
compound_sexp(Term, Sexp) =>
    compound_name_arguments(Term, Name, Arguments),
    text_sexp(Name, Head),
    arguments_sexps(Arguments, Sexps),
    Sexp = [Head|Sexps].

arguments_sexps([], []).
arguments_sexps([Argument|Arguments], Sexps) :-
    (   nonvar(Argument),
        Argument = Name:Value
    ->  parameter_word(Name, Key),
        term_sexp(Value, Sexp),
        Sexps = [Key, Sexp|More]
    ;   term_sexp(Argument, Sexp),
        Sexps = [Sexp|More]
    ),
    arguments_sexps(Arguments, More).

parameter_word(Name, Key) :-
    (   atom(Name),
        sexp_word(Name)
    ->  atom_concat(:, Name, Key)
    ;   type_error(fipa_term, Name)
    ).
