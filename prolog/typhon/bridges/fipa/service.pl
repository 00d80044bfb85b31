:- module(typhon_fipa_service,
          [ fipa_property/2             % ?Host, ?Property
          ]).
:- use_module(library(error), [domain_error/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2, option/3]).
:- use_module('../../kernel/base/options', [check_name/2, check_options/2]).
:- use_module('../../kernel/program', [payload_load/2]).
:- use_module('../../kernel/host', [host_option/2]).
:- use_module('../common',
              [ client_becomes/1, http_server_close/1, http_server_open/4,
                service_begin/5, service_offer/4 ]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module(carriage, [carriage_close/1, carriage_queued/2]).
:- use_module(exchange, [exchange_received/3, exchange_send/4]).
:- use_module(http, [http_request/4, http_respond/3, http_url/3, within/2]).
:- use_module(managers, [manager_end/1]).
:- use_module(platform,
              [ platform/4, platform_add/4, platform_aid/3,
                platform_counts/2, platform_local/3, platform_remove/1 ]).
:- use_module(sexp, [aid/1, aid_name/2]).

/** <module> A host as a platform of FIPA

The time between the first and the last byte of a request is limited, and so is
the number of clients, see typhon_http_server.

*Threading*: any thread; one thread accepts connections, and each client has
one.
*/

:- multifile
    typhon_external_recipients:carried/4,
    typhon_names:known/2,
    typhon_options:declared/4,
    typhon_starting:ends/2,
    typhon_starting:starts/4.

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
    service_begin(fipa, Host, [], typhon_fipa_service,
                  ( service_offer(service(fipa), Host, PIs, Clauses),
                    open_platform(Host, Platform, Url, Options) )).

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
    option(connections(Most), Limits),
    http_server_open(fipa(Host), Interface:Port, Most,
                     typhon_fipa_service:serve(Host, Limits)),
    atomic_list_concat(['http://', UrlHost, ':', Port, Path], Reached),
    platform_add(Host, Platform, Reached, Limits).

%   Platform follows the last @ of a name.

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

typhon_starting:ends(fipa, Host) :-
    http_server_close(fipa(Host)),
    carriage_close(Host),
    ignore(platform_remove(Host)),
    manager_end(Host).

%!  fipa_property(?Host, ?Property) is nondet.
%
%   Property is a property of Host, which is a platform:
%
%     - name(Atom), url(URL)
%     - name(Id, Name): Name is the full name of the agent Id
%     - queued(N): messages to be sent
%     - sent(N), received(N): messages since its start
%     - failed(N): messages that were not delivered
%     - dropped(N): messages beyond a limit
%     - refused(N): requests without a valid message

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

%   The message goes through the platform of the host, else through that of the
%   receiver, else through any platform of this process.

typhon_external_recipients:carried(Host, To, From, Message) :-
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

                /*******************************
                *      INCOMING REQUESTS       *
                *******************************/

%   Maximal time in seconds between two requests.

idle_seconds(60).

%   Maximal number of bytes that are read from a client that sends too much, so
%   that it gets the answer.

max_drained(16000000).

:- public serve/4.              % called by typhon_http_server

serve(_, _, none, Out) :-
    !,
    http_respond(Out, 503, false).
serve(Host, Limits, In, Out) :-
    requests(Host, In, Out, Limits).

requests(Host, In, Out, Limits) :-
    client_becomes(idle),
    idle_seconds(Idle),
    set_stream(In, timeout(Idle)),
    peek_byte(In, Byte),
    Byte \== -1,
    client_becomes(reading),
    option(seconds(Seconds), Limits),
    option(max_bytes(Max), Limits),
    set_stream(In, timeout(Seconds)),
    catch(within(Seconds, http_request(In, Out, Max, Request)),
          Ball,
          Request = bad(Ball)),
    client_becomes(busy),
    answer(Request, Host, In, Out, KeepAlive),
    KeepAlive == true,
    requests(Host, In, Out, Limits).

answer(bad(Ball), _, In, Out, false) :-
    !,
    (   bad(Ball, Code)
    ->  http_respond(Out, Code, false),
        drained(Code, In)
    ;   throw(Ball)
    ).
answer(Request, Host, _, Out, KeepAlive) :-
    Request = request(_, _, _, _, KeepAlive0),
    (   catch(exchange_received(Host, Request, Code0), error(Formal, Context),
              ( print_error(error, error(Formal, Context)), fail ))
    ->  Code = Code0,
        KeepAlive = KeepAlive0
    ;   Code = 500,
        KeepAlive = false
    ),
    http_respond(Out, Code, KeepAlive).

bad(time_limit_exceeded, 408).
bad(error(resource_error(http_body), _), 413) :- !.
bad(error(resource_error(http_head), _), 413) :- !.
bad(error(syntax_error(http_length), _), 411) :- !.
bad(error(timeout_error(_, _), _), 408) :- !.
bad(error(_, _), 400).

%   Closing a connection with unread input resets it, and the client loses the
%   answer.

drained(413, In) :-
    !,
    max_drained(Most),
    set_stream(In, timeout(2)),
    catch(catch(within(5, drain(In, Most)),
                time_limit_exceeded, true),
          error(_, _), true).
drained(_, _).

drain(In, Left) :-
    (   Left > 0,
        peek_byte(In, Byte),
        Byte \== -1
    ->  read_pending_codes(In, Codes, []),
        length(Codes, Count),
        Left1 is Left-Count,
        drain(In, Left1)
    ;   true
    ).
