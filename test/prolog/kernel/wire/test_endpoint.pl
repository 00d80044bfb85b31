:- module(test_endpoint, []).

:- use_module('../../../lib/common').
:- use_module('../../../lib/cutting_proxy').
:- use_module('../../../lib/endpoints').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(random), [random_between/3]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(socket), [tcp_connect/3]).
:- use_module(library(thread), [concurrent_forall/3]).
:- use_module(library(typhon/kernel/base/prolog_faults), [spawn/3]).
:- use_module(library(typhon/kernel/wire)).

:- dynamic
    note/1,                             % Note, posted to us
    seen/2,                             % Peer, State
    trouble/1,                          % How: a hook fails or raises
    reported/1.                         % Problem of a hook of connections

:- multifile
    typhon_endpoint:received/3,
    typhon_endpoint:requested/4,
    typhon_endpoint:connection/2,
    typhon_kinds:accepts/5.

typhon_kinds:accepts(post, note, _, none, none).
typhon_kinds:accepts(request, echo, _, none, none).

typhon_endpoint:received(note, Note, _) :-
    assertz(note(Note)).
typhon_endpoint:requested(echo, Term, _, ReplyTo) :-
    endpoint_reply(ReplyTo, Term).
typhon_endpoint:connection(Peer, State) :-
    assertz(seen(Peer, State)).
typhon_endpoint:connection(_, up) :-
    \+ trouble(fails),
    (   trouble(raises)
    ->  throw(error(trouble, _))
    ;   true
    ).

:- multifile user:message_hook/3.

user:message_hook(typhon(endpoint, hook(connection, Problem)), error, _) :-
    assertz(reported(Problem)).

		 /*******************************
		 *           FIXTURES           *
		 *******************************/

:- meta_predicate
    with_peer(-, 0),
    with_peer(+, -, -, 0),
    with_deaf(-, 0),
    quiet(0),
    truth(0, -),
    fresh(0).

%   fresh(:Goal): as with_endpoint/1; nothing was noted before.

fresh(Goal) :-
    retractall(note(_)),
    retractall(seen(_, _)),
    with_endpoint(Goal).

with_peer(Address, Goal) :-
    with_peer_process(Address, Goal).

with_peer(Port, Pid, Address, Goal) :-
    with_peer_process([port(Port)], Pid, _, Address, Goal).

%   The peer ends when it reads `end`.

says_goodbye(In) :-
    format(In, "end.~n", []),
    flush_output(In).

%   killed(+Pid, +Address): the endpoint has noticed that the peer ended.

killed(Pid, Address) :-
    process_kill(Pid, kill),
    process_wait(Pid, _),
    wait_until(endpoint_peer(Address, state(down)), 5).

%   Goal prints warnings.

:- dynamic silenced/0.
:- multifile user:message_hook/3.

user:message_hook(typhon(endpoint, _), Kind, _) :-
    memberchk(Kind, [warning, error, informational]),
    silenced.

quiet(Goal) :-
    setup_call_cleanup(
        assertz(silenced),
        Goal,
        retractall(silenced)).

ask(Address, Kind, Term, Answer) :-
    endpoint_call(Address, Kind, Term, answer(Answer), 20).

%   with_deaf(-Address, :Goal): one connection waits, and no more may.

with_deaf(Address, Goal) :-
    with_listener(0, Address,
        ( port_of(Address, Port),
          setup_call_cleanup(
              tcp_connect('127.0.0.1':Port, First, []),
              Goal,
              close(First)) )).

post_notes(Address, From, To) :-
    forall(between(From, To, I), endpoint_post(Address, note, I)).

%   The thread that calls this gets the order to end, once.

:- dynamic to_end/0.
:- public told_to_end/0.

told_to_end :-
    (   retract(to_end)
    ->  thread_self(Me),
        typhon_threads:wire_thread_signal(Me, broken)
    ;   true
    ).

%   posting(+Address, -Thread), posted(+Thread, -Outcome)

posting(Address, Thread) :-
    thread_create(( truth(unreachable(Address), Failed),
                    thread_exit(Failed) ), Thread).

posted(Thread, Outcome) :-
    thread_join(Thread, exited(Failed)),
    ( Failed == true -> Outcome = unreachable ; Outcome = posted ).

