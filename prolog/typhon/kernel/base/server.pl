:- module(typhon_server,
          [ server_start/4,             % +Role, :Handle, +State, -Server
            server_start/5,             % +Role, :Handle, +State, +Options,
                                        % -Server
            server_cast/2,              % +Server, +Message
            server_call/4,              % +Server, +Request, +Seconds, -Answer
            server_answer/2,            % +Caller, +Answer
            server_check/1,             % +Server
            server_self/1,              % -Server
            server_stop/1,              % +Server
            server_leave/1              % +Server
          ]).
:- use_module(fifo, [fifo_send/2]).
:- use_module(monotonic, [monotonic_time/1, wait_before/2, wait_within/2]).
:- use_module(error_text, [error_lines/3, is_abort/1]).

/** <module> Servers: threads that own a queue

A server handles one message after another:

    call(Handle, Message, State0, State)

State may be until(Stamp, State): then the server gets the message `timeout`
when no other message has arrived until Stamp, `inf` for never.  Other messages
are those of server_cast/2, call(Request, Caller) of server_call/4, which
server_answer/2 answers, `begin` before all others, and `stop` as the last one.
Handle may fail for `begin` and `stop`.

A call for which Handle raises an error, or fails, gets that error, and the
server goes on.  If Handle raises an error for another message the server
prints it, and begins again with its first State.  If its thread is aborted, it
reports this as an error, and another thread begins with that State and the same
queue; if no thread can be created, server_cast/2 and server_check/1 try again.

In a Prolog without threads the sender of a message handles it at once; while the
server handles another message, after that one.  `timeout` comes with the first
server_cast/2 or server_check/1 after its time.

*Threading*: any thread. A server may stop itself.
*/

:- meta_predicate
    server_start(+, 3, +, -),
    server_start(+, 3, +, +, -).

:- multifile prolog:message//1.

:- dynamic
    server/4,                   % Queue, Role, Handle, first State
    serving/2,                  % Queue, Thread, or `here` without threads
    resting/3,                  % Queue, Handle, State: without threads, between
                                % messages
    unserved/1.                 % Queue: its lack of a thread was reported

                /*******************************
                *        START AND STOP        *
                *******************************/

%!  server_start(+Role:atom, :Handle, +State, -Server) is det.
%!  server_start(+Role:atom, :Handle, +State, +Options, -Server) is det.
%
%   Options may have max_size(N): server_cast/2 waits while N messages wait.
%   Role is part of the alias of the thread.
%
%   @error resource_error(What) if no thread can be created

server_start(Role, Handle, State, Server) :-
    server_start(Role, Handle, State, [], Server).

server_start(Role, Handle, State, Options, Queue) :-
    message_queue_create(Queue, Options),
    assertz(server(Queue, Role, Handle, State)),
    catch(with_mutex(typhon_server, make_thread(Queue)),
          error(Formal, Context),
          ( server_stop(Queue),
            throw(error(Formal, Context)) )).

make_thread(Queue) :-
    current_prolog_flag(threads, false),
    !,
    server(Queue, _, Handle, State),
    here(Queue, begin_here(State, Handle, Queue)).
make_thread(Queue) :-
    server(Queue, Role, Handle, State),
    flag(typhon_server, N, N+1),
    atomic_list_concat([typhon, Role, N], '_', Alias),
    sig_atomic(( thread_create(typhon_server:serve(Queue, Handle, State),
                               Thread,
                               [ alias(Alias),
                                 at_exit(typhon_server:ended(Queue)) ]),
                 assertz(serving(Queue, Thread)) )),
    retractall(unserved(Queue)).

%!  server_stop(+Server) is det.
%
%   Stop the server after the messages that have arrived until now, and wait
%   for that.  Later messages are dropped; calls raise an error.

server_stop(Queue) :-
    ignore(( unregister(Queue, Thread), stop(Thread, Queue) )).

%!  server_leave(+Server) is det.
%
%   As server_stop/1, but does not wait.

server_leave(Queue) :-
    ignore(( unregister(Queue, Thread), leave(Thread, Queue) )).

unregister(Queue, Thread) :-
    with_mutex(typhon_server,
               ( retract(server(Queue, _, _, _)),
                 retractall(unserved(Queue)),
                 (   retract(serving(Queue, Thread0))
                 ->  Thread = Thread0
                 ;   Thread = none
                 ) )).

