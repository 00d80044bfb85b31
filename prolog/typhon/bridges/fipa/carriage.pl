:- module(typhon_fipa_carriage,
          [ carriage_send/4,            % +Host, +Urls, +Letter, +Limits
            carriage_queued/2,          % +Host, -Count
            carriage_close/1            % +Host
          ]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [resource_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(option), [option/2]).
:- use_module(library(socket), [tcp_connect/3]).
:- use_module('../../kernel/base/monotonic', [wait_within/2]).
:- use_module('../../kernel/base/error_text', [print_error/2]).
:- use_module('../common', [crew_end/1, crew_start/4]).
:- use_module(http, [http_post/4, http_response/3, http_url/3, within/2]).

/** <module> Sending messages to other platforms

Each address to which messages are sent has a queue and a carrier, a thread that
owns the connection.  So messages for one address stay in order, and a slow
platform delays no messages to others.  A carrier that is idle for some seconds
ends.

A letter is letter(ContentType, Body, About).  If none of its addresses
accepts it, returned/4 is called with About.

*Threading*: carriage_send/4 never waits; a carrier calls returned/4.
*/

:- multifile
    returned/4.                 % Host, About, Url, Why: not delivered

:- dynamic
    carrier/3.                  % Host, Address, Queue

idle_seconds(10).

%   Maximal number of simultaneous addresses.

max_carriers(64).

%!  carriage_send(+Host, +Urls:list, +Letter, +Limits) is det.
%
%   Send Letter to the first of Urls that accepts it.  Limits has queue(N) and
%   seconds(S), for one attempt.
%
%   @error domain_error(http_url, Url)
%   @error resource_error(fipa_queue), resource_error(fipa_destinations)

carriage_send(Host, [Url|Urls], Letter, Limits) :-
    http_url(Url, Address, _),
    option(queue(Most), Limits),
    with_mutex(typhon_fipa_carriage,
               queue(Host, Address, Limits, Most, send([Url|Urls], Letter))).

queue(Host, Address, _, Most, Message) :-
    carrier(Host, Address, Queue),
    !,
    message_queue_property(Queue, size(Size)),
    (   Size < Most
    ->  thread_send_message(Queue, Message)
    ;   resource_error(fipa_queue)
    ).
queue(Host, Address, Limits, _, Message) :-
    aggregate_all(count, carrier(Host, _, _), Count),
    max_carriers(Max),
    (   Count < Max
    ->  true
    ;   resource_error(fipa_destinations)
    ),
    sig_atomic(start_carrier(Host, Address, Limits, Queue)),
    thread_send_message(Queue, Message).

start_carrier(Host, Address, Limits, Queue) :-
    message_queue_create(Queue),
    assertz(carrier(Host, Address, Queue)),
    catch(crew_start(carriage(Host), fipa_carrier,
                     typhon_fipa_carriage:carrier_run(Host, Address, Queue,
                                                      Limits),
                     typhon_fipa_carriage:gone(Host, Address, Queue)),
          error(Formal, Context),
          ( forget(Host, Address, Queue),
            throw(error(Formal, Context)) )).

forget(Host, Address, Queue) :-
    retractall(carrier(Host, Address, Queue)),
    message_queue_destroy(Queue).

%!  carriage_queued(+Host, -Count) is det.

carriage_queued(Host, Count) :-
    aggregate_all(sum(Size),
                  ( carrier(Host, _, Queue),
                    catch(message_queue_property(Queue, size(Size)),
                          error(_, _), fail) ),
                  Count).

%!  carriage_close(+Host) is det.
%
%   Stop sending.  Waiting letters are discarded.

carriage_close(Host) :-
    crew_end(carriage(Host)).

                /*******************************
                *            CARRIERS          *
                *******************************/

carrier_run(Host, Address, Queue, Limits) :-
    Way = way(none),
    call_cleanup(carrier_loop(Host, Address, Queue, Limits, Way),
                 disconnect(Way)).

gone(Host, Address, Queue) :-
    with_mutex(typhon_fipa_carriage,
               (   carrier(Host, Address, Queue)
               ->  forget(Host, Address, Queue)
               ;   true
               )).

carrier_loop(Host, Address, Queue, Limits, Way) :-
    idle_seconds(Idle),
    (   wait_within(Idle, thread_get_message(Queue, send(Urls, Letter)))
    ->  sent(Urls, Host, Letter, Limits, Way),
        carrier_loop(Host, Address, Queue, Limits, Way)
    ;   with_mutex(typhon_fipa_carriage, idle(Host, Address, Queue))
    ->  true
    ;   carrier_loop(Host, Address, Queue, Limits, Way)
    ).

%   The caller holds the mutex, which threads take that add to the queue: so no
%   message gets into a queue that is about to be destroyed.

idle(Host, Address, Queue) :-
    message_queue_property(Queue, size(0)),
    forget(Host, Address, Queue).

sent([Url|Urls], Host, Letter, Limits, Way) :-
    option(seconds(Seconds), Limits),
    catch(within(Seconds, exchange(Url, Letter, Way, Code)),
          Ball,
          failed(Ball, Way, Code)),
    debug(typhon(fipa), '~w: a message to ~w: ~p', [Host, Url, Code]),
    (   Code == 200
    ->  true
    ;   Urls == []
    ->  Letter = letter(_, _, About),
        why(Code, Why),
        catch(ignore(returned(Host, About, Url, Why)),
              error(Formal, Context),
              print_error(error, error(Formal, Context)))
    ;   disconnect(Way),
        sent(Urls, Host, Letter, Limits, Way)
    ).

failed(Ball, Way, Code) :-
    disconnect(Way),
    (   Ball == time_limit_exceeded
    ->  Code = slow
    ;   Ball = error(Formal, _)
    ->  Code = Formal
    ;   throw(Ball)
    ).

why(slow, "it took too long").
why(socket_error(_, Text), Why) :-
    !,
    format(string(Why), '~w', [Text]).
why(Code, Why) :-
    (   integer(Code)
    ->  format(string(Why), 'HTTP status ~d', [Code])
    ;   format(string(Why), '~p', [Code])
    ).

%   exchange(+Url, +Letter, !Way, -Code): Way holds the open connection.  The
%   other side may have closed it just now; then a new connection is tried.

exchange(Url, Letter, Way, Code) :-
    kept(Url, Way, In, Out),
    catch(post(In, Out, Url, Letter, Code0, KeepAlive),
          error(_, _), fail),
    !,
    keep(KeepAlive, Way),
    Code = Code0.
exchange(Url, Letter, Way, Code) :-
    disconnect(Way),
    connect(Url, Way, In, Out),
    (   post(In, Out, Url, Letter, Code0, KeepAlive)
    ->  keep(KeepAlive, Way),
        Code = Code0
    ;   disconnect(Way),
        Code = connection_closed
    ).

post(In, Out, Url, letter(Type, Body, _), Code, KeepAlive) :-
    http_post(Out, Url, Type, Body),
    http_response(In, Code, KeepAlive).

%   kept(+Url, +Way, -In, -Out): Way has an open connection to Url.  Pending
%   input is the rest of an earlier answer.

kept(Url, way(open(Address, In, Out)), In, Out) :-
    http_url(Url, Address, _),
    \+ ended(In).

ended(In) :-
    wait_for_input([In], [_], 0),
    peek_byte(In, Byte),
    (   Byte == -1
    ->  true
    ;   read_pending_codes(In, _, []),
        ended(In)
    ).

keep(true, _).
keep(false, Way) :-
    disconnect(Way).

connect(Url, Way, In, Out) :-
    http_url(Url, Address, _),
    tcp_connect(Address, Pair, [bypass_proxy(true), nodelay(true)]),
    stream_pair(Pair, In, Out),
    nb_setarg(1, Way, open(Address, In, Out)),
    forall(member(Stream, [In, Out]),
           ( set_stream(Stream, encoding(octet)),
             set_stream(Stream, newline(posix)) )).

disconnect(Way) :-
    arg(1, Way, Connection),
    (   Connection = open(_, In, Out)
    ->  nb_setarg(1, Way, none),
        close(Out, [force(true)]),
        close(In, [force(true)])
    ;   true
    ).
