:- module(typhon_endpoint,
          [ endpoint_start/3,           % +Interface, +Port, -Address
            endpoint_stop/0,
            endpoint_address/1,         % -Address
            endpoint_process/1,         % -Id
            endpoint_post/3,            % +Address, +Kind, +Term
            endpoint_post_up/3,         % +Address, +Kind, +Term
            endpoint_request/4,         % +Address, +Kind, +Term, :OnAnswer
            endpoint_call/5,            % +Address, +Kind, +Term, -Answer,
                                        % +Timeout
            endpoint_reply/2,           % +ReplyTo, +Term
            endpoint_reply_later/2,     % +ReplyTo, +Term
            endpoint_peer/2,            % ?Address, ?Property
            endpoint_gone/1,            % +Address
            endpoint_flush/1,           % +Seconds
            endpoint_flush/2            % +Seconds, +Peers
          ]).

/** <module> The endpoint: one per process

An endpoint sends terms to the endpoints of other processes, and of its
own, over TCP. It knows nothing of agents. Its address is an atom
`Interface:Port`. What arrives goes to hooks, one clause per kind of
message, in the room that owns the kind:

  - received(+Kind, +Term, +Peer)
  - requested(+Kind, +Term, +Peer, +ReplyTo)
  - connection(+Peer, +State)

Peer is the address the sender listens to.

_Threading_: everything may be called from any thread. The hooks run in the
thread of a connection and must be quick: while one runs, nothing else of
that peer is read. They may post, request and reply.
*/

