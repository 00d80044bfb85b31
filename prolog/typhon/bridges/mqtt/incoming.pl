:- module(typhon_mqtt_incoming,
          [ connection/1,               % +Host
            connection_gone/1           % +Host
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../common',
              [ subscribers_drop/4, subscribers_tell/5,
                subscribers_tell_new/5, subscription/3 ]).

/** <module> What comes from brokers

*Threading*: the thread that reads from the helper passes it on.
*/

:- multifile
    typhon_helper_answers:heard/2,
    prolog:message//1.

:- dynamic
    up/2.                       % Host, Since: there is a connection; Since
                                % is 0 if no message can have been missed

missed_seconds(5).              % in which what is retained comes again

%!  connection(+Host) is semidet.
%!  connection_gone(+Host) is det.
%
%   There is a connection to the broker, as far as is known; or none.

connection(Host) :-
    up(Host, _),
    !.

connection_gone(Host) :-
    retractall(up(Host, _)).

typhon_helper_answers:heard(mqtt(Host), Dict) :-
    get_dict(event, Dict, Event),
    heard(Event, Host, Dict).

heard("message", Host, Dict) :-
    _{ topic:Text, keys:Filters, kind:Kind, payload:Payload, qos:QoS,
       retain:Retain } :< Dict,
    atom_string(Topic, Text),
    Message = message(Topic, Payload, [qos(QoS),retain(Retain)]),
    forall(member(Filter, Filters),
           tell(Retain, Host, Filter, Kind, Message, message(Topic, _, _))).
heard("too_big", Host, Dict) :-
    _{topic:Text, keys:Filters, kind:Kind, size:Size} :< Dict,
    atom_string(Topic, Text),
    forall(member(Filter, Filters),
           tell(false, Host, Filter, Kind, too_big(Topic, Size),
                too_big(Topic, _))).
heard("denied", Host, Dict) :-
    _{filter:Text} :< Dict,
    atom_string(Filter, Text),
    forall(subscription(mqtt, Host, mqtt(Filter, Kind)),
           subscribers_drop(mqtt, Host, mqtt(Filter, Kind), denied(Filter))).
heard("down", Host, _) :-
    connection_gone(Host),
    print_message(warning, typhon(mqtt_down(Host))).
heard("up", Host, Dict) :-
    get_time(Now),
    (   get_dict(again, Dict, true)
    ->  Since = Now
    ;   Since = 0
    ),
    assertz(up(Host, Since)),
    print_message(informational, typhon(mqtt_up(Host))).
heard("refused", Host, _) :-
    print_message(warning, typhon(mqtt_refused(Host))).

tell(Retain, Host, Filter0, Kind0, Message, Same) :-
    atom_string(Filter, Filter0),
    atom_string(Kind, Kind0),
    (   Retain == true,
        \+ came_back(Host)
    ->  subscribers_tell_new(mqtt, Host, mqtt(Filter, Kind), Message, Same)
    ;   subscribers_tell(mqtt, Host, mqtt(Filter, Kind), Message, Same)
    ).

%   What is retained may have changed meanwhile, so all want it.

came_back(Host) :-
    up(Host, Since),
    missed_seconds(Seconds),
    get_time(Now),
    Now-Since < Seconds.

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:message(typhon(mqtt_down(Host))) -->
    [ 'MQTT on ~w: the connection to the broker is lost'-[Host] ].
prolog:message(typhon(mqtt_up(Host))) -->
    [ 'MQTT on ~w: connected'-[Host] ].
prolog:message(typhon(mqtt_refused(Host))) -->
    [ 'MQTT on ~w: the broker refuses the connection'-[Host] ].
