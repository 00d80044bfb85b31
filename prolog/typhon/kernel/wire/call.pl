:- module(typhon_call,
          [ endpoint_call/5             % +Address, +Kind, +Term, -Answer,
                                        % +Timeout
          ]).

/** <module> To ask, and wait for the answer

*Threading*: any thread but those of the endpoint: it waits.
*/

:- use_module(library(error), [must_be/2]).
:- use_module(library(settings), [setting/2, setting/4]).
:- use_module(messaging, [endpoint_request/4]).
:- use_module(peers, [endpoint_peer/2]).
:- use_module(request, [request_forget/1]).
:- use_module(unsent, [unsent_forget/1]).

:- setting(typhon_endpoint:lost_time, number, 5,
           "Seconds without connection before endpoint_call/5 gives up").

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
    ->  setting(typhon_endpoint:lost_time, Seconds),
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