unreachable(Address) :-
    catch(( endpoint_post(Address, note, x), fail ),
          error(unreachable(_), _),
          true).

truth(Goal, Truth) :-
    ( call(Goal) -> Truth = true ; Truth = false ).

%   asked(+Address, +Kind): a request that answer(-Result) waits for.

asked(Address, Kind) :-
    thread_self(Me),
    endpoint_request(Address, Kind, x, thread_send_message(Me)).

answer(Result) :-
    thread_self(Me),
    thread_get_message(Me, Result, [timeout(20)]).

waiting(Address, Count) :-
    aggregate_all(count, typhon_connection_manager:waiting(Address, _, thread(_)), Count).

%   with_held(+Head, :First, :Then): Then is called when First is about to call
%   Head, of the wire, which continues when the gate gets `go`.

:- meta_predicate with_held(:, 0, 0).
:- dynamic to_hold/0.
:- public hold_once/0.

with_held(Head, First, Then) :-
    setup_call_cleanup(
        message_queue_create(Gate, [alias(endpoint_gate)]),
        ( wrap_predicate(Head, held, Wrapped,
                         ( test_endpoint:hold_once, Wrapped )),
          assertz(to_hold),
          call(First),
          thread_get_message(Gate, held, [timeout(20)]),
          call(Then) ),
        message_queue_destroy(Gate)).

hold_once :-
    (   retract(to_hold)
    ->  thread_send_message(endpoint_gate, held),
        thread_get_message(endpoint_gate, go)
    ;   true
    ).

:- begin_tests(two_processes).

test(call, Answer == foo(1, "two", [3.0])) :-
    fresh(with_peer(A, ask(A, echo, foo(1, "two", [3.0]), Answer))).
test(another_thread_answers_later, Answer == x) :-
    fresh(with_peer(A, ask(A, later, x, Answer))).
test(answer_after_the_deadline, error(timeout_error(answer, _))) :-
    fresh(with_peer(A, endpoint_call(A, never, x, _, 0.2))).
test(request_that_cannot_be_served,
     [ forall(member(Kind, [wrong, unheard_of])),
       error(connection_lost(_)) ]) :-
    fresh(with_peer(A, ask(A, Kind, x, _))).
test(request_to_itself, Answer-Codec == x-fast) :-
    fresh(( endpoint_address(Me),
                    ask(Me, echo, x, Answer),
                    endpoint_peer(Me, codec(Codec)) )).
test(properties, [State, Pending, Same] == [up, 0, false]) :-
    fresh(with_peer(A,
        ( ask(A, echo, x, x),
          endpoint_flush(5),
          endpoint_peer(A, state(State)),
          endpoint_peer(A, pending(Pending)),
          endpoint_peer(A, process(P)),
          truth(endpoint_process(P), Same) ))).
test(term_that_cannot_travel, error(type_error(mobile_term, S))) :-
    stream_property(S, alias(user_error)),
    fresh(with_peer(A, endpoint_post(A, note, S))).
test(too_long_for_a_frame, error(resource_error(frame_bytes))) :-
    numlist(1, 100000, Long),
    fresh(with_peer(A,
        ( ask(A, echo, x, x),
          with_settings([typhon_session:frame_bytes=100000],
                       ask(A, echo, Long, _)) ))).

:- end_tests(two_processes).

:- begin_tests(no_peer_there).

test(unreachable, [ forall(member(A, ['127.0.0.1:1', nonsense])),
                    error(unreachable(A)) ]) :-
    fresh(endpoint_post(A, note, x)).
test(not_running, error(existence_error(endpoint, _))) :-
    endpoint_post('127.0.0.1:1', note, x).
test(silent_listener, error(unreachable(_))) :-
    fresh(with_settings([typhon_connection_manager:connect_time=1],
        with_settings([typhon_handshake:handshake_time=0.3],
                     with_listener(5, A, endpoint_post(A, note, x))))).
test(twice, error(permission_error(start, endpoint, _))) :-
    fresh(endpoint_start(localhost, 0, [], _)).

%   An attempt was refused, and the connection manager is not notified yet,
%   when a peer begins to listen: later callers get the result of a later
%   attempt. The waiting caller must not give up before the process of the peer
%   has started.

