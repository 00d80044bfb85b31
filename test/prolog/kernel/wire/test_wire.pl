:- module(test_wire, []).

/** <module> Tests of the wire: many peers, large frames, disconnected peers

*Threading*: the main thread; the hooks run in those of the endpoint.
*/

:- use_module('../../../lib/common').
:- use_module('../../../lib/cutting_proxy').
:- use_module('../../../lib/endpoints').
:- use_module(library(aggregate), [aggregate_all/3]).
:- use_module(library(apply), [maplist/2, maplist/3]).
:- use_module(library(lists), [member/2, numlist/3, subtract/3]).
:- use_module(library(plunit)).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(thread), [concurrent_forall/3]).
:- use_module(library(typhon/kernel/wire)).
:- use_module('../../../lib/endpoint_peer', [sleep_until/1]).

:- dynamic
    peer/3,                             % Address, Pid, In
    place_wanted/0,
    refused/0.

%   A client has been evicted in favour of another, or has another cookie.

:- multifile user:message_hook/3.

user:message_hook(typhon(endpoint, turned_away(_, silent)), _, _) :-
    assertz(place_wanted),
    fail.
user:message_hook(typhon(endpoint, turned_away(_, cookie)), _, _) :-
    assertz(refused),
    fail.

                /*******************************
                *           FIXTURES           *
                *******************************/

:- meta_predicate
    fresh(0),
    with_peers(+, -, 0).

%   fresh(:Goal): as with_endpoint/1; nothing was noted before.

fresh(Goal) :-
    retractall(endpoint_peer:note(_)),
    with_endpoint(Goal).

%   with_peers(+Count, -Addresses, :Goal): the last argument of peer/3 is
%   where a peer reads commands.

with_peers(Count, Addresses, Goal) :-
    with_more(Count, [], Addresses, Goal).

with_more(0, Addresses, Addresses, Goal) :-
    !,
    call(Goal).
with_more(Count, Addresses0, Addresses, Goal) :-
    Count1 is Count-1,
    with_peer_process([], Pid, Streams, Address,
                      with_this(Address, Pid, Streams,
                                with_more(Count1, [Address|Addresses0],
                                          Addresses, Goal))).

:- meta_predicate with_more(+, +, -, 0), with_this(+, +, +, 0).

with_this(Address, Pid, Streams, Goal) :-
    setup_call_cleanup(
        assertz(peer(Address, Pid, Streams)),
        Goal,
        retractall(peer(_, Pid, _))).

ask(Address, Kind, Term, Answer) :-
    endpoint_call(Address, Kind, Term, answer(Answer), 120).

kill(Address) :-
    peer(Address, Pid, _),
    process_kill(Pid, kill),
    process_wait(Pid, _).

unreachable(Address) :-
    catch(( endpoint_post(Address, note, x), fail ),
          error(unreachable(_), _),
          true).

                /*******************************
                *          CONNECTING          *
                *******************************/

%   Of two processes the one with the smaller id is the arbiter.

:- meta_predicate as_process(+, 0), with_late_callers(0).

as_process(Id, Goal) :-
    findall(Own, retract(typhon_endpoint:process(Own)), Owns),
    setup_call_cleanup(
        assertz(typhon_endpoint:process(Id)),
        Goal,
        ( retractall(typhon_endpoint:process(_)),
          forall(member(Own, Owns), assertz(typhon_endpoint:process(Own))) )).

%   A client has authenticated, reports that, and waits for `go`. Wrapped is no
%   meta-predicate: in 9.2.9 those of wrappers get closures in the wrong
%   module.

with_late_callers(Goal) :-
    thread_self(Me),
    setup_call_cleanup(
        wrap_predicate(typhon_connection:session_keys(Role, _, _, _, _),
                       late,
                       Keys, ( test_wire:wait_if_called(Role, Me), Keys )),
        Goal,
        unwrap_predicate(typhon_connection:session_keys/5, late)).

:- public wait_if_called/2.

wait_if_called(Role, Waiter) :-
    (   functor(Role, server, _)
    ->  thread_self(Me),
        thread_send_message(Waiter, called(Me)),
        thread_get_message(Me, go, [timeout(20)])
    ;   true
    ).

