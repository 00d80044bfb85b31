:- use_module('../../../lib/common').
:- use_module('../../../lib/peers').
:- use_module(library(plunit)).
:- use_module(library(lists), [last/2, member/2, numlist/3]).
:- use_module(library(process), [process_kill/2, process_wait/2]).
:- use_module(library(prolog_wrap), [wrap_predicate/4]).
:- use_module(library(random), [random_member/2]).
:- use_module(library(readutil), [read_line_to_string/2]).
:- use_module(library(typhon)).

/** <module> Messages between processes that keep journals

Whatever breaks while a message is being posted, the message arrives, even if
it is the last one.
*/

:- needs([journal]).

%   with_beta(-Beta, -Pid, :Before, :After): from a host with a journal, to
%   another process with a journal, Pid, which is killed after Before; After is
%   called when it has restarted. Its hosts are Beta and, at another port, gamma.
%   With_listener/3 passes the host to Goal, and an agent there.

:- meta_predicate
    with_beta(-, -, 0, 0),
    with_listener(-, -, 0),
    beta(+, +, -, 0).

with_beta(Beta, Pid, Before, After) :-
    no_leaks(with_tmp_dir(Dir,
        ( atom_concat(Dir, '/driver', Mine),
          atom_concat(Dir, '/beta', Journal),
          free_port(Port),
          format(atom(Beta), 'beta@127.0.0.1:~d', [Port]),
          setup_call_cleanup(
              host_start(driver, [journal(Mine)]),
              ( beta(Journal, Port, Pid, Before),
                beta(Journal, Port, _, After) ),
              host_stop(driver)) ))).

with_listener(Beta, Id, Goal) :-
    with_beta(Beta, _, ( listener(Beta, Id), Goal ), true).

beta(Journal, Port, Pid, Goal) :-
    project_file('test/chaos/lasting/node.pl', File),
    with_swipl([File, '--', beta, Port, Journal, normal, 1], Pid, In, Out,
               ( format(In, 'orders([]).~n', []),
                 flush_output(In),
                 read_line_to_string(Out, "ready"),
                 call(Goal) )).

%   listener(+Host, -Id): an agent on Host that stores received messages.

listener(Host, Id) :-
    agent_create(clauses([ (:- agent(listens, [state([got/1])])),
                           (on_message(_, M) :- assertz(got(M))) ]),
                 Id, [host(Host)]).

got(Id, Expected) :-
    wait_until(( agent_property(Id, facts(Facts)),
                 findall(M, member(got(M), Facts), Expected) ), 30).

:- begin_tests(channel).

%   Predicates stay wrapped: unwrapping a predicate that a thread executes is
%   not safe.

:- dynamic
    interrupted/1,                      % Thread: once, before it has posted
    held/0.  % once, when a worker has posted messages

:- public interrupt/0, hold/1.

interrupt :-
    thread_self(Me),
    (   retract(interrupted(Me))
    ->  thread_signal(Me, throw(told_to_end))
    ;   true
    ).

hold(Kind) :-
    (   Kind == channel,
        retract(held)
    ->  thread_send_message(channel_gate, posted),
        thread_get_message(channel_gate, on)
    ;   true
    ).

test(interrupted_post_does_not_block_others) :-
    with_listener(_, Id,
        ( wrap_predicate(typhon_scheduler:scheduler_call(_), told_to_end, Wrapped,
                         ( plunit_channel:interrupt, Wrapped )),
          thread_self(Me),
          assertz(interrupted(Me)),
          catch(agent_send(Id, first), told_to_end, true),
          \+ interrupted(_),
          agent_send(Id, second),
          got(Id, [first, second]) )).

%   The worker has posted, and not recorded it yet, when the process dies; it
%   continues when there is a connection with the next process.

test(unacknowledged_posts_are_sent_to_the_successor) :-
    message_queue_create(Gate, [alias(channel_gate)]),
    with_beta(Beta, Pid,
        ( listener(Beta, Id),
          stop_process(Pid),
          wrap_predicate(typhon_endpoint:endpoint_post(_, Kind, _), posted,
                         Wrapped, ( Wrapped, plunit_channel:hold(Kind) )),
          assertz(held),
          agent_send(Id, hello),
          thread_get_message(Gate, posted) ),
        ( remote(Beta, true),
          thread_send_message(Gate, on),
          got(Id, [hello]) )),
    message_queue_destroy(Gate).

