:- module(typhon_fipa_letter,
          [ letter_write/5,             % +Text, +From, +To, -Type, -Body
            letter_read/4               % +Type, +Body, -Envelope, -Text
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [permission_error/3, resource_error/1, syntax_error/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(random), [random_between/3]).
:- use_module(library(sgml), [load_xml/3]).
:- use_module(library(sgml_write), [xml_write/3]).
:- use_module(library(utf8), [utf8_codes//1]).
:- use_module(sexp, [aid_addresses/2, aid_name/2, utc_text/2]).

/** <module> Encoding of messages and their envelopes

A message is sent as multipart/mixed (RFC 2046): its envelope and its text.
Text that is not ASCII is UTF-8, which the envelope declares.

The envelope (FIPA00084, FIPA00071) tells the transport the receivers.  It is
XML, and a list of parameters in this program:

  - to(Aids), intended_receiver(Aids), from(Aid)
  - acl_representation(Atom), payload_length(Bytes), payload_encoding(Atom),
    date(Text)

An envelope with a document type is refused before it is parsed, so no entity
can expand, or refer to a file.  The time of the parser for attributes and
digits grows faster than their length, so both are bounded.

*Threading*: pure, but for the date and the boundary.
*/

%!  letter_write(+Text:string, +From, +To, -Type:string, -Body:string) is det.
%
%   Body is Text, a message in the string representation, with its envelope
%   for the agent identifier To; Type is the content type of Body.

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
%   Decode Body, whose content type is Type, to Envelope and Text.
%
%   @error syntax_error(fipa_multipart), and the errors of envelope_xml/2
%   @error syntax_error(fipa_representation) if Text is not in the string
%   representation
%   @error syntax_error(fipa_encoding)

letter_read(Type, Body, Envelope, Text) :-
    multipart_read(Type, Body, Xml0, Bytes),
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

%   An envelope has at most max_envelope characters, a number in it max_digits
%   digits.

max_envelope(65 536).
max_digits(15).

%   envelope_xml(+Envelope, -Text:string) is det.
%   envelope_xml(-Envelope, +Text:string) is det.
%
%   @error syntax_error(fipa_envelope), resource_error(fipa_envelope)
%   @error permission_error(declare, fipa_envelope, document_type)

envelope_xml(Envelope, Text) :-
    nonvar(Text),
    !,
    string_length(Text, Length),
    max_envelope(Most),
    (   Length > Most
    ->  resource_error(fipa_envelope)
    ;   sub_string(Text, _, _, _, "<!")
    ->  permission_error(declare, fipa_envelope, document_type)
    ;   true
    ),
    (   catch(dom(Text, Dom), error(_, _), fail),
        envelope_dom(Envelope0, Dom)
    ->  Envelope = Envelope0
    ;   syntax_error(fipa_envelope)
    ).
envelope_xml(Envelope, Text) :-
    findall(Element, ( member(Slot, Envelope), slot_element(Slot, Element) ),
            Elements),
    Dom = element(envelope, [], [element(params, [index='1'], Elements)]),
    with_output_to(string(Text),
                   ( current_output(Out),
                     xml_write(Out, Dom, [layout(false)]) )).

                /*******************************
                *            READING           *
                *******************************/

dom(Text, Dom) :-
    setup_call_cleanup(
        open_string(Text, In),
        load_xml(stream(In), Dom,
                 [ space(remove), max_errors(0), syntax_errors(quiet) ]),
        close(In)).

%   Platforms that forward a message add params, which replace earlier ones.

envelope_dom(Envelope, Dom) :-
    member(element(envelope, _, Parts), Dom),
    findall(Index-Elements,
            ( member(element(params, Attributes, Elements), Parts),
              index(Attributes, Index) ),
            Params),
    keysort(Params, Sorted),
    pairs_values(Sorted, Lists),
    newest(Lists, [], Envelope).

index(Attributes, Index) :-
    memberchk(index=Text, Attributes),
    whole_number(Text, Index),
    !.
index(_, 1).

newest([], Envelope, Envelope).
newest([Elements|Lists], Older, Envelope) :-
    findall(Slot, element_slot(Elements, Slot), Slots),
    findall(Slot,
            ( member(Slot, Older),
              functor(Slot, Name, 1),
              functor(Same, Name, 1),
              \+ memberchk(Same, Slots) ),
            Kept),
    append(Kept, Slots, Newer),
    newest(Lists, Newer, Envelope).

element_slot(Elements, Slot) :-
    slot(Tag, Name, aids),
    findall(Aid,
            ( member(element(Tag, _, Content), Elements),
              member(Child, Content),
              element_aid(Child, Aid) ),
            Aids),
    Aids \== [],
    Slot =.. [Name,Aids].
element_slot(Elements, Slot) :-
    slot(Tag, Name, Kind),
    Kind \== aids,
    memberchk(element(Tag, _, Content), Elements),
    read_slot(Kind, Content, Value),
    Slot =.. [Name,Value].

slot(to, to, aids).
slot('intended-receiver', intended_receiver, aids).
slot(from, from, aid).
slot('acl-representation', acl_representation, text).
slot('payload-length', payload_length, number).
slot('payload-encoding', payload_encoding, text).
slot(date, date, text).

read_slot(aid, [Child|_], Aid) :-
    element_aid(Child, Aid).
read_slot(text, Content, Text) :-
    words(Content, Text).
read_slot(number, Content, Number) :-
    words(Content, Text),
    whole_number(Text, Number).

whole_number(Text, Number) :-
    atom_length(Text, Length),
    max_digits(Most),
    Length =< Most,
    atom_number(Text, Number),
    integer(Number).

words([Text0|_], Text) :-
    atom(Text0),
    normalize_space(atom(Text), Text0).

element_aid(element('agent-identifier', _, Parts), fipa(Name, Addresses)) :-
    memberchk(element(name, _, Words), Parts),
    words(Words, Name),
    findall(Url,
            ( member(element(addresses, _, Urls), Parts),
              member(element(url, _, Content), Urls),
              words(Content, Url) ),
            Addresses).

                /*******************************
                *            WRITING           *
                *******************************/

slot_element(Slot, element(Tag, [], Content)) :-
    Slot =.. [Name,Value],
    slot(Tag, Name, Kind),
    slot_content(Kind, Value, Content).

slot_content(aids, Aids, [Element]) :-
    member(Aid, Aids),
    aid_element(Aid, Element).
slot_content(aid, Aid, [Element]) :-
    aid_element(Aid, Element).
slot_content(text, Text, [Text]).
slot_content(number, Number, [Text]) :-
    atom_number(Text, Number).

aid_element(Aid, element('agent-identifier', [],
                         [element(name, [], [Name])|More])) :-
    aid_name(Aid, Name),
    aid_addresses(Aid, Addresses),
    (   Addresses == []
    ->  More = []
    ;   maplist(url_element, Addresses, Urls),
        More = [element(addresses, [], Urls)]
    ).

url_element(Url, element(url, [], [Url])).

                /*******************************
                *            PARTS             *
                *******************************/

%   multipart_read(+ContentType:text, +Body:string, -Xml, -Bytes) is det.
%
%   Body has two parts, Xml and Bytes, strings of bytes.
%
%   @error syntax_error(fipa_multipart)

multipart_read(ContentType, Body, Xml, Bytes) :-
    (   boundary(ContentType, Boundary),
        string_concat("\n--", Boundary, Mark),
        string_concat("\n", Body, Text),
        cut_at(Mark, Text, _, Rest1),
        cut_at(Mark, Rest1, Part1, Rest2),
        cut_at(Mark, Rest2, Part2, End),
        sub_string(End, 0, 2, _, "--"),
        maplist(part_bytes, [Part1, Part2], [Xml0, Bytes0])
    ->  Xml = Xml0,
        Bytes = Bytes0
    ;   syntax_error(fipa_multipart)
    ).

boundary(ContentType, Boundary) :-
    split_string(ContentType, ";", " \t", [Type|Parameters]),
    string_lower(Type, "multipart/mixed"),
    member(Parameter, Parameters),
    cut_at("=", Parameter, Name, Quoted),
    string_lower(Name, "boundary"),
    !,
    split_string(Quoted, "", "\"", [Boundary]),
    string_length(Boundary, Length),
    between(1, 70, Length).

%   A part begins with the end of the boundary line, and its head.  The line
%   break before the next boundary belongs to that boundary.

part_bytes(Part0, Bytes) :-
    (   string_concat(Part, "\r", Part0)
    ->  true
    ;   Part = Part0
    ),
    (   cut_at("\r\n\r\n", Part, _, Bytes0)
    ->  true
    ;   cut_at("\n\n", Part, _, Bytes0)
    ),
    Bytes = Bytes0.

cut_at(Mark, Text, Before, After) :-
    sub_string(Text, Start, _, Left, Mark),
    !,
    sub_string(Text, 0, Start, _, Before),
    sub_string(Text, _, Left, 0, After).

multipart_write(Parts, ContentType, Body) :-
    Most is 1<<96,
    random_between(0, Most, Drawn),
    format(string(Boundary), 'typhon-~36r', [Drawn]),
    format(string(ContentType), 'multipart/mixed ; boundary="~w"',
           [Boundary]),
    with_output_to(string(Body), write_parts(Parts, Boundary)).

write_parts([], Boundary) :-
    format('--~w--\r\n', [Boundary]).
write_parts([Type-Bytes|Parts], Boundary) :-
    format('--~w\r\nContent-Type: ~w\r\n\r\n~s\r\n', [Boundary, Type, Bytes]),
    write_parts(Parts, Boundary).