stop(none, Queue) :-
    !,
    leave(none, Queue).
stop(here, Queue) :-
    !,
    leave(here, Queue).
stop(Thread, Queue) :-
    thread_self(Thread),
    !,
    leave(Thread, Queue).
stop(Thread, Queue) :-
    thread_send_message(Queue, '$stop'),
    thread_join(Thread, _),
    close_queue(Queue).

leave(none, Queue) :-
    resting(Queue, _, _),
    !,
    thread_send_message(Queue, '$leave'),
    serve_waiting(Queue).
leave(none, Queue) :-
    !,
    close_queue(Queue).
leave(here, Queue) :-
    !,
    thread_send_message(Queue, '$leave').
leave(Thread, Queue) :-
    thread_detach(Thread),
    thread_send_message(Queue, '$leave').

close_queue(Queue) :-
    refuse_calls(Queue),
    message_queue_destroy(Queue).

refuse_calls(Queue) :-
    thread_peek_message(Queue, _),
    !,
    thread_get_message(Queue, Message),
    (   Message = call(_, Caller)
    ->  answer(Caller, raised(error(existence_error(server, Queue), _)))
    ;   true
    ),
    refuse_calls(Queue).
refuse_calls(_).

                /*******************************
                *            MESSAGES          *
                *******************************/

%!  server_cast(+Server, +Message) is semidet.
%
%   Fails if the server has been stopped.

server_cast(Queue, Message) :-
    fifo_send(Queue, Message),
    server_check(Queue).

%!  server_call(+Server, +Request, +Seconds, -Answer) is semidet.
%
%   Seconds may be `inf`.  Fails if there is no answer in time.
%
%   @error existence_error(server, Server), and errors that Handle raises

server_call(Queue, Request, Seconds, Answer) :-
    setup_call_cleanup(
        message_queue_create(Caller),
        ( send_call(Queue, call(Request, Caller)),
          wait_within(Seconds, thread_get_message(Caller, Result))
        ),
        message_queue_destroy(Caller)),
    (   Result = raised(Ball)
    ->  throw(Ball)
    ;   Result = answer(Answer)
    ).

send_call(Queue, Call) :-
    (   server_cast(Queue, Call)
    ->  true
    ;   throw(error(existence_error(server, Queue), _))
    ).

%!  server_answer(+Caller, +Answer) is det.
%
%   Answer a call, see call(Request, Caller) above.

server_answer(Caller, Answer) :-
    answer(Caller, answer(Answer)).

answer(Caller, Result) :-
    ignore(fifo_send(Caller, Result)).  % the caller may have given up

%!  server_check(+Server) is det.
%
%   If Server has lost its thread, create another, if that is possible.

server_check(Queue) :-
    (   serving(Queue, _)
    ->  true
    ;   resting(Queue, _, _)
    ->  serve_waiting(Queue)
    ;   with_mutex(typhon_server, replace_thread(Queue))
    ).

replace_thread(Queue) :-
    server(Queue, Role, _, _),
    \+ serving(Queue, _),
    !,
    catch(( make_thread(Queue),
            print_message(error, typhon(server_ended(Role))) ),
          error(Formal, _),
          no_thread(Formal, Queue)).
replace_thread(_).

no_thread(permission_error(create, thread, _), _) :-
    !.                                  % Prolog is halting
no_thread(_, Queue) :-
    unserved(Queue),
    !.
no_thread(Formal, Queue) :-
    assertz(unserved(Queue)),
    server(Queue, Role, _, _),
    print_message(error, typhon(no_server(Role, Formal))).

                /*******************************
                *        WITHOUT THREADS       *
                *******************************/

:- meta_predicate here(+, 0).

%   here(+Queue, :Goal): call Goal as its server.  The server may be called by
%   the handler of another.

here(Queue, Goal) :-
    ( server_self(Outer) -> true ; Outer = none ),
    setup_call_cleanup(
        ( assertz(serving(Queue, here)),
          nb_setval(typhon_server, Queue) ),
        Goal,
        ( retractall(serving(Queue, here)),
          nb_setval(typhon_server, Outer) )).

begin_here(State0, Handle, Queue) :-
    handle_message(begin, Handle, State0, State),
    rest_or_serve(State, Handle, Queue).

serve_waiting(Queue) :-
    retract(resting(Queue, Handle, Next)),
    !,
    here(Queue, rest_or_serve(Next, Handle, Queue)).

