:- module(typhon_fipa_letter,
          [ letter_write/5,             % +Text, +From, +To, -Type, -Body
            letter_read/4               % +Type, +Body, -Envelope, -Text
          ]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(utf8), [utf8_codes//1]).
:- use_module(envelope, [envelope_xml/2]).
:- use_module(multipart, [multipart_read/3, multipart_write/3]).
:- use_module(sexp, [utc_text/2]).

/** <module> A message and its envelope, as bytes

Text that is not ASCII is UTF-8, which the envelope declares.

*Threading*: pure, but for the date and the boundary.
*/

%!  letter_write(+Text:string, +From, +To, -Type:string, -Body:string) is det.
%
%   Body is Text, a message in the string representation, with its envelope
%   for the agent identifier To; Type is the content type of that.

letter_write(Text, From, To, Type, Body) :-
    text_bytes(Text, Bytes, Encoding),
    string_length(Bytes, Length),
    get_time(Now),
    utc_text(Now, Date0),
    sub_atom(Date0, 0, _, 1, Date),
    Envelope = [ to([To]), from(From),
                 acl_representation('fipa.acl.rep.string.std'),
                 payload_length(Length),
                 payload_encoding(Encoding),
                 date(Date),
                 intended_receiver([To]) ],
    envelope_xml(Envelope, Xml0),
    text_bytes(Xml0, Xml, _),
    multipart_write(['application/xml'-Xml, 'application/text'-Bytes],
                    Type, Body).

text_bytes(Text, Text, 'US-ASCII') :-
    string_codes(Text, Codes),
    \+ ( member(Code, Codes), Code > 0x7f ),
    !.
text_bytes(Text, Bytes, 'UTF-8') :-
    string_codes(Text, Codes),
    phrase(utf8_codes(Codes), ByteCodes),
    string_codes(Bytes, ByteCodes).

%!  letter_read(+Type, +Body:string, -Envelope, -Text:string) is det.
%
%   @error syntax_error(fipa_multipart) and what envelope_xml/2 raises
%   @error syntax_error(fipa_representation) if Text is not in the string
%   representation
%   @error syntax_error(fipa_encoding)

letter_read(Type, Body, Envelope, Text) :-
    multipart_read(Type, Body, Parts),
    (   Parts = [_-Xml0, _-Bytes]
    ->  true
    ;   syntax_error(fipa_multipart)
    ),
    decoded('utf-8', Xml0, Xml),
    envelope_xml(Envelope, Xml),
    check_representation(Envelope),
    (   memberchk(payload_encoding(Encoding0), Envelope)
    ->  downcase_atom(Encoding0, Encoding)
    ;   Encoding = 'utf-8'
    ),
    decoded(Encoding, Bytes, Text).

check_representation(Envelope) :-
    (   memberchk(acl_representation(Name0), Envelope),
        downcase_atom(Name0, Name),
        Name \== 'fipa.acl.rep.string.std'
    ->  syntax_error(fipa_representation)
    ;   true
    ).

decoded(_, Bytes, Text) :-
    string_codes(Bytes, Codes),
    \+ ( member(Code, Codes), Code > 0x7f ),
    !,
    Text = Bytes.
decoded(Encoding, Bytes, Text) :-
    memberchk(Encoding, ['iso-8859-1', 'latin1', latin_1]),
    !,
    Text = Bytes.
decoded(Encoding, Bytes, Text) :-
    memberchk(Encoding, ['utf-8', utf8, 'us-ascii']),
    string_codes(Bytes, Codes),
    phrase(utf8_codes(TextCodes), Codes),
    !,
    string_codes(Text, TextCodes).
decoded(_, _, _) :-
    syntax_error(fipa_encoding).
