:- module(test_attempts, []).

/** <module> Attempts to reach a peer

*Threading*: one test at a time; the connection manager tries.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/endpoints', [with_endpoint/1]).
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(lists), [max_list/2]).
:- use_module(library(plunit)).
:- use_module(library(prolog_wrap), [unwrap_predicate/2, wrap_predicate/4]).
:- use_module(library(socket)).
:- use_module(library(typhon/kernel/wire)).
:- use_module(library(typhon/kernel/wire/peer_cache),
              [peer_expect/1, peer_expect_no_more/1]).

:- dynamic tried/2.                     % Address, Others: that are tried, too

:- meta_predicate noting(0).

noting(Goal) :-
    retractall(tried(_, _)),
    wrap_predicate(typhon_connection_manager:try(Address, _, _), noted, Try,
                   ( test_attempts:note(Address), Try )),
    call_cleanup(with_endpoint(Goal),
                 unwrap_predicate(typhon_connection_manager:try/3, noted)).

note(Address) :-
    aggregate_all(count, typhon_connection_manager:young(_), Count),
    assertz(tried(Address, Count)).

%   result(+Address, -Result, -Tries): of a request, and after so many tries.

result(Address, Result, Tries) :-
    thread_self(Me),
    endpoint_request(Address, echo, x, thread_send_message(Me)),
    thread_get_message(Me, Result, [timeout(60)]),
    aggregate_all(count, tried(Address, _), Tries).

%   listening(:Serve, -Address, :Goal): call(Serve, Client) for each client.

:- meta_predicate listening(1, -, 0).

listening(Serve, Address, Goal) :-
    setup_call_cleanup(
        ( tcp_socket(Socket),
          tcp_bind(Socket, '127.0.0.1':Port),
          tcp_listen(Socket, 50),
          thread_create(serve(Socket, Serve), Thread) ),
        ( atomic_list_concat(['127.0.0.1', Port], :, Address), call(Goal) ),
        ( thread_signal(Thread, throw(over)),
          thread_join(Thread, _),
          tcp_close_socket(Socket) )).

serve(Socket, Serve) :-
    repeat,
    tcp_accept(Socket, Client, _),
    call(Serve, Client),
    fail.

hangs_up(Client) :-
    tcp_close_socket(Client).

%   silent(-Port, :Goal): clients connect to Port, and get no answer.

:- meta_predicate silent(-, 0).

silent(Port, Goal) :-
    setup_call_cleanup(
        ( tcp_socket(Socket), tcp_bind(Socket, Port), tcp_listen(Socket, 50) ),
        Goal,
        tcp_close_socket(Socket)).

requests(Count, Port) :-
    forall(between(1, Count, N),
           ( format(atom(Address), '127.0.0.~d:~d', [N, Port]),
             endpoint_request(Address, echo, x, =(_)) )),
    wait_until(aggregate_all(count, tried(_, _), Count), 60).

:- begin_tests(attempts).

test(address_without_a_listener_is_tried_once, Result-Tries == unreachable-1) :-
    with_settings([typhon_connection_manager:connect_time=50],
                  noting(result('127.0.0.1:1', Result, Tries))).
test(expected_process_is_tried_again, [true(Result == unreachable)]) :-
    Address = '127.0.0.1:1',
    with_settings([typhon_connection_manager:return_time=1],
        setup_call_cleanup(peer_expect(Address),
                           noting(result(Address, Result, Tries)),
                           peer_expect_no_more(Address))),
    assertion(Tries > 1).
test(broken_handshake_is_tried_again, [true(Result == unreachable)]) :-
    with_settings([typhon_connection_manager:connect_time=1],
        listening(hangs_up, Address, noting(result(Address, Result, Tries)))),
    assertion(Tries > 1).
test(four_addresses_are_tried_at_a_time, true(Most == 3)) :-
    with_settings([typhon_connection_manager:connect_time=60],
                  silent(Port, noting(requests(8, Port)))),
    findall(Others, tried(_, Others), All),
    max_list(All, Most).

:- end_tests(attempts).
