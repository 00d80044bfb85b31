:- module(typhon_connection,
          [ incoming/5,                 % +In, +Out, +Ip, :Stage, +Me
            outgoing/2,                 % +Address, +Me
            open_streams/3              % +Socket, -In, -Out
          ]).

/** <module> The thread of one connection

A connection has one thread, which opens its streams, proves us to the
peer, gives the connection to the session with that peer, reads frames
until it breaks, and closes the streams.

Both ends may connect at the same time, and a connection may be dead on one
side only. So a new connection always replaces an old one, and of two
processes the one with the smaller key, the arbiter, decides in which order
that happens: it speaks first, and about one connection at a time.

_Threading_: incoming/5 and outgoing/2 are the goals of crew threads. Signals
are held back while a session is given its connection, and while a frame is
being handled and counted.
*/

:- use_module(library(error), [domain_error/2, syntax_error/1]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(socket),
              [ tcp_close_socket/1, tcp_connect/2, tcp_open_socket/3,
                tcp_setopt/2, tcp_socket/1 ]).
:- use_module(auth, [authenticate/5]).
:- use_module(contacts, [contact_gone/1, contact_met/2]).
:- use_module(hello, [hello_codec/3, line_read/3, line_write/2]).
:- use_module(outbox,
              [ session_down/2, session_install/4, session_left/0,
                session_retire/1, session_up_since/2 ]).
:- use_module(reader, [read_frames/2]).
:- use_module(refusals, [refused/2]).
:- use_module(request, [connection_is/2]).
:- use_module(session,
              [ route_add/2, session_adopting/2, session_open/4,
                session_received/2 ]).
:- use_module(threads, [crew_tell/1]).

:- multifile
    typhon_auth:greeted/0.

:- meta_predicate
    incoming(+, +, +, 1, +),
    with_streams(0, ?, ?, 0),
    meet(+, +, +, +, +, -, 1).

%!  incoming(+In, +Out, +Ip, :Stage, +Me) is det.
%
%   Serve the client at Ip, whose streams are In and Out; Me is our hello.
%   Stage is called with `silent`, from when on we see to the streams, with
%   `heard` when the client has said something, and with `proved`. If it
%   fails, that was all.

incoming(In, Out, Ip, Stage, Me) :-
    catch(with_streams(call(Stage, silent), In, Out,
                       ( await_word(In),
                         call(Stage, heard),
                         prove(server, In, Out, Me, Peer),
                         call(Stage, proved),
                         nb_setval(typhon_proved, true),
                         meet(server, In, Out, Me, Peer, Session,
                              reachable(Peer, Ip)),
                         serve(Session, In) )),
          error(Formal, _),
          turned_away(Ip, Formal)).

await_word(In) :-
    setting(typhon_auth:handshake_time, Seconds),
    set_stream(In, timeout(Seconds)),
    peek_byte(In, _).

turned_away(Ip, Formal) :-
    (   nb_current(typhon_proved, true) % it came to us by another way
    ->  true
    ;   refused(Ip, Formal)
    ).

%   The peer at Ip can be reached at the address it says it listens to,
%   unless that is meaningless here.

reachable(_, _, session(Key, _, _, _, _)) :-
    memberchk(Key, [self_client, self_server]),
    !.
reachable(hello(Process, _, Claimed, _, _, _), Ip, Session) :-
    address_parts(Claimed, Interface, Port),
    (   Interface == '0.0.0.0'
    ->  atomic_list_concat([Ip, Port], :, Address),
        leads_to(Address, Process, Session)
    ;   loopback(Interface),
        \+ loopback(Ip)
    ->  true
    ;   leads_to(Claimed, Process, Session)
    ).

leads_to(Address, Process, Session) :-
    route_add(Address, Session),
    contact_met(Address, Process).

loopback(localhost).
loopback(Ip) :-
    sub_atom(Ip, 0, _, _, '127.').

%!  outgoing(+Address, +Me) is det.
%
%   Connect to Address. If there comes no connection of it the keeper hears
%   missed(Thread, Formal).

outgoing(Address, Me) :-
    get_time(Start),
    nb_setval(typhon_set_out, Start),
    catch(( address_parts(Address, Interface, Port),
            connect(Interface, Port, Socket),
            with_streams(open_streams(Socket, In, Out), In, Out,
                         ( prove(client, In, Out, Me, Peer),
                           meet(client, In, Out, Me, Peer, Session,
                                found(Address, Interface, Peer)),
                           serve(Session, In) ))
          ),
          error(Formal, _),
          missed(Address, Formal)).

