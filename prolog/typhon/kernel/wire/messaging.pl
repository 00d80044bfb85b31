:- module(typhon_messaging,
          [ endpoint_post/3,            % +Address, +Kind, +Term
            endpoint_post_up/3,         % +Address, +Kind, +Term
            endpoint_post_by/4,         % +Deadline, +Address, +Kind, +Term
            endpoint_request/4,         % +Address, +Kind, +Term, :OnAnswer
            endpoint_hand/4,            % +Address, +Kind, +Term, -Hand
            endpoint_call/5,            % +Address, +Kind, +Term, -Answer,
                                        % +Timeout
            endpoint_ask_all/6          % +Addresses, +Kind, +Term, :Further,
                                        % +Seconds, -Results
          ]).

/** <module> Messages to the endpoints of other processes

A post goes one way, a request is answered. Both go over the session to
which the address leads; if there is none that is up, a connection is
made first. A caller may wait for one answer, or for those of many peers
with one deadline.

*Threading*: any thread may call everything. endpoint_post/3 may block it,
unless it is in a hook of the endpoint; endpoint_call/5 and endpoint_ask_all/6
wait, and are not for the threads of the endpoint.
*/

:- use_module(library(error), [existence_error/2, must_be/2]).
:- use_module(library(lists), [append/3, member/2, selectchk/3, subtract/3]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module('../base/durable', [commits_must_succeed/0]).
:- use_module('../base/monotonic',
              [monotonic_time/1, wait_within/2]).
:- use_module('../base/on_demand', [on_demand_load/2]).
:- use_module(endpoint, [endpoint_address/1]).
:- use_module(frame, [mobile_term/1]).
:- use_module(session,
              [route/2, route_up/2, session_hand/4, session_send_with/2]).
:- use_module(peer_cache, [endpoint_peer/2]).
:- use_module(reader, [in_reader/0]).
:- use_module(request,
              [ request_answer/2, request_forget/1, request_send/4, take_post/3,
                take_request/4 ]).
:- use_module(transport, [alone/1]).
:- use_module(connection_manager,
              [ manager_connect/1, manager_connect/2, unsent/1,
                unsent_closed/4, unsent_forget/1, unsent_request/4 ]).

:- meta_predicate
    endpoint_request(+, +, +, 1).

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

:- setting(typhon_endpoint:lost_time, number, 5,
           "Seconds without connection before endpoint_call/5 gives up").

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
    ;   endpoint_peer(Address, state(down))
    ->  setting(typhon_endpoint:lost_time, Seconds),
        (   Now-Up0 > Seconds
        ->  Result = lost
        ;   await(Queue, Address, Deadline, Up0, Result)
        )
    ;   await(Queue, Address, Deadline, Now, Result)
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

:- meta_predicate
    endpoint_ask_all(+, +, +, 2, +, -).

%!  endpoint_ask_all(+Addresses, +Kind, +Term, :Further, +Seconds, -Results)
%!      is det.
%
%   Ask the endpoints at Addresses, and further ones: for each answer
%   call(Further, Answer, More) gives More addresses.  Each is asked once.
%   Results are Address-Result in no order, Result being one of
%   endpoint_request/4, or `late` if there was none after Seconds.

endpoint_ask_all(Addresses, Kind, Term, Further, Seconds, Results) :-
    must_be(number, Seconds),
    monotonic_time(Now),
    Deadline is Now+Seconds,
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
                            typhon_messaging:send_result(Queue, Address))).

send_result(Queue, Address, Result) :-
    catch(thread_send_message(Queue, Address-Result),
          error(existence_error(_, _), _),
          true).                        % the caller no longer waits

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
    OnAnswer = typhon_messaging:send_result(Queue, Address),
    unsent_forget(OnAnswer),
    request_forget(OnAnswer).
