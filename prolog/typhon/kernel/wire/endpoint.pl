:- module(typhon_endpoint,
          [ endpoint_start/4,           % +Interface, +Port, +Options, -Address
            endpoint_start_alone/1,     % +Address
            endpoint_open/0,
            endpoint_stop/0,
            endpoint_listen/2,          % +Port, -Address
            endpoint_listen_end/1,      % +Address
            endpoint_address/1,         % ?Address
            endpoint_option/1,          % ?Option
            endpoint_process/1,         % -Id
            endpoint_post/3,            % +Address, +Kind, +Term
            endpoint_post_up/3,         % +Address, +Kind, +Term
            endpoint_post_by/4,         % +Deadline, +Address, +Kind, +Term
            endpoint_request/4,         % +Address, +Kind, +Term, :OnAnswer
            endpoint_hand/4,            % +Address, +Kind, +Term, -Hand
            endpoint_call/5,            % +Address, +Kind, +Term, -Answer,
                                        % +Timeout
            endpoint_ask_all/6          % +Addresses, +Kind, +Term, :Further,
                                        % +Seconds, -Results
          ]).

/** <module> The endpoint: one per process

An endpoint sends terms to the endpoints of other processes, and to itself,
over TCP. It does not know of agents. Its address is an atom `Interface:Port`,
see typhon_addresses.  Its process has a random id, which together with the number of this start shows
peers whether they meet the same process again. Arriving terms go to hooks, one
clause for each kind of message, in the module that owns the kind:

  - received(+Kind, +Term, +Peer)
  - together(+Kind, +Terms, -Fewer): merge posts that have come in one frame;
    fails if they are to be taken one by one
  - requested(+Kind, +Term, +Peer, +ReplyTo)
  - connection(+Peer, +State)
  - lent(+Thread) and returned, see typhon_reader

Peer is the address at which the sender listens.

A post goes one way, a request is answered. Both go over the session to which
the address leads; if there is none that is up, a connection is made first. A
caller may wait for one answer, or for those of many peers with one deadline.

*Threading*: any thread may call everything; endpoint_post/3 may block it,
unless it is in a hook of the endpoint; endpoint_call/5 and endpoint_ask_all/6
wait, and are not for the threads of the endpoint. The hooks run in the thread
of a connection and must be quick: while one runs, no other frame of that peer
is read. They may post, request and reply. own_place/4 and own_start_next/1 run
under the mutex of the endpoint.
*/

:- use_module(library(apply), [maplist/2]).
:- use_module(library(debug), [debug/3]).
:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists),
              [append/3, member/2, reverse/2, selectchk/3, subtract/3]).
