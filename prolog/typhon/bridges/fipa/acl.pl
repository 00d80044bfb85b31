:- module(typhon_fipa_acl,
          [ acl_text/2,                 % ?Acl, ?Text
            acl_parameter/2,            % +Acl, ?Parameter
            acl_with/3,                 % +Acl, +Parameters, -Acl
            acl_reply/4,                % +Acl, +Performative, +Content, -Reply
            must_be_acl/1,              % @Acl
            performative/1              % ?Performative
          ]).
:- use_module(library(apply), [foldl/4, maplist/3]).
:- use_module(library(error),
              [domain_error/2, must_be/2, syntax_error/1, type_error/2]).
:- use_module(library(lists), [append/2, append/3, member/2, selectchk/3]).
:- use_module(sexp,
              [ aid_sexp/2, sexp_atom/2, sexp_parameters/2, sexp_text/2,
                sexp_word/1, text_sexp/2, utc_text/2 ]).
:- use_module(sl, [sl_text/2]).

/** <module> Messages of FIPA's ACL

A message is acl(Performative, Parameters), as acl(request, [content(C),
protocol('fipa-request')]).  Its string representation is that of FIPA00070.

  | parameter                                  | value                     |
  | ------------------------------------------ | ------------------------- |
  | sender                                     | fipa(Name, Addresses)     |
  | receiver, reply_to                         | a list of these terms     |
  | content                                    | a list of terms if the    |
  |                                            | language is SL, else a    |
  |                                            | string                    |
  | reply_by                                   | a time stamp              |
  | language, ontology, protocol, encoding,    | an atom                   |
  | conversation_id, reply_with, in_reply_to   |                           |
  | others, such as 'x-colour'               | an atom                   |

In messages that are read the conversation is the first parameter, so that an
agent can wait for messages of one conversation:
`receive(_-acl(P, [conversation_id(Id)|_]))`.

In a message to be written, names like `reply-with` are also accepted.  A
content that is a list or a compound term is written in SL, with the language
`fipa-sl` unless another one is given; an atom, a string or a number is written
unchanged.

*Threading*: pure.
*/

%!  performative(?Performative) is nondet.
%
%   Performative is a communicative act of FIPA00037.

performative('accept-proposal').
performative(agree).
performative(cancel).
performative(cfp).
performative(confirm).
performative(disconfirm).
performative(failure).
performative(inform).
performative('inform-if').
performative('inform-ref').
performative('not-understood').
performative(propagate).
performative(propose).
performative(proxy).
performative('query-if').
performative('query-ref').
performative(refuse).
performative('reject-proposal').
performative(request).
performative('request-when').
performative('request-whenever').
performative(subscribe).

%!  acl_parameter(+Acl, ?Parameter) is semidet.
%
%   Parameter is the first parameter of Acl that unifies with it.

acl_parameter(acl(_, Parameters), Parameter) :-
    memberchk(Parameter, Parameters).

%!  acl_with(+Acl, +Parameters:list, -With) is det.
%
%   With is Acl with Parameters, which replace parameters of the same names.

acl_with(acl(Performative, Old), Parameters, acl(Performative, New)) :-
    foldl(put_parameter, Parameters, Old, New).

put_parameter(Parameter, Old, New) :-
    functor(Parameter, Name, 1),
    functor(Any, Name, 1),
    (   selectchk(Any, Old, Rest)
    ->  true
    ;   Rest = Old
    ),
    append(Rest, [Parameter], New).

%!  acl_reply(+Acl, +Performative, +Content, -Reply) is det.
%
%   Reply answers Acl, in its conversation.

acl_reply(Acl, Performative, Content, Reply) :-
    fipa_answer(Acl, Performative, Content, _, Reply).

:- include('../../../../payloads/fipa/answer').

%!  acl_text(+Acl, -Text:string) is det.
%!  acl_text(-Acl, +Text) is det.
%
%   Text is the string representation of Acl.
%
%   @error domain_error(performative, P) only for a message that is written
%   @error type_error(fipa_parameter, Parameter)
%   @error syntax_error(fipa_text), syntax_error(fipa_message)

acl_text(Acl, Text) :-
    nonvar(Text),
    !,
    sexp_text(Sexp, Text),
    (   Sexp = [Head|Rest],
        atom(Head),
        sexp_parameters(Rest, Pairs),
        maplist(read_parameter, Pairs, Parameters0)
    ->  downcase_atom(Head, Performative)
    ;   syntax_error(fipa_message)
    ),
    parse_content(Parameters0, Parameters1),
    conversation_first(Parameters1, Parameters),
    Acl = acl(Performative, Parameters).
acl_text(Acl, Text) :-
    must_be_acl(Acl),
    Acl = acl(Performative, Parameters0),
    with_language(Parameters0, Parameters),
    maplist(parameter_sexps, Parameters, Lists),
    append(Lists, Sexps),
    sexp_text([Performative|Sexps], Text).