test(later_request_gets_the_result_of_a_later_attempt,
     [First,Then,Answer] == [unreachable,posted,answer(x)]) :-
    free_port(Port),
    atomic_list_concat(['127.0.0.1', Port], :, A),
    with_settings([typhon_connection_manager:connect_time=60],
        fresh(
            with_held(
                typhon_connection:missed(_, _), posting(A, T1),
                with_peer(Port, _, A,
                    ( asked(A, echo),
                      posting(A, T2),
                      wait_until(waiting(A, 2), 10),
                      thread_send_message(endpoint_gate, go),
                      posted(T1, First),
                      posted(T2, Then),
                      answer(Answer) ))))).

:- end_tests(no_peer_there).

:- begin_tests(every_frame_once_over_breaking_connections).

test(connection_is_cut_on_command) :-
    cut_while_posting(up, 600, [Proxy]>>proxy_cut(Proxy)).
test(connection_is_cut_after_some_bytes,
     [forall(member(Direction, [up, down]))]) :-
    cut_while_posting(Direction, 600,
        [Proxy]>>( random_between(1, 3000, Bytes),
                   proxy_cut_after(Proxy, Direction, Bytes) )).
test(requests_survive_cuts) :-
    with_proxied_peer(Proxy, A,
        concurrent_forall(between(1, 4, T),
                          forall(between(1, 100, I),
                                 ( cut_now_and_then(Proxy, I),
                                   ask_again(A, T-I) )),
                          [threads(4)])).
test(posts_of_the_peer_survive_cuts, Got == Expected) :-
    numlist(1, 800, Expected),
    with_proxied_peer(Proxy, A,
        ( proxy_cut_after(Proxy, down, 5000),
          ask(A, back, 800, done),
          findall(N, note(N), Got) )).
test(half_open, [Notes == [1, 2]]) :-
    with_settings([typhon_reader:silence=0.3],
        with_proxied_peer(Proxy, A,
            ( post_notes(A, 1, 1),
              endpoint_flush(5),
              proxy_hold(Proxy, up),
              post_notes(A, 2, 2),
              quiet(( wait_until(seen_down(A), 20),
                      proxy_release(Proxy, up),
                      endpoint_flush(10) )),
              ask(A, notes, x, Notes) ))).
test(flush_fails_without_acknowledgement, fail) :-
    with_proxied_peer(Proxy, A,
        ( post_notes(A, 1, 1),
          endpoint_flush(5),
          proxy_hold(Proxy, up),
          post_notes(A, 2, 2),
          endpoint_flush(0.2) )).
test(two_addresses_of_one_process, Same == true) :-
    with_proxied_peer(_, A,
        ( ask(A, echo, 1, 1),
          once(( endpoint_peer(B, state(up)), B \== A )),
          ask(B, echo, 2, 2),
          endpoint_peer(A, process(P1)),
          truth(endpoint_peer(B, process(P1)), Same) )).

test(both_connect_at_once) :-
    fresh(with_peer(A, with_peer(B,
        ( concurrent_forall(member(X-Y, [A-B, B-A]),
                            ask(X, greet, Y-100, done),
                            [threads(2)]),
          numlist(1, 100, Expected),
          forall(member(X, [A, B]),
                 ( wait_until(all_there(X, 100, Notes), 20),
                   assertion(Notes == Expected) )) )))).

%   The old connection has ended, the new one has not begun: our side opens it,
%   as nothing is on its way from the peer.

test(post_before_its_deadline_waits_for_the_next_connection,
     [Up,Last,Notes] == [false,true,[0,1]]) :-
    fresh(with_peer(A,
        ( endpoint_post(A, note, 0),
          endpoint_flush(20),
          typhon_session:route(A, Session),
          typhon_session:session_retire(Session),
          with_held(
              typhon_connection:send_count(_, _),
              thread_create(typhon_connection_manager:manager_connect(A), Connects),
              ( truth(endpoint_post_up(A, note, 1), Up),
                thread_create(( thread_send_message(endpoint_gate, posts),
                                ( get_time(Now), By is Now+20,
                                  endpoint_post_by(By, A, note, 1) ) ), Posts),
                thread_get_message(endpoint_gate, posts, [timeout(20)]),
                thread_send_message(endpoint_gate, go),
                thread_join(Connects, _),
                thread_join(Posts, Last) )),
          ask(A, notes, x, Notes) ))).