:- begin_tests(simultaneous_connections).

test(two_processes_connect_to_each_other, Late == []) :-
    fresh(with_peers(1, [A],
        ( peer(A, _, Streams),
          findall(Outcome,
                  ( between(1, 150, _),
                    meet_at_once(Streams, Outcomes),
                    member(Outcome, Outcomes),
                    Outcome \= outcome(ok, _) ),
                  Late) ))).
test(first_of_two_simultaneous_connections_stays, Kept == true) :-
    as_process('0000000000000000',
        fresh(with_peers(1, [A], with_late_callers(second(A, Kept))))).
test(offered_connection_is_accepted) :-
    as_process(ffffffffffffffff,
        fresh(with_peers(1, [A],
            setup_call_cleanup(
                wrap_predicate(typhon_session:session_up_since(_, _),
                               not_noticed, _, true),
                ask(A, echo, x, x),
                unwrap_predicate(typhon_session:session_up_since/2,
                                 not_noticed))))).
test(sixteen_processes_connect_to_each_other, Missed == []) :-
    fresh(with_peers(16, Addresses,
        ( maplist(reach_others(Addresses), Addresses),
          findall(M, ( member(_, Addresses),
                       thread_get_message(reached(Answer)),
                       Answer \= answer([]),
                       M = Answer ), Missed) ))).
test(slot_of_an_unauthenticated_client_is_freed, Outcome = outcome(ok, _)) :-
    retractall(test_wire:place_wanted),
    with_settings([typhon_acceptor:unproved=1],
        fresh(with_peers(1, [A],
            ( endpoint_address(Me),
              with_client(_, _,
                          ( peer(A, _, In-Out),
                            command(In, greet(Me, 0)),
                            wait_until(test_wire:place_wanted, 20) )),
              read(Out, Outcome) )))).
test(no_process_at_the_address) :-
    fresh(all_unreachable('127.0.0.1:1', 300)).
