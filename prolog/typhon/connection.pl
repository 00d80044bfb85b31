:- module(typhon_connection,
          [ incoming/4,                 % +Socket, +Ip, :Welcomed, +Me
            outgoing/2                  % +Address, +Me
          ]).

/** <module> The thread of one connection

A connection has one thread, which opens its streams, proves us to the
peer, gives the connection to the session with that peer, reads frames
until it breaks, and closes the streams.

Both ends may connect at the same time, and a connection may be dead on one
side only. So a new connection always replaces an old one, and of two
processes the one with the smaller key, the arbiter, decides in which order
that happens: it speaks first, and about one connection at a time.

_Threading_: incoming/4 and outgoing/2 are the goals of crew threads. Signals
are held back while a frame is being handled and counted.
*/

:- use_module(library(error), [domain_error/2, syntax_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(socket), [tcp_close_socket/1, tcp_connect/2,
                                tcp_open_socket/3, tcp_setopt/2,
                                tcp_socket/1]).
:- use_module(auth, [authenticate/5]).
:- use_module(contacts, [contact_gone/1, contact_met/2]).
:- use_module(crew, [crew_tell/1]).
:- use_module(hello, [hello_codec/3, line_read/3, line_write/2]).
:- use_module(request, [connection_is/2]).
:- use_module(reader, [read_frames/2]).
:- use_module(session, [route/2, route_add/2, session_adopting/2,
                        session_down/2,
                        session_install/4, session_left/0,
                        session_open/4, session_peer/3,
                        session_received/2, session_retire/1]).

%!  incoming(+Socket, +Ip, :Welcomed, +Me) is det.
%
%   Serve the client at Ip, that has connected; Me is our hello. Welcomed
%   is called when it has proved itself.

incoming(Socket, Ip, Welcomed, Me) :-
    catch(with_streams(Socket, In, Out,
                       ( meet(server, In, Out, Me, Peer, Session),
                         call(Welcomed),
                         reachable(Peer, Ip, Session),
                         serve(Session, In) )),
          error(Formal, _),
          turned_away(Ip, Formal)).

turned_away(Ip, Formal) :-
    (   memberchk(Formal, [io_error(_, _), socket_error(_, _),
                           syntax_error(end_of_file)])
    ->  Level = informational
    ;   Level = warning
    ),
    print_message(Level, typhon(endpoint, turned_away(Ip, Formal))).

%   The peer at Ip can be reached at the address it says it listens to,
%   unless that is meaningless here.

reachable(_, _, session(Key, _, _, _, _)) :-
    memberchk(Key, [self_client, self_server]),
    !.
reachable(hello(Process, _, Claimed, _, _, _), Ip, Session) :-
    address_parts(Claimed, Interface, Port),
    (   Interface == '0.0.0.0'
    ->  atomic_list_concat([Ip, Port], :, Address),
        found(Address, Process, Session)
    ;   loopback(Interface),
        \+ loopback(Ip)
    ->  true
    ;   found(Claimed, Process, Session)
    ).

found(Address, Process, Session) :-
    route_add(Address, Session),
    contact_met(Address, Process).

loopback(localhost).
loopback(Ip) :-
    sub_atom(Ip, 0, _, _, '127.').

%!  outgoing(+Address, +Me) is det.
%
%   Connect to Address. The keeper hears met(Address, Session) or
%   missed(Address, Formal).

outgoing(Address, Me) :-
    outgoing(Address, Me, 4).

outgoing(Address, Me, Times) :-
    catch(( address_parts(Address, Interface, Port),
            connect(Interface, Port, Socket),
            with_streams(Socket, In, Out,
                         ( meet(client, In, Out, Me, Peer, Session),
                           arg(1, Peer, Process),
                           found(Address, Process, Session),
                           reachable(Peer, Interface, Session),
                           ignore(crew_tell(met(Address, Session))),
                           serve(Session, In) ))
          ),
          error(Formal, _),
          missed(Address, Me, Times, Formal)).

%   A peer we have met before and that takes the connection, which breaks
%   before we have met again, is tried again at once.

missed(Address, Me, Times, Formal) :-
    broken_off(Formal),
    Times > 0,
    route(Address, _),
    !,
    Times1 is Times-1,
    outgoing(Address, Me, Times1).
missed(Address, _, _, Formal) :-
    (   Formal = socket_error(econnrefused, _)
    ->  contact_gone(Address)
    ;   true
    ),
    ignore(crew_tell(missed(Address, Formal))).

broken_off(syntax_error(end_of_file)).
broken_off(io_error(_, _)).
broken_off(socket_error(Code, _)) :-
    Code \== econnrefused.

connect(Interface, Port, Socket) :-
    tcp_socket(Socket),
    catch(tcp_connect(Socket, Interface:Port),
          Error,
          ( tcp_close_socket(Socket),
            throw(Error) )).

address_parts(Address, Interface, Port) :-
    (   atomic_list_concat([Interface, PortText], :, Address),
        atom_number(PortText, Port),
        integer(Port)
    ->  true
    ;   domain_error(endpoint_address, Address)
    ).

:- meta_predicate
    incoming(+, +, 0, +),
    with_streams(+, -, -, 0).

%   Once opened, the streams own the socket.

with_streams(Socket, In, Out, Goal) :-
    setup_call_cleanup(
        open_streams(Socket, In, Out),
        Goal,
        ( session_left,
          close(Out, [force(true)]),
          close(In, [force(true)]) )).

open_streams(Socket, In, Out) :-
    tcp_setopt(Socket, nodelay),
    tcp_open_socket(Socket, In, Out),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, buffer_size(65536)),
    set_stream(Out, buffer_size(65536)).

		 /*******************************
		 *            MEETING           *
		 *******************************/

