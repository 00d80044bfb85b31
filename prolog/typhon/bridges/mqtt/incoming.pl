:- module(typhon_mqtt_incoming,
          [ connection/1,               % +Host
            connection_gone/1,          % +Host
            mqtt_topic/2,               % +Term, -Topic
            mqtt_filter/2,              % +Term, -Filter
            mqtt_payload/3,             % +Term, +Kind, -Payload
            mqtt_url/2                  % +URL, -Parts
          ]).
:- use_module(library(error), [domain_error/2, must_be/2, type_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- use_module(library(uri),
              [ uri_authority_components/2, uri_authority_data/3,
                uri_components/2, uri_data/3, uri_encoded/3 ]).
:- use_module('../../kernel/base/monotonic', [monotonic_time/1]).
:- use_module('../json', [json_dict/2, json_text/2]).
:- use_module('../common',
              [ subscribers_drop/4, subscribers_notify/5,
                subscribers_notify_new/5, subscription/3 ]).

/** <module> Messages from brokers, and checks of topics, payloads and URLs

*Threading*: the thread that reads from the helper delivers messages; the rest
is pure.
*/

:- multifile
    typhon_helper_owner:handle_message/2,
    prolog:message//1.

:- dynamic
    up/2.                       % Host, Since: Host is connected; Since is 0
                                % if no message can have been missed

missed_seconds(5).              % for which retained messages arrive again

%!  connection(+Host) is semidet.
%!  connection_gone(+Host) is det.
%
%   Host is connected to the broker, by the latest report of the helper; record
%   that Host is not connected.

connection(Host) :-
    up(Host, _),
    !.

connection_gone(Host) :-
    retractall(up(Host, _)).

typhon_helper_owner:handle_message(mqtt(Host), Dict) :-
    get_dict(event, Dict, Event),
    handle_event(Event, Host, Dict).

handle_event("message", Host, Dict) :-
    _{ topic:Text, keys:Filters, kind:Kind, qos:QoS, retain:Retain } :< Dict,
    atom_string(Topic, Text),
    payload(Dict, Payload),
    Message = message(Topic, Payload, [qos(QoS),retain(Retain)]),
    forall(member(Filter, Filters),
           notify(Retain, Host, Filter, Kind, Message, message(Topic, _, _))).
handle_event("too_big", Host, Dict) :-
    _{topic:Text, keys:Filters, kind:Kind, size:Size} :< Dict,
    atom_string(Topic, Text),
    forall(member(Filter, Filters),
           notify(false, Host, Filter, Kind, too_big(Topic, Size),
                  too_big(Topic, _))).
handle_event("denied", Host, Dict) :-
    _{filter:Text} :< Dict,
    atom_string(Filter, Text),
    forall(subscription(mqtt, Host, mqtt(Filter, Kind)),
           subscribers_drop(mqtt, Host, mqtt(Filter, Kind), denied(Filter))).
handle_event("down", Host, _) :-
    connection_gone(Host),
    print_message(warning, typhon(mqtt_down(Host))).
handle_event("up", Host, Dict) :-
    monotonic_time(Now),
    (   get_dict(again, Dict, true)
    ->  Since = Now
    ;   Since = 0
    ),
    assertz(up(Host, Since)),
    print_message(informational, typhon(mqtt_up(Host))).
handle_event("refused", Host, _) :-
    print_message(warning, typhon(mqtt_refused(Host))).

%   The helper decides which payloads are to be read as JSON.

payload(Dict, Payload) :-
    _{payload:Text, json:Json} :< Dict,
    (   Json == true,
        catch(json_dict(Text, Term), error(_, _), fail)
    ->  Payload = Term
    ;   Payload = Text
    ).

notify(Retain, Host, Filter0, Kind0, Message, Same) :-
    atom_string(Filter, Filter0),
    atom_string(Kind, Kind0),
    (   Retain == true,
        \+ reconnected(Host)
    ->  subscribers_notify_new(mqtt, Host, mqtt(Filter, Kind), Message, Same)
    ;   subscribers_notify(mqtt, Host, mqtt(Filter, Kind), Message, Same)
    ).

%   After a reconnection all subscribers get retained messages, which may have
%   changed meanwhile.

reconnected(Host) :-
    up(Host, Since),
    missed_seconds(Seconds),
    monotonic_time(Now),
    Now-Since < Seconds.

                /*******************************
                *       TOPICS, PAYLOADS       *
                *******************************/

longest(65535).                 % bytes
deepest(200).                   % levels: many brokers disconnect beyond

%!  mqtt_topic(+Term, -Topic:atom) is det.
%!  mqtt_filter(+Term, -Filter:atom) is det.
%
%   Topic is Term, a text, as an atom.  In a filter a level may be `+`, and the
%   last level `#`.
%
%   @error type_error(text, Term), domain_error(mqtt_topic, Term),
%   domain_error(mqtt_filter, Term)

mqtt_topic(Term, Topic) :-
    text(Term, Topic),
    (   fits(Topic),
        \+ ( member(Char, [+,#]), sub_atom(Topic, _, _, _, Char) )
    ->  true
    ;   domain_error(mqtt_topic, Term)
    ).

mqtt_filter(Term, Filter) :-
    text(Term, Filter),
    atomic_list_concat(Levels, /, Filter),
    (   fits(Filter),
        append(Before, [Last], Levels),
        ( Last == # ; level(Last) ),
        forall(member(Level, Before), level(Level))
    ->  true
    ;   domain_error(mqtt_filter, Term)
    ).

level(+) :-
    !.
level(Level) :-
    \+ sub_atom(Level, _, _, _, +),
    \+ sub_atom(Level, _, _, _, #).

text(Term, Atom) :-
    must_be(nonvar, Term),
    (   ( atom(Term) ; string(Term) )
    ->  atom_string(Atom, Term)
    ;   type_error(text, Term)
    ).

%   Brokers disconnect clients that send other texts.

fits(Text) :-
    Text \== '',
    atom_codes(Text, Codes),
    \+ ( member(Code, Codes), no_character(Code) ),
    longest(Max),
    string_bytes(Text, Length),
    Length =< Max,
    deepest(Most),
    atomic_list_concat(Levels, /, Text),
    length(Levels, Count),
    Count =< Most.

no_character(Code) :- Code < 32.
no_character(Code) :- Code >= 127, Code < 160.
no_character(Code) :- Code >= 0xD800, Code =< 0xDFFF.
no_character(Code) :- Code >= 0xFDD0, Code =< 0xFDEF.
no_character(Code) :- Code /\ 0xFFFE =:= 0xFFFE.

string_bytes(Text, Length) :-
    atom_length(Text, Chars),
    (   Chars*4 =< 65535
    ->  Length = Chars
    ;   setup_call_cleanup(
            open_null_stream(Out),
            ( set_stream(Out, encoding(utf8)),
              write(Out, Text),
              byte_count(Out, Length) ),
            close(Out))
    ).

%!  mqtt_payload(+Term, +Kind, -Payload) is det.
%
%   Payload is the text of Term.  With the Kind `auto` text is unchanged, numbers
%   are written, dicts and lists become JSON; with `json` all terms become JSON;
%   with `bytes` Term is a text of characters up to 255.
%
%   @error type_error(mqtt_payload, Culprit), instantiation_error, and the errors
%          of json_text/2

mqtt_payload(Term, json, Text) :-
    !,
    json_text(Term, Text).
mqtt_payload(Term, bytes, Text) :-
    !,
    ( ( atom(Term) ; string(Term) ) -> true ; type_error(text, Term) ),
    text_to_string(Term, Text),
    (   string_codes(Text, Codes),
        member(Code, Codes),
        Code > 255
    ->  type_error(bytes, Term)
    ;   true
    ).
mqtt_payload(Term, auto, Text) :-
    ( is_list(Term) ; is_dict(Term) ),
    !,
    json_text(Term, Text).
mqtt_payload(Term, _, Text) :-
    (   ( atom(Term) ; string(Term) ; number(Term) )
    ->  format(string(Text), '~w', [Term])
    ;   must_be(nonvar, Term),
        type_error(mqtt_payload, Term)
    ).

                /*******************************
                *             URL              *
                *******************************/

%!  mqtt_url(+URL, -Parts:dict) is det.
%
%   URL is mqtt://User:Password@Host:Port, or mqtts:// for TLS; only the host is
%   required.  Parts has the keys `host`, `port` and `tls`, and `user` and
%   `password` if URL has them.
%
%   @error domain_error(mqtt_url, URL)

mqtt_url(URL, Parts) :-
    (   catch(parts(URL, Parts0), error(_, _), fail)
    ->  Parts = Parts0
    ;   domain_error(mqtt_url, URL)
    ).

parts(URL, Parts) :-
    uri_components(URL, Components),
    uri_data(scheme, Components, Scheme),
    scheme(Scheme, TLS, Default),
    uri_data(authority, Components, Authority),
    uri_authority_components(Authority, Data),
    uri_authority_data(host, Data, Host0),
    nonvar(Host0),
    bare(Host0, Host),
    Host \== '',
    uri_authority_data(port, Data, Port0),
    ( var(Port0) -> Port = Default ; integer(Port0), Port = Port0 ),
    between(1, 65535, Port),
    login(Data, Login),
    Parts = Login.put(_{host:Host, port:Port, tls:TLS}).

scheme(mqtt, false, 1883).
scheme(mqtts, true, 8883).

%   IPv6 addresses are in brackets.

bare(Host0, Host) :-
    (   atomic_list_concat(['', Rest], '[', Host0),
        atomic_list_concat([Inner, ''], ']', Rest)
    ->  Host = Inner
    ;   Host = Host0
    ).

login(Data, Login) :-
    uri_authority_data(user, Data, User0),
    (   var(User0)
    ->  Login = _{}
    ;   uri_encoded(segment, User, User0),
        uri_authority_data(password, Data, Password0),
        (   var(Password0)
        ->  Login = _{user:User}
        ;   uri_encoded(segment, Password, Password0),
            Login = _{user:User, password:Password}
        )
    ).

prolog:message(typhon(mqtt_down(Host))) -->
    [ 'MQTT on ~w: the connection to the broker is lost'-[Host] ].
prolog:message(typhon(mqtt_up(Host))) -->
    [ 'MQTT on ~w: connected'-[Host] ].
prolog:message(typhon(mqtt_refused(Host))) -->
    [ 'MQTT on ~w: the broker refuses the connection'-[Host] ].
