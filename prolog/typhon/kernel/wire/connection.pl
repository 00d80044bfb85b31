:- module(typhon_connection,
          [ outgoing/2,                 % +Address, +Me
            accept_all/2,               % +Socket, +Me
            accept_no_more/0
          ]).

/** <module> Connections: accepting them, and the thread of each

A connection has one thread, which opens its streams, gives the connection to
the session of the peer, reads frames until it breaks, and closes the streams.

Two endpoints that have completed the handshake look up their session, or open
one, and give it the new connection. On it each reports how many frames it
has received, and sends the rest again.

Both ends may connect at the same time, and a connection may be dead on one
side only. So a new connection replaces an old one, and of two processes the
one with the smaller key, the arbiter, decides in which order that happens: it
sends its count first, and on one connection at a time. Of two connections that
were begun together it refuses the later; the other process accepts the
connection on which the arbiter sends its count.

Each client has a thread of its own and, until it has proved itself, one of a
bounded number of slots. If all are taken, a new client gets the slot of
another, by these rules in this order: of an address from which no peer has
proved itself; of the address that holds most slots; of a client that has sent
nothing yet; of the oldest. So a client that only occupies slots keeps them only
as long as no other client needs them.

Most unknown clients speak another protocol. A client whose first byte has
arrived, and is not that of a greeting, gets neither slot nor thread.

A message for each second reports the number, addresses and reasons of refusals,
see typhon_reports.

*Threading*: incoming/5 and outgoing/2 are the goals of threads of the wire,
and so is accept_all/2, which is woken by a signal: closing the socket would
not wake it. A mutex guards the slots: the acceptor gives and takes them, the
thread of a client reports its progress and returns its own.
*/

