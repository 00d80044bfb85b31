:- module(typhon_host_log,
          [ host_log/3,                 % +Host, +Agent, +What
            host_log_event/4,           % +Host, +Agent, +What, -Post
            host_logs/1                 % +Host
          ]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/error_text', [print_error/2]).
:- use_module('../wire', [endpoint_post/3]).
:- use_module(event_shown, [event_shown/3]).
:- use_module(events, [events_hear/3, log_kind/2]).
:- use_module(host_names, [address_parts/3]).
:- use_module(hosts, [host/3, host_option/2]).

/** <module> What a host says to its log server

A log hears when agents begin and end, what they log, and of those kinds of
events that the option of its host names.

*Threading*: any thread; that of an endpoint does not wait for a connection.
*/

:- multifile
    typhon_events:told/4,
    typhon_hosting:begins/1.

:- dynamic
    unheard/2.                  % Endpoint, Key: of the flag that counts

typhon_hosting:begins(Host) :-
    log_server(Host, Log, Kinds),
    !,
    address_parts(Log, _, Endpoint),
    retractall(unheard(Endpoint, _)),
    findall(Kind, ( member(Wanted, Kinds), once(log_kind(Wanted, Kind)) ),
            Heard),
    events_hear([life, bad_ends|Heard], Host, log).

log_server(Host, Log, []) :-
    host_option(Host, log(Log)).
log_server(Host, Log, Kinds) :-
    host_option(Host, log(Log, Kinds)).

typhon_events:told(log, Host, Agent, What) :-
    event_shown(Host, What, Shown),
    host_log(Host, Agent, Shown).

%!  host_log(+Host, +Agent, +What) is det.
%!  host_log_event(+Host, +Agent, +What, -Post) is semidet.
%!  host_logs(+Host) is semidet.
%
%   Send an event to the log server of Host, if it has one; what is to be
%   posted there, Endpoint-Event; whether it has one.

host_log(Host, Agent, What) :-
    host_log_event(Host, Agent, What, Endpoint-Event),
    !,
    catch(( endpoint_post(Endpoint, log, Event), heard(Endpoint) ),
          error(Formal, Context),
          lost(Formal, Context, Endpoint)).
host_log(_, _, _).

%   A log server that is not there is reported once, and again when it is: what
%   has happened meanwhile is lost.

lost(unreachable(_), _, Endpoint) :-
    !,
    with_mutex(typhon_host_log, unheard(Endpoint, Key, First)),
    flag(Key, Count, Count+1),
    (   First == true
    ->  print_message(warning, typhon(log_unheard(Endpoint)))
    ;   true
    ).
lost(Formal, Context, _) :-
    print_error(warning, error(Formal, Context)).

unheard(Endpoint, Key, false) :-
    unheard(Endpoint, Key),
    !.
unheard(Endpoint, Key, true) :-
    atom_concat('typhon unheard ', Endpoint, Key),
    flag(Key, _, 0),
    assertz(unheard(Endpoint, Key)).

heard(Endpoint) :-
    unheard(Endpoint, _),
    with_mutex(typhon_host_log, retract(unheard(Endpoint, Key))),
    !,
    flag(Key, Count, 0),
    print_message(warning, typhon(log_heard(Endpoint, Count))).
heard(_).

host_log_event(Host, Agent, What, Endpoint-event(Log, Address, Agent, What)) :-
    log_server(Host, Log, _),
    !,
    host(Host, Address, _),
    address_parts(Log, _, Endpoint).

host_logs(Host) :-
    log_server(Host, _, _),
    !.