%!  must_be_acl(@Acl) is det.
%
%   Acl has the form acl(Performative, Parameters), with a known Performative.
%
%   @error type_error(fipa_message, Acl), domain_error(performative, P)

must_be_acl(Acl) :-
    (   subsumes_term(acl(_, _), Acl)
    ->  Acl = acl(Performative, Parameters),
        must_be(atom, Performative),
        must_be(list, Parameters)
    ;   type_error(fipa_message, Acl)
    ),
    (   performative(Performative)
    ->  true
    ;   domain_error(performative, Performative)
    ).

                /*******************************
                *            READING           *
                *******************************/

read_parameter(Key-Sexp, Parameter) :-
    parameter(Key, _, Name, Kind),
    read_value(Kind, Sexp, Value),
    Parameter =.. [Name,Value].

%   parameter(+Written, -Key, -Name, -Kind): in Prolog the names of the standard
%   have underscores in place of hyphens.

parameter(Written, Key, Name, Kind) :-
    (   known(Key, Name, Kind),
        ( Written == Key ; Written == Name )
    ->  true
    ;   Key = Written,
        Name = Written,
        Kind = text
    ).

known(sender, sender, aid).
known(receiver, receiver, aids).
known('reply-to', reply_to, aids).
known(content, content, content).
known('reply-by', reply_by, time).
known('reply-with', reply_with, text).
known('in-reply-to', in_reply_to, text).
known('conversation-id', conversation_id, text).
known(language, language, text).
known(ontology, ontology, text).
known(protocol, protocol, text).
known(encoding, encoding, text).

read_value(aid, Sexp, Aid) :-
    aid_sexp(Aid, Sexp).
read_value(aids, [Set|Sexps], Aids) :-
    sexp_atom(Set, Name),
    downcase_atom(Name, Down),
    memberchk(Down, [set, sequence]),
    maplist(aid_of, Sexps, Aids).
read_value(content, Sexp, String) :-
    sexp_atom(Sexp, Text),
    atom_string(Text, String).
read_value(time, Sexp, Stamp) :-
    sexp_atom(Sexp, Text),
    utc_text(Stamp, Text).
read_value(text, Sexp, Text) :-
    sexp_atom(Sexp, Text).

aid_of(Sexp, Aid) :-
    aid_sexp(Aid, Sexp).

%   A content that is declared as SL but is no SL stays a string.

parse_content(Parameters0, Parameters) :-
    memberchk(language(Language), Parameters0),
    is_sl(Language),
    selectchk(content(Text), Parameters0, Rest),
    catch(sl_text(Terms, Text), error(_, _), fail),
    !,
    Parameters = [content(Terms)|Rest].
parse_content(Parameters, Parameters).

is_sl(Language) :-
    downcase_atom(Language, Down),
    sub_atom(Down, 0, _, _, 'fipa-sl'),
    !.

conversation_first(Parameters0, Parameters) :-
    selectchk(conversation_id(Id), Parameters0, Rest),
    !,
    Parameters = [conversation_id(Id)|Rest].
conversation_first(Parameters, Parameters).

                /*******************************
                *            WRITING           *
                *******************************/

with_language(Parameters, [language('fipa-sl')|Parameters]) :-
    member(content(Content), Parameters),
    compound(Content),
    \+ member(language(_), Parameters),
    !.
with_language(Parameters, Parameters).

parameter_sexps(Parameter, [Key, Sexp]) :-
    (   compound(Parameter),
        compound_name_arguments(Parameter, Written, [Value]),
        ground(Value),
        parameter(Written, Name, _, Kind),
        value_sexp(Kind, Value, Sexp0),
        sexp_word(Name)
    ->  atom_concat(:, Name, Key),
        Sexp = Sexp0
    ;   type_error(fipa_parameter, Parameter)
    ).

value_sexp(aid, Aid, Sexp) :-
    aid_sexp(Aid, Sexp).
value_sexp(aids, Aids, [set|Sexps]) :-
    is_list(Aids),
    maplist(aid_sexp, Aids, Sexps).
value_sexp(content, Content, string(Text)) :-
    content_text(Content, Text).
value_sexp(time, Stamp, Text) :-
    number(Stamp),
    utc_text(Stamp, Text).
value_sexp(text, Value, Sexp) :-
    atomic(Value),
    format(string(Text), '~w', [Value]),
    text_sexp(Text, Sexp).

content_text(Terms, Text) :-
    is_list(Terms),
    !,
    sl_text(Terms, Text).
content_text(Term, Text) :-
    compound(Term),
    !,
    sl_text([Term], Text).
content_text(Atomic, Text) :-
    format(string(Text), '~w', [Atomic]).