:- use_module(library(option), [option/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- autoload(library(socket),
            [ tcp_bind/2, tcp_close_socket/1, tcp_listen/2, tcp_open_socket/3,
              tcp_setopt/2, tcp_socket/1 ]).
:- use_module('../base/compiling', [compiling/1]).
:- use_module('../base/fifo', [fifo_send/2]).
:- use_module('../base/durable',
              [ commits_must_succeed/0, durable_item/5, durable_opened/1,
                durable_put/4, sync_changes/0 ]).
:- use_module('../base/monotonic',
              [deadline/2, monotonic_time/1, wait_within/2]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module('../base/own_thread', [in_own_thread/1, stop_steps/1]).
:- use_module('../base/reports', [reports_end/0]).
:- use_module(addresses,
              [ announced/4, endpoint_parts/3, must_be_reachable/2,
                stands_for_all/1 ]).
:- use_module(connection, [accept_all/2, accept_no_more/0]).
:- use_module(connection_manager,
              [ manager_begin/1, manager_connect/1, manager_connect/2,
                manager_end/0, peers_flush/1, unsent/1, unsent_closed/4,
                unsent_forget/1, unsent_request/4 ]).
:- use_module(frame, [mobile_term/1]).
:- use_module(handshake, [cookie/1, hello/4, random_hex/2]).
:- use_module(peer_cache, [endpoint_peer/2]).
:- use_module(reader, [in_reader/0, lending_anew/0]).
:- use_module(request,
              [ request_answer/2, request_forget/1, request_send/4,
                requests_lost/2, take_post/3, take_request/4 ]).
:- use_module(session,
              [ route/2, route_up/2, session/2, session_close/2,
                session_control/2, session_hand/4, session_send_with/2 ]).
:- use_module(threads,
              [wire_thread_create/3, wire_thread_end/2, wire_threads_end/0]).
:- use_module(transport,
              [ alone/1, alone_begin/1, alone_end/0, transport_begin/1,
                transport_end/0 ]).

:- setting(flush_time, number, 2,
           "Seconds endpoint_stop/0 waits for the last frames to arrive").
:- setting(typhon_endpoint:lost_time, number, 5,
           "Seconds without connection before endpoint_call/5 gives up").

:- meta_predicate
    endpoint_request(+, +, +, 1),
    endpoint_ask_all(+, +, +, 2, +, -).

:- dynamic
    connection/2,
    lent/1,
    closed/0,                           % peers are not accepted yet
    advertised/1,                       % Name or Name:Port, or `none`
    listening/4,                        % Address, Interface:Port, Socket,
                                        % Acceptor: the address of the endpoint
                                        % is the first
    process/1,                          % Id
    starts/1.                           % Count: how often it began to listen

:- multifile
    received/3,                         % Kind, Term, Peer
    together/3,                         % Kind, Terms, Fewer
    requested/4,                        % Kind, Term, Peer, ReplyTo
    handed/4,                           % Kind, Term, Peer, Verdict: `accepted`,
                                        % `deferred`, or another answer
    handed_over/2,                      % Token, Result
    connection/2,                       % Peer, State
    lent/1,                             % Thread
    returned/0,
    typhon_connection:listens_at/3.

%!  endpoint_start(+Interface, +Port, +Options, -Address) is det.
%
%   Listen at Port of Interface; Port 0 is any free one.  Address is the one that
%   peers get, by default Interface with the port.  Options are advertise(Name) or
%   advertise('Name:Port') for another, and those of transports, see
%   typhon_transport.
%
%   @error permission_error(start, endpoint, Address) if one is running
%   @error socket_error(Code, Text): the port is taken, or the interface is
%   unknown; the context names both
%   @error errors of must_be_reachable/2

endpoint_start(Interface, Port, Options, Address) :-
    must_be(nonneg, Port),
    with_mutex(typhon_endpoint, start(Options, Interface, Port, Address)).

start(_, _, _, _) :-
    endpoint_address(Address),
    !,
    permission_error(start, endpoint, Address).
start(Options, Interface, Port, Address) :-
    option(advertise(Advertised), Options, none),
    transport_begin(Options),
    catch(start_at(at(Interface, Advertised), Port, Address), Ball,
          ( transport_end, throw(Ball) )).

start_at(At0, Port0, Address) :-
    compiling(use_module(library(socket), [])),
    cookie(_),
    own_place(At0, Port0, at(Interface0, Advertised), Port1),
    until_opened,
    (   Interface0 == localhost
    ->  Interface = '127.0.0.1'
    ;   Interface = Interface0
    ),
    must_be_reachable(Interface, Advertised),
    listen(Interface, Port1, Port, Socket),
    announced(Interface, Advertised, Port, Address),
    retractall(advertised(_)),
    assertz(advertised(Advertised)),
    own_start_next(Start),
    our_hello(Start, Address, Me),
    lending_anew,
    manager_begin(Me),
    accept_at(Address, Interface:Port, Socket, Me, acceptor),
    debug(typhon(session), 'endpoint: starts at ~w, start ~w',
          [Address, Start]).

%   If there is a journal, peers are accepted only after it was read.

until_opened :-
    retractall(closed),
    (   durable_opened(_)
    ->  assertz(closed)
    ;   true
    ).

accept_at(Address, Bound, Socket, Me, Name) :-
    wire_thread_create(accept_open(Socket, Me), Name, Acceptor),
    assertz(listening(Address, Bound, Socket, Acceptor)).

accept_open(Socket, Me) :-
    (   closed
    ->  thread_get_message(endpoint_opens)
    ;   true
    ),
    accept_all(Socket, Me).

%!  endpoint_open is det.
%
%   Accept peers: the journal was read.

endpoint_open :-
    listening(_, Bound, _, _),
    !,
    own_id_note(Bound),
    sync_changes,
    retractall(closed),
    forall(listening(_, _, _, Acceptor),
           thread_send_message(Acceptor, endpoint_opens)).

%!  endpoint_start_alone(+Address) is det.
%
%   Start an endpoint that reaches only itself.
%
%   @error permission_error(start, endpoint, Address) if one is running

endpoint_start_alone(Address) :-
    with_mutex(typhon_endpoint, start_alone(Address)).

start_alone(_) :-
    endpoint_address(Address),
    !,
    permission_error(start, endpoint, Address).
start_alone(Address) :-
    alone_begin(Address).

%   listen(+Interface, +Port0, -Port, -Socket): reuseaddr lets a new process
%   listen at the port as soon as the old one has stopped.  The socket gets a
%   stream because child processes would inherit it otherwise.

listen(Interface, Port0, Port, Socket) :-
    (   Port0 =:= 0
    ->  true                            % any free one
    ;   Port = Port0
    ),
    tcp_socket(Socket),
    catch(( tcp_setopt(Socket, reuseaddr),
            tcp_bind(Socket, Interface:Port),
            tcp_listen(Socket, 1024),
            tcp_open_socket(Socket, _, _)
          ),
          Error,
          ( tcp_close_socket(Socket),
            blame(Error, Interface, Port0) )).

%   Name the port that is taken, or the interface that is not of this machine.

blame(error(socket_error(Code, Text), _), Interface, Port) :-
    !,
    how_to_listen(Code, How),
    format(atom(Where), 'at ~w:~w~w', [Interface, Port, How]),
    throw(error(socket_error(Code, Text), context(_, Where))).
blame(Error, _, _) :-
    throw(Error).

how_to_listen(eaddrinuse,
              '; choose another port, or port(0) for any free one') :- !.
how_to_listen(eacces, '') :- !.
how_to_listen(_, '; give a name or an IPv4 address of this machine').

our_hello(Start, Address, Me) :-
    endpoint_process(Process),
    hello(Process, Start, Address, Me).

%!  endpoint_listen(+Port, -Address) is det.
%
%   Listen at a further Port, too, unless it does, until endpoint_listen_end/1 or
%   the end of the endpoint. A peer that connects there reaches the endpoint as at
%   its first port.
%
%   @error existence_error(endpoint, running)

endpoint_listen(Port, Address) :-
    must_be(between(1, 65535), Port),
    with_mutex(typhon_endpoint, listen_too(Port, Address)).

listen_too(Port, Address) :-
    listening(Address0, _:Port, _, _),
    !,
    Address = Address0.
listen_too(Port, Address) :-
    (   listening(First, Interface:_, _, _)
    ->  true
    ;   existence_error(endpoint, running)
    ),
    starts(Start),
    our_hello(Start, First, Me),
    listen(Interface, Port, _, Socket),
    advertised(Advertised),
    ( endpoint_parts(Advertised, Name, _) -> true ; Name = Advertised ),
    announced(Interface, Name, Port, Address),
    accept_at(Address, Interface:Port, Socket, Me, acceptor-Port),
    debug(typhon(session), 'endpoint: listens at ~w, too', [Address]).

%!  endpoint_listen_end(+Address) is det.
%
%   Stop listening at Address, see endpoint_listen/2, unless it is the first.

endpoint_listen_end(Address) :-
    with_mutex(typhon_endpoint, listen_end(Address)).

listen_end(Address) :-
    (   endpoint_address(First),
        First \== Address
    ->  listen_no_more(Address)
    ;   true
    ).

listen_no_more(Address) :-
    retract(listening(Address, _, Socket, Acceptor)),
    !,
    wire_thread_end(Acceptor, stopped),
    tcp_close_socket(Socket).
listen_no_more(_).

%!  endpoint_stop is det.
%
%   Accept no more connections, wait until the last frames have arrived at peers
%   that are connected, close everything.  Requests without an answer are lost.
%   May be called in a clean-up handler: the wait with a deadline is in another
%   thread, see manager_connect/1.

endpoint_stop :-
    with_mutex(typhon_endpoint, stop).

stop :-
    listening(Address, _, _, _),
    !,
    debug(typhon(session), 'endpoint: stops at ~w', [Address]),
    findall(Each, listening(Each, _, _, _), All),
    reverse(All, LastToFirst),
    setting(flush_time, Seconds),
    stop_steps([ maplist(listen_no_more, LastToFirst),
                 in_own_thread(ignore(peers_flush(Seconds))),
                 forall(session(_, Session), session_control(Session, bye)),
                 manager_end,
                 wire_threads_end,
                 accept_no_more,
                 forall(session(_, Session), close_session(Session)),
                 transport_end,
                 reports_end ]).
stop :-
    alone_end,
    reports_end.

close_session(Session) :-
    session_close(Session, Unsent),
    requests_lost(Session, Unsent).

%!  endpoint_address(?Address) is semidet.
%
%   Address is one of this process: the first, if unbound.

endpoint_address(Address) :-
    listening(Address, _, _, _),
    !.
endpoint_address(Address) :-
    alone(Address).

%   A network may not lead from the address that peers use back to this process.

typhon_connection:listens_at(Address, Interface, Port) :-
    listening(Address, Bound:Port, _, _),
    !,
    ( stands_for_all(Bound) -> Interface = '127.0.0.1' ; Interface = Bound ).

%!  endpoint_option(?Option) is nondet.
%
%   The endpoint listens with Option, bind(Interface) or advertise(Address).

endpoint_option(bind(Interface)) :-
    listening(_, Interface:_, _, _),
    !.
endpoint_option(advertise(Address)) :-
    advertised(Address),
    listening(_, _, _, _).

		 /*******************************
		 *          PROCESS ID          *
		 *******************************/

%!  own_place(+At0, +Port0, -At, -Port) is det.
%
%   The interface and port to listen at, and the name to advertise; At is
%   at(Interface, Advertised).  A process that has a journal keeps the id and the
%   place that it had when the journal was last open.  Peers recognise such a
%   process by the first letter of its id, see endpoint_lasting/1.

own_place(At0, Port0, At, Port) :-
    durable_opened(_),
    !,
    retractall(process(_)),
    (   durable_item(endpoint, any, _, _,
                     endpoint(Process, Start, Noted, Port1))
    ->  retractall(starts(_)),
        assertz(starts(Start)),
        ( Port0 =:= 0 -> Port = Port1 ; Port = Port0 ),
        noted_place(At0, Noted, At)
    ;   random_hex(8, New),
        atom_concat(j, New, Process),
        Port = Port0,
        At = At0
    ),
    assertz(process(Process)).
own_place(At, Port, At, Port) :-
    (   process(Process),
        sub_atom(Process, 0, _, _, j)
    ->  retractall(process(_))
    ;   true
    ).

%   Noted is the interface alone where the process announced that.

noted_place(at(localhost, none), Noted, At) :-
    !,
    ( Noted = at(_, _) -> At = Noted ; At = at(Noted, none) ).
noted_place(At, _, At).

%!  own_start_next(-Start) is det.
%
%   Count one more start.

own_start_next(Start) :-
    (   retract(starts(Start0))
    ->  true
    ;   Start0 = 0
    ),
    Start is Start0+1,
    assertz(starts(Start)).

%!  own_id_note(+Bound) is det.
%
%   Write the id and the place, with Bound, which is Interface:Port, to the
%   journal.

own_id_note(Interface:Port) :-
    advertised(Advertised),
    (   Advertised == none
    ->  Noted = Interface
    ;   Noted = at(Interface, Advertised)
    ),
    endpoint_process(Process),
    starts(Start),
    durable_put(endpoint, '', 0, endpoint(Process, Start, Noted, Port)).

%!  endpoint_process(-Id) is det.
%
%   The random id of this process.

endpoint_process(Id) :-
    process(Id0),
    !,
    Id = Id0.
endpoint_process(Id) :-
    random_hex(8, New),
    with_mutex(typhon_runtime,
               (   process(_)
               ->  true
               ;   assertz(process(New))
               )),
    endpoint_process(Id).

                /*******************************
                *    MESSAGES AND REQUESTS     *
                *******************************/

%!  endpoint_post(+Address, +Kind, +Term) is det.
%
%   Send Term, one way.  It arrives once, in the order of the posts of this
%   thread, as long as both processes live.  May block while it connects.  A
%   post to this process is handled by this thread, at once.
%
%   @error unreachable(Address)
%   @error type_error(mobile_term, Culprit)
%   @error the error with which commits fail now, as endpoint_call/5: other
%          output waits until they succeed

endpoint_post(Address, Kind, Term) :-
    endpoint_address(Own),
    Own == Address,
    !,
    mobile_term(Term),
    copy_term(Term, Copy),
    take_post(Kind, Copy, Address).
endpoint_post(Address, _, _) :-
    alone(_),
    !,
    throw(error(unreachable(Address), _)).
endpoint_post(Address, Kind, Term) :-
    commits_must_succeed,
    (   ready_session(Address, Session)
    ->  true
    ;   connect(Address, Session)
    ),
    (   post(Session, Kind, Term)
    ->  true
    ;   throw(error(unreachable(Address), _))
    ).

%!  endpoint_post_up(+Address, +Kind, +Term) is semidet.
%
%   As endpoint_post/3 if there is a connection; fails at once if not.

endpoint_post_up(Address, Kind, Term) :-
    open_session(Address, Session),
    !,
    post(Session, Kind, Term).
endpoint_post_up(Address, Kind, Term) :-
    alone(Address),
    endpoint_post(Address, Kind, Term).

%!  endpoint_post_by(+Deadline, +Address, +Kind, +Term) is semidet.
%
%   As endpoint_post_up/3, but waits for a connection until Deadline. If the
%   connection breaks, Term waits for the next. Not for hooks nor clean-up
%   handlers, see manager_connect/2.

endpoint_post_by(_, Address, Kind, Term) :-
    endpoint_post_up(Address, Kind, Term),
    !.
endpoint_post_by(Deadline, Address, Kind, Term) :-
    manager_connect(Address, Deadline),
    route(Address, Session),
    !,
    post(Session, Kind, Term).

post(Session, Kind, Term) :-
    catch(session_send_with(Session, post(Kind, Term)),
          error(session_closed, _),
          fail).

%   ready_session(+Address, -Session): a session in which a frame can be sent
%   without waiting. A hook must not wait: its frames wait in the session for
%   the next connection, which cannot be made while its thread is in a hook.

ready_session(Address, Session) :-
    open_session(Address, Session),
    !.
ready_session(Address, Session) :-
    in_reader,
    route(Address, Session),
    !.

%   A new request must not overtake requests that wait for Address.

open_session(Address, Session) :-
    route_up(Address, Session),
    \+ unsent(Address),
    !.

connect(Address, Session) :-
    check_running,
    (   manager_connect(Address),
        route(Address, Session0)
    ->  Session = Session0
    ;   throw(error(unreachable(Address), _))
    ).

check_running :-
    (   endpoint_address(_)
    ->  true
    ;   existence_error(endpoint, running)
    ).

%!  endpoint_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   Send a request; call(OnAnswer, Result) once, in some thread of the endpoint,
%   where it must be quick. Result is answer(Term), `unreachable` (the request
%   certainly never arrived) or `lost` (it may have). Does not block.

endpoint_request(Address, Kind, Term, OnAnswer) :-
    alone(_),
    !,
    alone_request(Address, Kind, Term, OnAnswer).
endpoint_request(Address, Kind, Term, OnAnswer) :-
    ready_session(Address, Session),
    !,
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(session_closed, _),
          unsent_closed(Address, Kind, Term, OnAnswer)).
endpoint_request(Address, Kind, Term, OnAnswer) :-
    check_running,
    mobile_term(Term),
    unsent_request(Address, Kind, Term, OnAnswer).

%   If this endpoint is alone a request is handled at once, as a copy.

alone_request(Address, Kind, Term, OnAnswer) :-
    alone(Address),
    !,
    mobile_term(Term),
    copy_term(Term, Copy),
    on_demand_load(requested, Kind),    % time may stand still meanwhile
    (   take_request(Kind, Copy, Address, alone(OnAnswer))
    ->  true
    ;   request_answer(lost, OnAnswer)
    ).
alone_request(_, _, _, OnAnswer) :-
    request_answer(unreachable, OnAnswer).

%!  endpoint_hand(+Address, +Kind, +Term, -Hand) is semidet.
%
%   Hand is the frame by which Term is handed over to the process at Address.
%   Fails if there is no connection, or requests wait for Address.  Term holds
%   neither attributed variables nor cycles.  Hand can be kept in clauses.
%
%   @error resource_error(frame_bytes), type_error(mobile_term, Culprit)

endpoint_hand(Address, Kind, Term, Hand) :-
    open_session(Address, Session),
    session_hand(Session, Kind, Term, Hand).

		 /*******************************
		 *             CALL             *
		 *******************************/

%!  endpoint_call(+Address, +Kind, +Term, -Answer, +Timeout) is det.
%
%   Send a request and wait, at most Timeout seconds.  Answer is answer(Term).
%   The connection counts as lost when it has been down for some seconds: the
%   caller prefers an error to waiting for the peer to come back.
%
%   @error unreachable(Address), connection_lost(Address)
%   @error timeout_error(answer, Address)

endpoint_call(Address, Kind, Term, Answer, Timeout) :-
    must_be(number, Timeout),
    commits_must_succeed,
    monotonic_time(Now),
    Deadline is Now+Timeout,
    setup_call_cleanup(
        message_queue_create(Queue),
        ( ask([Address], Kind-Term, Queue),
          await(Queue, Address, Deadline, Now, Result)
        ),
        message_queue_destroy(Queue)),
    call_result(Result, Address, Answer).

%   await(+Queue, +Address, +Deadline, +Up, -Result): Up is the last time at
%   which the connection was not down.

await(Queue, Address, Deadline, Up0, Result) :-
    monotonic_time(Now),
    Slice is max(0, min(1, Deadline-Now)),
    (   wait_within(Slice, thread_get_message(Queue, _-Result0))
    ->  Result = Result0
    ;   Now >= Deadline
    ->  forget(Queue, Address),
        Result = late
    ;   \+ endpoint_peer(Address, state(down))
    ->  await(Queue, Address, Deadline, Now, Result)
    ;   setting(typhon_endpoint:lost_time, Seconds),
        Now-Up0 > Seconds
    ->  Result = lost
    ;   await(Queue, Address, Deadline, Up0, Result)
    ).

call_result(answer(Term), _, answer(Term)).
call_result(unreachable, Address, _) :-
    throw(error(unreachable(Address), _)).
call_result(lost, Address, _) :-
    throw(error(connection_lost(Address), _)).
call_result(late, Address, _) :-
    throw(error(timeout_error(answer, Address), _)).

		 /*******************************
		 *           INQUIRY            *
		 *******************************/

%!  endpoint_ask_all(+Addresses, +Kind, +Term, :Further, +Seconds, -Results)
%!      is det.
%
%   Ask the endpoints at Addresses, and further ones: for each answer
%   call(Further, Answer, More) gives More addresses.  Each is asked once.
%   Results are Address-Result in no order, Result being one of
%   endpoint_request/4, or `late` if there was none after Seconds.

endpoint_ask_all(Addresses, Kind, Term, Further, Seconds, Results) :-
    must_be(number, Seconds),
    deadline(Seconds, Deadline),
    setup_call_cleanup(
        message_queue_create(Queue),
        ( ask(Addresses, Kind-Term, Queue),
          gather(Addresses, Addresses, asking(Kind-Term, Queue, Further),
                 Deadline, Results)
        ),
        message_queue_destroy(Queue)).

ask(Addresses, Kind-Term, Queue) :-
    forall(member(Address, Addresses),
           endpoint_request(Address, Kind, Term,
                            typhon_endpoint:send_result(Queue, Address))).

send_result(Queue, Address, Result) :-
    ignore(fifo_send(Queue, Address-Result)). % the caller may have given up

%   gather(+Open, +Asked, +Asking, +Deadline, -Results)

gather([], _, _, _, []) :-
    !.
gather(Open, Asked, Asking, Deadline, [Address-Result|Results]) :-
    Asking = asking(Question, Queue, Further),
    monotonic_time(Now),
    Left is max(0, Deadline-Now),
    wait_within(Left, thread_get_message(Queue, Address-Result)),
    !,
    selectchk(Address, Open, Open1),
    more(Result, Further, Asked, New),
    ask(New, Question, Queue),
    append(New, Open1, Open2),
    append(New, Asked, Asked2),
    gather(Open2, Asked2, Asking, Deadline, Results).
gather(Open, _, asking(_, Queue, _), _, Results) :-
    forall(member(Address, Open), forget(Queue, Address)),
    findall(Address-late, member(Address, Open), Results).

more(answer(Answer), Further, Asked, New) :-
    call(Further, Answer, More),
    !,
    sort(More, Set),
    subtract(Set, Asked, New).
more(_, _, _, []).

%   A request whose caller no longer waits must not keep a session busy.

forget(Queue, Address) :-
    OnAnswer = typhon_endpoint:send_result(Queue, Address),
    unsent_forget(OnAnswer),
    request_forget(OnAnswer).