%   Prove each other and give the connection to the session.

meet(Role, In, Out, Me, Peer, Session) :-
    authenticate(Role, In, Out, Me, Peer),
    hello_codec(Me, Peer, Codec),
    session_keys(Role, Me, Peer, MyKey, Key),
    session_open(Key, Peer, Codec, Session),
    adopt(MyKey, Key, Session, In, Out).

%   A process that connects to itself has a session for either end.

session_keys(Role, hello(P, S, _, _, _, _), hello(P, S, _, _, _, _),
             MyKey, Key) :-
    !,
    (   Role == client
    ->  MyKey = self_client, Key = self_server
    ;   MyKey = self_server, Key = self_client
    ).
session_keys(_, hello(P1, S1, _, _, _, _), hello(P2, S2, _, _, _, _),
             MyKey, Key) :-
    atomic_list_concat([P1, S1], '.', MyKey),
    atomic_list_concat([P2, S2], '.', Key).

adopt(MyKey, Key, Session, In, Out) :-
    MyKey @< Key,
    !,
    session_adopting(Session,
                     ( session_retire(Session),
                       say_count(Key, Out),
                       hear_count(In, Count),
                       install(Session, Out, Count) )).
adopt(_, Key, Session, In, Out) :-
    hear_count(In, Count),
    session_adopting(Session,
                     ( session_retire(Session),
                       say_count(Key, Out),
                       install(Session, Out, Count) )).

install(Session, Out, Count) :-
    thread_self(Me),
    session_install(Session, Me, Out, Count).

say_count(Key, Out) :-
    session_received(Key, Count),
    format(string(Line), "resume ~d", [Count]),
    line_write(Out, Line).

hear_count(In, Count) :-
    setting(typhon_auth:handshake_time, Seconds),
    get_time(Now),
    Deadline is Now+Seconds,
    line_read(In, Deadline, Line),
    (   string_concat("resume ", Digits, Line),
        number_string(Count, Digits),
        integer(Count)
    ->  true
    ;   syntax_error(resume)
    ).

%   Read until the connection breaks; how is of no interest, since what is
%   missing will be sent again.

serve(Session, In) :-
    thread_self(Me),
    connection_is(Session, up),
    call_cleanup(
        catch(read_frames(Session, In),
              error(Formal, _),
              report_break(Session, Formal)),
        ( session_down(Session, Me),
          connection_is(Session, down) )).

%   A break is nothing special, but what the peer does may be.

report_break(session(Key, _, _, _, _), Formal) :-
    (   memberchk(Formal, [io_error(_, _), socket_error(_, _),
                           syntax_error(truncated_frame)])
    ->  Level = silent
    ;   Level = warning
    ),
    ignore(session_peer(Key, _, Address)),
    print_message(Level, typhon(endpoint, broken(Address, Formal))).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, turned_away(Ip, Formal))) -->
    [ 'Endpoint: turned away a client at ~w: ~p'-[Ip, Formal] ].
prolog:message(typhon(endpoint, broken(Address, Formal))) -->
    [ 'Endpoint: connection with ~w broken: ~p'-[Address, Formal] ].