%   The connection manager has the request: its answer shows that it is done
%   with it.

test(caller_that_gives_up_during_a_send_leaves_nothing_open, Open == 0) :-
    fresh(with_peer(A,
        ( with_held(
              typhon_request:request_send(_, _, _, _),
              thread_create(gives_up(A), Asks),
              ( thread_join(Asks, true),
                thread_send_message(endpoint_gate, go),
                typhon_connection_manager:manager_connect(A) )),
          aggregate_all(count, typhon_request:open_request(_, _, _), Open) ))).

gives_up(Address) :-
    catch(endpoint_call(Address, never, x, _, 0.2),
          error(timeout_error(answer, _), _),
          true).

%   The thread that has installed a connection is ended at that moment if
%   another one has a connection with the peer already, or if writing fails.

test(connection_is_reported_even_if_its_thread_ends) :-
    fresh(with_peer(A,
        ( wrap_predicate(typhon_session:session_install(_, _, _, _),
                         told_to_end, Wrapped,
                         ( Wrapped, test_endpoint:told_to_end )),
          assertz(test_endpoint:to_end),
          typhon_connection_manager:manager_connect(A),
          wait_until(\+ endpoint_peer(A, state(up)), 30),
          assertion(seen(A, up)) ))).

test(hook_of_connections_that_fails_or_raises_is_reported,
     [ forall(member(How-Problem, [fails-failed, raises-error(trouble, _)])),
       true(Problems = [Problem|_]) ]) :-
    setup_call_cleanup(
        assertz(test_endpoint:trouble(How)),
        fresh(with_peer(A, ask(A, echo, x, x))),
        retractall(test_endpoint:trouble(_))),
    findall(Reported, retract(test_endpoint:reported(Reported)), Problems).

all_there(Address, Count, Notes) :-
    ask(Address, notes, x, Notes),
    length(Notes, Count).

seen_down(_) :-
    seen(_, down),
    !.

cut_now_and_then(Proxy, I) :-
    ( I mod 25 =:= 0 -> proxy_cut(Proxy) ; true ).

%   A request waits for the next connection if there is none.

ask_again(Address, Term) :-
    ask(Address, echo, Term, Answer),
    assertion(Answer == Term).

:- meta_predicate
    cut_while_posting(+, +, 1),
    with_proxied_peer(-, -, 0).

with_proxied_peer(Proxy, Address, Goal) :-
    fresh(
        with_peer(Peer,
                  with_proxy(Peer, Proxy,
                             ( proxy_address(Proxy, Address),
                               call(Goal) )))).

cut_while_posting(_, Count, Cut) :-
    with_proxied_peer(Proxy, A,
        ( forall(between(1, Count, I),
                 ( ( I mod 50 =:= 0 -> call(Cut, Proxy) ; true ),
                   endpoint_post(A, note, I) )),
          ask(A, notes, x, Notes),
          numlist(1, Count, Expected),
          assertion(Notes == Expected) )).

:- end_tests(every_frame_once_over_breaking_connections).

:- begin_tests(damage).

%   A frame damaged in transit is sent again; a frame damaged by its sender is
%   skipped. So no frame is damaged while another is to be sent again: it might
%   be the same.

test(damage_in_transit, Notes == Expected) :-
    numlist(1, 300, Expected),
    damaging(( forall(between(1, 300, I),
                      ( (   I mod 60 =:= 0
                        ->  endpoint_flush(10),
                            assertz(damage_next)
                        ;   true
                        ),
                        endpoint_post(A, note, I) )),
               ask(A, notes, x, Notes) ), A).
test(damage_by_the_sender, Notes == [1, 3]) :-
    damaging(( endpoint_post(A, note, 1),
               endpoint_post(A, note, 'always damaged'),
               endpoint_post(A, note, 3),
               ask(A, notes, x, Notes) ), A).
test(unreadable_request, error(connection_lost(_))) :-
    as_text(typhon_text:term_text(Term, Bytes), Original,
            (   Term = request(_, _, zork)
            ->  Bytes = "f((. "
            ;   Original
            ),
            A, ask(A, echo, zork, _)).