:- autoload(library(aggregate), [aggregate_all/3]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error), [syntax_error/1]).
:- use_module(library(lists), [member/2]).
:- use_module(library(pairs), [group_pairs_by_key/2, pairs_keys_values/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- autoload(library(socket),
            [ tcp_accept/3, tcp_close_socket/1, tcp_connect/2,
              tcp_open_socket/3, tcp_setopt/2, tcp_socket/1 ]).
:- use_module('../base/monotonic', [deadline/2, monotonic_time/1]).
:- use_module('../base/names', [counted/3]).
:- use_module('../base/reports', [report/4]).
:- use_module(addresses, [endpoint_parts/3, must_be_endpoint/1]).
:- use_module(handshake,
              [ authenticate/6, cookie/1, hello_codec/3, hello_peer/4,
                hello_to/3 ]).
:- use_module(peer_cache, [peer_gone/1, peer_met/2]).
:- use_module(reader, [lent_away/0, read_frames/3]).
:- use_module(session,
              [ connection_is/2, route_add/2, session_adopting/2,
                session_install/4, session_left/0, session_lost/2,
                session_open/4, session_peer/3, session_retire/1,
                session_to_self/1, session_up_since/2, session_window/2 ]).
:- use_module(threads,
              [ manager_notify/1, wire_thread_create/4, wire_thread_running/1,
                wire_thread_signal/2 ]).
:- use_module(transport,
              [ line_read/3, line_write/2, refusal_text/2, transport_close/0,
                transport_first/2, transport_octets/1, transport_open/6 ]).
:- use_module(window, [window_received/2]).

:- setting(typhon_acceptor:unproved, positive_integer, 128,
           "Connections at a time that have not proved themselves").

:- meta_predicate
    incoming(+, +, +, 1, +),
    meet(+, +, +, +, 0, 2),
    join_session(+, +, +, +, +, -, 2),
    with_streams(0, ?, ?, 0),
    slot(0).

:- dynamic
    unproved/4,                         % Thread, Ip, Since, Stage
    proved/1.                           % Ip, of a peer; the newest last

:- multifile
    leads_to/2,                         % Address, Real: the process of Address
                                        % listens at Real
    harmless/1,                         % Formal: a break that need not be reported
    listens_at/3,                       % Address, Interface, Port: this process listens
                                        % there, and Address is one of its own
    typhon_handshake:greeted/0,
    prolog:message//1,
    typhon_reports:summary/3.

%   incoming(+In, +Out, +Ip, :Stage, +Me): serve the client at Ip, whose
%   streams are In and Out; Me is the hello of this process. Stage is called
%   with `silent`, after which this thread closes the streams, with `heard`
%   when the client has sent something, and with `proved` or refused(Formal).
%   If a call fails the connection ends.

incoming(In, Out, Ip, Stage, Me) :-
    monotonic_time(Start),
    catch(with_streams(call(Stage, silent), In, Out,
                       ( await_first_byte(In, Out),
                         call(Stage, heard),
                         meet(server(Start), In, Out, Me, proves(Stage),
                              reachable(Ip)) )),
          error(Formal, _),
          report_refused(Ip, Formal, Stage)).

await_first_byte(In, Out) :-
    setting(typhon_handshake:handshake_time, Seconds),
    set_stream(In, timeout(Seconds)),
    first_byte(In, Out).

proves(Stage) :-
    call(Stage, proved),
    nb_setval(typhon_proved, true).

report_refused(Ip, Formal, Stage) :-
    debug(typhon(connect), '~w: a client was refused: ~p', [Ip, Formal]),
    (   nb_current(typhon_proved, true) % it has proved itself
    ->  true
    ;   ignore(call(Stage, refused(Formal)))
    ).

%   The address at which the peer claims to listen leads to its session, unless
%   that address is meaningless here.

reachable(_, _, Session) :-
    session_to_self(Session),
    !.
reachable(Ip, Peer, Session) :-
    hello_peer(Peer, Process, _, Claimed),
    must_be_endpoint(Claimed),
    endpoint_parts(Claimed, Interface, _),
    (   loopback(Interface),
        \+ loopback(Ip)
    ->  true
    ;   add_route(Claimed, Process, Session)
    ).

add_route(Address, Process, Session) :-
    route_add(Address, Session),
    peer_met(Address, Process).

loopback(localhost).
loopback(Ip) :-
    sub_atom(Ip, 0, _, _, '127.').

%!  outgoing(+Address, +Me) is det.
%
%   Connect to Address. If that fails the connection manager receives
%   missed(Thread, Formal).

outgoing(Address, Me) :-
    nb_setval(typhon_set_out, true),
    monotonic_time(Start),
    catch(( must_be_endpoint(Address),
            endpoint_parts(Address, Interface, _),
            connects_to(Address, At, Port),
            connect(At, Port, Socket),
            with_streams(open_streams(Socket, In, Out), In, Out,
                         meet(client(Start), In, Out, Me, true,
                              add_routes(Address, Interface)))
          ),
          error(Formal, _),
          missed(Address, Formal)).

%   connects_to(+Address, -Interface, -Port): the process of an address may be
%   elsewhere: another that stands in for it has its address, and its id.

connects_to(Address, Interface, Port) :-
    listens_at(Address, Interface, Port),
    !.
connects_to(Address, Interface, Port) :-
    leads_to(Address, Real),
    !,
    must_be_endpoint(Real),
    endpoint_parts(Real, Interface, Port).
connects_to(Address, Interface, Port) :-
    endpoint_parts(Address, Interface, Port).

typhon_handshake:greeted :-
    nb_current(typhon_set_out, true),
    thread_self(Me),
    manager_notify(greeted(Me)).

add_routes(Address, Interface, Peer, Session) :-
    hello_peer(Peer, Process, _, _),
    add_route(Address, Process, Session),
    reachable(Interface, Peer, Session).

missed(Address, Formal) :-
    (   Formal = socket_error(econnrefused, _)
    ->  peer_gone(Address)
    ;   Formal = permission_error(authenticate, peer, Why),
        ( Why = version(_) ; memberchk(Why, [other,superseded])
        ; refusal_text(Why, _) )
    ->  report(warning, foreign_processes, Address,
               typhon(endpoint, foreign(Address, Formal)))
    ;   true
    ),
    thread_self(Me),
    ignore(manager_notify(missed(Me, Formal))).

connect(Interface, Port, Socket) :-
    tcp_socket(Socket),
    catch(tcp_connect(Socket, Interface:Port),
          Error,
          ( tcp_close_socket(Socket),
            throw(Error) )).

with_streams(Open, In, Out, Goal) :-
    setup_call_cleanup(
        Open,
        Goal,
        ( session_left,
          transport_close,
          close_streams(In, Out) )).

%   The streams of a thread that was lent may be closed already.

close_streams(In, Out) :-
    close_stream(Out),
    close_stream(In).

close_stream(Stream) :-
    catch(close(Stream, [force(true)]),
          error(existence_error(stream, _), _),
          true).

%   open_streams(+Socket, -In, -Out): from now on the streams own Socket.

open_streams(Socket, In, Out) :-
    catch(( tcp_setopt(Socket, nodelay),
            tcp_open_socket(Socket, In, Out) ),
          Error,
          ( tcp_close_socket(Socket),
            throw(Error) )),
    transport_octets(In),
    transport_octets(Out).

		 /*******************************
		 *           MEETING            *
		 *******************************/

%   meet(+Role, +In, +Out, +Me, :Proved, :Known): prove this process and the
%   peer to each other, call Proved, give the connection to their session, and
%   serve it.

meet(Role, In, Out, Me0, Proved, Known) :-
    functor(Role, End, _),
    transport_open(End, In, Out, SIn, SOut, Proof),
    hello_to(Proof, Me0, Me),
    prove(Role, SIn, SOut, Me, Peer),
    call(Proved),
    join_session(Role, SIn, SOut, Me, Peer-Proof, Session, Known),
    serve(Session, SIn, SOut).

%   prove(+Role, +In, +Out, +Me, -Peer) is det.
%
%   Me is the hello of this process, Peer that of the peer, which has proved
%   itself. Role is server(Start), for a connection accepted at the time Start,
%   or client(Start), for one begun then.
%
%   A server reports to a client that its proof is wrong, so that the client
%   does not try again.

prove(client(_), In, Out, Me, Peer) :-
    authenticate(client, In, Out, Me, cookie, Peer).
prove(server(_), In, Out, Me, Peer) :-
    catch(authenticate(server, In, Out, Me, cookie, Peer),
          error(permission_error(authenticate, peer, cookie), Context),
          ( line_write(Out, refused),
            throw(error(permission_error(authenticate, peer, cookie),
                        Context)) )).

%   join_session(+Role, +In, +Out, +Me, +Peer, -Session, :Known) is semidet.
%
%   Give the connection to the session with the peer; Peer is Hello-Proof.
%   Before, call(Known, Hello, Session) notes the addresses that lead to the
%   session: it has one connection for all of them.

join_session(Role, In, Out, Me, Peer-Proof, Session, Known) :-
    hello_codec(Me, Peer, Codec),
    session_keys(Role, Me, Peer, MyKey, Key),
    session_open(Key, Peer-Proof, Codec, Session),
    call(Known, Peer, Session),
    hello_peer(Peer, _, _, Address),
    debug(typhon(session), '~w: a connection, with ~w, ~w',
          [Key, Address, Codec]),
    adopt(MyKey, Key, Role, Session, In, Out).

%   A process that connects to itself has one session for each end.

session_keys(Role, Me, Peer, MyKey, Key) :-
    hello_peer(Me, P1, S1, _),
    hello_peer(Peer, P2, S2, _),
    (   P1-S1 == P2-S2
    ->  own_keys(Role, MyKey, Key)
    ;   atomic_list_concat([P1, S1], '.', MyKey),
        atomic_list_concat([P2, S2], '.', Key)
    ).

own_keys(client(_), self_client, self_server).
own_keys(server(_), self_server, self_client).

adopt(MyKey, Key, Role, Session, In, Out) :-
    MyKey @< Key,
    !,
    session_adopting(Session,
                     ( must_be_needed(Role, Session),
                       session_retire(Session),
                       send_count(Session, Out),
                       receive_count(In, Count),
                       install(Session, Out, Count) )).
adopt(_, _, _, Session, In, Out) :-
    receive_count(In, Count),
    session_adopting(Session,
                     ( session_retire(Session),
                       send_count(Session, Out),
                       install(Session, Out, Count) )).

%   If another connection has been made since this one was begun, this one is
%   not needed.  The peer got the count on the other one, and has it when it
%   detects that this one is closed.

must_be_needed(Role, Session) :-
    arg(1, Role, Start),
    session_up_since(Session, Start),
    !,
    throw(wire_thread_end(met)).
must_be_needed(_, _).

%   The hooks run in the same step: when a process has died, the layer that sent
%   to it sends again when it is notified of its successor.

install(Session, Out, Count) :-
    thread_self(Me),
    sig_atomic(( session_install(Session, Me, Out, Count),
                 connection_is(Session, up) )).

send_count(Session, Out) :-
    session_window(Session, Window),
    window_received(Window, Count),
    format(string(Line), "resume ~d", [Count]),
    line_write(Out, Line).

receive_count(In, Count) :-
    setting(typhon_handshake:handshake_time, Seconds),
    deadline(Seconds, Deadline),
    line_read(In, Deadline, Line),
    (   string_concat("resume ", Digits, Line),
        number_string(Count, Digits),
        integer(Count),
        Count >= 0
    ->  true
    ;   syntax_error(resume)
    ).

		 /*******************************
		 *            SERVING           *
		 *******************************/

%   Read until the connection breaks.  The reason is only reported: missing
%   frames are sent again over the next connection.

serve(Session, In, Out) :-
    thread_self(Me),
    call_cleanup(
        catch(read_frames(Session, In, Out),
              error(Formal, _),
              report_break(Session, Formal)),
        lost(Session, Me)).

%   If this thread was lent, the connection manager may be about to do the same.

lost(Session, Me) :-
    lent_away,
    !,
    session_adopting(Session, session_lost(Session, Me)).
lost(Session, Me) :-
    session_lost(Session, Me).

%   A broken connection is normal, but a violation of the protocol is reported.

report_break(Session, Formal) :-
    session_peer(Session, _, Address),
    (   is_normal_break(Formal)
    ->  print_message(silent, typhon(endpoint, broken(Address, Formal)))
    ;   report(warning, broken_connections, Address,
               typhon(endpoint, broken(Address, Formal)))
    ).

is_normal_break(Formal) :-
    memberchk(Formal, [ io_error(_, _), socket_error(_, _),
                        syntax_error(truncated_frame) ]),
    !.
is_normal_break(Formal) :-
    harmless(Formal).

prolog:message(typhon(endpoint, foreign(Address, Formal))) -->
    { arg(3, Formal, version(Theirs)) },
    !,
    [ 'Endpoint: ~w speaks another version of the protocol, ~w'
      -[Address, Theirs] ].
prolog:message(typhon(endpoint, foreign(Address, Formal))) -->
    { arg(3, Formal, Why) },
    [ 'Endpoint: no connection with ~w: '-[Address] ],
    why(Why).
prolog:message(typhon(endpoint, broken(Address, Formal))) -->
    [ 'Endpoint: connection with ~w broken: ~p'-[Address, Formal] ].

                /*******************************
                *          ACCEPTING           *
                *******************************/

%   The number of addresses kept in proved/1.

proved_addresses(256).

%!  accept_all(+Socket, +Me)
%
%   Serve all clients that connect to Socket until stopped by a signal.  Me is
%   the hello of this process.

accept_all(Socket, Me) :-
    repeat,
    catch(accept(Socket, Me), error(Formal, _), accept_failed(Formal)),
    fail.

%!  accept_no_more is det.
%
%   Close the streams of clients whose threads had not begun with them.  Called
%   when all threads of the endpoint have ended.

accept_no_more :-
    forall(unproved(Thread, _, _, _), take_slot(Thread)).

accept(Socket, Me) :-
    tcp_accept(Socket, Client, ip(A, B, C, D)),
    atomic_list_concat([A, B, C, D], '.', Ip),
    sig_atomic(admit(Client, Ip, Me)).

%   Most likely descriptors are used up: unproved clients may hold them.

accept_failed(Formal) :-
    refused(anywhere, Formal),
    sig_atomic(ignore(slot(evict(_)))),
    sleep(0.1).

admit(Client, Ip, Me) :-
    catch(( open_streams(Client, In, Out),
            let_in(In, Out, Ip, Me, Evicted) ),
          error(Formal, _),
          refused(Ip, Formal)),
    (   nonvar(Evicted)
    ->  refused(Evicted, silent)
    ;   true
    ).

let_in(In, Out, Ip, Me, Evicted) :-
    catch(( check_first(In, Out),
            slot(give(In, Out, Ip, Me, Evicted)) ),
          Error,
          ( close_streams(In, Out),
            throw(Error) )).

check_first(In, Out) :-
    (   wait_for_input([In], [_], 0)
    ->  first_byte(In, Out)
    ;   true
    ).

first_byte(In, Out) :-
    peek_code(In, Byte),
    (   Byte == -1
    ->  syntax_error(end_of_file)
    ;   transport_first(Byte, Out)
    ).

slot(Goal) :-
    with_mutex(typhon_connection, Goal).

give(In, Out, Ip, Me, Evicted) :-
    (   has_slot
    ->  true
    ;   evict(Evicted)
    ->  true
    ;   throw(error(crowd, _))
    ),
    monotonic_time(Now),
    wire_thread_create(serve(In, Out, Ip, Me), in-Ip, Thread,
                       assertz(unproved(Thread, Ip, Now, new(In, Out)))).

		 /*******************************
		 *            SLOTS             *
		 *******************************/

has_slot :-
    free_slot,
    !.
has_slot :-
    forall(( unproved(Thread, _, _, _), \+ wire_thread_running(Thread) ),
           bury(Thread)),
    free_slot.

free_slot :-
    predicate_property(unproved(_, _, _, _), number_of_clauses(Count)),
    setting(typhon_acceptor:unproved, Max),
    Count < Max.

%   A thread that was interrupted in its first or last steps may not have
%   reported its end.

bury(Thread) :-
    take_slot(Thread),
    ignore(manager_notify(ended(Thread))).

evict(Ip) :-
    victim(Thread, Ip),
    take_slot(Thread),
    wire_thread_signal(Thread, evicted).

victim(Thread, Ip) :-
    findall(Ip0, unproved(_, Ip0, _, _), Ips0),
    msort(Ips0, Ips),
    pairs_keys_values(Pairs, Ips, Ips),
    group_pairs_by_key(Pairs, Holders),
    findall(Rank-(Thread1-Ip1),
            ( member(Ip1-Slots, Holders),
              address_rank(Ip1, Slots, Known, Free),
              unproved(Thread1, Ip1, Since, Stage),
              stage_rank(Stage, Spoke),
              Rank = rank(Known, Free, Spoke, Since) ),
            Ranked),
    keysort(Ranked, [_-(Thread-Ip)|_]).

%   The streams of a client whose thread has not begun with them are closed
%   here.

take_slot(Thread) :-
    retract(unproved(Thread, _, _, Stage)),
    !,
    (   Stage = new(In, Out)
    ->  close_streams(In, Out)
    ;   true
    ).

address_rank(Ip, Slots, Known, Free) :-
    (   proved(Ip)
    ->  Known = 1
    ;   Known = 0
    ),
    length(Slots, Count),
    Free is -Count.

%   A new client has had no time to send anything.

stage_rank(silent, 0) :- !.
stage_rank(_, 1).

		 /*******************************
		 *            CLIENTS           *
		 *******************************/

serve(In, Out, Ip, Me) :-
    call_cleanup(incoming(In, Out, Ip, typhon_connection:stage(Ip), Me),
                 leave).

%   stage(+Ip, +Stage): the client of this thread has come so far: `silent`, its
%   streams belong to its thread; `heard`; `proved`; or refused(Formal).  Fails
%   if the slot of the client was given to another, whose thread has counted the
%   refusal.

stage(Ip, refused(Formal)) :-
    !,
    sig_atomic(slot(returned)),
    refused(Ip, Formal).
stage(Ip, Stage) :-
    sig_atomic(slot(reach(Stage, Ip))).

returned :-
    thread_self(Me),
    retract(unproved(Me, _, _, _)),
    !.

reach(proved, Ip) :-
    !,
    leave,
    remember(Ip).
reach(Stage, _) :-
    thread_self(Me),
    retract(unproved(Me, Ip, Since, _)),
    !,
    assertz(unproved(Me, Ip, Since, Stage)).

leave :-
    thread_self(Me),
    retractall(unproved(Me, _, _, _)).

remember(Ip) :-
    proved(Ip),
    !.
remember(Ip) :-
    assertz(proved(Ip)),
    predicate_property(proved(_), number_of_clauses(Count)),
    proved_addresses(Max),
    (   Count > Max
    ->  once(retract(proved(_)))
    ;   true
    ).

		 /*******************************
		 *           REFUSALS           *
		 *******************************/

%   refused(+Ip, +Formal): a client at Ip was refused. Formal is that of an
%   error, `silent` (its slot was needed), `crowd` (there was no slot), or
%   version(V).

refused(Ip, Formal) :-
    reason(Formal, Why),
    level(Why, Level),
    report(Level, refused_clients, Ip-Why,
           typhon(endpoint, turned_away(Ip, Why))).

typhon_reports:summary(refused_clients, Groups,
                       typhon(endpoint, turned_away(Groups))).

%   reason(+Formal, -Why): Why has no details that differ from case to case.

reason(permission_error(authenticate, peer, Why), Why) :- !.
reason(syntax_error(end_of_file), hung_up) :- !.
reason(syntax_error(Why), Why) :- !.
reason(timeout_error(_, _), slow) :- !.
reason(io_error(_, _), broken) :- !.
reason(socket_error(_, _), broken) :- !.
reason(Why, Why).

level(hung_up, informational) :- !.
level(broken, informational) :- !.
level(_, warning).

prolog:message(typhon(endpoint, turned_away(Ip, Why))) -->
    [ 'Endpoint: refused a client at ~w: '-[Ip] ],
    why(Why).
prolog:message(typhon(endpoint, turned_away(Groups))) -->
    { aggregate_all(sum(Count), member(Count-_, Groups), Sum),
      counted(Sum, 'more client', Clients) },
    [ 'Endpoint: refused ~w:'-[Clients] ],
    groups(Groups).

groups([]) -->
    [].
groups([Count-Group|Groups]) -->
    { Group = Ip-Why -> true ; Ip-Why = others-several },
    [ nl, '  ~D at ~w: '-[Count, Ip] ],
    why(Why),
    groups(Groups).

why(version(Version)) -->
    !, [ 'it speaks another version of the protocol, ~w'-[Version] ].
why(Why) -->
    { ours(Why, Text) ; refusal_text(Why, Text) },
    !, [ '~w'-[Text] ].
why(Why) -->
    [ '~p'-[Why] ].

ours(cookie, 'its cookie is not that of this process').
ours(protocol, 'it uses another protocol').
ours(hung_up, 'it closed the connection').
ours(broken, 'the connection broke').
ours(slow, 'it did not complete the handshake in time').
ours(silent, 'its slot was given to another client').
ours(crowd, 'all slots are taken').
ours(line, 'it sent a line that is too long').
ours(other, 'it claims to be another process').
ours(superseded, 'it is an earlier start of a process that was started again').
ours(several, 'for several reasons').
