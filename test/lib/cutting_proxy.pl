:- module(cutting_proxy,
          [ with_proxy/3,               % +Target, -Proxy, :Goal
            proxy_start/3,              % +Target, -Proxy, -Address
            proxy_stop/1,               % +Proxy
            proxy_address/2,            % +Proxy, -Address
            proxy_cut/1,                % +Proxy
            proxy_cut_after/3,          % +Proxy, +Direction, +Bytes
            proxy_hold/2,               % +Proxy, +Direction
            proxy_release/2,            % +Proxy, +Direction
            proxy_delay/3,              % +Proxy, +Direction, +Seconds
            proxy_cuts/2                % +Proxy, -Count
          ]).

/** <module> A TCP proxy that breaks connections, for tests

The proxy listens at an address of its own and forwards to a target, both
being atoms 'Interface:Port'. Directions are `up`, from the client to the
target, and `down`.

*Threading*: a thread accepts, and each connection has two that pump, the one
of direction `up` owning the sockets. The predicates may be called from any
thread.
*/

:- use_module(library(socket), [tcp_accept/3, tcp_bind/2, tcp_close_socket/1,
                                tcp_connect/2, tcp_listen/2,
                                tcp_open_socket/3, tcp_setopt/2,
                                tcp_socket/1]).

:- meta_predicate
    with_proxy(+, -, 0),
    till_broken(0),
    quietly(0).

:- dynamic
    proxy/5,                            % Proxy, Target, Address, Socket, Thread
    pump/3,                             % Proxy, Direction, Thread
    cut_after/3,                        % Proxy, Direction, Bytes
    held/2,                             % Proxy, Direction
    delay/3,                            % Proxy, Direction, Seconds
    cuts/2.                             % Proxy, Count

%!  with_proxy(+Target, -Proxy, :Goal)
%
%   Run Goal with a proxy in front of Target.

with_proxy(Target, Proxy, Goal) :-
    setup_call_cleanup(
        proxy_start(Target, Proxy, _),
        Goal,
        proxy_stop(Proxy)).

%!  proxy_start(+Target, -Proxy, -Address) is det.

proxy_start(Target, Proxy, Address) :-
    gensym(proxy, Proxy),
    tcp_socket(Socket),
    tcp_setopt(Socket, reuseaddr),
    tcp_bind(Socket, '127.0.0.1':Port),
    tcp_listen(Socket, 16),
    atomic_list_concat(['127.0.0.1', Port], :, Address),
    assertz(cuts(Proxy, 0)),
    thread_create(accept_all(Socket, Proxy, Target), Thread),
    assertz(proxy(Proxy, Target, Address, Socket, Thread)).

%!  proxy_stop(+Proxy) is det.

proxy_stop(Proxy) :-
    retract(proxy(Proxy, _, _, Socket, Thread)),
    end_thread(Thread),
    tcp_close_socket(Socket),
    findall(Pump, pump(Proxy, up, Pump), Pumps),
    forall(member(Pump, Pumps), end_thread(Pump)),
    retractall(pump(Proxy, _, _)),
    retractall(cut_after(Proxy, _, _)),
    retractall(held(Proxy, _)),
    retractall(delay(Proxy, _, _)),
    retractall(cuts(Proxy, _)).

proxy_address(Proxy, Address) :-
    proxy(Proxy, _, Address, _, _).

%!  proxy_cut(+Proxy) is det.
%
%   Close all connections that are open now.

proxy_cut(Proxy) :-
    forall(pump(Proxy, up, Pump), signal(Pump)).

%!  proxy_cut_after(+Proxy, +Direction, +Bytes) is det.
%
%   Forward Bytes more bytes in Direction, then close the connection. Once.

proxy_cut_after(Proxy, Direction, Bytes) :-
    retractall(cut_after(Proxy, Direction, _)),
    assertz(cut_after(Proxy, Direction, Bytes)).

%!  proxy_hold(+Proxy, +Direction) is det.
%!  proxy_release(+Proxy, +Direction) is det.
%
%   Forward nothing from now on: the connection looks alive and is silent.

proxy_hold(Proxy, Direction) :-
    assertz(held(Proxy, Direction)).

proxy_release(Proxy, Direction) :-
    retractall(held(Proxy, Direction)),
    forall(pump(Proxy, Direction, Pump),
           quietly(thread_send_message(Pump, go))).