test(unreadable_answer, error(connection_lost(_))) :-
    as_text(typhon_text:text_term(Bytes, _), Original,
            (   sub_string(Bytes, 0, _, _, "answer(")
            ->  syntax_error(spoilt)
            ;   Original
            ),
            A, ask(A, echo, zork, _)).
test(frame_longer_than_memory, error(connection_lost(_))) :-
    numlist(1, 100000, Long),
    fresh(with_peer(A,
        wrapped(typhon_frame:unmarked(_, _), _, resource_error(memory),
                ask(A, echo, Long, _)))).
test(acknowledgement_of_unsent_frames, Notes == [1, 2]) :-
    fresh(with_peer(A,
        ( ask(A, echo, x, x),
          endpoint_post(A, note, 1),
          once(typhon_session:route(A, Session)),
          acknowledge(Session, 1000000000),
          endpoint_post(A, note, 2),
          ask(A, notes, x, Notes) ))).

:- dynamic damage_next/0.

%   acknowledge(+Session, +Count): the next head that is written says that
%   Count frames were received.

acknowledge(Session, Count) :-
    typhon_session:session_window(Session, Window),
    arg(3, Window, Received),
    get_flag(Received, Count0),
    set_flag(Received, Count),
    typhon_session:session_acknowledge(Session),
    set_flag(Received, Count0).

:- meta_predicate
    damaging(0, +),
    as_text(+, +, +, +, 0).

damaging(Goal, A) :-
    wrapped(typhon_frame:frame_write(Out, Counts, Bytes), Original,
            plunit_damage:write_damaged(Original, Out, Counts, Bytes),
            fresh(with_peer(A, ( ask(A, echo, x, x), Goal )))).

write_damaged(_, Out, counts(R, S), Bytes) :-
    damaged_now(Bytes),
    !,
    typhon_frame:frame_check(Bytes, R, S, Check),
    string_length(Bytes, Length),
    string_codes(Bytes, [Code0|Codes]),
    Code is Code0 xor 64,
    forall(member(Part, [ Length>>24, Length>>16, Length>>8, Length,
                          Check>>16, Check>>8, Check,
                          R>>24, R>>16, R>>8, R,
                          S>>24, S>>16, S>>8, S ]),
           ( Byte is Part /\ 255, put_byte(Out, Byte) )),
    maplist(put_byte(Out), [Code|Codes]).
write_damaged(Original, _, _, _) :-
    call(Original).

damaged_now(Bytes) :-
    Bytes \== "",
    retract(damage_next),
    !.
damaged_now(Bytes) :-
    sub_string(Bytes, _, _, _, "always damaged"),
    !.

as_text(Head, Original, Body, A, Goal) :-
    with_settings([typhon_handshake:records=false],
        fresh(with_peer(A,
            ( ask(A, echo, x, x),
              endpoint_peer(A, codec(Codec)),
              assertion(Codec == text),
              wrapped(Head, Original, Body, Goal) )))).

:- meta_predicate wrapped(:, +, +, 0).

wrapped(Module:Head, Original, Body, Goal) :-
    functor(Head, Name, Arity),
    setup_call_cleanup(
        wrap_predicate(Module:Head, damage, Original, Body),
        Goal,
        unwrap_predicate(Module:Name/Arity, damage)).

:- end_tests(damage).

:- begin_tests(dead_peer).

test(request_fails_when_the_peer_dies, Result == lost) :-
    free_port(Port),
    fresh(with_peer(Port, Pid, A,
        ( ask(A, echo, x, x),
          asked(A, never),
          endpoint_flush(5),
          process_kill(Pid, kill),
          process_wait(Pid, _),
          with_peer(Port, _, A, answer(Result)) ))).
test(successor_gets_no_old_messages, Notes == [new]) :-
    free_port(Port),
    fresh(with_peer(Port, Pid, A,
        ( ask(A, echo, x, x),
          stop_process(Pid),
          endpoint_post(A, note, old),
          killed(Pid, A),
          with_peer(Port, _, A,
                    ( endpoint_post(A, note, new),
                      ask(A, notes, x, Notes) )) ))).
