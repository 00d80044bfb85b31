:- module(typhon_fipa_envelope,
          [ envelope_xml/2              % ?Envelope, ?Text
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error),
              [permission_error/3, resource_error/1, syntax_error/1]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(pairs), [pairs_values/2]).
:- use_module(library(sgml), [load_xml/3]).
:- use_module(library(sgml_write), [xml_write/3]).
:- use_module(aid, [aid_addresses/2, aid_name/2]).

/** <module> Envelopes of messages, in XML

The part of a message that the transport reads (FIPA00084, FIPA00071) is a
list of parameters:

  - to(Aids), intended_receiver(Aids), from(Aid)
  - acl_representation(Atom), payload_length(Bytes), payload_encoding(Atom),
    date(Text)

An envelope with a document type is refused before it is parsed, so there are
no entities that grow, and none that stand for files.  The parser's time for
attributes and digits grows faster than their length, so both are bounded.

*Threading*: pure.
*/

%   Characters of an envelope; digits of a number in one.

max_envelope(65 536).
max_digits(15).

%!  envelope_xml(+Envelope, -Text:string) is det.
%!  envelope_xml(-Envelope, +Text:string) is det.
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

%   Later params, of platforms on the way, replace what earlier ones say.

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