:- use_module(library(error),
              [existence_error/2, must_be/2, permission_error/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(library(socket),
              [ tcp_bind/2, tcp_close_socket/1, tcp_listen/2, tcp_setopt/2,
                tcp_socket/1 ]).
:- use_module('../base/own_thread', [in_own_thread/1]).
:- use_module(acceptor, [accept_all/2, accept_no_more/0]).
:- use_module(auth, [cookie/1, random_hex/2]).
:- use_module(contacts, [contact/3]).
:- use_module(frame, [mobile_term/1]).
:- use_module(hello, [hello/4]).
:- use_module(keeper, [keep/1, keeper_connect/1, keeper_unheard/1]).
:- use_module(outbox,
              [ session_close/2, session_control/2, session_flush/2,
                session_pending/2, session_send/2, session_up/1 ]).
:- use_module(request,
              [ request_answer/2, request_forget/1, request_reply/2,
                request_reply_later/2, request_send/4, requests_lost/2 ]).
:- use_module(session, [route/2, session/2]).
:- use_module(threads,
              [ crew_bury/1, crew_retire/2, crew_spawn/2, crew_start/0,
                crew_stop/1, crew_tell/1 ]).
:- use_module(unsent, [unsent/1, unsent_forget/1, unsent_request/4]).

:- meta_predicate
    endpoint_request(+, +, +, 1).

:- multifile
    received/3,                         % Kind, Term, Peer
    requested/4,                        % Kind, Term, Peer, ReplyTo
    connection/2.                       % Peer, State
:- dynamic
    received/3,
    requested/4,
    connection/2.

:- setting(lost_time, number, 5,
           "Seconds without connection before endpoint_call/5 gives up").
:- setting(flush_time, number, 2,
           "Seconds endpoint_stop/0 waits for the last frames to arrive").

:- dynamic
    process/1,                          % Id
    starts/1,                           % Count
    running/4.                          % Address, Socket, Acceptor, Keeper

%!  endpoint_start(+Interface, +Port, -Address) is det.
%
%   Listen at Port of Interface; Port 0 is any free one.
%
%   @error permission_error(start, endpoint, Address) one is running.

endpoint_start(Interface, Port, Address) :-
    must_be(atom, Interface),
    must_be(nonneg, Port),
    with_mutex(typhon_endpoint, start(Interface, Port, Address)).

start(_, _, _) :-
    running(Address, _, _, _),
    !,
    permission_error(start, endpoint, Address).
start(Interface0, Port, Address) :-
    cookie(_),
    (   Interface0 == localhost
    ->  Interface = '127.0.0.1'
    ;   Interface = Interface0
    ),
    listen(Interface, Port, Bound, Socket),
    atomic_list_concat([Interface, Bound], :, Address),
    next_start(Start),
    endpoint_process(Process),
    hello(Process, Start, Address, Me),
    crew_start,
    crew_spawn(keep(Me), Keeper),
    crew_spawn(accept_all(Socket, Me), Acceptor),
    assertz(running(Address, Socket, Acceptor, Keeper)).

listen(Interface, Port, Bound, Socket) :-
    (   Port =:= 0
    ->  true                            % any free one
    ;   Bound = Port
    ),
    tcp_socket(Socket),
    catch(( tcp_setopt(Socket, reuseaddr),
            tcp_bind(Socket, Interface:Bound),
            tcp_listen(Socket, 1024)
          ),
          Error,
          ( tcp_close_socket(Socket),
            throw(Error) )).

next_start(Start) :-
    (   retract(starts(Start0))
    ->  true
    ;   Start0 = 0
    ),
    Start is Start0+1,
    assertz(starts(Start)).

%!  endpoint_stop is det.
%
%   Take no more connections, let the last frames arrive where there is a
%   connection, close all.
%   Requests without an answer are lost. May be called in a clean-up
%   handler: the wait with a deadline is in another thread, see
%   keeper_connect/1.

endpoint_stop :-
    with_mutex(typhon_endpoint, stop).

stop :-
    retract(running(_, Socket, Acceptor, Keeper)),
    !,
    crew_retire(Acceptor, stopped),
    tcp_close_socket(Socket),
    setting(flush_time, Seconds),
    in_own_thread(ignore(flush(Seconds, up))),
    forall(session(_, Session), session_control(Session, bye)),
    crew_tell(stop),
    crew_bury(Keeper),
    crew_stop(Unheard),
    accept_no_more,
    keeper_unheard(Unheard),
    forall(session(_, Session),
           ( session_close(Session, Unsent),
             requests_lost(Session, Unsent) )).
stop.

%!  endpoint_address(-Address) is semidet.

endpoint_address(Address) :-
    running(Address, _, _, _).

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

%!  endpoint_post(+Address, +Kind, +Term) is det.
%
%   Send Term, one way. It arrives once, in the order of the posts of this
%   thread, as long as both processes live. May block while it connects.
%
%   @error unreachable(Address)
%   @error type_error(mobile_term, Culprit)

endpoint_post(Address, Kind, Term) :-
    (   way(Address, Session)
    ->  true
    ;   connect(Address, Session)
    ),
    catch(session_send(Session, post(Kind, Term)),
          error(session_closed, _),
          throw(error(unreachable(Address), _))).

%!  endpoint_post_up(+Address, +Kind, +Term) is semidet.
%
%   As endpoint_post/3 if there is a connection; fails at once if not.

endpoint_post_up(Address, Kind, Term) :-
    open_way(Address, Session),
    catch(session_send(Session, post(Kind, Term)),
          error(session_closed, _),
          fail).

%   way(+Address, -Session): nothing has to be waited for. In a hook there
%   must be no waiting: what is sent there waits in the session for the next
%   connection, which cannot be made while its thread is in a hook.

way(Address, Session) :-
    open_way(Address, Session),
    !.
way(Address, Session) :-
    nb_current(typhon_reader, true),
    route(Address, Session),
    !.

%   What is asked now must not overtake what waits to be asked.

open_way(Address, Session) :-
    up_session(Address, Session),
    \+ unsent(Address),
    !.

up_session(Address, Session) :-
    route(Address, Session),
    Session = session(Key, _, _, _, _),
    session_up(Key).

connect(Address, Session) :-
    check_running,
    (   keeper_connect(Address),
        route(Address, Session0)
    ->  Session = Session0
    ;   throw(error(unreachable(Address), _))
    ).

check_running :-
    (   running(_, _, _, _)
    ->  true
    ;   existence_error(endpoint, running)
    ).

%!  endpoint_request(+Address, +Kind, +Term, :OnAnswer) is det.
%
%   Ask; call(OnAnswer, Result) once, in some thread of the endpoint, where
%   it must be quick. Result is answer(Term), `unreachable` (it certainly
%   never arrived) or `lost` (it may have). Does not block.

endpoint_request(Address, Kind, Term, OnAnswer) :-
    way(Address, Session),
    !,
    catch(request_send(Session, Kind, Term, OnAnswer),
          error(session_closed, _),
          request_answer(unreachable, OnAnswer)).
endpoint_request(Address, Kind, Term, OnAnswer) :-
    check_running,
    mobile_term(Term),
    unsent_request(Address, Kind, Term, OnAnswer).

%!  endpoint_call(+Address, +Kind, +Term, -Answer, +Timeout) is det.
%
%   Ask and wait, at most Timeout seconds. Answer is answer(Term). The
%   connection counts as lost when it has been down for some seconds: who
%   asks like this would rather know than wait for the peer to come back.
%
%   @error unreachable(Address), connection_lost(Address)
%   @error timeout_error(answer, Address)

endpoint_call(Address, Kind, Term, Answer, Timeout) :-
    must_be(number, Timeout),
    get_time(Now),
    Deadline is Now+Timeout,
    setup_call_cleanup(
        message_queue_create(Queue),
        ( endpoint_request(Address, Kind, Term, tell(Queue)),
          await(Queue, Address, Deadline, Now, Result),
          no_longer(Result, tell(Queue))
        ),
        message_queue_destroy(Queue)),
    call_result(Result, Address, Answer).

%   await(+Queue, +Address, +Deadline, +Up, -Result): at the time Up the
%   connection was not down.

await(Queue, Address, Deadline, Up0, Result) :-
    get_time(Now),
    Slice is max(0, min(1, Deadline-Now)),
    (   thread_get_message(Queue, Result0, [timeout(Slice)])
    ->  Result = Result0
    ;   Now >= Deadline
    ->  Result = late
    ;   endpoint_peer(Address, state(down))
    ->  setting(lost_time, Seconds),
        (   Now-Up0 > Seconds
        ->  Result = lost
        ;   await(Queue, Address, Deadline, Up0, Result)
        )
    ;   await(Queue, Address, Deadline, Now, Result)
    ).

%   What nobody waits for must not keep a session busy.

no_longer(late, OnAnswer) :-
    !,
    unsent_forget(OnAnswer),
    request_forget(OnAnswer).
no_longer(_, _).

tell(Queue, Result) :-
    catch(thread_send_message(Queue, Result),
          error(existence_error(_, _), _),
          true).

call_result(answer(Term), _, answer(Term)).
call_result(unreachable, Address, _) :-
    throw(error(unreachable(Address), _)).
call_result(lost, Address, _) :-
    throw(error(connection_lost(Address), _)).
call_result(late, Address, _) :-
    throw(error(timeout_error(answer, Address), _)).

%!  endpoint_reply(+ReplyTo, +Term) is det.
%
%   Answer a request, from any thread, any time later. A second answer
%   goes unnoticed.

endpoint_reply(ReplyTo, Term) :-
    catch(request_reply(ReplyTo, Term),
          error(session_closed, _),
          true).                        % whoever asked is no more

%!  endpoint_reply_later(+ReplyTo, +Term) is det.
%
%   As endpoint_reply/2, with the next frame to that peer or a millisecond
%   later; for answers that nobody waits for in earnest. Only worth while
%   in a hook.

endpoint_reply_later(ReplyTo, Term) :-
    catch(request_reply_later(ReplyTo, Term),
          error(session_closed, _),
          true).

%!  endpoint_peer(?Address, ?Property) is nondet.
%
%   Property of the peer at Address: process(Id), the one last met there,
%   state(up or down), pending(Frames), codec(fast or text).

endpoint_peer(Address, process(Id)) :-
    contact(Address, Id, _),
    Id \== none.
endpoint_peer(Address, Property) :-
    route(Address, Session),
    peer_property(Property, Session).

peer_property(state(State), session(Key, _, _, _, _)) :-
    (   session_up(Key)
    ->  State = up
    ;   State = down
    ).
peer_property(pending(Count), Session) :-
    session_pending(Session, Count).
peer_property(codec(Codec), session(_, Codec, _, _, _)).

%!  endpoint_gone(+Address) is semidet.
%
%   As far as this process knows there is no process at Address any more to
%   which it can have talked: nobody listened there when it last tried to
%   connect, or the one that did said goodbye. Not true of a process that
%   has been stopped, or is behind a network that is cut.

endpoint_gone(Address) :-
    contact(Address, _, gone),
    \+ up_session(Address, _).

%!  endpoint_flush(+Seconds) is semidet.
%!  endpoint_flush(+Seconds, +Peers:list) is semidet.
%
%   Wait until all that was posted has arrived, or all to these addresses;
%   fails after Seconds.

endpoint_flush(Seconds) :-
    must_be(number, Seconds),
    flush(Seconds, _).

endpoint_flush(Seconds, Peers) :-
    get_time(Now),
    Deadline is Now+Seconds,
    forall(( member(Peer, Peers),
             route(Peer, Session) ),
           session_flush(Session, Deadline)).

flush(Seconds, State) :-
    get_time(Now),
    Deadline is Now+Seconds,
    forall(( session(_, Session),
             peer_property(state(State), Session) ),
           session_flush(Session, Deadline)).
