:- module(typhon_host_log,
          [ host_log/3,                 % +Host, +Agent, +What
            host_log_event/4,           % +Host, +Agent, +What, -Post
            host_logs/1,                % +Host
            event_shown/3               % +Host, +What, -Shown
          ]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/error_text', [abridged/3, print_error/2]).
:- use_module('../wire', [endpoint_post/3]).
:- use_module(events, [events_subscribe/3, log_kind/2]).
:- use_module(host_names, [address_parts/3]).
:- use_module(hosts, [host/3, host_option/2]).

/** <module> Events that a host sends to its log server

A log gets events when agents begin and end, the terms that agents log, and the
kinds of events that the option of its host names.

Logs and watches get events without the content of messages.  They get the
content, bounded in size, where the option log(Address, Kinds) of the host has
messages(content) among Kinds.

*Threading*: any thread; a thread of an endpoint does not wait for a connection.
*/

:- multifile
    typhon_events:handle_event/4,
    typhon_hosting:begins/1.

:- dynamic
    missed/2.                   % Endpoint, Key: the flag that counts
                                % lost events

typhon_hosting:begins(Host) :-
    log_server(Host, Log, Kinds),
    !,
    address_parts(Log, _, Endpoint),
    retractall(missed(Endpoint, _)),
    findall(Kind, ( member(Wanted, Kinds), once(log_kind(Wanted, Kind)) ),
            Wished),
    events_subscribe([life, bad_ends|Wished], Host, log).

log_server(Host, Log, []) :-
    host_option(Host, log(Log)).
log_server(Host, Log, Kinds) :-
    host_option(Host, log(Log, Kinds)).

typhon_events:handle_event(log, Host, Agent, What) :-
    event_shown(Host, What, Shown),
    host_log(Host, Agent, Shown).

%!  host_log(+Host, +Agent, +What) is det.
%
%   Send an event to the log server of Host, if it has one.

host_log(Host, Agent, What) :-
    host_log_event(Host, Agent, What, Endpoint-Event),
    !,
    catch(( endpoint_post(Endpoint, log, Event), log_back(Endpoint) ),
          error(Formal, Context),
          log_failed(Formal, Context, Endpoint)).
host_log(_, _, _).

%   A log server that cannot be reached is reported once, and again when it is
%   back: events in between are lost.

log_failed(unreachable(_), _, Endpoint) :-
    !,
    with_mutex(typhon_host_log, count_of_missed(Endpoint, Key, First)),
    flag(Key, Count, Count+1),
    (   First == true
    ->  print_message(warning, typhon(log_unheard(Endpoint)))
    ;   true
    ).
log_failed(Formal, Context, _) :-
    print_error(warning, error(Formal, Context)).

count_of_missed(Endpoint, Key, false) :-
    missed(Endpoint, Key),
    !.
count_of_missed(Endpoint, Key, true) :-
    atom_concat('typhon unheard ', Endpoint, Key),
    flag(Key, _, 0),
    assertz(missed(Endpoint, Key)).

log_back(Endpoint) :-
    missed(Endpoint, _),
    with_mutex(typhon_host_log, retract(missed(Endpoint, Key))),
    !,
    flag(Key, Count, 0),
    print_message(warning, typhon(log_heard(Endpoint, Count))).
log_back(_).

%!  host_log_event(+Host, +Agent, +What, -Post) is semidet.
%
%   Post is Endpoint-Event, to be posted to the log server of Host.  Fails if
%   Host has no log server.

host_log_event(Host, Agent, What, Endpoint-event(Log, Address, Agent, What)) :-
    log_server(Host, Log, _),
    !,
    host(Host, Address, _),
    address_parts(Log, _, Endpoint).

%!  host_logs(+Host) is semidet.
%
%   Host has a log server.

host_logs(Host) :-
    log_server(Host, _, _),
    !.

                /*******************************
                *           CONTENT            *
                *******************************/

:- setting(content_characters, positive_integer, 200,
           "The text of longer messages is cut to this many characters").

%!  event_shown(+Host, +What, -Shown) is det.
%
%   What is an event on Host, as in event/4; Shown is the form of it that logs
%   and watches get.

event_shown(Host, sent(To, Message), Shown) =>
    (   shows_content(Host)
    ->  content(Message, Content),
        Shown = sent(To, Content)
    ;   Shown = sent(To)
    ).
event_shown(Host, received(From, Message), Shown) =>
    (   shows_content(Host)
    ->  content(Message, Content),
        Shown = received(From, Content)
    ;   Shown = received(From)
    ).
event_shown(_, What, Shown) =>
    Shown = What.

shows_content(Host) :-
    host_option(Host, log(_, Kinds)),
    memberchk(messages(content), Kinds).

%   content(+Message, -Content): Content is Message, or, if its text is too
%   long, a string with the beginning of the text and three dots.

content(Message, Content) :-
    setting(content_characters, Longest),
    abridged(Message, Longest, Text),
    (   string_length(Text, Length),
        Length > Longest,
        string_concat(_, "...", Text)
    ->  Content = Text
    ;   Content = Message
    ).
