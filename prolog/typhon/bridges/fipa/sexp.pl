:- module(typhon_fipa_sexp,
          [ sexp_text/2,                % ?Sexp, ?Text
            sexp_word/1,                % +Text
            utc_text/2,                 % ?Stamp, ?Text
            aid_sexp/2,                 % ?Aid, ?Sexp
            aid/1,                      % @Term
            aid_name/2,                 % +Aid, -Name
            aid_addresses/2,            % +Aid, -Addresses
            text_sexp/2,                % +Text, -Sexp
            sexp_atom/2,                % +Sexp, -Atom
            sexp_parameters/2           % +Sexps, -Pairs
          ]).
:- use_module(library(apply), [foldl/4, maplist/2, maplist/3]).
:- use_module(library(dcg/basics),
              [atom//1, blanks//0, digits//1, integer//1]).
:- use_module(library(dcg/high_order), [sequence//3]).
:- use_module(library(error),
              [resource_error/1, syntax_error/1, type_error/2]).
:- use_module(library(lists), [member/2]).

/** <module> S-expressions, the syntax of ACL and SL, and agent identifiers

Both languages of FIPA consist of lists in parentheses.  This module reads and
writes them; typhon_fipa_acl and typhon_fipa_sl define their meaning.  An
S-expression is a Prolog list of S-expressions, string(String) for quoted text,
or an atom for any other word, as it was written.

In quoted text a backslash escapes only a quote; elsewhere it is a backslash, as
in JADE.  A string that ends with a backslash can only be written with its
length in front.

An agent of any platform is fipa(Name, Addresses): its name, an atom like
'seller@jadeplat', and the URLs of its message transports, the best first.
Resolvers and other parameters of an identifier are dropped.  If only the name
matters, fipa(Name) is enough.

*Threading*: pure.
*/

%   Maximal nesting of lists.

max_depth(200).

%!  sexp_text(+Sexp, -Text:string) is det.
%!  sexp_text(-Sexp, +Text:string) is det.
%
%   Text is the written form of Sexp.
%
%   @error syntax_error(fipa_text)
%   @error resource_error(fipa_depth)

sexp_text(Sexp, Text) :-
    nonvar(Text),
    !,
    string_codes(Text, Codes),
    max_depth(Depth),
    (   phrase(document(Depth, Sexp0), Codes)
    ->  Sexp = Sexp0
    ;   syntax_error(fipa_text)
    ).
sexp_text(Sexp, Text) :-
    phrase(written(Sexp), Codes),
    string_codes(Text, Codes).

                /*******************************
                *            READING           *
                *******************************/

document(Depth, Sexp) -->
    blanks,
    item(Depth, Sexp),
    blanks.

item(Depth, List) -->
    "(",
    !,
    { deeper(Depth, Inside) },
    blanks,
    items(Inside, List).
item(_, string(String)) -->
    "\"",
    !,
    quoted(Codes),
    { string_codes(String, Codes) }.
item(_, string(String)) -->
    "#",
    digits([D|Ds]),
    "\"",
    !,
    { length(Ds, Digits),
      Digits < 9,                       % no message is longer
      number_codes(Bytes, [D|Ds])
    },
    counted(Bytes, Codes),
    { string_codes(String, Codes) }.
item(_, Word) -->
    bare(Code),
    bares(Codes),
    { atom_codes(Word, [Code|Codes]) }.

deeper(Depth, Inside) :-
    (   Depth > 0
    ->  Inside is Depth-1
    ;   resource_error(fipa_depth)
    ).

items(_, []) -->
    ")",
    !.
items(Depth, [Item|Items]) -->
    item(Depth, Item),
    !,
    blanks,
    items(Depth, Items).

quoted([]) -->
    "\"",
    !.
quoted([0'"|Codes]) -->
    "\\\"",
    !,
    quoted(Codes).
quoted([Code|Codes]) -->
    [Code],
    quoted(Codes).

%   The length counts bytes.

counted(0, []) -->
    !.
counted(Bytes, [Code|Codes]) -->
    { Bytes > 0 },
    [Code],
    { code_bytes(Code, Width),
      Left is Bytes-Width },
    counted(Left, Codes).

code_bytes(Code, Width) :-
    (   Code < 0x80 -> Width = 1
    ;   Code < 0x800 -> Width = 2
    ;   Code < 0x10000 -> Width = 3
    ;   Width = 4
    ).

bare(Code) -->
    [Code],
    { Code > 0' ,
      \+ memberchk(Code, `()"`) }.

bares([Code|Codes]) -->
    bare(Code),
    !,
    bares(Codes).
bares([]) -->
    [].

                /*******************************
                *            WRITING           *
                *******************************/

written(Sexp) -->
    { var(Sexp),
      type_error(fipa_text, Sexp) }.
written(List) -->
    { is_list(List) },
    !,
    "(",
    sequence(written, " ", List),
    ")".
written(string(String)) -->
    !,
    string_written(String).
written(Word) -->
    atom(Word).

string_written(String) -->
    { sub_string(String, _, 1, 0, "\\") },
    !,
    { string_codes(String, Codes),
      foldl(add_bytes, Codes, 0, Bytes) },
    "#", integer(Bytes), "\"", Codes.
string_written(String) -->
    { atomic_list_concat(Parts, '"', String),
      atomic_list_concat(Parts, '\\"', Escaped) },
    "\"", atom(Escaped), "\"".

add_bytes(Code, Bytes0, Bytes) :-
    code_bytes(Code, Width),
    Bytes is Bytes0+Width.

%!  sexp_word(+Text) is semidet.
%
%   Text, an atom or a string, needs no quotes, and is a word in both languages:
%   not a number, a date, a variable or the name of a parameter.

sexp_word(Text) :-
    atom_codes(Text, [First|Codes]),
    plain(First),
    \+ memberchk(First, `#-:?+0123456789`),
    \+ ( member(Code, Codes), \+ plain(Code) ).

plain(Code) :-
    Code > 0' ,
    Code < 0x7f,
    \+ memberchk(Code, `()"`).

%!  utc_text(+Stamp, -Text:atom) is det.
%!  utc_text(-Stamp, +Text) is semidet.
%
%   Text is a time in the form of FIPA, to the millisecond:
%   `20261122T081127162Z`.

utc_text(Stamp, Text) :-
    nonvar(Text),
    !,
    atom_codes(Text, Codes),
    phrase(utc(Stamp), Codes).
utc_text(Stamp, Text) :-
    Ms is round(Stamp*1000),
    Seconds is Ms // 1000,
    Fraction is Ms mod 1000,
    format_time(atom(Date), '%Y%m%dT%H%M%S', Seconds),
    format(atom(Text), '~w~|~`0t~d~3+Z', [Date, Fraction]).

utc(Stamp) -->
    number_of(4, Y), number_of(2, M), number_of(2, D),
    t,
    number_of(2, H), number_of(2, Min), number_of(2, S), number_of(3, Ms),
    zone,
    { M >= 1, M =< 12, D >= 1, D =< 31, H < 24, Min < 60, S < 61,
      date_time_stamp(date(Y,M,D,H,Min,S,0,-,-), Stamp0),
      Stamp is (round(Stamp0)*1000+Ms)/1000.0 }.

t --> [Code], { memberchk(Code, `TtZz`) }.       % JADE writes Z in envelopes

zone --> [Code], !, { memberchk(Code, `Zz`) }.
zone --> [].

number_of(Count, Number) -->
    { length(Codes, Count) },
    digits(Codes),
    { number_codes(Number, Codes) }.

                /*******************************
                *      AGENT IDENTIFIERS       *
                *******************************/

%!  aid(@Term) is semidet.
%
%   Term is an agent identifier, fipa(Name) or fipa(Name, Addresses).

aid(Term) :-
    subsumes_term(fipa(_), Term),
    !,
    Term = fipa(Name),
    text(Name).
aid(Term) :-
    subsumes_term(fipa(_, _), Term),
    Term = fipa(Name, Addresses),
    text(Name),
    is_list(Addresses),
    maplist(text, Addresses).

text(Text) :-
    (   atom(Text)
    ;   string(Text)
    ),
    !.

%!  aid_name(+Aid, -Name:atom) is det.
%!  aid_addresses(+Aid, -Addresses:list(atom)) is det.
%
%   Name is the name in Aid; Addresses are its addresses, `[]` if it has none.

aid_name(fipa(Text), Name) =>
    atom_string(Name, Text).
aid_name(fipa(Text, _), Name) =>
    atom_string(Name, Text).

aid_addresses(fipa(_), Addresses) =>
    Addresses = [].
aid_addresses(fipa(_, Texts), Addresses) =>
    maplist([Text, Atom]>>atom_string(Atom, Text), Texts, Addresses).

%!  aid_sexp(+Aid, -Sexp) is det.
%!  aid_sexp(-Aid, +Sexp) is semidet.
%
%   Sexp is the S-expression of the agent identifier Aid.
%
%   @error type_error(fipa_agent, Aid)

aid_sexp(Aid, Sexp) :-
    nonvar(Sexp),
    !,
    Sexp = [Head|Rest],
    sexp_atom(Head, 'agent-identifier'),
    sexp_parameters(Rest, Pairs),
    memberchk(name-Name0, Pairs),
    sexp_atom(Name0, Name),
    (   memberchk(addresses-[_|Urls], Pairs)
    ->  maplist(sexp_atom, Urls, Addresses)
    ;   Addresses = []
    ),
    Aid = fipa(Name, Addresses).
aid_sexp(Aid, ['agent-identifier', ':name', Name|More]) :-
    aid(Aid),
    !,
    aid_name(Aid, Name0),
    aid_addresses(Aid, Addresses0),
    text_sexp(Name0, Name),
    (   Addresses0 == []
    ->  More = []
    ;   maplist(text_sexp, Addresses0, Addresses),
        More = [':addresses', [sequence|Addresses]]
    ).
aid_sexp(Aid, _) :-
    type_error(fipa_agent, Aid).

%!  text_sexp(+Text, -Sexp) is det.
%!  sexp_atom(+Sexp, -Atom) is det.
%
%   Sexp is Text as a word if it can be one, else quoted.  Atom is the text of a
%   word or quoted text; for a list, its written form.

text_sexp(Text, Sexp) :-
    (   sexp_word(Text)
    ->  atom_string(Sexp, Text)
    ;   text_to_string(Text, String),
        Sexp = string(String)
    ).

sexp_atom(string(String), Atom) =>
    atom_string(Atom, String).
sexp_atom(Sexp, Atom), is_list(Sexp) =>
    sexp_text(Sexp, String),
    atom_string(Atom, String).
sexp_atom(Word, Atom) =>
    Atom = Word.

%!  sexp_parameters(+Sexps:list, -Pairs) is semidet.
%
%   Sexps are parameters, `:name value`; Pairs are Name-Value, the names in
%   lower case.

sexp_parameters([], []).
sexp_parameters([Key, Value|Sexps], [Name-Value|Pairs]) :-
    atom(Key),
    atom_concat(:, Name0, Key),
    Name0 \== '',
    downcase_atom(Name0, Name),
    sexp_parameters(Sexps, Pairs).
