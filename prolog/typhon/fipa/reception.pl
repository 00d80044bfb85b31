:- module(typhon_fipa_reception,
          [ reception_open/4,           % +Host, +Address, +Limits, -Port
            reception_close/1           % +Host
          ]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(option), [option/2]).
:- use_module(library(socket),
              [ tcp_accept/3, tcp_bind/2, tcp_close_socket/1, tcp_listen/2,
                tcp_open_socket/3, tcp_setopt/2, tcp_socket/1 ]).
:- use_module(crew, [crew_end/1, crew_start/4]).
:- use_module(limit, [within/2]).
:- use_module(http, [http_request/4, http_respond/3]).

/** <module> Where messages come in

Each client has a thread, as many at a time as there may be connections.  If
there are so many, who has been silent for longest between two requests has
to go; if nobody is, who comes is sent away.  A request has only so many
seconds to come, from its first byte to its last.

*Threading*: an acceptor, and a thread for each client.
*/

:- multifile
    requested/3.                % Host, Request, Code: what a request comes to

:- dynamic
    listens/2,                  % Host, Socket
    client/4.                   % Host, Thread, Since, State: idle or busy

%   Between two requests, at most.

idle_seconds(60).

%   So that who sends too much gets to hear it.

max_drained(16000000).

%!  reception_open(+Host, +Address, +Limits, -Port) is det.
%
%   Listen at Address, Interface:Port0, for Host.  Limits has
%   connections(N), max_bytes(N) and seconds(S).
%
%   @error socket_error(Code, Message)

reception_open(Host, Interface:Port0, Limits, Port) :-
    tcp_socket(Socket),
    catch(( tcp_setopt(Socket, reuseaddr),
            Port = Port0,
            tcp_bind(Socket, Interface:Port),
            tcp_listen(Socket, 64),
            assertz(listens(Host, Socket)),
            crew_start(reception(Host), acceptor,
                       typhon_fipa_reception:accept_all(Host, Socket,
                                                        Limits),
                       true)
          ),
          error(Formal, Context),
          ( retractall(listens(Host, _)),
            tcp_close_socket(Socket),
            throw(error(Formal, Context)) )).

%!  reception_close(+Host) is det.

reception_close(Host) :-
    (   retract(listens(Host, Socket))
    ->  crew_end(reception(Host)),
        tcp_close_socket(Socket)
    ;   true
    ).

accept_all(Host, Socket, Limits) :-
    repeat,
    catch(accept(Host, Socket, Limits), error(Formal, _),
          accept_failed(Host, Formal)),
    fail.

accept_failed(Host, Formal) :-
    debug(typhon(fipa), '~w: a client is lost: ~p', [Host, Formal]),
    sleep(0.1).                         % out of descriptors, most likely

accept(Host, Socket, Limits) :-
    tcp_accept(Socket, Client, _),
    sig_atomic(admit(Host, Client, Limits)).

admit(Host, Client, Limits) :-
    open_streams(Client, In, Out),
    (   room(Host, Limits)
    ->  catch(crew_start(reception(Host), client,
                         typhon_fipa_reception:serve(Host, In, Out, Limits),
                         typhon_fipa_reception:left(Host, In, Out)),
              error(_, _),
              send_away(In, Out))
    ;   send_away(In, Out)
    ).

open_streams(Socket, In, Out) :-
    catch(( tcp_setopt(Socket, nodelay),
            tcp_open_socket(Socket, In, Out) ),
          error(Formal, Context),
          ( tcp_close_socket(Socket),
            throw(error(Formal, Context)) )),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, newline(posix)),
    set_stream(Out, newline(posix)).

send_away(In, Out) :-
    catch(http_respond(Out, 503, false), error(_, _), true),
    close_streams(In, Out).

close_streams(In, Out) :-
    close(Out, [force(true)]),
    close(In, [force(true)]).

%   room(+Host, +Limits): fails if nobody can be sent away for who comes.

room(Host, Limits) :-
    option(connections(Most), Limits),
    findall(Since-Thread, client(Host, Thread, Since, idle), Idle),
    findall(t, client(Host, _, _, _), All),
    length(All, Count),
    (   Count < Most
    ->  true
    ;   msort(Idle, [_-Thread|_]),
        retract(client(Host, Thread, _, idle))
    ->  catch(thread_signal(Thread, typhon_fipa_reception:evict),
              error(_, _), true)
    ).

%   Between two requests nothing is lost by it.

evict :-
    thread_self(Me),
    (   client(_, Me, _, _)
    ->  true
    ;   throw(crew_end)
    ).

                /*******************************
                *            CLIENTS           *
                *******************************/

serve(Host, In, Out, Limits) :-
    thread_self(Me),
    note(Host, Me, busy),
    catch(requests(Host, In, Out, Limits), error(Formal, _),
          debug(typhon(fipa), '~w: a client goes: ~p', [Host, Formal])).

left(Host, In, Out) :-
    thread_self(Me),
    retractall(client(Host, Me, _, _)),
    close_streams(In, Out).

note(Host, Me, State) :-
    get_time(Now),
    assertz(client(Host, Me, Now, State)).

%   Fails for one that has been evicted.

becomes(Host, State) :-
    thread_self(Me),
    retract(client(Host, Me, _, _)),
    note(Host, Me, State).

requests(Host, In, Out, Limits) :-
    sig_atomic(becomes(Host, idle)),
    idle_seconds(Idle),
    set_stream(In, timeout(Idle)),
    peek_byte(In, Byte),
    Byte \== -1,
    sig_atomic(becomes(Host, busy)),
    option(seconds(Seconds), Limits),
    set_stream(In, timeout(Seconds)),
    catch(within(Seconds, one_request(In, Out, Limits, Request)),
          Ball,
          Request = bad(Ball)),
    answer(Request, Host, In, Out, KeepAlive),
    KeepAlive == true,
    requests(Host, In, Out, Limits).

one_request(In, Out, Limits, Request) :-
    option(max_bytes(Max), Limits),
    http_request(In, Out, Max, Request).

answer(bad(Ball), _, In, Out, false) :-
    !,
    (   bad(Ball, Code)
    ->  http_respond(Out, Code, false),
        drained(Code, In)
    ;   throw(Ball)
    ).
answer(Request, Host, _, Out, KeepAlive) :-
    Request = request(_, _, _, _, KeepAlive0),
    (   catch(requested(Host, Request, Code0), error(Formal, Context),
              ( print_message(error, error(Formal, Context)), fail ))
    ->  Code = Code0,
        KeepAlive = KeepAlive0
    ;   Code = 500,
        KeepAlive = false
    ),
    http_respond(Out, Code, KeepAlive).

bad(time_limit_exceeded, 408).
bad(error(Formal, _), Code) :-
    bad_request(Formal, Code).

bad_request(resource_error(http_body), 413) :- !.
bad_request(resource_error(http_head), 413) :- !.
bad_request(syntax_error(http_length), 411) :- !.
bad_request(timeout_error(_, _), 408) :- !.
bad_request(_, 400).

%   What is closed while there is something to read is reset, and the answer
%   is lost.

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
