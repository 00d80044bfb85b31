:- module(typhon_host_log, []).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../kernel/base/durable',
              [deferred_act/4, durable_post/3, effects_deferred/0]).
:- use_module('../kernel/base/error_text', [abridged/3]).
:- use_module('../kernel/base/reports', [report/4]).
:- use_module('../kernel/wire', [endpoint_post/3, mobile_term/1]).
:- use_module('../kernel/host',
              [ address_parts/3, event_shown/3, events_subscribe/3, host/3,
                host_option/2, log_kind/2 ]).

/** <module> Events that a host sends to its log server

A log gets events when agents begin and end, the terms that agents log, and the
kinds of events that the option of its host names.

Logs and watches get events without the content of messages.  They get the
content, bounded in size, where the option log(Address, Kinds) of the host has
messages(content) among Kinds.

With a journal, what an agent logs is part of its turn: it is noted with the
turn, and goes to the log server once, whichever process ends.  Other events go
to the log server at once.

*Threading*: any thread; a thread of an endpoint does not wait for a connection.
*/

:- multifile
    typhon_durable:act/3,
    typhon_durable:undelivered/4,
    typhon_events:handle_event/4,
    typhon_events:shown/3,
    typhon_host_parts:changeable/1,
    typhon_host_parts:check/1,
    typhon_hosting:begins/1,
    typhon_options:declared/4,
    typhon_words:logged/3.

:- dynamic
    missed/2.                   % Endpoint, Key: the flag that counts
                                % lost events

typhon_options:declared(host_option, log(X), host_address, X).
typhon_options:declared(host_option, log(X, _), host_address, X).

typhon_host_parts:check(Options) :-
    forall(member(log(_, Kinds), Options), must_be(list(event_kind), Kinds)).

typhon_host_parts:changeable(log(_)).

typhon_hosting:begins(Host) :-
    once(log_server(Host, Log, Kinds)),
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
    send(Host, Agent, Shown).

typhon_words:logged(Host, Agent, What) :-
    log_server(Host, _, _),
    !,
    mobile_term(What),
    (   effects_deferred
    ->  deferred_act(logged, Host, Agent-What, any)
    ;   send(Host, Agent, What)
    ).

%   send(+Host, +Agent, +What): send an event to the log server of Host, if it
%   has one.

send(Host, Agent, What) :-
    post(Host, Agent, What, Endpoint-Event),
    !,
    catch(( endpoint_post(Endpoint, log, Event), log_back(Endpoint) ),
          error(Formal, Context),
          log_failed(Formal, Context, Endpoint)).
send(_, _, _).

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
log_failed(Formal, Context, Endpoint) :-
    report(warning, log_errors, Endpoint, error(Formal, Context)).

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

%   post(+Host, +Agent, +What, -Post): Post is Endpoint-Event, to be posted to
%   the log server of Host.  Fails if Host has no log server.

post(Host, Agent, What, Endpoint-event(Log, Address, Agent, What)) :-
    log_server(Host, Log, _),
    !,
    host(Host, Address, _),
    address_parts(Log, _, Endpoint).

typhon_durable:act(logged, Host, Agent-What) :-
    (   post(Host, Agent, What, Endpoint-Event)
    ->  catch(durable_post(Endpoint, log, Event),
              error(resource_error(frame_bytes), Context),
              print_message(warning,
                            error(resource_error(frame_bytes), Context)))
    ;   true                            % the log server was removed
    ).

%   The log server is gone, or cannot take the event: print it here.

typhon_durable:undelivered(log, event(_, Host, Agent, What), _, _) :-
    print_message(informational, typhon(log(Host, Agent, What))).

                /*******************************
                *           CONTENT            *
                *******************************/

:- setting(content_characters, positive_integer, 200,
           "The text of longer messages is cut to this many characters").

typhon_events:shown(Host, sent(To, Message), sent(To, Content)) :-
    shows_content(Host),
    content(Message, Content).
typhon_events:shown(Host, received(From, Message), received(From, Content)) :-
    shows_content(Host),
    content(Message, Content).

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
