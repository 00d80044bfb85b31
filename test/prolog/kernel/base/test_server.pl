:- module(test_server, []).
:- use_module(library(plunit)).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module(library(lists)).
:- use_module(library(typhon)).
:- use_module(library(typhon/kernel/base/server)).

/** <module> Tests of servers

The server of these tests has a list of its messages, the newest first.

*Threading*: the main thread, and the threads of the servers.
*/

:- dynamic ended/1, timeout/0, waits/1. % the thread that waits

handle(begin, List, [begun|List]).
handle(stop, List, _) :-
    assertz(ended(List)).
handle(timeout, List, [timeout|List]) :-
    assertz(timeout).
handle(add(X), List, [X|List]).
handle(soon(X), List, until(Stamp, [X|List])) :-
    get_time(Now),
    Stamp is Now+0.02.
handle(raise(X), _, _) :-
    throw(X).
handle(wait(Queue), List, List) :-
    thread_self(Me),
    assertz(waits(Me)),
    thread_get_message(Queue, _).
handle(call(list, Caller), List, List) :-
    reverse(List, All),
    server_answer(Caller, All).
handle(call(raise(X), _), _, _) :-
    throw(error(domain_error(test, X), _)).
handle(call(silence, _), List, List).
handle(call(stop, Caller), List, List) :-
    server_self(Server),
    server_stop(Server),
    server_answer(Caller, stopped).

:- meta_predicate serving(-, 0), serving(+, -, 0).

serving(Server, Goal) :-
    serving([], Server, Goal).

serving(Options, Server, Goal) :-
    retractall(ended(_)),
    retractall(timeout),
    retractall(waits(_)),
    no_leaks(setup_call_cleanup(
                 server_start(test, test_server:handle, [], Options, Server),
                 once(Goal),
                 server_stop(Server))).

list(Server, List) :-
    server_call(Server, list, 5, List).

%   A signal that comes just before a thread waits does not wake it.

aborted(Thread) :-
    wait_until(test_server:ends(Thread), 10).

ends(Thread) :-
    catch(( thread_signal(Thread, throw('$aborted')), fail ),
          error(existence_error(_, _), _), true).

:- begin_tests(server).

test(messages_arrive_in_order, true(List == [begun,a,b])) :-
    serving(Server, ( server_cast(Server, add(a)),
                      server_cast(Server, add(b)),
                      list(Server, List) )).
test(timeout_occurs_when_the_queue_is_empty, true(List == [begun,a,timeout])) :-
    serving(Server, ( server_cast(Server, soon(a)),
                      wait_until(test_server:timeout, 5),
                      list(Server, List) )).
test(message_precedes_the_timeout, true(List == [begun,a,b])) :-
    message_queue_create(Gate),
    serving(Server, ( server_cast(Server, wait(Gate)),
                      server_cast(Server, soon(a)),
                      server_cast(Server, add(b)),
                      thread_send_message(Gate, go),
                      list(Server, _),
                      list(Server, List) )),
    message_queue_destroy(Gate).
test(error_of_a_call_is_raised_in_the_caller, true(List == [begun,a])) :-
    serving(Server,
            ( server_cast(Server, add(a)),
              catch(server_call(Server, raise(x), 5, _),
                    error(domain_error(test, x), _), true),
              list(Server, List) )).
test(call_has_a_deadline, fail) :-
    serving(Server, server_call(Server, silence, 0.05, _)).
test(unknown_request_is_an_error,
     error(system_error(not_handled(call(what, _))))) :-
    serving(Server, server_call(Server, what, 5, _)).
test(error_of_a_message_is_printed, true(List == [begun,b])) :-
    serving(Server,
            capturing(( server_cast(Server, add(a)),
                        server_cast(Server, raise(error(oops, _))),
                        server_cast(Server, add(b)),
                        list(Server, List) ), Messages)),
    Messages = [error-typhon(server_error(error(oops, _)))].
test(aborted_thread_is_replaced_and_its_queue_kept,
     true(List == [begun,b])) :-
    message_queue_create(Gate),
    serving(Server,
            capturing(( server_cast(Server, add(a)),
                        server_cast(Server, wait(Gate)),
                        server_cast(Server, add(b)),
                        wait_until(test_server:waits(Thread), 10),
                        aborted(Thread),
                        wait_until(was_printed(error,
                                               typhon(server_ended(test))), 10),
                        list(Server, List) ), Messages)),
    message_queue_destroy(Gate),
    Messages = [error-typhon(server_ended(test))].
test(stop_follows_earlier_messages, true(List == [b,a,begun])) :-
    serving(Server, ( server_cast(Server, add(a)),
                      server_cast(Server, add(b)) )),
    ended(List).
test(stop_twice) :-
    serving(Server, server_stop(Server)).
test(send_to_a_stopped_server_fails, fail) :-
    serving(Server, ( server_stop(Server), server_cast(Server, add(a)) )).
test(call_of_a_stopped_server, error(existence_error(server, _))) :-
    serving(Server, ( server_stop(Server), list(Server, _) )).
test(server_stops_itself, true(Answer == stopped)) :-
    serving(Server, server_call(Server, stop, 5, Answer)).
test(leave_does_not_wait, true(List == [a,begun])) :-
    message_queue_create(Gate),
    serving(Server, ( server_cast(Server, add(a)),
                      server_cast(Server, wait(Gate)),
                      server_leave(Server),
                      thread_send_message(Gate, go) )),
    message_queue_destroy(Gate),
    ended(List).
test(call_overtaken_by_a_stop, error(existence_error(server, _))) :-
    message_queue_create(Gate),
    serving(Server,
            ( server_cast(Server, wait(Gate)),
              server_leave(Server),
              catch(thread_send_message(Server, call(list, Gate)),
                    error(_, _), true),
              thread_send_message(Gate, go),
              thread_get_message(Gate, raised(Ball)) )),
    message_queue_destroy(Gate),
    throw(Ball).
test(sender_waits_for_a_full_queue, true(List == [begun,1,2,3,4,5])) :-
    serving([max_size(1)], Server,
            ( forall(between(1, 5, I), server_cast(Server, add(I))),
              list(Server, List) )).

:- end_tests(server).