rest_or_serve(Next, Handle, Queue) :-
    (   waiting_message(Next, Queue, Message)
    ->  ( Next = until(_, State) -> true ; State = Next ),
        serve_here(Message, State, Handle, Queue)
    ;   assertz(resting(Queue, Handle, Next))
    ).

waiting_message(_, Queue, Message) :-
    thread_peek_message(Queue, _),
    !,
    thread_get_message(Queue, Message).
waiting_message(until(Stamp, _), _, timeout) :-
    number(Stamp),
    monotonic_time(Now),
    Stamp =< Now.

serve_here(Message, State, Handle, Queue) :-
    ending(Message),
    !,
    ignore(call(Handle, stop, State, _)),
    close_queue(Queue).
serve_here(Message, State, Handle, Queue) :-
    catch(handle_message(Message, Handle, State, Next), Ball, report_error(Ball)),
    (   nonvar(Next)
    ->  rest_or_serve(Next, Handle, Queue)
    ;   server(Queue, _, Handle, First)
    ->  begin_here(First, Handle, Queue)
    ;   close_queue(Queue)              % stopped meanwhile
    ).

                /*******************************
                *           THE THREAD         *
                *******************************/

%!  server_self(-Server) is semidet.
%
%   This thread belongs to Server.

server_self(Server) :-
    nb_current(typhon_server, Server),
    Server \== none.

serve(Queue, Handle, State) :-
    nb_setval(typhon_server, Queue),
    catch(serve_from(begin, State, Handle, Queue, End), Ball,
          report_error(Ball)),
    (   var(End)
    ->  serve(Queue, Handle, State)
    ;   end(End, Queue)
    ).

report_error(Ball) :-
    rethrow_abort(Ball),
    print_message(error, typhon(server_error(Ball))).

rethrow_abort(Ball) :-
    (   is_abort(Ball)
    ->  throw(Ball)
    ;   true
    ).

serve_from(Message, State, Handle, _, Message) :-
    ending(Message),
    !,
    ignore(call(Handle, stop, State, _)).
serve_from(Message, State, Handle, Queue, End) :-
    handle_message(Message, Handle, State, Next),
    serve_next(Next, Handle, Queue, End).

serve_next(Next, Handle, Queue, End) :-
    (   Next = until(Stamp, State)
    ->  next(Stamp, Queue, Message)
    ;   State = Next,
        thread_get_message(Queue, Message)
    ),
    serve_from(Message, State, Handle, Queue, End).

ending('$stop').
ending('$leave').

next(Stamp, Queue, Message) :-
    (   wait_before(Stamp, thread_get_message(Queue, Message0))
    ->  Message = Message0
    ;   Message = timeout
    ).

handle_message(begin, Handle, State0, State) :-
    !,
    ( call(Handle, begin, State0, State1) -> State = State1 ; State = State0 ).
handle_message(call(Request, Caller), Handle, State0, State) :-
    !,
    catch(must_handle(call(Request, Caller), Handle, State0, State), Ball,
          ( answer(Caller, raised(Ball)),
            rethrow_abort(Ball),
            State = State0 )).
handle_message(Message, Handle, State0, State) :-
    must_handle(Message, Handle, State0, State).

must_handle(Message, Handle, State0, State) :-
    (   call(Handle, Message, State0, State)
    ->  true
    ;   throw(error(system_error(not_handled(Message)), _))
    ).

end('$stop', _).
end('$leave', Queue) :-
    close_queue(Queue).

%   Called in the thread, at its end. Does nothing if the server was stopped.

ended(Queue) :-
    thread_self(Me),
    (   with_mutex(typhon_server, retract(serving(Queue, Me)))
    ->  thread_detach(Me),
        server_check(Queue)
    ;   true
    ).

                /*******************************
                *            MESSAGES          *
                *******************************/

prolog:message(typhon(server_error(Ball))) -->
    { thread_self(Me) },
    [ 'Error in the thread ~w, which continues: '-[Me], nl ],
    error_lines(Ball).
prolog:message(typhon(server_ended(Role))) -->
    [ 'The thread of the ~w has ended and was replaced'-[Role] ].
prolog:message(typhon(no_server(Role, Formal))) -->
    [ 'The thread of the ~w has ended, and no other can be created now (~p)'-
      [Role, Formal] ].