test(caller_of_an_undelivered_request_continues) :-
    free_port(Port),
    fresh(with_peer(Port, Pid, A,
        ( ask(A, echo, x, x),
          stop_process(Pid),
          endpoint_post(A, note, old),
          thread_create(once(endpoint_flush(20, [A])), Thread),
          wait_until(endpoint_peer(A, pending(2)), 5),
          killed(Pid, A),
          with_peer(Port, _, A,
                    ( ask(A, echo, x, x),
                      wait_until(\+ thread_property(Thread, status(running)),
                                 10),
                      thread_join(Thread, _) )) ))).
test(goodbye_is_sent, Result == lost) :-
    fresh(with_peer_process([], _, In-_, A,
        ( ask(A, echo, x, x),
          asked(A, never),
          endpoint_flush(5),
          says_goodbye(In),
          answer(Result) ))).
test(peer_is_gone_after_goodbye) :-
    fresh(with_peer_process([], _, In-_, A,
        ( ask(A, echo, x, x),
          says_goodbye(In),
          wait_until(endpoint_gone(A), 10) ))).
test(peer_is_gone_when_no_process_listens, Before-After == false-true) :-
    fresh(with_peer(0, Pid, A,
        ( ask(A, echo, x, x),
          truth(endpoint_gone(A), Before),
          killed(Pid, A),
          wait_until(unreachable(A), 5),
          truth(endpoint_gone(A), After) ))).
test(stopped_peer_is_not_gone, State-Gone == down-false) :-
    fresh(with_settings([typhon_reader:silence=0.2],
        with_peer(0, Pid, A,
            ( ask(A, echo, x, x),
              process_kill(Pid, stop),
              endpoint_post(A, note, x),
              quiet(wait_until(endpoint_peer(A, state(down)), 10)),
              endpoint_peer(A, state(State)),
              truth(endpoint_gone(A), Gone),
              process_kill(Pid, cont) )))).
test(another_process_at_the_address_is_reported, Process == New) :-
    free_port(Port),
    fresh(with_peer(Port, Pid, A,
        ( ask(A, echo, x, x),
          endpoint_peer(A, process(Old)),
          killed(Pid, A),
          wait_until(unreachable(A), 5),
          assertion(endpoint_gone(A)),
          assertion(endpoint_peer(A, process(Old))),
          with_peer(Port, _, A,
                    ( ask(A, process, x, New),
                      assertion(\+ endpoint_gone(A)),
                      endpoint_peer(A, process(Process)) )) ))).

:- end_tests(dead_peer).

:- begin_tests(no_leaks).

test(after_many_starts) :-
    no_leaks(forall(between(1, 25, _),
                    fresh(( endpoint_address(A),
                                    ask(A, echo, x, x) )))).
test(processes_do_not_keep_the_port) :-
    setup_call_cleanup(
        true,
        ( endpoint_start(localhost, 0, [], Address),
          call_cleanup(begun(Pid, In, Out), endpoint_stop),
          atomic_list_concat(['127.0.0.1', Port0], :, Address),
          atom_number(Port0, Port),
          endpoint_start(localhost, Port, [], Address) ),
        ( endpoint_stop,
          close(In),
          close(Out),
          process_wait(Pid, _) )).
test(stop_with_requests_open, Result == lost) :-
    with_peer(A, ( fresh(( ask(A, echo, x, x),
                                   asked(A, never),
                                   endpoint_flush(5) )),
                   answer(Result) )).
test(stop_while_connecting, Result == unreachable) :-
    with_deaf(A,
        fresh(( asked(A, echo),
                        wait_until(typhon_connection_manager:attempt(
                                       A, trying(_, _, _), _, _), 10) ))),
    answer(Result).
test(thread_stops_waiting_at_its_deadline, Count == 0) :-
    with_deaf(A,
        fresh(( get_time(Now),
                        Deadline is Now+0.2,
                        \+ typhon_connection_manager:manager_connect(A, Deadline),
                        waiting(A, Count) ))).

%   Until it executes its program a new process is a copy of this one.

begun(Pid, In, Out) :-
    spawn(path(cat), [],
          [stdin(pipe(In)), stdout(pipe(Out)), process(Pid)]),
    format(In, 'hello~n', []),
    flush_output(In),
    read_line_to_string(Out, "hello").

:- end_tests(no_leaks).
