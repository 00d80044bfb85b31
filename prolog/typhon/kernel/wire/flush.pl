:- module(typhon_flush,
          [ endpoint_flush/1,           % +Seconds
            endpoint_flush/2,           % +Seconds, +Peers
            peers_flush/1               % +Seconds
          ]).
:- use_module(library(error), [must_be/2]).
:- use_module(library(lists), [member/2]).
:- use_module('../base/durable_changes', [commit_changes/0]).
:- use_module(connection_manager, [manager_connect/2]).
:- use_module(outbox, [session_mark/2]).
:- use_module(session,
              [route/2, session/2, session_key/2, session_up/1]).
:- use_module(unacked, [session_pending/2]).

:- multifile typhon_endpoint:handed_over/2.

/** <module> Waiting until all that was sent has arrived

*Threading*: any thread that may wait.
*/

%!  endpoint_flush(+Seconds) is semidet.
%!  endpoint_flush(+Seconds, +Peers:list) is semidet.
%
%   Wait until all that was posted has arrived, or all to these addresses;
%   fails after Seconds.

endpoint_flush(Seconds) :-
    must_be(number, Seconds),
    get_time(Now),
    Deadline is Now+Seconds,
    forall(session(_, Session), session_flush(Session, Deadline)).

endpoint_flush(Seconds, Peers) :-
    get_time(Now),
    Deadline is Now+Seconds,
    forall(( member(Peer, Peers),
             route(Peer, Session) ),
           session_flush(Session, Deadline)).

%!  peers_flush(+Seconds) is semidet.
%
%   As endpoint_flush/1, for a process about to end: nothing is waited for that
%   cannot arrive, as no process listens at the address of the peer any more.
%   Not for hooks nor clean-up handlers, see manager_connect/2.

peers_flush(Seconds) :-
    get_time(Now),
    Deadline is Now+Seconds,
    forall(( session(_, Session),
             reachable(Session, Deadline) ),
           session_flush(Session, Deadline)).

%   One connection may just be replaced by another.

reachable(Session, _) :-
    session_key(Session, Key),
    session_up(Key),
    !.
reachable(Session, Deadline) :-
    session_pending(Session, Count),
    Count > 0,
    route(Address, Session),
    manager_connect(Address, Deadline),
    !.

%   session_flush(+Session, +Deadline) is semidet.
%
%   Wait until all that was sent before has arrived, or the session is closed,
%   as when its peer has died; fails at Deadline, a time stamp.  What is waited
%   for is a frame without content, with which Queue is handed over: it comes
%   after all else, and the peer settles it at once.

session_flush(Session, Deadline) :-
    setup_call_cleanup(
        message_queue_create(Queue),
        flush(Session, Queue, Deadline),
        message_queue_destroy(Queue)).

flush(Session, Queue, Deadline) :-
    catch(commit_changes, error(_, _), true), % the committer has reported it
    (   session_pending(Session, 0)
    ->  true
    ;   catch(session_mark(Session, flushed(Queue)),
              error(session_closed, _),
              thread_send_message(Queue, flushed)),
        thread_get_message(Queue, flushed, [deadline(Deadline)])
    ).

%   The waiting thread may have given up.

typhon_endpoint:handed_over(flushed(Queue), _) :-
    catch(thread_send_message(Queue, flushed),
          error(existence_error(_, _), _),
          true).
