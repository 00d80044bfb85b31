:- module(typhon_fipa_aid,
          [ aid_sexp/2,                 % ?Aid, ?Sexp
            aid/1,                      % @Term
            aid_name/2,                 % +Aid, -Name
            aid_addresses/2,            % +Aid, -Addresses
            text_sexp/2,                % +Text, -Sexp
            sexp_atom/2,                % +Sexp, -Atom
            sexp_parameters/2           % +Sexps, -Pairs
          ]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(error), [type_error/2]).
:- use_module(sexp, [sexp_text/2, sexp_word/1]).

/** <module> Agent identifiers

An agent of any platform is fipa(Name, Addresses): its name, an atom like
'seller@jadeplat', and the URLs at which it takes messages, the best first.
Resolvers and other parameters of an identifier are not kept.  Where nothing
but the name matters fipa(Name) is enough.

*Threading*: pure.
*/

%!  aid(@Term) is semidet.

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
%   Sexp is Text as a word if it can be one, else quoted.  Atom is the text of
%   a word or quoted text; of a list, its written form.

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
