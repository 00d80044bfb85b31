:- module(typhon_json,
          [ json_dict/2,                % +Text, -Term
            json_text/2,                % +Term, -Text
            json_value/1                % +Term
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [instantiation_error/1, type_error/2]).
:- use_module(library(lists), [reverse/2]).
:- use_module(library(pairs), [pairs_keys_values/3]).

:- if(exists_source(library(json))).
:- use_module(library(json), [atom_json_dict/3]).
:- else.
:- use_module(library(http/json), [atom_json_dict/3]).
:- endif.

/** <module> JSON: the reader and the writer of all bridges and of the page

The reader is for texts of any origin.  It accepts what RFC 8259 defines and, as
many programs write them, `NaN`, `Infinity`, `-Infinity`, and a byte order mark
before the value.  The library drops such texts, and those with repeated keys;
it leaves surrogate pairs as two characters, and accepts `[1,]` and `[01]`.

*Threading*: no state.
*/

:- set_prolog_flag(optimise, true).     % arithmetic without calls

deepest(600).                   % levels; readers in Python have 1000
longest(4300).                  % characters of a number, as in Python; the
                                % time to read it is quadratic

                /*******************************
                *            WRITING           *
                *******************************/

%!  json_text(+Term, -Text:string) is det.
%
%   Text is Term in one line.
%
%   @error the errors of json_value/1
%   @error representation_error(code_point) a text has half a surrogate pair

json_text(Term, Text) :-
    json_value(Term),
    atom_json_dict(Text, Term, [as(string), width(0)]).

%!  json_value(+Term) is det.
%
%   Term can be written as JSON: texts, integers, finite floats, and lists and
%   dicts of such terms.  The members Name=Value of json(Members) keep their
%   order.
%
%   @error instantiation_error, type_error(json_value, Culprit)

json_value(Term) :-
    deepest(Depth),
    json_value(Depth, Term).

json_value(Depth, Term) :-
    (   var(Term)
    ->  instantiation_error(Term)
    ;   ( atom(Term) ; string(Term) ; integer(Term) )
    ->  true
    ;   float(Term),
        finite(Term)
    ->  true
    ;   Depth > 0,
        json_parts(Term, Parts)
    ->  Depth1 is Depth-1,
        maplist(json_value(Depth1), Parts)
    ;   type_error(json_value, Term)
    ).

json_parts(Term, Term) :-
    is_list(Term),
    !.
json_parts(Dict, Values) :-
    is_dict(Dict),
    !,
    dict_pairs(Dict, _, Pairs),
    pairs_keys_values(Pairs, Keys, Values),
    maplist(atom, Keys).
json_parts(json(Members), Values) :-
    is_list(Members),
    maplist(member_value, Members, Values).

member_value(Name=Value, Value) :-
    atom(Name).

finite(Float) :-
    float_class(Float, Class),
    \+ memberchk(Class, [infinite,nan]).

                /*******************************
                *            READING           *
                *******************************/

%!  json_dict(+Text, -Term) is det.
%
%   Term is the value of the JSON text: dicts, none with a tag, lists, strings,
%   numbers, `true`, `false` and `null`.  A number that is not finite as a float,
%   or has more than 4300 characters, is `null`.  Of members with the same key
%   the last one counts.  Half of a surrogate pair is U+FFFD.  Text with more
%   than 600 levels of lists and dicts is illegal.
%
%   @error syntax_error(json(illegal_json))

json_dict(Text, Term) :-
    string_codes(Text, Codes),
    (   phrase(document(Value), Codes)
    ->  Term = Value
    ;   throw(error(syntax_error(json(illegal_json)), _))
    ).

document(Value) -->
    ( "\uFEFF" ; "" ), !,
    { deepest(Depth) },
    ws, value(Depth, Value), ws.

ws --> [C], { ws(C) }, !, ws.
ws --> [].

ws(0'\s).
ws(0'\t).
ws(0'\n).
ws(0'\r).

value(Depth, Value) -->
    [C], value(C, Depth, Value).

value(0'{, Depth, Dict) -->
    !,
    { Depth > 0, Depth1 is Depth-1 },
    ws, members(Depth1, Pairs),
    { pairs_dict(Pairs, Dict) }.
value(0'[, Depth, List) -->
    !,
    { Depth > 0, Depth1 is Depth-1 },
    ws, elements(Depth1, List).
value(0'", _, String) --> !, chars(Codes), { string_codes(String, Codes) }.
value(0't, _, true) --> !, "rue".
value(0'f, _, false) --> !, "alse".
value(0'n, _, null) --> !, "ull".
value(0'N, _, null) --> !, "aN".
value(0'I, _, null) --> !, "nfinity".
value(0'-, _, null) --> "Infinity", !.
value(C, _, Number) -->
    integer(C, Codes, Fraction),
    fraction(Fraction, Exponent),
    exponent(Fraction, Exponent),
    { number_or_null(Codes, Number) }.

members(_, []) --> "}", !.
members(Depth, [Pair|Pairs]) --> pair(Depth, Pair), members_end(Depth, Pairs).

members_end(Depth, [Pair|Pairs]) -->
    ",", !, ws, pair(Depth, Pair), members_end(Depth, Pairs).
members_end(_, []) --> "}".

pair(Depth, Key-Value) -->
    "\"", chars(Codes), ws, ":", ws, value(Depth, Value), ws,
    { atom_codes(Key, Codes) }.

pairs_dict(Pairs, Dict) :-
    reverse(Pairs, LastFirst),
    sort(1, @<, LastFirst, Unique),     % keeps the first of each key
    dict_pairs(Dict, _, Unique).

elements(_, []) --> "]", !.
elements(Depth, [Value|Values]) -->
    value(Depth, Value), ws, elements_end(Depth, Values).

elements_end(Depth, [Value|Values]) -->
    ",", !, ws, value(Depth, Value), ws, elements_end(Depth, Values).
elements_end(_, []) --> "]".

                /*******************************
                *            STRINGS           *
                *******************************/

chars(Codes) -->
    [C], chars(C, Codes).

chars(0'", []) --> !.
chars(0'\\, [Code|Codes]) --> !, [C], escape(C, Code), chars(Codes).
chars(C, [C|Codes]) --> { C >= 0x20, C < 0xD800 }, !, chars(Codes).
chars(C, [Code|Codes]) --> { C >= 0x20, whole(C, Code) }, chars(Codes).

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
    { whole(Unit, Code) }.

whole(Unit, Code) :-
    ( between(0xD800, 0xDFFF, Unit) -> Code = 0xFFFD ; Code = Unit ).

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

digit(C) :-
    C >= 0'0,
    C =< 0'9.

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

number_or_null(Codes, Number) :-
    (   length(Codes, Length),
        longest(Longest),
        Length =< Longest,
        catch(number_codes(Number0, Codes), error(_, _), fail),
        ( integer(Number0) ; finite(Number0) )
    ->  Number = Number0
    ;   Number = null
    ).