%   The process was met at its first port, and is connected again by that one.

test(unacknowledged_posts_to_a_second_port_are_sent_to_the_successor) :-
    free_port(Port),
    format(atom(Gamma), 'gamma@127.0.0.1:~d', [Port]),
    with_beta(Beta, Pid,
        ( remote(Beta, typhon:host_start(gamma, [port(Port)])),
          listener(Gamma, Id),
          asked_for_ever(Gamma, Thread),
          stop_process(Pid),
          agent_send(Id, hello) ),
        ( thread_join(Thread, exception(error(connection_lost(Gamma), _))),
          got(Id, [hello]) )).

%   asked_for_ever(+Host, -Thread): a remote goal that never ends is running on
%   Host.

asked_for_ever(Host, Thread) :-
    thread_create(remote(Host, ( leave(asked),
                                 thread_self(Me),
                                 thread_get_message(Me, never) )), Thread),
    wait_until(remote(Host, sense(asked)), 30).

%   Changes that belong together are one entry of the journal: a process may be
%   killed between any two.

:- dynamic entry/1.                     % Changes

noting_entries :-
    retractall(entry(_)),
    wrap_predicate(typhon_committing:queue_entry(Changes), noted, Wrapped,
                   ( assertz(plunit_channel:entry(Changes)), Wrapped )).

%   entry_with(+Change, -Entry): the only one, or the next.

entry_with(Change, Entry) :-
    entry(Entry),
    memberchk(Change, Entry).

test(refused_agent_keeps_its_queued_messages) :-
    with_beta(Beta, Pid, ( waits(Id), sent_nowhere(Id, Beta, Pid) ), true).

waits(Id) :-
    agent_create(clauses([ (:- agent(waits, [])), (main :- receive(never)) ]),
                 Id, [host(driver)]),
    agent_send(Id, m(1)),
    agent_send(Id, m(2)),
    wait_until(in_mailbox(Id, [m(1), m(2)]), 30).

in_mailbox(Id, Messages) :-
    agent_property(Id, mailbox(Mail)),
    findall(M, member(_-M, Mail), Messages).

%   The agent gets an order to a missing host of a process that is suspended
%   for a while.

sent_nowhere(Id, Beta, Pid) :-
    remote(Beta, true),
    atom_concat(beta, Place, Beta),
    atom_concat(missing, Place, Nowhere),
    noting_entries,
    stop_process(Pid),
    agent_move(Id, Nowhere),
    wait_until(typhon_agents:agent_status(Id, transit(_, _), _), 30),
    agent_send(Id, m(3)),
    process_kill(Pid, cont),
    wait_until(in_mailbox(Id, [m(1), m(2), m(3)]), 30),
    findall(Entry, entry_with(drop_all(mail, Id), Entry), [Leaves, Stays]),
    memberchk(put(agent, Id, _, _), Leaves),
    memberchk(put(agent, Id, _, _), Stays),
    findall(M, member(put(mail, Id, M, _), Stays), [_, _, _]).

:- multifile user:message_hook/3.

user:message_hook(typhon(order_failed(_, _)), warning, _).

%   The whereabouts of the recipient say that it is on its way to this process.

test(forwarded_message_is_moved_in_one_unit_of_work) :-
    with_beta(Beta, _,
        ( typhon_endpoint:endpoint_address(Endpoint),
          atom_concat('driver@', Endpoint, Here),
          atom_concat('late.abc.0@', Beta, Late),
          typhon_durable:durable_restore(gone, Late, 0, gone(Here, 1, unknown)),
          noting_entries,
          agent_create(clauses([ (:- agent(says, [state([to/1])])),
                                 (main :- to(To), send(To, hello)) ]),
                       Id, [host(driver), facts([to(Late)])]),
          agent_join(Id, done, 30),
          wait_until(entry_with(drop(letter, Late, _), Entry), 30),
          memberchk(put(wait, Late, _, _), Entry) ),
        true).

:- end_tests(channel).

%   A message that is too long for a frame does not block others.

:- begin_tests(channel_frames).

small(Goal) :-
    with_settings([typhon_session:frame_bytes=70000], Goal).

text(Length, Text) :-
    format(string(Text), "~`xt~*|", [Length]).

test(sender_of_a_too_long_message_gets_an_error) :-
    with_listener(_, Id,
        ( text(90000, Long),
          small(( catch(agent_send(Id, Long), error(Formal, _), true),
                  agent_send(Id, short),
                  got(Id, [short]) )),
          Formal == resource_error(frame_bytes) )).