%!  proxy_delay(+Proxy, +Direction, +Seconds) is det.
%
%   Wait so long before forwarding each piece.

proxy_delay(Proxy, Direction, Seconds) :-
    retractall(delay(Proxy, Direction, _)),
    assertz(delay(Proxy, Direction, Seconds)).

%!  proxy_cuts(+Proxy, -Count) is det.
%
%   Count connections were cut after a number of bytes.

proxy_cuts(Proxy, Count) :-
    cuts(Proxy, Count).

		 /*******************************
		 *            PUMPS             *
		 *******************************/

accept_all(Socket, Proxy, Target) :-
    repeat,
    tcp_accept(Socket, Client, _),
    sig_atomic(( thread_create(forward(Client, Proxy, Target), Thread),
                 assertz(pump(Proxy, up, Thread)) )),
    fail.

forward(Client, Proxy, Target) :-
    setup_call_cleanup(
        open_streams(Client, In, Out),
        till_broken(forward_streams(In, Out, Proxy, Target)),
        close_streams(In, Out)).

forward_streams(In, Out, Proxy, Target) :-
    atomic_list_concat([Interface, PortText], :, Target),
    atom_number(PortText, Port),
    tcp_socket(Server),
    catch(tcp_connect(Server, Interface:Port),
          Error,
          ( tcp_close_socket(Server), throw(Error) )),
    thread_self(Me),
    setup_call_cleanup(
        open_streams(Server, SIn, SOut),
        setup_call_cleanup(
            ( thread_create(pump_down(SIn, Out, Proxy, Me), Down),
              assertz(pump(Proxy, down, Down)) ),
            pump(In, SOut, Proxy, up),
            sig_atomic(( retractall(pump(Proxy, down, Down)),
                         end_thread(Down) ))),
        close_streams(SIn, SOut)).

pump_down(In, Out, Proxy, Owner) :-
    call_cleanup(
        till_broken(pump(In, Out, Proxy, down)),
        signal(Owner)).

%   A connection ends when it is cut, or when one of its two sides breaks.

till_broken(Goal) :-
    catch(catch(Goal, cut, true), error(_, _), true).

pump(In, Out, Proxy, Direction) :-
    repeat,
    peek_byte(In, Byte),                % fill_buffer/1 may leave In locked
    (   Byte == -1
    ->  !
    ;   read_pending_codes(In, Codes, []),
        pass(Proxy, Direction),
        forward_codes(Codes, Out, Proxy, Direction),
        fail
    ).

pass(Proxy, Direction) :-
    (   held(Proxy, Direction)
    ->  thread_get_message(go),
        pass(Proxy, Direction)
    ;   delay(Proxy, Direction, Seconds)
    ->  sleep(Seconds)
    ;   true
    ).

forward_codes(Codes, Out, Proxy, Direction) :-
    length(Codes, Length),
    (   retract(cut_after(Proxy, Direction, Bytes))
    ->  (   Bytes >= Length
        ->  Left is Bytes-Length,
            assertz(cut_after(Proxy, Direction, Left)),
            send(Codes, Out)
        ;   length(Last, Bytes),
            append(Last, _, Codes),
            send(Last, Out),
            count_cut(Proxy),
            throw(cut)
        )
    ;   send(Codes, Out)
    ).

count_cut(Proxy) :-
    with_mutex(cutting_proxy,
               ( retract(cuts(Proxy, Count0)),
                 Count is Count0+1,
                 assertz(cuts(Proxy, Count)) )).

send(Codes, Out) :-
    format(Out, "~s", [Codes]),
    flush_output(Out).

open_streams(Socket, In, Out) :-
    tcp_setopt(Socket, nodelay),
    tcp_open_socket(Socket, In, Out),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)).

%   A second signal must not end this early: closing a stream that a thread
%   still reads from would wait for ever.

close_streams(In, Out) :-
    sig_atomic(( close(Out, [force(true)]),
                 close(In, [force(true)]) )).

signal(Thread) :-
    quietly(thread_signal(Thread, throw(cut))).

%   A signal that comes just before a system call does not interrupt it.

end_thread(Thread) :-
    (   thread_property(Thread, status(running))
    ->  signal(Thread),
        sleep(0.002),
        end_thread(Thread)
    ;   thread_join(Thread, _)
    ).

quietly(Goal) :-
    catch(Goal, error(existence_error(_, _), _), true).