test(wrong_cookie_is_reported_at_once, Status-Refused == exit(3)-true) :-
    project_file('prolog/typhon/kernel/wire', File),
    retractall(test_wire:refused),
    fresh(( endpoint_address(A),
                    format(atom(Goal),
                           "use_module('~w'),endpoint_start(localhost,0,[],_),\c
                            settings:set_setting(typhon_connection_manager:connect_time,600),\c
                            catch(endpoint_post('~w',note,x),\c
                                  error(unreachable(_),_),\c
                                  halt(3)),halt(0)", [File, A]),
                    run_swipl(['-g', Goal],
                              [environment(['TYPHON_COOKIE'=no])], Status, _,
                              _) )),
    ( refused -> Refused = true ; Refused = false ).

meet_at_once(In-Out, [Theirs, Ours]) :-
    command(In, restart),
    read_address(Out, Address),
    endpoint_address(Me),
    get_time(Now),
    Time is Now+0.003,
    command(In, greet(Me, Time)),
    sleep_until(Time),
    get_time(T0),
    endpoint_peer:greeted(Address, Outcome),
    get_time(T1),
    Seconds is T1-T0,
    Ours = outcome(Outcome, Seconds),
    read(Out, Theirs).

read_address(Out, Address) :-
    read_line_to_string(Out, Line),
    (   Line == ""                      % rest of a line that read/1 has left
    ->  read_address(Out, Address)
    ;   atom_string(Address, Line)
    ).

command(In, Command) :-
    format(In, "~q.~n", [Command]),
    flush_output(In).

reach_others(Addresses, Address) :-
    subtract(Addresses, [Address], Others),
    thread_self(Me),
    endpoint_request(Address, reach, Others, tell_reached(Me)).

tell_reached(Queue, Answer) :-
    thread_send_message(Queue, reached(Answer)).

%   A calls us while we call A, and we are connected.

second(A, Kept) :-
    peer(A, _, In-Out),
    endpoint_address(Me),
    command(In, greet(Me, 0)),
    thread_self(Self),
    thread_get_message(Self, called(Caller), [timeout(20)]),
    ask(A, echo, x, x),
    connections(Both),
    subtract(Both, [Caller], [Thread]),
    thread_send_message(Caller, go),
    read(Out, outcome(ok, _)),
    wait_until(\+ is_thread(Caller), 20),
    (   connections([Thread])
    ->  Kept = true
    ;   Kept = false
    ).

%   The threads of connections to other processes.

connections(Threads) :-
    findall(Alias,
            ( thread_property(_, alias(Alias)),
              ( sub_atom(Alias, 0, _, _, typhon_in_)
              ; sub_atom(Alias, 0, _, _, typhon_out_) ) ),
            Threads).

:- end_tests(simultaneous_connections).

:- begin_tests(requests_wait_for_the_connection).

test(requests_are_sent_in_order_and_precede_later_posts, Notes == Expected) :-
    numlist(1, 500, Numbers),
    numlist(1, 501, Expected),
    fresh(with_peers(1, [A],
        ( send_all(A, Numbers),
          endpoint_post(A, note, 501),
          maplist(answered, Numbers, _),
          ask(A, notes, x, Notes) ))).
test(waiting_requests_need_no_threads, true(More < 8)) :-
    fresh(with_settings([typhon_connection_manager:connect_time=1],
        with_listener(5, A,
            ( statistics(threads, Before),
              send_up_to(A, 300),
              statistics(threads, After),
              More is After-Before,
              none_answered(300) )))).
test(request_that_cannot_travel, error(type_error(mobile_term, _))) :-
    stream_property(S, alias(user_error)),
    fresh(endpoint_request('127.0.0.1:1', echo, S, =(_))).
test(waiting_requests_end_with_the_endpoint) :-
    with_listener(5, A, fresh(send_up_to(A, 1))),
    none_answered(1).

:- end_tests(requests_wait_for_the_connection).

send_up_to(Address, Count) :-
    numlist(1, Count, Numbers),
    send_all(Address, Numbers).

none_answered(Count) :-
    forall(between(1, Count, N), answered(N, unreachable)).

all_unreachable(Address, Count) :-
    send_up_to(Address, Count),
    none_answered(Count).

send_all(Address, Numbers) :-
    thread_self(Me),
    forall(member(N, Numbers),
           endpoint_request(Address, remember, N, tell_answer(Me, N))).

tell_answer(Queue, N, Answer) :-
    thread_send_message(Queue, answered(N, Answer)).

answered(N, Answer) :-
    thread_self(Me),
    thread_get_message(Me, answered(N, Answer), [timeout(20)]).

                /*******************************
                *          BIG FRAMES          *
                *******************************/

%   Prologs of 32 bits have no strings of 2^25 characters.

longest(Size) :-
    current_prolog_flag(address_bits, 32),
    !,
    Size = 33 000 000.
longest(60 000 000).

:- begin_tests(large_frames).

test(large_frames_in_both_directions,
     [ forall(member(Codec-Size-N,
                     [ fast-65 000-10, fast-70 000-10,
                       fast-1 000 000-4,
                       text-70 000-4, text-1 000 000-1 ])),
       Count == N ]) :-
    with_codec(Codec, cross(Size, N, Count)).

%   A process that decodes such a frame answers no ping meanwhile.

test(longest_frames, Count == 1) :-
    longest(Size),
    Patience = (typhon_reader:silence),
    with_settings([Patience=60], with_endpoint(
        with_peer_process([setup(set_setting(Patience, 60))], _, _, A,
            ( ask(A, echo, x, x),
              endpoint_peer:big_string(Size, String),
              endpoint_post(A, note, String),
              ask(A, count, x, Count) )))).
test(answers_of_8_MB_at_once) :-
    fresh(with_peers(1, [A],
        ( endpoint_address(Me),
          thread_self(Queue),
          ask(A, echo, x, x),
          forall(between(1, 2, _),
                 ( endpoint_request(A, ask_back, ask(Me, 8 000 000),
                                    thread_send_message(Queue)),
                   ask(A, string, 8 000 000, String),
                   assertion(string_length(String, 8 000 000)),
                   thread_get_message(Queue, Done, [timeout(60)]),
                   assertion(Done == answer(done)) )) ))).

:- meta_predicate with_codec(+, 0).

with_codec(fast, Goal) :-
    call(Goal).
with_codec(text, Goal) :-
    with_settings([typhon_handshake:records=false], Goal).

%   N strings of Size in each direction, with answers of the same size,
%   while small requests go on.

cross(Size, N, Count) :-
    fresh(with_peers(1, [A],
        ( endpoint_address(Me),
          ask(A, echo, x, x),
          concurrent_forall(
              member(Goal, [ ask(A, cross, cross(Me, Size, N), done),
                             endpoint_peer:cross(A, Size, N),
                             forall(between(1, 50, I), ask(A, echo, I, I)),
                             forall(between(1, 50, I), ask(A, echo, I, I))
                           ]),
              Goal,
              [threads(4)]),
          ask(A, count, x, Count),
          aggregate_all(count, endpoint_peer:note(_), Mine),
          assertion(Mine == N),
          assertion(endpoint_flush(10)) ))).

:- end_tests(large_frames).

:- begin_tests(disconnected_peers).

test(disconnected_peers_leave_no_queue, Queues == Before) :-
    fresh(with_peers(3, Addresses,
        ( queues(Before),
          forall(member(A, Addresses), ask(A, echo, x, x)),
          assertion(endpoint_flush(5)),
          maplist(kill, Addresses),
          wait_until(forall(member(A, Addresses),
                            endpoint_peer(A, state(down))), 10),
          wait_until(queues(Before), 5),
          queues(Queues) ))).
test(number_of_kept_sessions_is_bounded) :-
    with_settings([typhon_connection_manager:resting=2],
        fresh(with_peers(4, Addresses,
            ( forall(member(A, Addresses), ask(A, echo, x, x)),
              assertion(endpoint_flush(5)),
              maplist(kill, Addresses),
              wait_until(sessions(2), 10),
              forall(member(A, Addresses),
                     assertion(endpoint_peer(A, process(_)))) )))).
test(returning_peer_resumes_its_session, Notes == [1, 2, 3]) :-
    fresh(with_peers(1, [Peer],
        with_proxy(Peer, Proxy,
            ( proxy_address(Proxy, A),
              forall(between(1, 3, N),
                     ( endpoint_post(A, note, N),
                       assertion(endpoint_flush(5)),
                       proxy_cut(Proxy),
                       wait_until(endpoint_peer(A, state(down)), 5) )),
              ask(A, notes, x, Notes),
              sessions(1) )))).
test(answer_to_a_disconnected_peer, Answer == answer(x)) :-
    fresh(with_peers(1, [Peer],
        with_proxy(Peer, Proxy,
            ( proxy_address(Proxy, A),
              thread_self(Me),
              endpoint_request(A, later, x, thread_send_message(Me)),
              proxy_cut(Proxy),
              thread_get_message(Me, Answer, [timeout(20)]) )))).
test(peer_records_are_bounded, true(Count =< 5)) :-
    with_settings([typhon_peer_cache:contacts=5],
        fresh(
            ( forall(between(1, 20, P),
                     ( atom_concat('127.0.0.1:', P, A), unreachable(A) )),
              aggregate_all(count, typhon_peer_cache:last_process(_, _, _),
                            Count) ))).

queues(Count) :-
    aggregate_all(count, typhon_session:session(_, _), Sessions),
    aggregate_all(count, message_queue_property(_, size(_)), All),
    Count is All-2*Sessions.

sessions(Count) :-
    findall(Process,
            ( endpoint_peer(Address, state(_)),
              endpoint_peer(Address, process(Process)) ),
            Processes),
    sort(Processes, Set),
    length(Set, Count).

:- end_tests(disconnected_peers).

:- begin_tests(flushes).

test(each_flush_ends, Failed == 0) :-
    fresh(with_peers(1, [A],
        ( ask(A, echo, x, x),
          flag(test_failed, _, 0),
          concurrent_forall(between(1, 4, _),
                            forall(between(1, 1000, I), post_and_flush(A, I)),
                            [threads(4)]),
          flag(test_failed, Failed, Failed) ))).

post_and_flush(Address, I) :-
    endpoint_post(Address, note, I),
    (   endpoint_flush(10)
    ->  true
    ;   flag(test_failed, N, N+1)
    ).

%   With the topic typhon(frame) connections broke at each of these.

test(frames_of_counts_can_be_shown, Words == none) :-
    typhon_session:frame_words(none, Words).

:- end_tests(flushes).
