:- module(typhon_json,
          [ json_dict/2,                % +Text, -Term
            json_text/2                 % +Term, -Text
          ]).
:- use_module(library(lists), [reverse/2]).

:- if(exists_source(library(json))).
:- use_module(library(json), [atom_json_dict/3]).
:- else.
:- use_module(library(http/json), [atom_json_dict/3]).
:- endif.

/** <module> JSON: the reader and the writer of all bridges and of the page

The reader is for texts of any origin.  It accepts what RFC 8259 defines and, as
many programs write it, `NaN`, `Infinity` and `-Infinity`.

*Threading*: no state.
*/

%!  json_text(+Term, -Text:string) is det.
%
%   One line; Term is as in json_write_dict/3.

json_text(Term, Text) :-
    atom_json_dict(Text, Term, [as(string), width(0)]).

%!  json_dict(+Text, -Term) is det.
%
%   Term is the value of the JSON text: dicts, none with a tag, lists, strings,
%   numbers, `true`, `false` and `null`.  A number that is not finite as a float
%   is `null`.  Of members with the same key the last one counts.  Half of a
%   surrogate pair is U+FFFD.
%
%   @error syntax_error(json(illegal_json))

json_dict(Text, Term) :-
    string_codes(Text, Codes),
    (   phrase(document(Value), Codes)
    ->  Term = Value
    ;   throw(error(syntax_error(json(illegal_json)), _))
    ).

document(Value) -->
    ws, value(Value), ws.

ws --> [C], { ws(C) }, !, ws.
ws --> [].

ws(0'\s).
ws(0'\t).
ws(0'\n).
ws(0'\r).

value(Value) -->
    [C], value(C, Value).

value(0'{, Dict) --> !, ws, members(Pairs), { pairs_dict(Pairs, Dict) }.
value(0'[, List) --> !, ws, elements(List).
value(0'", String) --> !, chars(Codes), { string_codes(String, Codes) }.
value(0't, true) --> !, "rue".
value(0'f, false) --> !, "alse".
value(0'n, null) --> !, "ull".
value(0'N, null) --> !, "aN".
value(0'I, null) --> !, "nfinity".
value(0'-, null) --> "Infinity", !.
value(C, Number) -->
    integer(C, Codes, Fraction),
    fraction(Fraction, Exponent),
    exponent(Fraction, Exponent),
    { finite(Codes, Number) }.

members([]) --> "}", !.
members([Pair|Pairs]) --> pair(Pair), members_end(Pairs).

members_end([Pair|Pairs]) --> ",", !, ws, pair(Pair), members_end(Pairs).
members_end([]) --> "}".

pair(Key-Value) -->
    "\"", chars(Codes), ws, ":", ws, value(Value), ws,
    { atom_codes(Key, Codes) }.

pairs_dict(Pairs, Dict) :-
    reverse(Pairs, LastFirst),
    sort(1, @<, LastFirst, Unique),     % keeps the first of each key
    dict_pairs(Dict, _, Unique).

elements([]) --> "]", !.
elements([Value|Values]) --> value(Value), ws, elements_end(Values).

elements_end([Value|Values]) -->
    ",", !, ws, value(Value), ws, elements_end(Values).
elements_end([]) --> "]".

                /*******************************
                *            STRINGS           *
                *******************************/

chars(Codes) -->
    [C], chars(C, Codes).

chars(0'", []) --> !.
chars(0'\\, [Code|Codes]) --> !, [C], escape(C, Code), chars(Codes).
chars(C, [C|Codes]) --> { C >= 0x20 }, chars(Codes).

escape(0'u, Code) --> !, unit(Unit), character(Unit, Code).
escape(C, Code) --> { escaped(C, Code) }.

escaped(0'", 0'").
escaped(0'\\, 0'\\).
escaped(0'/, 0'/).
escaped(0'b, 0'\b).
escaped(0'f, 0'\f).
escaped(0'n, 0'\n).
escaped(0'r, 0'\r).
escaped(0't, 0'\t).

unit(Unit) -->
    hex(A), hex(B), hex(C), hex(D),
    { Unit is ((A*16+B)*16+C)*16+D }.

hex(Weight) -->
    [C], { C < 128, code_type(C, xdigit(Weight)) }.

character(High, Code) -->
    { between(0xD800, 0xDBFF, High) },
    "\\u", unit(Low),
    { between(0xDC00, 0xDFFF, Low) },
    !,
    { Code is 0x10000 + (High-0xD800)*0x400 + Low-0xDC00 }.
character(Unit, Code) -->
    { between(0xD800, 0xDFFF, Unit) -> Code = 0xFFFD ; Code = Unit }.

                /*******************************
                *            NUMBERS           *
                *******************************/

%   Parts of a number are open lists of codes, in the syntax of Prolog: a
%   number with an exponent gets a fraction.

integer(0'-, [0'-|Codes], End) --> !, [C], natural(C, Codes, End).
integer(C, Codes, End) --> natural(C, Codes, End).

natural(0'0, [0'0|End], End) --> !.
natural(C, [C|Codes], End) --> { digit(C) }, digits(Codes, End).

digits([C|Codes], End) --> [C], { digit(C) }, !, digits(Codes, End).
digits(End, End) --> [].

digits1([C|Codes], End) --> [C], { digit(C) }, digits(Codes, End).

digit(0'0).
digit(0'1).
digit(0'2).
digit(0'3).
digit(0'4).
digit(0'5).
digit(0'6).
digit(0'7).
digit(0'8).
digit(0'9).

fraction([0'.|Codes], End) --> ".", !, digits1(Codes, End).
fraction(End, End) --> [].

exponent(Fraction, Codes) -->
    ( "e" ; "E" ), !,
    { Fraction == Codes -> Codes = [0'.,0'0,0'e|Rest] ; Codes = [0'e|Rest] },
    sign(Rest, Digits),
    digits1(Digits, []).
exponent(_, []) --> [].

sign([0'-|End], End) --> "-", !.
sign(End, End) --> "+", !.
sign(End, End) --> [].

%   Prolog raises an error, or has an infinite number, as its flags demand.

finite(Codes, Number) :-
    (   catch(number_codes(Number0, Codes), error(syntax_error(_), _), fail),
        \+ ( float(Number0), float_class(Number0, infinite) )
    ->  Number = Number0
    ;   Number = null
    ).