test(agent_sending_a_too_long_message_gets_an_error) :-
    with_listener(_, Id,
        ( listener(driver, Near),
          Clauses = [ (:- agent(says, [state([to/2])])),
                      (main :- to(Near1, Far),
                               format(string(Long), "~`xt~90000|", []),
                               send(Near1, Long),
                               catch(send(Far, Long), error(Error, _), true),
                               send(Far, short),
                               result(Error)) ],
          small(( agent_create(clauses(Clauses), A,
                               [host(driver), facts([to(Near, Id)])]),
                  agent_result(A, Formal, 20),
                  got(Id, [short]) )),
          Formal == resource_error(frame_bytes),
          text(90000, Long0),
          got(Near, [Long0]) )).

%   As if another codec needed more space than was estimated.

test(message_that_became_too_long_is_reported_as_a_dead_letter) :-
    setting(typhon_session:frame_bytes, Bytes),
    call_cleanup(
        with_beta(Beta, Pid,
            ( listener(Beta, Id),
              process_kill(Pid, kill),
              process_wait(Pid, _),
              text(90000, Long),
              forall(member(Message, [first, Long, second]),
                     agent_send(Id, Message)),
              set_setting(typhon_session:frame_bytes, 70000) ),
            ( got(Id, [first, second]),
              wait_until(dead_letter_reported(Id,
                                              resource_error(frame_bytes)),
                         5) )),
        set_setting(typhon_session:frame_bytes, Bytes)).

%   The whereabouts of the recipient say that it is on its way to this process.

test(queued_messages_are_split_over_frames) :-
    with_listener(Beta, Id,
        ( typhon_endpoint:endpoint_address(Endpoint),
          atom_concat('driver@', Endpoint, Here),
          typhon_durable:durable_restore(gone, Id, 0, gone(Here, 1, unknown)),
          text(30000, Text),
          numlist(1, 7, Numbers),
          small(( forall(member(N, Numbers), agent_send(Id, N-Text)),
                  typhon_whereabouts:agent_arrived(Id, Beta, 2, unknown),
                  findall(N-Text, member(N, Numbers), All),
                  got(Id, All) )) )).

test(end_is_reported_without_a_too_long_result) :-
    with_beta(Beta, _,
        ( host_property(driver, address(Driver)),
          Clauses = [ (:- agent(leaves, [state([to/1])])),
                      (main :- to(To), move(To),
                               format(string(S), "~`xt~90000|", []),
                               result(S)) ],
          small(( agent_create(clauses(Clauses), Id,
                               [host(Beta), facts([to(Driver)])]),
                  remote(Beta, typhon:agent_join(Id, done, 20)) )),
          wait_until(retract(told(results_lost(Id))), 5) ),
        true).

test(too_long_log_entry_is_reported) :-
    with_listener(Beta, Id,
        ( host_change(driver, log(Beta)),
          agent_create(clauses([ (:- agent(logs, [state([to/1])])),
                                 (main :- format(string(S), "~`xt~90000|", []),
                                          log(S), to(To), send(To, logged)) ]),
                       A, [host(driver), facts([to(Id)])]),
          small(( agent_join(A, done, 10), got(Id, [logged]) )) )).

:- dynamic told/1.

:- multifile user:message_hook/3.

user:message_hook(typhon(Told), warning, _) :-
    ( Told = undeliverable(_, _, _, _) ; Told = results_lost(_) ),
    assertz(plunit_channel_frames:told(Told)).

dead_letter_reported(Id, Formal) :-
    retract(told(undeliverable(Formal, Id, _, _))).

:- end_tests(channel_frames).

%   A caller in another process waits for as long.

:- begin_tests(channel_full).

:- dynamic asked/0.

pages(Most) :-
    format(atom(Pragma), 'pragma max_page_count=~d', [Most]),
    odbc:odbc_current_connection(Connection, _),
    with_mutex(typhon_commit,
               odbc:odbc_query(Connection, Pragma, _, [])).

full :-
    pages(1),
    numlist(1, 20000, Long),
    remote(driver, leave(Long)),
    wait_until(typhon_durable:commit_error(_), 20).

