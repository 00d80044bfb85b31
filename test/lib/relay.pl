:- module(test_relay,
          [ relay_start/4,              % +Target, :Pump, -Relay, -Address
            relay_stop/1,               % +Relay
            relay_cut/1,                % +Relay
            relay_refuse/1,             % +Relay
            relay_admit/1,              % +Relay
            relay_pumps/3,              % +Relay, +Direction, -Threads
            cut/0,
            carry/2                     % +Out, +Text
          ]).

/** <module> Connections through the test process

A relay listens at an address of its own and connects each client to a target,
both being atoms 'Interface:Port'. The pump passes the bytes: a closure that
is called as

    call(Pump, Relay, Connection, Direction, In, Out)

in a thread of its own for each connection and direction, `up` from the client
to the target or `down`. It reads In, a stream of octets, to its end, and
writes Out. cut/0 in a pump closes its connection.

*Threading*: one thread accepts, and of the two that pump the one of direction
`up` owns the sockets. The predicates may be called from any thread, but
relay_refuse/1, relay_admit/1 and relay_stop/1 of one relay not at once.
*/

:- use_module(common, [wait_until/2]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(gensym), [gensym/2]).
:- use_module(library(socket),
              [ tcp_accept/3, tcp_bind/2, tcp_close_socket/1, tcp_connect/2,
                tcp_listen/2, tcp_open_socket/3, tcp_setopt/2, tcp_socket/1 ]).

:- meta_predicate
    relay_start(+, 5, -, -),
    till_broken(0),
    quietly(0).

:- dynamic
    relay/4,                            % Relay, Target, Address, Pump
    listener/3,                         % Relay, Socket, Thread
    pump/3.                             % Relay, Direction, Thread

%!  relay_start(+Target, :Pump, -Relay, -Address) is det.

relay_start(Target, Pump, Relay, Address) :-
    gensym(relay, Relay),
    listen(Port, Socket),
    atomic_list_concat(['127.0.0.1', Port], :, Address),
    assertz(relay(Relay, Target, Address, Pump)),
    accept_from(Relay, Socket).

%!  relay_stop(+Relay) is det.

relay_stop(Relay) :-
    relay_refuse(Relay),
    relay_pumps(Relay, up, Pumps),
    maplist(end_thread, Pumps),
    retractall(pump(Relay, _, _)),
    retractall(relay(Relay, _, _, _)).

%!  relay_cut(+Relay) is det.
%
%   Close the connections that are open now, and wait until they are closed.

relay_cut(Relay) :-
    relay_pumps(Relay, up, Pumps),
    maplist(await_end, Pumps).

%!  relay_refuse(+Relay) is det.
%!  relay_admit(+Relay) is det.
%
%   From relay_refuse/1 to relay_admit/1 no process listens at the address:
%   clients are refused as by a machine whose process is dead.

relay_refuse(Relay) :-
    (   retract(listener(Relay, Socket, Thread))
    ->  end_thread(Thread),
        tcp_close_socket(Socket)
    ;   true
    ).

relay_admit(Relay) :-
    relay(Relay, _, Address, _),
    interface_port(Address, _, Port),
    listen(Port, Socket),
    accept_from(Relay, Socket).

%!  relay_pumps(+Relay, +Direction, -Threads:list) is det.

relay_pumps(Relay, Direction, Threads) :-
    findall(Thread, pump(Relay, Direction, Thread), Threads).

%!  cut.
%
%   Called by a pump: close its connection.

cut :-
    throw(cut).

%!  carry(+Out, +Text) is det.
%
%   Writes and flushes Text, a string or list of octets.

carry(Out, Text) :-
    format(Out, "~s", [Text]),
    flush_output(Out).

		 /*******************************
		 *          CONNECTIONS         *
		 *******************************/

listen(Port, Socket) :-
    tcp_socket(Socket),
    tcp_setopt(Socket, reuseaddr),
    tcp_bind(Socket, '127.0.0.1':Port),
    tcp_listen(Socket, 16).

accept_from(Relay, Socket) :-
    thread_create(till_broken(accept_all(Socket, Relay)), Thread),
    assertz(listener(Relay, Socket, Thread)).

accept_all(Socket, Relay) :-
    repeat,
    tcp_accept(Socket, Client, _),
    sig_atomic(( thread_create(connection(Client, Relay), Thread),
                 assertz(pump(Relay, up, Thread)) )),
    fail.

connection(Client, Relay) :-
    setup_call_cleanup(
        open_streams(Client, In, Out),
        till_broken(connect(In, Out, Relay)),
        close_streams(In, Out)).

connect(In, Out, Relay) :-
    relay(Relay, Target, _, Pump),
    interface_port(Target, Interface, Port),
    tcp_socket(Server),
    catch(tcp_connect(Server, Interface:Port),
          Error,
          ( tcp_close_socket(Server), throw(Error) )),
    thread_self(Me),
    gensym(connection, Connection),
    Up = call(Pump, Relay, Connection, up, In, ServerOut),
    Down = call(Pump, Relay, Connection, down, ServerIn, Out),
    setup_call_cleanup(
        open_streams(Server, ServerIn, ServerOut),
        setup_call_cleanup(
            ( thread_create(pump_down(Down, Me), Thread),
              assertz(pump(Relay, down, Thread)) ),
            Up,
            sig_atomic(( retractall(pump(Relay, down, Thread)),
                         end_thread(Thread) ))),
        close_streams(ServerIn, ServerOut)).

pump_down(Pump, Owner) :-
    call_cleanup(till_broken(Pump), signal(Owner)).

%   A connection ends when it is cut, or when one of its two sides breaks.

till_broken(Goal) :-
    catch(catch(Goal, cut, true), error(_, _), true).

interface_port(Address, Interface, Port) :-
    atomic_list_concat([Interface, PortText], :, Address),
    atom_number(PortText, Port).

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
    await_end(Thread),
    thread_join(Thread, _).

await_end(Thread) :-
    wait_until(signalled_to_end(Thread), 30).

signalled_to_end(Thread) :-
    (   thread_property(Thread, status(running))
    ->  signal(Thread),
        fail
    ;   true
    ).

quietly(Goal) :-
    catch(Goal, error(existence_error(_, _), _), true).