typhon_auth:greeted :-
    nb_current(typhon_set_out, _),
    thread_self(Me),
    crew_tell(greeted(Me)).

found(Address, Interface, Peer, Session) :-
    arg(1, Peer, Process),
    leads_to(Address, Process, Session),
    reachable(Peer, Interface, Session).

missed(Address, Formal) :-
    (   Formal = socket_error(econnrefused, _)
    ->  contact_gone(Address)
    ;   Formal = permission_error(authenticate, peer, version(_))
    ->  print_message(warning, typhon(endpoint, foreign(Address, Formal)))
    ;   true
    ),
    thread_self(Me),
    ignore(crew_tell(missed(Me, Formal))).

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

with_streams(Open, In, Out, Goal) :-
    setup_call_cleanup(
        Open,
        Goal,
        ( session_left,
          close(Out, [force(true)]),
          close(In, [force(true)]) )).

%!  open_streams(+Socket, -In, -Out) is det.
%
%   From now on the streams own Socket.

open_streams(Socket, In, Out) :-
    catch(( tcp_setopt(Socket, nodelay),
            tcp_open_socket(Socket, In, Out) ),
          Error,
          ( tcp_close_socket(Socket),
            throw(Error) )),
    set_stream(In, encoding(octet)),
    set_stream(Out, encoding(octet)),
    set_stream(In, buffer_size(65536)),
    set_stream(Out, buffer_size(65536)).

		 /*******************************
		 *            MEETING           *
		 *******************************/

%   A server tells a client in vain at the door that it does not know the
%   cookie: it need not come back.

prove(client, In, Out, Me, Peer) :-
    authenticate(client, In, Out, Me, Peer).
prove(server, In, Out, Me, Peer) :-
    catch(authenticate(server, In, Out, Me, Peer),
          error(permission_error(authenticate, peer, cookie), Context),
          ( line_write(Out, refused),
            throw(error(permission_error(authenticate, peer, cookie),
                        Context)) )).

%   meet(+Role, +In, +Out, +Me, +Peer, -Session, :Known): give the connection
%   to the session with Peer. call(Known, Session) notes the addresses that
%   lead to it before that: whoever gives it a connection does so for all.

meet(Role, In, Out, Me, Peer, Session, Known) :-
    hello_codec(Me, Peer, Codec),
    session_keys(Role, Me, Peer, MyKey, Key),
    session_open(Key, Peer, Codec, Session),
    call(Known, Session),
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
                     ( make_way(Session),
                       say_count(Key, Out),
                       hear_count(In, Count),
                       install(Session, Out, Count) )).
adopt(_, Key, Session, In, Out) :-
    hear_count(In, Count),
    session_adopting(Session,
                     ( make_way(Session),
                       say_count(Key, Out),
                       install(Session, Out, Count) )).

%   Where the peer has come meanwhile there is no need for what we set out
%   for. It has said its count over that connection and will not give it up
%   for the same reason; over ours we have not.

make_way(Session) :-
    nb_current(typhon_set_out, Start),
    session_up_since(Session, Start),
    !,
    throw(crew(met)).
make_way(Session) :-
    session_retire(Session).

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
        integer(Count),
        Count >= 0
    ->  true
    ;   syntax_error(resume)
    ).

%   Read until the connection breaks; how is of no interest, since what is
%   missing will be sent again.

serve(Session, In) :-
    thread_self(Me),
    call_cleanup(
        ( connection_is(Session, up),
          catch(read_frames(Session, In),
                error(Formal, _),
                report_break(Session, Formal))
        ),
        ( session_down(Session, Me),
          connection_is(Session, down) )).

%   A break is nothing special, but what the peer does may be.

report_break(session(_, _, _, _, peer(_, Address)), Formal) :-
    (   nb_current(typhon_proved, true) % it came to us by another way
    ->  Level = silent
    ;   memberchk(Formal, [io_error(_, _), socket_error(_, _),
                           syntax_error(truncated_frame)])
    ->  Level = silent
    ;   Level = warning
    ),
    print_message(Level, typhon(endpoint, broken(Address, Formal))).

:- multifile prolog:message//1.

prolog:message(typhon(endpoint, foreign(Address, Formal))) -->
    { arg(3, Formal, version(Theirs)) },
    [ 'Endpoint: ~w speaks another version of the protocol, ~w'
      -[Address, Theirs] ].
prolog:message(typhon(endpoint, broken(Address, Formal))) -->
    [ 'Endpoint: connection with ~w broken: ~p'-[Address, Formal] ].