test(answer_waits_while_the_journal_is_full, Line == "answered") :-
    no_leaks(with_tmp_dir(Dir,
        ( retractall(asked),
          setup_call_cleanup(
              host_start(driver, [journal(Dir)]),
              ( host_property(driver, address(Driver)),
                with_asker(Driver, In, Out,
                           ( full,
                             format(In, 'ask.~n', []),
                             flush_output(In),
                             wait_until(plunit_channel_full:asked, 20),
                             pages(1000000),
                             read_line_to_string(Out, Line) )) ),
              host_stop(driver)) ))).

%   Prints `ready`, and `answered` when its question has been answered.

with_asker(Driver, In, Out, Goal) :-
    project_file('prolog/typhon.pl', Typhon),
    Asks = ( remote(Driver, true), writeln(ready), read(_),
             remote(Driver, assertz(plunit_channel_full:asked)),
             writeln(answered) ),
    format(atom(Text), '~q', [Asks]),
    with_swipl(['-q', '-g', Text, Typhon], _, In, Out,
               ( set_stream(Out, timeout(30)),
                 read_line_to_string(Out, "ready"),
                 call(Goal) )).

:- end_tests(channel_full).

%   A process without a journal receives posts of one that has a journal.  It
%   loads the receiving end when the first post comes.

:- begin_tests(channel_plain).

receiving_end(Loaded) :-
    (   peer_do(plain, current_module(typhon_channel))
    ->  Loaded = true
    ;   Loaded = false
    ).

test(plain_process_takes_posts_once_and_in_order,
     Loaded == [false, true]) :-
    with_tmp_dir(Dir,
        ( Loaded = [Before, After],
          with_peers([plain],
                     setup_call_cleanup(host_start(driver, [journal(Dir)]),
                                        ( receiving_end(Before), posted_all,
                                          receiving_end(After) ),
                                        host_stop(driver))) )).

posted_all :-
    peer_host(plain, Host),
    listener(Host, Id),
    numlist(1, 200, All),
    forall(member(N, All), agent_send(Id, N)),
    got(Id, All).

%   Both processes die before the post can be sent.

test(posts_are_sent_after_a_restart_of_their_sender) :-
    no_leaks(with_tmp_dir(sender_dies)).

sender_dies(Dir) :-
    findall(Peer-[host([journal(Journal)])],
            ( member(Peer, [sender, there]),
              atomic_list_concat([Dir, /, Peer], Journal) ), Peers),
    with_peers(Peers,
               ( peer_host(there, Host),
                 listener(Host, Id),
                 peer_do(sender, remote(Host, true)),
                 peer_kill(there),
                 peer_do(sender, agent_send(Id, hello)),
                 peer_kill(sender),
                 peer_restart(there),
                 peer_restart(sender),
                 got(Id, [hello]) )).

:- end_tests(channel_plain).

%   Posts 1, 2 and so on, of which some are lost, repeated, or sent again from an
%   earlier one on: each is taken once, in order.

:- begin_tests(channel_receiver).

:- dynamic taken/1.

:- multifile
    typhon_endpoint:received/3,
    typhon_kinds:accepts/5.

typhon_kinds:accepts(post, channel_note, _, none, none).

typhon_endpoint:received(channel_note, N, _) :-
    assertz(plunit_channel_receiver:taken(N)).

test(each_post_is_taken_once_in_order,
     [ forall(between(1, 30, Seed)),
       cleanup(retractall(typhon_channel:seen(_, _))) ]) :-
    set_random(seed(Seed)),
    retractall(taken(_)),
    arrives(40, 0),
    findall(N, taken(N), Taken),
    last([0|Taken], Last),
    findall(N, between(1, Last, N), Expected),
    assertion(Taken == Expected),
    numlist(1, 20, All),
    forall(member(N, All), arrived(N, _)),
    findall(N, taken(N), Finally),
    assertion(Finally == All).

%   arrives(+Count, +Last): Count posts, after that of number Last.

arrives(0, _) :-
    !.
arrives(Count, Last) :-
    random_member(Next, [1, 1, 1, 2, 0, -2]),
    N is min(20, max(1, Last+Next)),
    arrived(N, How),
    (   N =:= 1
    ->  assertion(How \== gap)
    ;   true
    ),
    Count1 is Count-1,
    arrives(Count1, N).

arrived(N, How) :-
    (   N =:= 1
    ->  Before = first(-1)
    ;   Before is N-1
    ),
    typhon_channel:take_once(key, Before, N, channel_note, N, peer, How).

:- end_tests(channel_receiver).
