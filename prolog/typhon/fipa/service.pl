:- module(typhon_fipa_service,
          [ fipa_start/3,               % +Host, +URL, +Options
            fipa_stop/1,                % +Host
            fipa_property/2             % ?Host, ?Property
          ]).
:- use_module(library(error), [domain_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/3]).
:- use_module('../base/options', [check_name/2, check_options/2]).
:- use_module('../program', [payload_load/2]).
:- use_module('../host', [host_option/2]).
:- use_module('../bridge',
              [ bridge_start/4, bridge_stop/2, service_begin/4,
                service_end/2, service_offer/4 ]).
:- use_module(aid, [aid/1, aid_name/2]).
:- use_module(carriage, [carriage_close/1, carriage_queued/2]).
:- use_module(exchange, [exchange_send/4]).
:- use_module(http, [http_url/3]).
:- use_module(incoming, []).
:- use_module(managers, [manager_end/1]).
:- use_module(platform,
              [ platform/4, platform_add/4, platform_aid/3,
                platform_counts/2, platform_local/3, platform_remove/1 ]).
:- use_module(reception, [reception_close/1, reception_open/4]).

/** <module> A host as a platform of FIPA

*Threading*: any thread.
*/

:- multifile
    typhon_abroad:carried/4,
    typhon_names:known/2,
    typhon_options:declared/4,
    typhon_services:ends/2,
    typhon_starting:starts/4.

%!  fipa_start(+Host, +URL, +Options) is det.
%
%   Host is a platform of FIPA from now on.  Others reach it at URL,
%   `http://Host:Port/Path`; where the port is 0 it is any, and
%   fipa_property/2 tells which, in the process of Host.  Agents on Host, and
%   those of its process, send messages to fipa(Name, Addresses); those for
%   its agents come from fipa(Name).  The place of Host has reply/3.  Options:
%
%     - name(+Atom): of the platform, default the name of the host
%     - bind(+Interface): on which it listens, default 127.0.0.1
%     - queue(+N): messages that wait for one address, or in one mailbox,
%       at the most, default 1000; what is too much is not taken
%     - connections(+N): from others at a time, default 64
%     - max_bytes(+N): of a message with its envelope, default 2,000,000
%     - seconds(+N): in which a message has to come, or be taken, default 10
%
%   @error permission_error(start, fipa, Host) if it is one already, or its
%   time is virtual: others do not wait for that
%   @error existence_error(host, Host)
%   @error domain_error(http_url, URL), domain_error(fipa_option, Option)
%   @error socket_error(Code, Message)

fipa_start(Host, Url, Options) :-
    bridge_start(fipa, Host, Url, Options).

typhon_options:declared(fipa_option, Option, Type, Value) :-
    option_type(Option, Type, Value).

option_type(name(X), atom, X).
option_type(bind(X), atom, X).
option_type(queue(X), positive_integer, X).
option_type(connections(X), positive_integer, X).
option_type(max_bytes(X), positive_integer, X).
option_type(seconds(X), positive_integer, X).

typhon_starting:starts(fipa, Host, Url, Options) :-
    check_options(fipa_option, Options),
    real_time(Host),
    option(name(Platform), Options, Host),
    check_platform(Platform),
    http_url(Url, _, _),
    payload_load(payloads(fipa/reply), payload(_, PIs, Clauses)),
    service_begin(fipa, Host, [], typhon_fipa_service),
    catch(( service_offer(service(fipa), Host, PIs, Clauses),
            open_platform(Host, Platform, Url, Options) ),
          Ball,
          ( service_end(fipa, Host),
            throw(Ball) )).

real_time(Host) :-
    (   host_option(Host, clock(virtual))
    ->  permission_error(start, fipa, Host)
    ;   true
    ).

open_platform(Host, Platform, Url, Options) :-
    http_url(Url, UrlHost:Port0, Path),
    option(bind(Interface), Options, '127.0.0.1'),
    limits(Options, Limits),
    (   Port0 == 0
    ->  true
    ;   Port = Port0
    ),
    reception_open(Host, Interface:Port, Limits, Port),
    atomic_list_concat(['http://', UrlHost, ':', Port, Path], Reached),
    platform_add(Host, Platform, Reached, Limits).

%   What stands after the last @ of a name.

check_platform(Platform) :-
    (   ( Platform == '' ; sub_atom(Platform, _, _, _, @) )
    ->  domain_error(fipa_platform, Platform)
    ;   true
    ).

limits(Options, [ queue(Queue), connections(Connections), max_bytes(Max),
                  seconds(Seconds) ]) :-
    option(queue(Queue), Options, 1000),
    option(connections(Connections), Options, 64),
    option(max_bytes(Max), Options, 2000000),
    option(seconds(Seconds), Options, 10).

%!  fipa_stop(+Host) is det.
%
%   Host is no platform any more.  What has not gone out is lost.  So it is
%   when the host stops.
%
%   @error existence_error(fipa, Host)

fipa_stop(Host) :-
    bridge_stop(fipa, Host).

typhon_services:ends(fipa, Host) :-
    reception_close(Host),
    carriage_close(Host),
    ignore(platform_remove(Host)),
    manager_end(Host).

%!  fipa_property(?Host, ?Property) is nondet.
%
%   Of a host that is a platform: name(Atom), url(URL), what others call one
%   of its agents, name(Id, Name), queued(N), messages that wait to go out,
%   and counts since it was started: sent(N), received(N); failed(N), messages
%   that nobody took; dropped(N), because there were too many; refused(N),
%   requests that were no message.

fipa_property(Host, Property) :-
    check_name(fipa_property, Property),
    platform(Host, Name, Url, _),
    property(Property, Host, Name, Url).

typhon_names:known(fipa_property, Property) :-
    member(Property, [ name(_), name(_, _), url(_), queued(_), sent(_),
                       received(_), failed(_), dropped(_), refused(_) ]).

property(name(Name), _, Name, _).
property(url(Url), _, _, Url).
property(name(Id, Name), Host, _, _) :-
    atom(Id),
    platform_aid(Host, Id, Aid),
    aid_name(Aid, Name).
property(queued(Count), Host, _, _) :-
    carriage_queued(Host, Count).
property(Count, Host, _, _) :-
    platform_counts(Host, Counts),
    member(Count, Counts).

                /*******************************
                *             BRIDGE           *
                *******************************/

%   The host's own platform, that of the receiver, or any.

typhon_abroad:carried(Host, To, From, Message) :-
    aid(To),
    way(Host, To, Way),
    !,
    exchange_send(Way, From, To, Message).

way(Host, _, Host) :-
    platform(Host, _, _, _).
way(_, To, Host) :-
    aid_name(To, Name),
    platform(Host, _, _, _),
    platform_local(Host, Name, _).
way(_, _, Host) :-
    platform(Host, _, _, _).
